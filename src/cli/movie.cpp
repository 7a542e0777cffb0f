// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/movie.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "opaline/error.h"
#include "values/frame_name.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr const char *kFrame = "frame.######.png", *kList = "frames.txt", *kEncoded = "movie.mp4";

/// Runs a program found in PATH, in this folder; returns false unless it exits with 0. Its messages go to stderr
/// unless it is silent.
bool succeeds(std::vector<std::string> words, const std::string& folder, bool is_silent) {
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (is_silent) ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  int status = 1;
  if (::posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ) == 0)
    ::waitpid(child, &status, 0);
  ::posix_spawn_file_actions_destroy(&actions);
  return status == 0;
}

}  // namespace

Movie::Movie(std::string path) : path_(std::move(path)), folder_(path_ + ".frames") {}

Movie::~Movie() {
  std::error_code not_empty;
  if (!folder_.empty()) fs::remove(folder_, not_empty);
}

std::optional<Movie> Movie::take(RenderArguments& arguments) {
  const auto output = std::ranges::find(arguments.outputs, OutputFormat::mp4, output_format);
  if (output == arguments.outputs.end()) return {};
  if (fs::is_directory(*output)) throw run_failed(*output, "cannot write: it is a folder");
  if (!succeeds({"ffmpeg", "-version"}, ".", true))
    throw run_failed(*output,
                     "a movie requires the program ffmpeg (Debian: apt-get install ffmpeg); "
                     "images of the frames, as -o out.####.png, do not");
  { const AtomicFile probe(*output); }
  Movie movie(*output);
  std::error_code failure;
  fs::create_directory(movie.folder_, failure);
  if (failure) throw run_failed(movie.folder_, "cannot create the folder: " + failure.message());
  *output = (fs::path(movie.folder_) / kFrame).string();
  return movie;
}

void Movie::encode(const std::vector<int>& frames, int frames_per_second) const {
  const fs::path folder(folder_);
  std::string list = "ffconcat version 1.0\n";
  for (const int frame : frames) list += "file " + with_frame(kFrame, frame) + '\n';
  write_file((folder / kList).string(), list);
  // Chroma has half the resolution, so sides are padded to even numbers.
  const std::string rate = std::to_string(frames_per_second);
  if (!succeeds({"ffmpeg",
                 "-nostdin",
                 "-y",
                 "-loglevel",
                 "error",
                 "-r",
                 rate,
                 "-f",
                 "concat",
                 "-i",
                 kList,
                 "-vf",
                 "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p",
                 "-c:v",
                 "libx264",
                 "-crf",
                 "16",
                 "-r",
                 rate,
                 "-movflags",
                 "+faststart",
                 kEncoded},
                folder_, false))
    throw run_failed(path_, "ffmpeg failed; the frames are in " + folder_);
  std::error_code failure;
  fs::rename(folder / kEncoded, path_, failure);
  if (failure) throw run_failed(path_, "cannot write: " + failure.message());
  for (const int frame : frames) fs::remove(folder / with_frame(kFrame, frame), failure);
  fs::remove(folder / kList, failure);
}

}  // namespace opaline
