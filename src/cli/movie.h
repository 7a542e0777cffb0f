// SPDX-License-Identifier: GPL-3.0-or-later
// A movie of the frames of a range, encoded by ffmpeg.
#pragma once

#include <optional>
#include <string>

#include "cli/arguments.h"

namespace opaline {

/// A movie and the folder of its frames, beside it until the movie is complete.
struct Movie {
  std::string path, folder;
};

/// Replaces the movie among the outputs by PNG files of the frames. None: no output is a movie.
/// error Error{run_failed}: ffmpeg is missing, or the folder cannot be made
std::optional<Movie> take_movie(RenderArguments& arguments);

/// Encodes all frames in the folder (H.264, 4:2:0) and removes the folder.
/// error Error{run_failed}: ffmpeg failed; the frames remain
void encode(const Movie& movie, int frames_per_second);

}  // namespace opaline
