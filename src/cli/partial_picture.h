// SPDX-License-Identifier: GPL-3.0-or-later
// A picture under way, where its user can see it: in the files that it will be in, and in a viewer.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "cli/arguments.h"
#include "cli/display_server.h"
#include "opaline/render/render.h"

namespace opaline {

/// From a coarse picture to the last tile. Files are written whole, R G B A alone, at each coarse picture and
/// then every five seconds; the viewer has each tile within a tenth of one. What cannot be written is a
/// warning: the picture itself may yet be.
class PartialPicture {
 public:
  /// in    arguments: files are written if --write-partial is among them; viewer: null or outlives this
  PartialPicture(const RenderArguments& arguments, const Film& film, DisplayServer* viewer);
  /// Sends what is left to the viewer.
  ~PartialPicture();
  PartialPicture(const PartialPicture&) = delete;
  PartialPicture& operator=(const PartialPicture&) = delete;

  /// in    picture: R G B A, of the film's size; stage: of what, for the files' metadata
  void show(Image picture, const char* stage);

  /// Whether the files hold a picture of it.
  bool is_written() const { return is_written_; }

  /// Pixels that are as they will be, in the place of coarse ones; from any thread.
  /// in    picture: its first channels are R G B A
  void show_tile(const Image& picture, const Rectangle& done);

 private:
  void watch(const std::stop_token& stop);
  void send_tiles();
  void write_files(const Image& picture);

  std::vector<std::string> files_;
  bool is_written_ = false;
  std::string name_;
  Film film_;
  Log log_;
  DisplayServer* viewer_;
  std::mutex mutex_;  // of the next two
  Image shown_;
  std::vector<Rectangle> tiles_;  // not sent yet
  std::chrono::steady_clock::time_point written_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace opaline
