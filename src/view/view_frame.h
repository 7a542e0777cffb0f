// SPDX-License-Identifier: GPL-3.0-or-later
// A picture as the bytes that a page draws.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "view/view_renderer.h"

namespace opaline {

// The first word of a frame: whole, as a JPEG, a band of its rows.
inline constexpr std::uint32_t kFrameMark = 0x314c504f, kJpegMark = 0x324c504f,
                               kBandMark = 0x334c504f;  // "OPL1", ...

/// Little endian: eight 32-bit words (kFrameMark, number, revision, step, width, height, channels of the layer, the
/// picture's time in microseconds), then R G B A of each pixel as halves, then the layer of each pixel as floats.
/// layer: as `opaline render --layers` names it; the frame has none where the picture lacks it
std::string pack_frame(const ViewPicture& picture, std::uint32_t number, const std::string& layer);

/// The length of that, bytes.
std::size_t frame_size(const ViewPicture& picture, const std::string& layer);

/// The colours within some percent, in about a thirtieth of the bytes: the same words with kJpegMark, no layer, and
/// the step `sharper` where the picture is final; the largest value P as a float; a JPEG of
/// log2(1 + 16 x) / log2(1 + 16 P) of R G B.
std::string pack_jpeg(const ViewPicture& picture, std::uint32_t number);

/// Whether it has no more pixels on a side than the format allows.
bool can_be_jpeg(const ViewPicture& picture);

/// What pack_frame holds, exactly, in bands of rows: of those that differ from what the page has.
class FrameBands {
 public:
  /// In place of what is left of the picture before.
  void begin(std::shared_ptr<const ViewPicture> picture, std::string layer);
  void stop() { picture_.reset(); }
  bool has_next() const { return picture_ != nullptr; }
  bool is_first() const { return row_ == 0; }

  /// The same words with kBandMark; the first row and the number of rows, 32 bits each; of these rows, deflated: for
  /// each of R G B A the lower bytes of all halves and then the upper ones, for each channel of the layer the four
  /// bytes likewise. A band of no rows is the last.
  std::string next(std::uint32_t number);

 private:
  std::shared_ptr<const ViewPicture> picture_;
  std::string layer_;
  std::vector<std::size_t> channels_;
  int width_ = 0, height_ = 0, rows_ = 0, row_ = 0;
  std::vector<std::string> held_;  ///< by the page, a band each, not deflated
};

}  // namespace opaline
