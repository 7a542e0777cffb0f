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
  using Changed = std::function<void(const std::set<std::string>& files)>;
  /// changed: on the thread of io, with the paths given to `watch`
  FileWatch(boost::asio::io_context& io, Changed changed);

  /// Replaces the watched files. Folders that cannot be watched are skipped.
  void watch(const std::vector<std::string>& files);

 private:
  void read();
  void note(std::size_t bytes);

  boost::asio::posix::stream_descriptor events_;
  boost::asio::steady_timer timer_;
  Changed changed_;
  std::vector<std::string> files_;
  std::map<int, std::map<std::string, std::string>> paths_;  // by the watch of their folder, and by name
  std::set<std::string> news_;
  std::array<char, 4096> bytes_{};
};

}  // namespace opaline
