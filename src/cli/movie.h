// SPDX-License-Identifier: GPL-3.0-or-later
// A movie of the frames of a range, encoded by ffmpeg.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace opaline {

/// A movie whose frames are in a folder beside it until it is complete.
class Movie {
 public:
  /// Replaces the movie among the outputs by PNG files of the frames. None: no output is a movie.
  /// error Error{run_failed}: ffmpeg is missing, or the movie or its folder cannot be written
  static std::optional<Movie> take(RenderArguments& arguments);

  /// Removes the folder if it is empty.
  ~Movie();
  Movie(Movie&&) = default;
  Movie& operator=(Movie&&) = default;

  /// Encodes these frames of the folder (H.264, 4:2:0), then removes them.
  /// error Error{run_failed}: ffmpeg failed; the frames and any old movie remain
  void encode(const std::vector<int>& frames, int frames_per_second) const;

  const std::string& path() const { return path_; }

 private:
  explicit Movie(std::string path);

  std::string path_, folder_;
};

}  // namespace opaline
