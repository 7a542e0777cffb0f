// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_exitance.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel.h"
#include "lights/light.h"
#include "volume/body_walks.h"
#include "volume/outer_shares.h"
#include "volume/walk_memory.h"

namespace opaline {
namespace {

constexpr std::size_t kWalksOfPass = 4;    // a sample
constexpr std::size_t kFewestPasses = 8;   // before an error estimate is reliable
constexpr std::size_t kPassesOfNoise = 2;  // before an error estimate exists
constexpr std::size_t kMostSeparate = 4, kMostSeparateSums = 8'000'000;  // lights; lights times samples

/// Channel providing the walks of a channel: the first one with an equal medium.
std::size_t walked_channel(const VolumeInput& input, std::size_t channel) {
  if (input.media_inside) return channel;
  const auto same = [](const HomogeneousMedium& a, const HomogeneousMedium& b) {
    return a.sigma_a == b.sigma_a && a.sigma_s == b.sigma_s && a.g == b.g && a.eta == b.eta;
  };
  for (std::size_t c = 0; c < channel && walks_by_light(input); ++c)
    if (same(input.media[c], input.media[channel])) return c;
  return channel;
}

bool is_walked(const VolumeInput& input, std::size_t channel) {
  return input.media[channel].sigma_s > 0;
}

/// One per light, or one for all; none without lights.
std::size_t sources_of(const VolumeInput& input) {
  return walks_by_light(input) ? input.lights.size() : std::min<std::size_t>(1, input.lights.size());
}

/// Factor of the sums of a source.
Rgb weight_of(const VolumeInput& input, std::size_t source) {
  return walks_by_light(input) ? emission(input.lights[source]) : Rgb(1);
}

struct Job {
  std::size_t source, channel;
};

/// Jobs with a nonzero weight in the lights' colours.
std::vector<Job> jobs_of(const VolumeInput& input, const VolumeSums& sums) {
  std::vector<Job> jobs;
  for (std::size_t s = 0; s < sums.sources.size(); ++s)
    for (std::size_t c = 0; c < 3; ++c) {
      bool is_seen = false;
      for (std::size_t other = c; other < 3; ++other)
        is_seen |= walked_channel(input, other) == c && weight_of(input, s)[other] > 0;
      if (is_seen && walked_channel(input, c) == c && is_walked(input, c)) jobs.push_back({s, c});
    }
  return jobs;
}

std::size_t starts_of(const VolumeInput& input) {
  return input.samples.size() * kWalksOfPass;
}

std::size_t passes_for(std::size_t walks) {
  return (walks + kWalksOfPass - 1) / kWalksOfPass;
}

double surface_area_of(const VolumeInput& input) {
  double area = 0;
  for (const SurfaceSample& s : input.samples) area += double(s.area);
  return area;
}

/// Mean of the passes, and its variance.
struct PassMean {
  double mean = 0, variance = 0;
};

PassMean pass_mean_of(const WalkSums& sums, std::size_t i) {
  const double n = double(sums.passes);
  if (sums.passes < 2) return {};
  const double mean = double(sums.flux[i]) / n, root = double(sums.roots[i]);
  return {mean, std::max(0.0, root * root / n - mean * mean) / (n - 1)};
}

/// Relative error and its contributions.
struct Noise {
  std::array<double, 3> relative{};     ///< relative error of each channel
  std::array<std::size_t, 3> walked{};  ///< channel providing its walks
  std::vector<double> shares;           ///< per job: largest contribution to a channel's relative^2

  double worst() const { return *std::ranges::max_element(relative); }
  /// Largest error of the channels using these walks.
  double of_job(std::size_t channel) const {
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, walked[c] == channel ? relative[c] : 0);
    return largest;
  }
};

class Evaluation {
 public:
  /// outer: outer_shares; empty: the whole cells
  Evaluation(const VolumeInput& input, const VolumeSums& sums, std::span<const float> outer = {})
      : input_(input),
        sums_(sums),
        outer_(outer),
        area_of_start_(surface_area_of(input) / double(starts_of(input))) {
    for (std::size_t c = 0; c < 3; ++c) walked_[c] = walked_channel(input, c);
    for (std::size_t s = 0; s < sums.sources.size(); ++s) weights_.push_back(weight_of(input, s));
  }

  /// Exitance of a cell from one source, and its variance.
  PassMean part(std::size_t source, std::size_t channel, std::size_t i) const {
    const double area = outer_area(i);
    const double scale = area > 0 ? weights_[source][channel] * area_of_start_ / area : 0;
    const PassMean pass = pass_mean_of(sums_.sources[source].channels[walked_[channel]], i);
    return {pass.mean * scale, pass.variance * scale * scale};
  }

  PassMean whole(std::size_t channel, std::size_t i) const {
    PassMean sum;
    for (std::size_t s = 0; s < weights_.size(); ++s) {
      const PassMean one = part(s, channel, i);
      sum.mean += one.mean;
      sum.variance += one.variance;
    }
    return sum;
  }

  /// enough: channels with a smaller error do not contribute
  Noise noise(const std::vector<Job>& jobs, double enough = 0) const {
    Noise noise;
    noise.shares.resize(jobs.size());
    noise.walked = walked_;
    const double area = surface_area_of(input_);
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<PassMean> cells(input_.samples.size());
      double largest = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        cells[i] = whole(c, i);
        largest = std::max(largest, cells[i].mean);
      }
      const auto scale = [&](std::size_t i) {
        const double square = cells[i].mean * cells[i].mean + 1e-4 * largest * largest;
        return square > 0 ? outer_area(i) / (square * area) : 0;
      };
      double sum = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) sum += cells[i].variance * scale(i);
      noise.relative[c] = std::sqrt(sum);
      for (std::size_t j = 0; j < jobs.size(); ++j) {
        if (walked_[c] != jobs[j].channel || noise.relative[c] <= enough) continue;
        double share = 0;
        for (std::size_t i = 0; i < cells.size(); ++i)
          share += part(jobs[j].source, c, i).variance * scale(i);
        noise.shares[j] = std::max(noise.shares[j], share);
      }
    }
    return noise;
  }

 private:
  double outer_area(std::size_t i) const {
    const double area = double(input_.samples[i].area);
    return outer_.empty() ? area : area * double(outer_[i]);
  }

  const VolumeInput& input_;
  const VolumeSums& sums_;
  std::span<const float> outer_;
  double area_of_start_;
  std::array<std::size_t, 3> walked_;
  std::vector<Rgb> weights_;
};

PassSums sums_of(std::span<const WalkCounts> chunks) {
  PassSums pass;
  pass.flux.resize(chunks[0].flux.size());
  parallel_chunks(pass.flux.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      for (const WalkCounts& chunk : chunks) pass.flux[i] += double(chunk.flux[i]);
  });
  for (const WalkCounts& chunk : chunks) pass.totals.push_back({chunk.entered, chunk.lost, chunk.stopped});
  return pass;
}

class Walks {
 public:
  Walks(const VolumeInput& input, VolumeSums& sums)
      : input_(input), sums_(sums), walks_(input, starts_of(input)), jobs_(jobs_of(input, sums)) {}

  const std::vector<Job>& jobs() const { return jobs_; }
  WalkSums& sums(const Job& job) const { return sums_.sources[job.source].channels[job.channel]; }

  /// Runs one pass of each of these jobs, in parallel over all: a single pass would leave threads idle at its
  /// end.
  void add_passes(std::span<const Job> jobs) const {
    std::vector<WalkPass> passes;
    for (const Job& job : jobs) passes.push_back({job.source, job.channel, sums(job).passes});
    walk(passes, [&](const WalkPass& pass, const PassSums& result) {
      add_pass(sums({pass.source, pass.channel}), result);
    });
  }

  /// Calls use(pass, its sums) in order.
  template <class Use>
  void walk(std::span<const WalkPass> passes, const Use& use) const {
    const std::size_t together =
        std::clamp<std::size_t>(kMostCounts / (BodyWalks::kChunks * input_.samples.size()), 1, 8);
    for (std::size_t first = 0; first < passes.size(); first += together)
      walk_together(passes.subspan(first, std::min(together, passes.size() - first)), use);
  }

 private:
  static constexpr std::size_t kMostCounts = std::size_t(1) << 26;  // in memory at once

  template <class Use>
  void walk_together(std::span<const WalkPass> passes, const Use& use) const {
    constexpr std::size_t kChunks = BodyWalks::kChunks;
    std::map<std::size_t, SphereExits> exits;
    for (const WalkPass& walked : passes)
      if (!exits.contains(walked.pass)) exits.emplace(walked.pass, walks_.exits_of(walked.pass));
    std::vector<WalkCounts> counts(passes.size() * kChunks);
    parallel_chunks(counts.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      const WalkPass& walked = passes[i / kChunks];
      counts[i] =
          walks_.walk(of({walked.source, walked.channel}), walked.pass, i % kChunks, exits.at(walked.pass));
      advance(input_.monitor, 1);
    });
    for (std::size_t p = 0; p < passes.size(); ++p)
      use(passes[p], sums_of(std::span(counts).subspan(p * kChunks, kChunks)));
  }

  WalkJob of(const Job& job) const {
    const bool alone = walks_by_light(input_);
    return {alone ? input_.lights.subspan(job.source, 1) : input_.lights, alone, job.channel,
            alone ? light_seed(input_.seed, input_.lights[job.source]) : input_.seed};
  }

  const VolumeInput& input_;
  VolumeSums& sums_;
  BodyWalks walks_;
  std::vector<Job> jobs_;
};

/// Jobs with fewer than this number of passes.
std::vector<Job> jobs_behind(const Walks& walks, std::size_t passes) {
  std::vector<Job> behind;
  for (const Job& job : walks.jobs())
    if (walks.sums(job).passes < passes) behind.push_back(job);
  return behind;
}

/// Jobs with the largest contributions to the error, where another pass is most effective.
std::vector<Job> jobs_wanted(const Walks& walks, const Noise& noise, std::size_t most) {
  double largest = 0;
  const auto brings = [&](std::size_t j) {
    const std::size_t passes = walks.sums(walks.jobs()[j]).passes;
    return passes < most ? noise.shares[j] / double(passes) : 0;
  };
  for (std::size_t j = 0; j < walks.jobs().size(); ++j) largest = std::max(largest, brings(j));
  std::vector<Job> wanted;
  for (std::size_t j = 0; j < walks.jobs().size(); ++j)
    if (brings(j) > 0 && brings(j) >= .5 * largest) wanted.push_back(walks.jobs()[j]);
  return wanted;
}

/// Reports progress against the expected passes.
class Progress {
 public:
  Progress(Monitor* monitor, const Walks& walks) : monitor_(monitor), walks_(walks), before_(passes()) {
    if (monitor != nullptr) monitor->begin("random walks", 0);
  }

  /// Expects this number of passes per job.
  void expect(std::size_t passes_each) const {
    std::size_t all = 0;
    for (const Job& job : walks_.jobs()) all += std::max(passes_each, walks_.sums(job).passes);
    expect_all(all);
  }
  /// Noise falls with the root of the passes.
  void expect(const Noise& noise, double until_error, std::size_t most) const {
    if (monitor_ != nullptr) monitor_->noise = noise.worst();
    double all = 0;
    for (const Job& job : walks_.jobs()) {
      const double ratio = std::max(1.0, noise.of_job(job.channel) / until_error);
      all += std::min(double(most), double(walks_.sums(job).passes) * ratio * ratio);
    }
    expect_all(std::size_t(std::ceil(all)));
  }

 private:
  std::size_t passes() const {
    std::size_t sum = 0;
    for (const Job& job : walks_.jobs()) sum += walks_.sums(job).passes;
    return sum;
  }
  void expect_all(std::size_t all) const {
    if (monitor_ != nullptr) monitor_->total = (std::max(all, passes()) - before_) * BodyWalks::kChunks;
  }

  Monitor* monitor_;
  const Walks& walks_;
  std::size_t before_;
};

}  // namespace

double expected_walk_bytes(const World& world, std::span<const std::uint32_t> meshes, double mean_free_path) {
  return BodyWalks::expected_bytes(world, meshes, mean_free_path);
}

bool walks_by_light(const VolumeInput& input) {
  return input.lights.size() <= kMostSeparate &&
         input.lights.size() * input.samples.size() <= kMostSeparateSums;
}

void walk_volume(const VolumeInput& input, VolumeSums& sums,
                 const std::function<void(const VolumeSums&)>& after_pass) {
  for (const HomogeneousMedium& medium : input.media) check_medium(medium);
  sums.sources.resize(sources_of(input));
  if (input.samples.empty()) return;
  const Walks walks(input, sums);
  Progress progress(input.monitor, walks);
  const std::size_t most = passes_for(input.until_error ? kMostWalks : kDefaultWalks);
  for (;;) {
    std::vector<Job> jobs = jobs_behind(walks, input.until_error ? kFewestPasses : most);
    if (jobs.empty() && input.until_error) {
      const Noise noise = Evaluation(input, sums).noise(walks.jobs(), *input.until_error);
      progress.expect(noise, *input.until_error, most);
      if (noise.worst() <= *input.until_error) break;
      jobs = jobs_wanted(walks, noise, most);
    } else if (!input.until_error) {
      progress.expect(most);
      if (input.monitor != nullptr) input.monitor->noise = Evaluation(input, sums).noise({}).worst();
    } else if (input.monitor != nullptr && jobs_behind(walks, kPassesOfNoise).empty()) {
      progress.expect(Evaluation(input, sums).noise(walks.jobs(), *input.until_error), *input.until_error,
                      most);
    }
    if (jobs.empty()) break;
    walks.add_passes(jobs);
    if (after_pass) after_pass(sums);
  }
}

std::size_t default_passes() {
  return passes_for(kDefaultWalks);
}

void walk_passes(const VolumeInput& input, std::size_t first, std::size_t last,
                 const std::function<bool(const WalkPass&)>& is_known,
                 const std::function<void(const WalkPass&, PassSums)>& keep) {
  for (const HomogeneousMedium& medium : input.media) check_medium(medium);
  VolumeSums sums;
  sums.sources.resize(sources_of(input));
  if (input.samples.empty()) return;
  const Walks walks(input, sums);
  std::vector<WalkPass> wanted;
  for (std::size_t pass = first; pass < last; ++pass)
    for (const Job& job : walks.jobs())
      if (const WalkPass walked{job.source, job.channel, pass}; !is_known(walked)) wanted.push_back(walked);
  if (input.monitor != nullptr) input.monitor->begin("random walks", wanted.size() * BodyWalks::kChunks);
  walks.walk(wanted, keep);
}

void add_pass(WalkSums& sums, const PassSums& pass) {
  sums.flux.resize(pass.flux.size());
  sums.roots.resize(pass.flux.size());
  parallel_chunks(pass.flux.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const double root = double(sums.roots[i]), flux = pass.flux[i];
      sums.flux[i] = float(double(sums.flux[i]) + flux);
      sums.roots[i] = float(std::sqrt(root * root + flux * flux));
    }
  });
  for (const auto& [entered, lost, stopped] : pass.totals) {
    sums.entered += entered;
    sums.lost += lost;
    sums.stopped += stopped;
  }
  ++sums.passes;
}

VolumeExitance exitance_of(const VolumeInput& input, const VolumeSums& sums) {
  VolumeExitance result;
  if (BodyInside(input.rays, input.world, input.meshes).overlaps())
    result.outer_shares = outer_shares(input.rays, input.world, input.meshes, input.samples);
  const Evaluation evaluation(input, sums, result.outer_shares);
  for (std::size_t i = 0; i < input.samples.size(); ++i) {
    Rgb mean{}, error{};
    for (std::size_t c = 0; c < 3; ++c) {
      const PassMean cell = evaluation.whole(c, i);
      mean[c] = cell.mean;
      error[c] = std::sqrt(cell.variance);
    }
    result.exitance.push_back(RgbF(mean));
    result.error.push_back(RgbF(error));
  }
  const std::vector<Job> jobs = jobs_of(input, sums);
  const Noise noise = evaluation.noise(jobs);
  result.relative_error = noise.worst();
  for (const Job& job : jobs) {
    const WalkSums& walks = sums.sources[job.source].channels[job.channel];
    result.walks = std::max(result.walks, walks.passes * kWalksOfPass);
    if (!(walks.entered > 0)) continue;
    result.lost[job.channel] = std::max(result.lost[job.channel], walks.lost / walks.entered);
    result.stopped[job.channel] = std::max(result.stopped[job.channel], walks.stopped / walks.entered);
  }
  return result;
}

VolumeExitance volume_exitance(const VolumeInput& input) {
  VolumeSums sums;
  walk_volume(input, sums);
  return exitance_of(input, sums);
}

}  // namespace opaline
