// SPDX-License-Identifier: GPL-3.0-or-later
// Image sums of --resume.
#pragma once

#include <string>

#include "opaline/error.h"
#include "opaline/image.h"

namespace opaline {

/// error Error{bad_input} with a remedy: damaged, or not an image
inline Image read_sums_file(const std::string& path) {
  try {
    return read_image(path);
  } catch (const Error& failure) {
    throw Error(failure.kind, failure.file, 0, 0, "holds no sums to resume from: " + failure.message,
                "the sums of an earlier run, or a new file name", failure.got);
  }
}

}  // namespace opaline
