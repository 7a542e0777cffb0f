// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <set>

#include "cli/metadata.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "input/load_scene.h"
#include "opaline/error.h"
#include "opaline/image.h"
#include "session/scene_hash.h"
#include "values/frame_name.h"
#include "values/json_tree.h"

namespace opaline {
namespace {

constexpr std::size_t kMostFrames = 100000;

/// Takes a whole number off the front.
std::optional<int> take_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || number < 0) return {};
  text.remove_prefix(std::size_t(end - text.data()));
  return number;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::vector<int> parse_frames(const std::string& text) {
  const auto refused = [&](const std::string& message, const std::string& expected) {
    return Error(ErrorKind::bad_input, "--frames", 0, 0, message, expected, printable(text));
  };
  const char* const such_as = "a range such as 1-24, 1-24x2 or 1,5,7-9";
  std::set<int> frames;
  std::string_view rest = text;
  do {
    const std::optional<int> first = take_number(rest);
    const std::optional<int> last = take(rest, '-') ? take_number(rest) : first;
    const std::optional<int> step = take(rest, 'x') ? take_number(rest) : 1;
    if (!first || !last || !step || *step < 1) throw refused("bad frame range", such_as);
    if (*last < *first) throw refused("a range ends before it begins", such_as);
    for (std::int64_t frame = *first; frame <= *last; frame += *step) {
      frames.insert(int(frame));
      if (frames.size() > kMostFrames) throw refused("too many frames", "at most " + grouped(kMostFrames));
    }
  } while (take(rest, ','));
  if (!rest.empty()) throw refused("bad frame range", such_as);
  return std::vector<int>(frames.begin(), frames.end());
}

std::string frames_text(const std::vector<int>& frames) {
  const bool is_range = frames.size() > 1 && std::size_t(frames.back() - frames.front()) == frames.size() - 1;
  return is_range ? fmt::format("{}-{}", frames.front(), frames.back())
                  : fmt::format("{}", fmt::join(frames, ","));
}

void for_frames(const Log& log, const std::vector<int>& frames, FramesSoFar& so_far,
                const std::function<bool(int)>& work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto begin = Clock::now();
  so_far = {frames.size()};
  std::vector<int> failed;
  Monitor between;  // monitor between two frames
  const InterruptHandler interrupt(between);
  const auto stopped = [&](const std::string& words) {
    return Error(ErrorKind::interrupted, {}, 0, 0,
                 fmt::format("{}; {} of {} frames are done; repeat the command to render the others", words,
                             so_far.finished - failed.size(), frames.size()));
  };
  for (const int frame : frames) {
    if (between.cancelled) throw stopped("interrupted");
    if (!log.quiet && log.format == LogFormat::text) write_line(stdout, fmt::format("\nframe {}", frame));
    if (!log.quiet) print_event(log, "frame", {{"frame", frame}});
    const auto start = Clock::now();
    try {
      if (work(frame)) {
        ++so_far.rendered;
        so_far.seconds += seconds_since(start);
      }
    } catch (const std::exception& failure) {
      const auto* error = dynamic_cast<const Error*>(&failure);
      if (error != nullptr && error->kind == ErrorKind::interrupted) throw stopped(error->message);
      print_warning(log, fmt::format("frame {} failed: {}", frame, failure.what()));
      failed.push_back(frame);
    }
    ++so_far.finished;
  }
  if (!log.quiet && log.format == LogFormat::text) {
    const std::size_t found = frames.size() - so_far.rendered - failed.size();
    write_line(stdout, fmt::format("\n{} of {} frames rendered{}{} in {}", so_far.rendered, frames.size(),
                                   found > 0 ? fmt::format(", {} skipped", found) : "",
                                   failed.empty() ? "" : fmt::format(", {} failed", failed.size()),
                                   short_time(seconds_since(begin))));
  }
  if (failed.empty()) return;
  throw run_failed(
      {}, fmt::format("{} of {} frames failed: {}", failed.size(), frames.size(), fmt::join(failed, ", ")));
}

void anchor_session(Session& session, const std::string& scene, const std::vector<std::string>& overrides) {
  const int reference = load_scene(scene, overrides).settings.reference_frame;
  Scene anchor = load_scene(scene, overrides, reference);
  session.anchor(std::move(anchor));
}

std::string frame_hash(const std::string& path, const std::vector<std::string>& overrides,
                       const Scene& scene) {
  Scene both = scene;
  const Scene reference = load_scene(path, overrides, scene.settings.reference_frame);
  both.shapes.insert(both.shapes.end(), reference.shapes.begin(), reference.shapes.end());
  return scene_hash(path, overrides, both);
}

RenderArguments arguments_of_frame(const RenderArguments& arguments, int frame) {
  RenderArguments own = arguments;
  for (std::string& output : own.outputs) output = with_frame(output, frame);
  own.samples_ply = with_frame(own.samples_ply, frame);
  own.resume = with_frame(own.resume, frame);
  return own;
}

bool is_rendered(const RenderArguments& arguments, const std::string& hash, int frame) {
  std::vector<std::string> others = arguments.outputs;
  if (!arguments.samples_ply.empty()) others.push_back(arguments.samples_ply);
  std::error_code unknown;  // reported on writing
  for (const std::string& path : others)
    if (!std::filesystem::exists(path, unknown)) return false;
  for (const std::string& path : arguments.outputs) {
    try {
      const Metadata stated = read_image(path).metadata;
      for (const auto& entry : frame_metadata(arguments, hash, frame))
        if (std::ranges::find(stated, entry) == stated.end()) return false;
    } catch (const Error&) {
      return false;  // not an image: overwritten
    }
  }
  return true;
}

}  // namespace opaline
