// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/movie.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// Runs a program of the path; returns false unless it exits with 0. Messages go to stderr, or nowhere.
bool succeeds(std::vector<std::string> words, bool is_silent) {
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_addopen(&streams, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (is_silent) ::posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  int status = 1;
  if (::posix_spawnp(&child, pointers[0], &streams, nullptr, pointers.data(), environ) == 0)
    ::waitpid(child, &status, 0);
  ::posix_spawn_file_actions_destroy(&streams);
  return status == 0;
}

}  // namespace

std::optional<Movie> take_movie(RenderArguments& arguments) {
  const auto output = std::ranges::find(arguments.outputs, OutputFormat::mp4, output_format);
  if (output == arguments.outputs.end()) return {};
  Movie movie{*output, *output + ".frames"};
  if (!succeeds({"ffmpeg", "-version"}, true))
    throw run_failed(movie.path,
                     "a movie requires the program ffmpeg (Debian: apt-get install ffmpeg); "
                     "images of the frames, as -o out.####.png, do not");
  std::error_code failure;
  fs::create_directories(movie.folder, failure);
  if (failure) throw run_failed(movie.folder, "cannot create the folder: " + failure.message());
  *output = (fs::path(movie.folder) / "frame.######.png").string();
  return movie;
}

void encode(const Movie& movie, int frames_per_second) {
  const std::string encoded = (fs::path(movie.folder) / "movie.mp4").string();
  // Chroma has half the resolution, so sides are padded to even numbers.
  if (!succeeds({"ffmpeg",
                 "-nostdin",
                 "-y",
                 "-loglevel",
                 "error",
                 "-framerate",
                 std::to_string(frames_per_second),
                 "-pattern_type",
                 "glob",
                 "-i",
                 movie.folder + "/frame.*.png",
                 "-vf",
                 "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p",
                 "-c:v",
                 "libx264",
                 "-crf",
                 "16",
                 "-movflags",
                 "+faststart",
                 encoded},
                false))
    throw run_failed(movie.path, "ffmpeg failed; the frames are in " + movie.folder);
  std::error_code failure;
  fs::rename(encoded, movie.path, failure);
  if (failure) throw run_failed(movie.path, "cannot write: " + failure.message());
  fs::remove_all(movie.folder, failure);
}

}  // namespace opaline
