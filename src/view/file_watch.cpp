// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/file_watch.h"

#include <sys/inotify.h>

#include <boost/asio/buffer.hpp>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <utility>

namespace opaline {
namespace {

constexpr std::chrono::milliseconds kPause{100};

}  // namespace

FileWatch::FileWatch(boost::asio::io_context& io, std::function<void()> changed)
    : events_(io), timer_(io), changed_(std::move(changed)) {
  const int descriptor = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (descriptor < 0) return;  // too many on this machine
  events_.assign(descriptor);
  read();
}

void FileWatch::watch(const std::vector<std::string>& files) {
  if (!events_.is_open()) return;
  std::map<int, std::set<std::string>> names;
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::absolute(file);
    const int watch = ::inotify_add_watch(events_.native_handle(), path.parent_path().c_str(),
                                          IN_CLOSE_WRITE | IN_MOVED_TO);
    if (watch >= 0) names[watch].insert(path.filename().string());
  }
  for (const auto& [watch, old] : names_)
    if (!names.contains(watch)) ::inotify_rm_watch(events_.native_handle(), watch);
  names_ = std::move(names);
}

void FileWatch::read() {
  events_.async_read_some(boost::asio::buffer(bytes_),
                          [this](boost::system::error_code error, std::size_t bytes) {
                            if (error) return;
                            if (is_watched(bytes)) {
                              timer_.expires_after(kPause);
                              timer_.async_wait([this](boost::system::error_code stopped) {
                                if (!stopped) changed_();
                              });
                            }
                            read();
                          });
}

bool FileWatch::is_watched(std::size_t bytes) const {
  for (std::size_t at = 0; at + sizeof(inotify_event) <= bytes;) {
    inotify_event event;
    std::memcpy(&event, bytes_.data() + at, sizeof event);
    const char* const name = bytes_.data() + at + sizeof event;
    const auto known = names_.find(event.wd);
    if (known != names_.end() && event.len > 0 && known->second.contains(name)) return true;
    at += sizeof event + event.len;
  }
  return false;
}

}  // namespace opaline
