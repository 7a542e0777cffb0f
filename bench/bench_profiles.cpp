// SPDX-License-Identifier: GPL-3.0-or-later
// Every profile against random walks of a half space in diffuse light: the table of src/diffusion/README.md.
//
//   bench_profiles [COLLISIONS] [PRESET...]
//
// COLLISIONS a channel, 4e7 unless given (some minutes of CPU); marble, wholemilk and skin1 unless other presets are.
// Means over the three channels: of the total's relative error without its sign, and of the L1 difference of shape,
// the sum over rings of the shares' differences without their sign, each share of its own total (2 at most). The
// row "walks" has another, equally long run against the first: the noise of the L1 column. A second table has the
// directional dipole by the cosine of entry, of the green channel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "diffusion/diffuse_profile.h"
#include "input/load_scene.h"
#include "transport/laboratory.h"
#include "user_seconds.h"

namespace {

using namespace opaline;

struct Difference {
  double total = 0, shape = 0, seconds = 0;  ///< the seconds of making the profile and a first value of it
  void add(const Difference& channel) {
    total += channel.total / 3;
    shape += channel.shape / 3;
    seconds += channel.seconds;
  }
};

SlabWalks walk(const HomogeneousMedium& medium, double collisions, std::uint64_t seed,
               const SlabEntry& entry = kDiffuseEntry) {
  LaboratorySettings settings;
  settings.seed = 100;
  settings.walks = 2048;
  const double each = walk_slab(medium, {}, entry, settings).collisions + 3;
  settings.seed = seed;
  settings.walks = std::size_t(std::clamp(collisions / each, 2048., 4e6));
  return walk_slab(medium, {}, entry, settings);
}

template <class Within>
Difference difference(const SlabWalks& walked, double total, const Within& within) {
  const double truth = walked.back.total.value;
  Difference result{std::abs(total / truth - 1), 0, 0};
  double before = 0, left = 1;
  for (std::size_t i = 0; i < walked.back.rings.size(); ++i) {
    const double now = within(i) / total, share = walked.back.rings[i].share.value / truth;
    result.shape += std::abs(now - before - share);
    before = now;
    left -= share;
  }
  result.shape += std::abs(1 - before - left);
  return result;
}

Difference difference(const SlabWalks& walked, ProfileKind kind, const ReducedMedium& medium) {
  ChannelProfile profile;
  const double seconds = user_seconds([&] {
    profile = make_channel_profile(kind, medium);
    diffuse_reflectance_within(profile, medium.mean_free_path);
  });
  Difference result = difference(walked, total_diffuse_reflectance(profile), [&](std::size_t i) {
    return diffuse_reflectance_within(profile, walked.back.rings[i].high);
  });
  result.seconds = seconds;
  return result;
}

/// Share of the light of a beam at a cosine that leaves within a ring on a plane: three radii, 24 azimuths.
double ring_share(const DirectionalDipole& profile, double cosine, const WalkedRing& ring) {
  const Vec3d to_light{std::sqrt(1 - cosine * cosine), 0, cosine}, up{0, 0, 1};
  const double low = std::max(ring.low, ring.high * 1e-2), step = std::log(ring.high / low) / 3;
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 24; ++k) {
      const double r = low * std::exp(step * (i + .5)), azimuth = std::numbers::pi * (k + .5) / 24;
      const Vec3d exit{r * std::cos(azimuth), r * std::sin(azimuth), 0};
      sum += 2 * std::numbers::pi * r * r * step / 24 *
             directional_reflectance(profile, {{}, up}, to_light, {exit, up});
    }
  return sum;
}

void print_directional(const std::string& preset, const HomogeneousMedium& medium, double collisions) {
  const double length = medium.reduced_mean_free_path();
  const auto profile =
      make_profile({length, medium.sigma_a * length, medium.eta}, std::type_identity<DirectionalDipole>());
  const double published = published_total(profile) / profile.total;
  for (const double cosine : {1., .5, .15}) {
    const SlabWalks walked = walk(medium, collisions, 3, {false, cosine});
    const double truth = walked.back.total.value, total = total_directional_reflectance(profile, cosine);
    double within = 0;
    std::vector<double> own;
    for (const WalkedRing& ring : walked.back.rings)
      own.push_back(within += ring_share(profile, cosine, ring));
    const Difference directional = difference(walked, total, [&](std::size_t i) { return own[i]; });
    const Difference mean = difference(walked, profile.total, [&](std::size_t i) {
      return diffuse_reflectance_within(profile, walked.back.rings[i].high);
    });
    fmt::print("| {}, {} | {:.4f} | {:.4f} | {:.4f} | {:.1f} % | {:.1f} % |\n", preset, cosine, truth, total,
               total * published, 100 * directional.shape, 100 * mean.shape);
  }
}

/// Every kind of profile, and normalized diffusion by each fit.
struct Model {
  ProfileKind kind;
  NormalizedDiffusionFit fit;
  std::string name;
};

std::vector<Model> all_models() {
  std::vector<Model> models;
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    const std::string name = fmt::format("`{}`", kProfileNames[kind]);
    if (ProfileKind(kind) != ProfileKind::normalized_diffusion)
      models.push_back({ProfileKind(kind), {}, name});
    else
      for (std::size_t fit = 0; fit < kFitNames.size(); ++fit)
        models.push_back(
            {ProfileKind(kind), NormalizedDiffusionFit(fit), fmt::format("{}, `{}`", name, kFitNames[fit])});
  }
  return models;
}

}  // namespace

int main(int argc, char** argv) {
  const double collisions = argc > 1 ? std::strtod(argv[1], nullptr) : 4e7;
  std::vector<std::string> presets(argv + std::min(argc, 2), argv + argc);
  if (presets.empty()) presets = {"marble", "wholemilk", "skin1"};
  const std::vector<Model> models = all_models();
  std::vector<std::vector<Difference>> rows(models.size() + 1, std::vector<Difference>(presets.size()));
  for (std::size_t p = 0; p < presets.size(); ++p) {
    const Medium medium = parse_medium("{\"preset\": \"" + presets[p] + "\"}", "bench");
    const auto& coefficients = std::get<PhysicalMedium>(medium.coefficients);
    for (std::size_t c = 0; c < 3; ++c) {
      const HomogeneousMedium walked{coefficients.sigma_a[c], coefficients.sigma_s_prime[c], 0, medium.eta};
      const SlabWalks truth = walk(walked, collisions, 1), other = walk(walked, collisions, 2);
      const double length = walked.reduced_mean_free_path();
      for (std::size_t m = 0; m < models.size(); ++m)
        rows[m][p].add(difference(truth, models[m].kind,
                                  {.mean_free_path = length,
                                   .absorbed = walked.sigma_a * length,
                                   .eta = medium.eta,
                                   .fit = models[m].fit}));
      rows[models.size()][p].add(difference(truth, other.back.total.value,
                                            [&](std::size_t i) { return other.back.rings[i].within.value; }));
    }
  }
  fmt::print("| total, shape (L1) |");
  for (const std::string& preset : presets) fmt::print(" {} |", preset);
  fmt::print(" CPU to make |\n|---|");
  for (std::size_t p = 0; p <= presets.size(); ++p) fmt::print("---|");
  fmt::print("\n");
  for (std::size_t row = 0; row <= models.size(); ++row) {
    fmt::print("| {} |", row < models.size() ? models[row].name : "walks, another run");
    double seconds = 0;
    for (const Difference& d : rows[row]) {
      fmt::print(" {:.1f} %, {:.1f} % |", 100 * d.total, 100 * d.shape);
      seconds = std::max(seconds, d.seconds);
    }
    fmt::print(" {} |\n", seconds < .005 ? "0 s" : fmt::format("{:.1f} s", seconds));
  }
  fmt::print(
      "\n| cosine of entry | walks | `directional_dipole` | as published | shape (L1) | of its mean |\n"
      "|---|---|---|---|---|---|\n");
  for (const std::string& preset : presets) {
    const Medium medium = parse_medium("{\"preset\": \"" + preset + "\"}", "bench");
    const auto& coefficients = std::get<PhysicalMedium>(medium.coefficients);
    print_directional(preset, {coefficients.sigma_a.y, coefficients.sigma_s_prime.y, 0, medium.eta},
                      collisions);
  }
}
