// SPDX-License-Identifier: GPL-3.0-or-later
#include "encode.h"

#include <OpenImageIO/filesystem.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"

namespace opaline {
namespace {

/// The file under OpenImageIO's encoders. It remembers the first failure of any write or seek, since they do
/// not: on a full disk OpenImageIO 2.4's own file says true from open, write_image and close without a
/// message when the failure falls into the last buffered kilobytes of an EXR (OpenEXR's destructor swallows
/// it), or anywhere in a small PNG. Nor does it know the reason.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
 public:
  explicit CheckedFile(const std::string& path)
      : IOProxy(path, IOProxy::Write), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) remember();
  }
  ~CheckedFile() override {
    if (file_) std::fclose(file_);
  }
  CheckedFile(const CheckedFile&) = delete;
  CheckedFile& operator=(const CheckedFile&) = delete;

  const char* proxytype() const override { return "checked"; }
  int64_t tell() override { return file_ ? ::ftello(file_) : -1; }

  bool seek(int64_t offset) override {
    if (file_ && ::fseeko(file_, offset, SEEK_SET) == 0) return true;
    remember();
    return false;
  }

  size_t write(const void* bytes, size_t size) override {
    const size_t written = file_ ? std::fwrite(bytes, 1, size, file_) : 0;
    if (written < size) remember();
    return written;
  }

  /// Closes; 0, or the errno of the first thing that failed since the start.
  int finish() {
    if (file_ && std::fclose(std::exchange(file_, nullptr)) != 0) remember();
    return failure_;
  }

 private:
  void remember() {
    if (failure_ == 0) failure_ = errno != 0 ? errno : EIO;
  }

  std::FILE* file_ = nullptr;
  int failure_ = 0;
};

/// A multiple of the 16 rows that ZIP compresses together.
constexpr int strip_rows = 64;

bool write_strips(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                  const FillRows& rows) {
  for (int first = 0; first < spec.height; first += strip_rows) {
    const int count = std::min(strip_rows, spec.height - first);
    if (!output.write_scanlines(spec.y + first, spec.y + first + count, 0, type, rows(first, count)))
      return false;
  }
  return true;
}

}  // namespace

std::string one_line(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

void encode(const std::string& path, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
            const FillRows& rows) {
  AtomicFile file(path);
  CheckedFile sink(file.temporary());
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) throw run_failed(path, "cannot write: " + one_line(OIIO::geterror()));
  bool written = output->set_ioproxy(&sink) && output->open(file.temporary(), spec) &&
                 write_strips(*output, spec, type, rows);
  written = output->close() && written;
  const std::string complaint = one_line(output->geterror());  // not fetched, OpenImageIO 2.5 prints it
  output.reset();                                              // may still write
  if (const int failure = sink.finish())
    throw run_failed(path, std::string("cannot write: ") + std::strerror(failure));
  if (!written || !complaint.empty()) throw run_failed(path, "cannot write: " + complaint);
  file.commit();
}

}  // namespace opaline
