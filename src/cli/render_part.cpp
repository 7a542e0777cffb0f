// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/render_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

#include "cli/part_file.h"
#include "opaline/error.h"
#include "scene/names.h"

namespace opaline {
namespace {

constexpr std::size_t kTotals = 3;  // numbers per range of starts

/// Place of a pass among those of a body's sources: the passes of a part are written in this order.
using PassPlace = std::tuple<std::size_t, std::size_t, std::size_t>;  // pass, source, channel

/// error Error{bad_input} naming the file: its contents are those of no part
template <class Read>
void checked(const PartFile& file, const Read& read) {
  const auto damaged = [&] { return bad_file(file.path(), "is damaged: its header is not that of a part"); };
  try {
    read();
  } catch (const Json::exception&) {
    throw damaged();
  } catch (const std::out_of_range&) {
    throw damaged();
  }
}

/// The passes of one part.
WalkShare share_of(const ImagePart& part) {
  const std::size_t passes = default_passes();
  return {(part.number - 1) * passes / part.count, part.number * passes / part.count, {}, {}};
}

std::size_t most_parts(const Scene& scene) {
  return scene.settings.method == Method::volume ? default_passes() : direct_tiles(scene.film);
}

/// A part of `volume`: the sums of each pass of each source and channel.
class PartWalks {
 public:
  PartWalks(Session& session, const ImagePart&) : session_(session) {}
  ~PartWalks() { session_.store_walks({}); }
  PartWalks(const PartWalks&) = delete;
  PartWalks& operator=(const PartWalks&) = delete;

  void read(const PartFile& file) {
    checked(file, [&] { read_passes(file); });
  }

  /// Adds the passes of a source in a file; false if the file does not know it.
  static bool add(const PartFile& file, const StageKey& key, SourceSums& source) {
    bool is_known = false;
    checked(file, [&] { is_known = add_passes(file, key, source); });
    return is_known;
  }

  template <class AfterPass>
  void run(StageRunner& stages, const ImagePart& part, const AfterPass& after_pass) {
    WalkShare share = share_of(part);
    share.is_known = [&](const StageKey& key, std::size_t channel, std::size_t pass) {
      return passes_.contains({pass, number_of(key), channel});
    };
    share.keep = [&](const StageKey& key, std::size_t channel, std::size_t pass, PassSums sums) {
      passes_[{pass, number_of(key), channel}] = std::move(sums);
      after_pass();
    };
    const auto list = [&](std::span<const StageKey> keys, const VolumeSums&) {
      for (const StageKey& key : keys) number_of(key);
    };
    session_.store_walks({{}, list, share});
    stages.run_unmeasured("rays", [&] { session_.prepare(&stages.monitor()); });
    for (const StageCost& cost : session_.costs()) stages.note(cost);
  }

  void write(const std::string& path, const PartRecord& record, bool is_complete) const {
    Json passes = Json::array();
    for (const auto& [place, sums] : passes_)
      passes.push_back(
          {std::get<0>(place), std::get<1>(place), std::get<2>(place), sums.flux.size(), sums.totals.size()});
    PartOutput file(path, record, is_complete, {{"sources", sources_}, {"passes", passes}});
    for (const auto& [place, sums] : passes_) {
      file.append(std::span(sums.flux));
      file.append(std::span(sums.totals));
    }
    file.commit();
  }

 private:
  void read_passes(const PartFile& file) {
    std::uint64_t offset = 0;
    sources_ = file.contents().at("sources").get<std::vector<std::string>>();
    for (const Json& pass : file.contents().at("passes")) {
      passes_[{pass.at(0), pass.at(1), pass.at(2)}] = sums_at(file, pass, offset);
      offset += bytes_of(pass);
    }
  }

  static bool add_passes(const PartFile& file, const StageKey& key, SourceSums& source) {
    const std::vector<std::string> sources = file.contents().at("sources");
    const auto number = std::size_t(std::ranges::find(sources, hex(key)) - sources.begin());
    std::uint64_t offset = 0;
    for (const Json& pass : file.contents().at("passes")) {
      if (pass.at(1) == number)
        add_pass(source.channels.at(pass.at(2).get<std::size_t>()), sums_at(file, pass, offset));
      offset += bytes_of(pass);
    }
    return number < sources.size();
  }

  // A pass in the contents of a file: its place, and its numbers of samples and of ranges of starts.
  static std::uint64_t bytes_of(const Json& pass) {
    return (pass.at(3).get<std::uint64_t>() + kTotals * pass.at(4).get<std::uint64_t>()) * sizeof(double);
  }
  static PassSums sums_at(const PartFile& file, const Json& pass, std::uint64_t offset) {
    const std::size_t samples = pass.at(3), ranges = pass.at(4);
    return {file.values<double>(offset, samples),
            file.values<std::array<double, kTotals>>(offset + samples * sizeof(double), ranges)};
  }

  std::size_t number_of(const StageKey& key) {
    const std::string name = hex(key);
    const auto found = std::ranges::find(sources_, name);
    const auto number = std::size_t(found - sources_.begin());
    if (found == sources_.end()) sources_.push_back(name);
    return number;
  }

  Session& session_;
  std::vector<std::string> sources_;
  std::map<PassPlace, PassSums> passes_;
};

/// A part of `direct`: the sums of its pixels.
class PartPixels {
 public:
  PartPixels(Session& session, const ImagePart& part)
      : session_(session), pixels_(pixels_of_part(session.scene().film, part)) {}

  void read(const PartFile& file) { add(file, state_); }

  void add(const PartFile& file, DirectState& state) const {
    checked(file, [&] { add_pixels(file, state); });
  }

  template <class AfterPass>
  void run(StageRunner& stages, const ImagePart& part, const AfterPass& after_pass) {
    stages.run_unmeasured("rays", [&] { session_.prepare(&stages.monitor()); });
    stages.run("shading", [&] {
      add_direct_passes(
          {session_.scene(), session_.world(), session_.rays(), session_.plan(), &stages.monitor()}, part,
          state_, [&](const DirectState&) { after_pass(); });
      return 0;
    });
  }

  void write(const std::string& path, const PartRecord& record, bool is_complete) const {
    std::vector<float> values;
    if (!state_.sums.empty())
      for (const std::size_t pixel : pixels_) {
        const auto sums = state_.sums.begin() + std::ptrdiff_t(pixel * DirectState::kSums);
        values.insert(values.end(), sums, sums + DirectState::kSums);
      }
    values.resize(pixels_.size() * DirectState::kSums);
    PartOutput file(path, record, is_complete, {{"passes", state_.passes}});
    file.append(std::span<const float>(values));
    file.commit();
  }

 private:
  void add_pixels(const PartFile& file, DirectState& state) const {
    const auto values = file.values<std::array<float, DirectState::kSums>>(0, pixels_.size());
    const Rectangle part = rendered_part(session_.scene().film);
    state.sums.resize(std::size_t(part.x1 - part.x0) * std::size_t(part.y1 - part.y0) * DirectState::kSums);
    state.passes = file.contents().at("passes");
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      std::ranges::copy(values[i], state.sums.begin() + std::ptrdiff_t(pixels_[i] * DirectState::kSums));
  }

  Session& session_;
  std::vector<std::size_t> pixels_;
  DirectState state_;
};

/// A part's file of an earlier run with the same record; none: there is no such file.
std::unique_ptr<const PartFile> earlier_file(const std::string& path, const PartRecord& record) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return nullptr;
  try {
    auto file = std::make_unique<const PartFile>(path);
    const bool is_same =
        file->record().part.number == record.part.number && difference(file->record(), record).empty();
    return is_same ? std::move(file) : nullptr;
  } catch (const Error&) {
    return nullptr;  // overwritten
  }
}

/// Runs a part from its stored sums to its end, or to an interruption.
template <class Work>
void run_part(StageRunner& stages, const RenderArguments& arguments, Session& session,
              const PartRecord& record, const PartFile* earlier) {
  const std::string& path = arguments.outputs.front();
  Work work(session, record.part);
  if (earlier != nullptr) work.read(*earlier);
  auto last = std::chrono::steady_clock::now();
  bool has_passes = earlier != nullptr;  // an interruption before leaves the file of another image
  try {
    work.run(stages, record.part, [&] {
      has_passes = true;
      if (std::chrono::steady_clock::now() - last < std::chrono::minutes(1)) return;
      work.write(path, record, false);
      last = std::chrono::steady_clock::now();
    });
  } catch (const Error& stopped) {
    if (stopped.kind != ErrorKind::interrupted) throw;
    if (has_passes) work.write(path, record, false);
    const std::string stored = has_passes ? path + " stores the complete passes" : "no pass is complete";
    throw Error(ErrorKind::interrupted, {}, 0, 0,
                fmt::format("interrupted; {}; resume with {}", stored, arguments.command_line));
  }
  work.write(path, record, true);
}

}  // namespace

void check_part(const ImagePart& part, const Scene& scene) {
  const auto refused = [](const std::string& message, const std::string& expected, const std::string& got) {
    return Error(ErrorKind::bad_input, "--part", 0, 0, message, expected, got);
  };
  const Method method = scene.settings.method;
  if (method != Method::direct && method != Method::volume)
    throw refused("this method has no passes to divide", "--method direct or volume",
                  std::string(name_of(method)));
  if (scene.settings.until_error)
    throw refused("the number of passes up to an error is not known before the whole image",
                  method == Method::direct ? "--entry-samples N" : "no settings.until_error",
                  fmt::format("{:.4g}%", 100 * *scene.settings.until_error));
  if (part.count > most_parts(scene))
    throw refused("too many parts", fmt::format("at most {}", most_parts(scene)), std::to_string(part.count));
}

std::size_t part_bytes(const ImagePart& part, const Session& session) {
  if (session.scene().settings.method == Method::direct) return 0;  // sums as of the whole image
  std::size_t samples = 0;
  for (const BodyPlan& body : session.plan().groups) samples += body.samples;
  const WalkShare share = share_of(part);
  return samples * 3 * session.scene().lights.size() * (share.last - share.first) * sizeof(double);
}

bool render_part(StageRunner& stages, const RenderArguments& arguments, Session& session,
                 const std::string& hash, std::optional<int> frame) {
  const PartRecord record = record_of(arguments, hash, frame);
  const std::unique_ptr<const PartFile> earlier = earlier_file(arguments.outputs.front(), record);
  if (earlier && earlier->is_complete()) return false;
  if (session.scene().settings.method == Method::volume)
    run_part<PartWalks>(stages, arguments, session, record, earlier.get());
  else
    run_part<PartPixels>(stages, arguments, session, record, earlier.get());
  return true;
}

DirectState merged_direct(const MergedParts& parts, Session& session) {
  DirectState state;
  for (const std::string& path : parts.files) {
    const PartFile file(path);
    PartPixels(session, file.record().part).add(file, state);
  }
  return state;
}

MergedWalks::MergedWalks(const MergedParts& parts, Session& session) : session_(session) {
  auto files = std::make_shared<std::deque<PartFile>>();
  for (const std::string& path : parts.files) files->emplace_back(path);
  session_.store_walks({[files](const StageKey& key) -> std::optional<SourceSums> {
                          SourceSums source;
                          for (const PartFile& file : *files)
                            if (!PartWalks::add(file, key, source))
                              throw bad_file(file.path(), "has random walks of another kind of machine",
                                             "a part by a processor and libraries like those here");
                          return source;
                        },
                        {}});
}

}  // namespace opaline
