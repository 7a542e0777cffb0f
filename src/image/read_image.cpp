// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>

#include "image/picture_module.h"
#include "image/picture_reader.h"
#include "opaline/core/error.h"
#include "opaline/image/image.h"

namespace opaline {

// Looked for along the run path of the program.
void* picture_module_function(const char* name) {
  constexpr const char* file = "opaline_picture_reader.so";
  void* const module = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* const function = module != nullptr ? ::dlsym(module, name) : nullptr;
  if (function == nullptr)
    throw run_failed(file, std::string("cannot load what reads pictures: ") + ::dlerror());
  return function;
}

Image read_image(const std::string& path) {
  static const ReadPicture read = reinterpret_cast<decltype(&opaline_picture_reader)>(
      picture_module_function("opaline_picture_reader"))();
  return read(path);
}

}  // namespace opaline
