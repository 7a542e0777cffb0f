// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>

#include <new>
#include <string>

#include "core/input_file.h"
#include "image/picture_module.h"
#include "image/picture_reader.h"
#include "image/read_exr.h"
#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {
namespace {

constexpr const char* kModule = "opaline_picture_reader.so";

}  // namespace

// Found through the run path of the program.
void* picture_module_function(const char* name) {
  void* const module = ::dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
  void* const function = module != nullptr ? ::dlsym(module, name) : nullptr;
  if (function != nullptr) return function;
  const std::string reason = ::dlerror();
  // Messages of the dynamic loader.
  for (const char* no_memory : {"failed to map segment", "annot allocate memory"})
    if (reason.find(no_memory) != std::string::npos) throw std::bad_alloc();
  throw run_failed(kModule, "cannot load the image-reader plugin: " + reason);
}

bool picture_module_is_loaded() {
  void* const module = ::dlopen(kModule, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
  if (module != nullptr) ::dlclose(module);
  return module != nullptr;
}

Image read_image(const std::string& path) {
  {
    const InputFile file(path, "image file");
    if (file.read(0, 4) == "\x76\x2f\x31\x01") return read_exr(path, file.size());
  }
  static const ReadPicture read = reinterpret_cast<decltype(&opaline_picture_reader)>(
      picture_module_function("opaline_picture_reader"))();
  return read(path);
}

}  // namespace opaline
