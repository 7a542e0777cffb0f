// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>

#include "opaline/core/error.h"
#include "opaline/image/image.h"
#include "picture_reader.h"

namespace opaline {
namespace {

// Looked for along the run path of the program.
constexpr const char* kModule = "opaline_picture_reader.so";

ReadPicture load_reader() {
  void* const module = ::dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
  void* const symbol = module != nullptr ? ::dlsym(module, "opaline_picture_reader") : nullptr;
  if (symbol == nullptr)
    throw run_failed(kModule, std::string("cannot load what reads pictures: ") + ::dlerror());
  return reinterpret_cast<decltype(&opaline_picture_reader)>(symbol)();
}

}  // namespace

Image read_image(const std::string& path) {
  static const ReadPicture read = load_reader();
  return read(path);
}

}  // namespace opaline
