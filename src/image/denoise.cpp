// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/denoise.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "opaline/error.h"

namespace opaline {
namespace {

constexpr int kMostMegabytes = 256;  // for the filter; larger images are filtered in tiles
constexpr const char *kLibrary = "libOpenImageDenoise.so.2", *kVariable = "OPALINE_DENOISER";

/// Functions of the library's C interface, version 2.
struct Library {
  static constexpr int kCpu = 1, kFloat3 = 3, kCancelled = 6;
  using Progress = bool (*)(void* user, double done);

  void* (*new_device)(int type);
  void (*set_device_int)(void* device, const char* name, int value);
  void (*set_device_bool)(void* device, const char* name, bool value);
  int (*get_device_int)(void* device, const char* name);
  void (*commit_device)(void* device);
  int (*get_device_error)(void* device, const char** message);
  void (*release_device)(void* device);
  void* (*new_filter)(void* device, const char* type);
  void (*set_shared_image)(void* filter, const char* name, void* first, int format, std::size_t width,
                           std::size_t height, std::size_t offset, std::size_t pixel_stride,
                           std::size_t row_stride);
  void (*set_filter_bool)(void* filter, const char* name, bool value);
  void (*set_filter_int)(void* filter, const char* name, int value);
  void (*set_progress)(void* filter, Progress progress, void* user);
  void (*commit_filter)(void* filter);
  void (*execute_filter)(void* filter);
  void (*release_filter)(void* filter);
};

Library load() {
  const char* const named = std::getenv(kVariable);
  const std::string file = named != nullptr && *named != '\0' ? named : kLibrary;
  void* const module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const auto missing = [&](const std::string& what) {
    return run_failed(file, fmt::format("{}; install Open Image Denoise 2, or name its library in {} (PyPI's "
                                        "pyoidn has it: docs/rendering.md)",
                                        what, kVariable));
  };
  if (module == nullptr) throw missing(std::string("cannot load the denoiser: ") + ::dlerror());
  Library library{};
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(module, name));
    if (function == nullptr) throw missing(std::string("the denoiser lacks the function ") + name);
  };
  find(library.new_device, "oidnNewDevice");
  find(library.set_device_int, "oidnSetDeviceInt");
  find(library.set_device_bool, "oidnSetDeviceBool");
  find(library.get_device_int, "oidnGetDeviceInt");
  find(library.commit_device, "oidnCommitDevice");
  find(library.get_device_error, "oidnGetDeviceError");
  find(library.release_device, "oidnReleaseDevice");
  find(library.new_filter, "oidnNewFilter");
  find(library.set_shared_image, "oidnSetSharedFilterImage");
  find(library.set_filter_bool, "oidnSetFilterBool");
  find(library.set_filter_int, "oidnSetFilterInt");
  find(library.set_progress, "oidnSetFilterProgressMonitorFunction");
  find(library.commit_filter, "oidnCommitFilter");
  find(library.execute_filter, "oidnExecuteFilter");
  find(library.release_filter, "oidnReleaseFilter");
  return library;
}

const Library& library() {
  static const Library loaded = load();
  return loaded;
}

/// The processor, with as many threads as the program may use.
class Device {
 public:
  Device() : device_(library().new_device(Library::kCpu)) {
    library().set_device_int(
        device_, "numThreads",
        int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    library().set_device_bool(device_, "setAffinity", false);
    library().commit_device(device_);
    check();
  }
  ~Device() { library().release_device(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void* get() const { return device_; }
  int value(const char* name) const { return library().get_device_int(device_, name); }
  void check() const {
    const char* message = nullptr;
    const int error = library().get_device_error(device_, &message);
    if (error == Library::kCancelled) throw Error(ErrorKind::interrupted, {}, 0, 0, "interrupted");
    if (error != 0)
      throw run_failed({}, fmt::format("the denoiser failed: {}", message != nullptr ? message : "unknown"));
  }

 private:
  void* device_;
};

/// Place of a layer's first channel among those of a pixel; none: the image lacks it.
std::optional<std::size_t> layer_of(const Image& image, const std::string& first) {
  const auto found = std::ranges::find(image.channels, first);
  if (found == image.channels.end()) return {};
  return std::size_t(found - image.channels.begin());
}

bool is_black(const Image& image, std::size_t layer) {
  for (std::size_t i = layer; i < image.pixels.size(); i += image.channels.size())
    if (image.pixels[i] != 0 || image.pixels[i + 1] != 0 || image.pixels[i + 2] != 0) return false;
  return true;
}

/// One filtered layer, three values per pixel.
std::vector<float> filtered(const Device& device, Image& image, std::size_t layer,
                            std::optional<std::size_t> albedo, std::optional<std::size_t> normal,
                            Monitor* monitor) {
  const Library& oidn = library();
  const auto width = std::size_t(image.width), height = std::size_t(image.height),
             stride = image.channels.size() * sizeof(float);
  std::vector<float> output(3 * width * height);
  void* const filter = oidn.new_filter(device.get(), "RT");
  const auto set = [&](const char* name, std::size_t channel) {
    oidn.set_shared_image(filter, name, image.pixels.data() + channel, Library::kFloat3, width, height, 0,
                          stride, stride * width);
  };
  set("color", layer);
  if (albedo) set("albedo", *albedo);
  if (albedo && normal) set("normal", *normal);  // normals alone are not allowed
  oidn.set_shared_image(filter, "output", output.data(), Library::kFloat3, width, height, 0, 0, 0);
  oidn.set_filter_bool(filter, "hdr", true);
  oidn.set_filter_int(filter, "maxMemoryMB", kMostMegabytes);
  oidn.set_progress(
      filter,
      [](void* user, double) {
        const auto* const watched = static_cast<const Monitor*>(user);
        return watched == nullptr || !watched->cancelled;
      },
      monitor);
  oidn.commit_filter(filter);
  oidn.execute_filter(filter);
  oidn.release_filter(filter);
  device.check();
  return output;
}

}  // namespace

std::string denoiser_name() {
  static const std::string name = [] {
    const Device device;
    return fmt::format("Open Image Denoise {}.{}.{}", device.value("versionMajor"),
                       device.value("versionMinor"), device.value("versionPatch"));
  }();
  return name;
}

void denoise(Image& image, std::span<const std::uint8_t> has_error, Monitor* monitor) {
  if (monitor != nullptr) monitor->begin("denoising", 0);
  const std::optional<std::size_t> color = layer_of(image, "R"), error = layer_of(image, "error.R"),
                                   variance = layer_of(image, "variance.R"),
                                   albedo = layer_of(image, "albedo.R"), normal = layer_of(image, "N.X");
  const Device device;
  const std::size_t step = image.channels.size(), pixels = image.pixels.size() / step;
  for (const char* name : {"diffuse.R", "specular.R"}) {
    const std::optional<std::size_t> layer = layer_of(image, name);
    if (!layer || is_black(image, *layer)) continue;
    const std::vector<float> smooth = filtered(device, image, *layer, albedo, normal, monitor);
    const bool is_diffuse = *name == 'd';
    for (std::size_t i = 0; i < pixels; ++i) {
      float* const pixel = image.pixels.data() + i * step;
      for (std::size_t c = 0; c < 3; ++c) {
        float& value = pixel[*layer + c];
        if (!(value >= 0)) continue;  // a colour outside Rec.709, clamped by the filter
        float change = smooth[3 * i + c] - value;
        if (is_diffuse && (error || variance) && i < has_error.size() && has_error[i] != 0) {
          const float most = 2 * (error ? pixel[*error + c] : std::sqrt(std::max(0.f, pixel[*variance + c])));
          change = std::clamp(change, -most, most);
        }
        value += change;
        if (color) pixel[*color + c] += change;
      }
    }
  }
}

}  // namespace opaline
