// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_bytes.h"

namespace opaline {

PictureBytes::PictureBytes(const PictureSource& source) : source_(source) {
  if (source.bytes.empty()) file_.emplace(source.path, "image file");
}

std::string PictureBytes::read(std::uintmax_t begin, std::uintmax_t most) const {
  if (file_) return file_->read(begin, most);
  return begin < source_.bytes.size() ? source_.bytes.substr(begin, most) : std::string();
}

}  // namespace opaline
