// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of files on the disk.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace opaline {

/// Calls back after files are written or replaced, once for changes in quick succession.
class FileWatch {
 public:
  /// changed: on the thread of io
  FileWatch(boost::asio::io_context& io, std::function<void()> changed);

  /// Replaces the watched files. Folders that cannot be watched are skipped.
  void watch(const std::vector<std::string>& files);

 private:
  void read();
  bool is_watched(std::size_t bytes) const;

  boost::asio::posix::stream_descriptor events_;
  boost::asio::steady_timer timer_;
  std::function<void()> changed_;
  std::map<int, std::set<std::string>> names_;  // by the watch of their folder
  std::array<char, 4096> bytes_{};
};

}  // namespace opaline
