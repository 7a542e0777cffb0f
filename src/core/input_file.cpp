// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "opaline/error.h"

namespace opaline {
namespace {

/// error unless it is a regular file
void check_kind(const std::string& path, mode_t mode) {
  if (S_ISREG(mode)) return;
  const char* const kind = S_ISDIR(mode)    ? "a folder"
                           : S_ISFIFO(mode) ? "a pipe"
                           : S_ISSOCK(mode) ? "a socket"
                                            : "a device";
  throw bad_file(path, std::string("is ") + kind, "a regular file");
}

}  // namespace

InputFile::Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

// Checks the file type before opening, as opening a device may have effects, and again after, as another file
// may have taken its name.
InputFile::InputFile(const std::string& path, const std::string& noun,
                     std::string (*hint)(const std::string& path))
    : path_(path) {
  struct stat status {};
  bool good = ::stat(path.c_str(), &status) == 0;
  if (good) {
    check_kind(path, status.st_mode);
    descriptor_.number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    good = descriptor_.number >= 0 && ::fstat(descriptor_.number, &status) == 0;
  }
  if (!good && (errno == ENOENT || errno == ENOTDIR))
    throw bad_file(path, "no such " + noun + (hint != nullptr ? hint(path) : ""));
  if (!good) throw bad_file(path, std::string("cannot be opened: ") + std::strerror(errno));
  check_kind(path, status.st_mode);
  size_ = std::uintmax_t(status.st_size);
}

std::string InputFile::read(std::uintmax_t begin, std::uintmax_t most) const {
  std::string bytes(begin < size_ ? std::min(most, size_ - begin) : 0, '\0');
  std::size_t at = 0;
  while (at < bytes.size()) {
    const ssize_t got = ::pread(descriptor_.number, bytes.data() + at, bytes.size() - at, off_t(begin + at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw run_failed(path_, std::string("reading failed: ") + std::strerror(errno));
    if (got == 0) break;
    at += std::size_t(got);
  }
  bytes.resize(at);
  return bytes;
}

std::string InputFile::read_all() const {
  std::string bytes = read(0, size_);
  if (bytes.size() < size_) throw run_failed(path_, "reading failed: the file was truncated during reading");
  return bytes;
}

}  // namespace opaline
