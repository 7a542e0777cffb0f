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

FileWatch::FileWatch(boost::asio::io_context& io, Changed changed)
    : events_(io), timer_(io), changed_(std::move(changed)) {
  const int descriptor = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (descriptor < 0) return;  // too many on this machine
  events_.assign(descriptor);
  read();
}

void FileWatch::watch(const std::vector<std::string>& files) {
  if (!events_.is_open() || files == files_) return;
  files_ = files;
  std::map<int, std::map<std::string, std::string>> paths;
  for (const std::string& file : files) {
    std::error_code missing;
    const std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file), missing);
    const int watch = ::inotify_add_watch(events_.native_handle(), path.parent_path().c_str(),
                                          IN_CLOSE_WRITE | IN_MOVED_TO);
    if (watch >= 0)
      paths[watch][path.filename().string()] = file;
    else
      files_.clear();  // its folder may come
  }
  for (const auto& [watch, old] : paths_)
    if (!paths.contains(watch)) ::inotify_rm_watch(events_.native_handle(), watch);
  paths_ = std::move(paths);
}

void FileWatch::read() {
  events_.async_read_some(boost::asio::buffer(bytes_),
                          [this](boost::system::error_code error, std::size_t bytes) {
                            if (error) return;
                            note(bytes);
                            if (!news_.empty()) {
                              timer_.expires_after(kPause);
                              timer_.async_wait([this](boost::system::error_code stopped) {
                                if (!stopped) changed_(std::exchange(news_, {}));
                              });
                            }
                            read();
                          });
}

void FileWatch::note(std::size_t bytes) {
  for (std::size_t at = 0; at + sizeof(inotify_event) <= bytes;) {
    inotify_event event;
    std::memcpy(&event, bytes_.data() + at, sizeof event);
    if ((event.mask & IN_IGNORED) != 0)
      files_.clear();  // a folder was removed; the next edit watches a new one
    const auto folder = paths_.find(event.wd);
    if (folder != paths_.end() && event.len > 0)
      if (const auto path = folder->second.find(bytes_.data() + at + sizeof event);
          path != folder->second.end())
        news_.insert(path->second);
    at += sizeof event + event.len;
  }
}

}  // namespace opaline
