// SPDX-License-Identifier: GPL-3.0-or-later
// A stand-in for Open Image Denoise, with the same C interface: each pixel becomes the mean of its row. Refuses albedo below 0, and normals
// without albedo, as errors.
#include <cstddef>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Plane {
  char* first = nullptr;
  std::size_t width = 0, height = 0, pixel = 0, row = 0;
  float& at(std::size_t x, std::size_t y, std::size_t c) const {
    return reinterpret_cast<float*>(first + y * row + x * pixel)[c];
  }
};

struct Filter {
  std::map<std::string, Plane> images;
  bool (*progress)(void*, double) = nullptr;
  void* user = nullptr;
};

int error = 0;
const char* message = nullptr;

}  // namespace

extern "C" {
void* oidnNewDevice(int) {
  return &error;
}
void oidnSetDeviceInt(void*, const char*, int) {}
void oidnSetDeviceBool(void*, const char*, bool) {}
int oidnGetDeviceInt(void*, const char* name) {
  return std::strcmp(name, "versionMajor") == 0 ? 2 : 0;
}
void oidnCommitDevice(void*) {}
int oidnGetDeviceError(void*, const char** text) {
  const int last = error;
  *text = message;
  error = 0;
  return last;
}
void oidnReleaseDevice(void*) {}
void* oidnNewFilter(void*, const char*) {
  return new Filter;
}
void oidnSetSharedFilterImage(void* filter, const char* name, void* first, int, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel, std::size_t row) {
  if (pixel == 0) pixel = 3 * sizeof(float);
  if (row == 0) row = pixel * width;
  static_cast<Filter*>(filter)->images[name] = {static_cast<char*>(first) + offset, width, height, pixel,
                                                row};
}
void oidnSetFilterBool(void*, const char*, bool) {}
void oidnSetFilterInt(void*, const char*, int) {}
void oidnSetFilterProgressMonitorFunction(void* filter, bool (*progress)(void*, double), void* user) {
  static_cast<Filter*>(filter)->progress = progress;
  static_cast<Filter*>(filter)->user = user;
}
void oidnCommitFilter(void*) {}
void oidnExecuteFilter(void* handle) {
  const Filter& filter = *static_cast<Filter*>(handle);
  if (!filter.progress(filter.user, 0)) {
    error = 6;
    return;
  }
  const auto albedo = filter.images.find("albedo");
  if ((albedo != filter.images.end() && albedo->second.at(0, 0, 0) < 0) ||
      (albedo == filter.images.end() && filter.images.contains("normal"))) {
    error = 3;
    message = "invalid guide";
    return;
  }
  const Plane color = filter.images.at("color"), output = filter.images.at("output");
  for (std::size_t y = 0; y < color.height; ++y)
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = 0;
      for (std::size_t x = 0; x < color.width; ++x) sum += color.at(x, y, c);
      for (std::size_t x = 0; x < color.width; ++x) output.at(x, y, c) = sum / float(color.width);
    }
}
void oidnReleaseFilter(void* filter) {
  delete static_cast<Filter*>(filter);
}
}
