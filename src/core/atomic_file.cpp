// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

struct Descriptor {
  int number = -1;
  ~Descriptor() { close(); }
  /// 0 or -1 with errno; only once.
  int close() { return number < 0 ? 0 : ::close(std::exchange(number, -1)); }
};

std::string reason() {
  return std::strerror(errno);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// Follows links: the target is replaced, or created if missing.
std::string resolve_link(const std::string& path) {
  constexpr int kMostLinks = 40;  // as the kernel's own limit
  std::error_code failure;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, failure)); ++links) {
    if (links == kMostLinks) throw run_failed(path, std::string("cannot write: ") + std::strerror(ELOOP));
    const fs::path next = fs::read_symlink(target, failure);
    if (failure) throw run_failed(path, "cannot write: " + failure.message());
    target = folder_of(target) / next;  // only `next` if it is absolute
  }
  return target.string();
}

/// Checks before the work: a rename would silently replace a device or a write-protected file.
void require_replaceable(const std::string& path) {
  if (!fs::path(path).has_filename()) throw run_failed(path, "cannot write: it has no file name");
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::not_found) return;
  if (!fs::status_known(status)) throw run_failed(path, "cannot write: " + failure.message());
  if (fs::is_directory(status)) throw run_failed(path, "cannot write: it is a folder");
  if (!fs::is_regular_file(status)) throw run_failed(path, "cannot write: it is not a regular file");
  // Another process may have removed it since.
  if (::access(path.c_str(), W_OK) != 0 && errno != ENOENT)
    throw run_failed(path, "cannot write: " + reason());
}

/// Creates an empty file beside `path` with a unique name, also between hosts sharing the folder.
std::string create_beside(const fs::path& path) {
  const fs::path folder = folder_of(path);
  const std::string stem = ".opaline-" + std::to_string(::getpid()) + '-';
  std::error_code unknown;
  for (int counter = 0;; ++counter) {
    const fs::path name = folder / (stem + std::to_string(counter) + path.extension().string());
    Descriptor file{::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
    if (file.number >= 0) return name.string();
    if (errno == ENOENT && !fs::exists(folder, unknown))
      throw run_failed(path.string(), "no such folder '" + folder.string() + "'");
    if (errno != EEXIST)
      throw run_failed(path.string(), "cannot write in the folder '" + folder.string() + "': " + reason());
  }
}

/// 0, or the errno of the failure.
int flush_to_disk(const fs::path& path, int flags) {
  Descriptor file{::open(path.c_str(), flags | O_CLOEXEC)};
  if (file.number < 0 || ::fsync(file.number) != 0 || file.close() != 0) return errno;
  return 0;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(resolve_link(path)) {
  require_replaceable(path_);
  temporary_ = create_beside(path_);
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::append(std::string_view bytes) {
  Descriptor file{::open(temporary_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)};
  if (file.number < 0) throw run_failed(path_, "cannot write: " + reason());
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw run_failed(path_, "cannot write: " + reason());
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (file.close() != 0) throw run_failed(path_, "cannot write: " + reason());
}

void AtomicFile::commit() {
  put_in_place(flush_to_disk(temporary_, O_WRONLY));
  // Flushes the folder of the new file. A folder without read permission, or a file system without folder
  // flushes (EINVAL), is not an error.
  const int failure = flush_to_disk(folder_of(path_), O_RDONLY | O_DIRECTORY);
  if (failure != 0 && failure != EACCES && failure != EINVAL)
    throw run_failed(path_, std::string("written, but its folder could not be flushed to disk: ") +
                                std::strerror(failure));
}

void AtomicFile::commit_unflushed() {
  put_in_place(0);
}

void AtomicFile::put_in_place(int failure) {
  require(!committed_, "an atomic file is committed once");
  if (failure == 0 && std::rename(temporary_.c_str(), path_.c_str()) != 0) failure = errno;
  if (failure != 0) {
    ::unlink(temporary_.c_str());
    throw run_failed(path_, std::string("cannot write: ") + std::strerror(failure));
  }
  committed_ = true;
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.append(bytes);
  file.commit();
}

}  // namespace opaline
