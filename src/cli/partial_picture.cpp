// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/partial_picture.h"

#include <algorithm>
#include <condition_variable>
#include <exception>

#include "cli/render_outputs.h"

namespace opaline {
namespace {

constexpr std::chrono::milliseconds kLook{100};
constexpr std::chrono::seconds kBetweenFiles{5};
constexpr int kRows = 256;  // sent at once: a packet's length has 32 bits

}  // namespace

PartialPicture::PartialPicture(const RenderArguments& arguments, const Film& film, DisplayServer* viewer)
    : name_(arguments.outputs.front()), film_(film), log_(arguments.log), viewer_(viewer) {
  if (arguments.write_partial) files_ = arguments.outputs;
}

PartialPicture::~PartialPicture() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  send_tiles();
}

void PartialPicture::show(Image picture, const char* stage) {
  const bool is_first = shown_.pixels.empty();
  shown_ = std::move(picture);
  shown_.metadata = {{"opaline:partial", stage}};
  if (viewer_ != nullptr) {
    if (is_first) viewer_->create(name_, shown_);
    const Rectangle part = rendered_part(film_);
    for (int y = part.y0; y < part.y1; y += kRows)
      viewer_->update(name_, shown_, {part.x0, y, part.x1, std::min(y + kRows, part.y1)});
  }
  write_files(shown_);
  is_written_ = !files_.empty();
}

void PartialPicture::show_tile(const Image& picture, const Rectangle& done) {
  const std::lock_guard lock(mutex_);
  for (int y = done.y0; y < done.y1; ++y)
    for (int x = done.x0; x < done.x1; ++x) {
      const std::size_t pixel =
          std::size_t(y - picture.crop_y) * std::size_t(picture.width) + std::size_t(x - picture.crop_x);
      std::copy_n(picture.pixels.data() + pixel * picture.channels.size(), shown_.channels.size(),
                  shown_.pixels.data() + pixel * shown_.channels.size());
    }
  tiles_.push_back(done);
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void PartialPicture::watch(const std::stop_token& stop) {
  std::mutex asleep;
  std::condition_variable_any never;
  std::unique_lock lock(asleep);
  while (!never.wait_for(lock, stop, kLook, [&] { return stop.stop_requested(); })) {
    send_tiles();
    if (files_.empty() || std::chrono::steady_clock::now() - written_ < kBetweenFiles) continue;
    std::unique_lock reading(mutex_);
    Image picture = shown_;
    reading.unlock();
    picture.metadata = {{"opaline:partial", "tiles"}};
    write_files(picture);
  }
}

// Workers write other tiles of shown_ meanwhile, never these.
void PartialPicture::send_tiles() {
  std::vector<Rectangle> tiles;
  {
    const std::lock_guard lock(mutex_);
    tiles.swap(tiles_);
  }
  if (viewer_ == nullptr) return;
  for (const Rectangle& tile : tiles) viewer_->update(name_, shown_, tile);
}

void PartialPicture::write_files(const Image& picture) {
  try {
    for (const std::string& path : files_) write_picture(path, picture, film_, {});
  } catch (const std::exception& failure) {
    print_warning(log_, std::string("no partial pictures are written: ") + failure.what());
    files_.clear();
  }
  written_ = std::chrono::steady_clock::now();
}

}  // namespace opaline
