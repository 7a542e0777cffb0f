// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a half space sends back, against values that nobody here computed.
#include "diffusion/diffusion_test.h"
#include "volume_test.h"

namespace opaline {
namespace {

using test::expect_walked;
using test::medium_of_albedo;
using test::walks_of_seed;

/// Converts a fraction of the transmitted flux to one of the incident flux.
WalkedValue per_incident(const SlabWalks& walks, const WalkedValue& share) {
  return {share.value * walks.entered, share.error * walks.entered};
}

struct HalfSpaceRow {
  double albedo, normal, diffuse;
};

void expect_rows(std::span<const HalfSpaceRow> rows, double eta, double largest_error) {
  std::uint64_t seed = 100;
  for (const HalfSpaceRow& row : rows)
    for (const SlabEntry& entry : {kNormalEntry, kDiffuseEntry}) {
      const std::size_t walks = row.albedo < .99 ? 100000 : 30000;
      const SlabWalks walked =
          walk_slab(medium_of_albedo(row.albedo, eta), {}, entry, walks_of_seed(walks, ++seed));
      expect_walked(per_incident(walked, walked.back.total), entry.is_diffuse ? row.diffuse : row.normal,
                    largest_error,
                    "albedo " + std::to_string(row.albedo) + (entry.is_diffuse ? " diffuse" : " normal"));
      expect_walked(walked.energy, 1, 3e-4, "energy");
      EXPECT_EQ(walked.through.total.value, 0);
      EXPECT_EQ(walked.unfinished.value, 0);
    }
}

// Claim: reflectance of an isotropic half space without a boundary, normal and diffuse incidence. Source: 1 - sqrt(1-c)
// H(1) with Chandrasekhar's H function and its moments (Radiative Transfer, 1960), van de Hulst 1980, table 12.
// Tolerance: four standard errors, each below 1e-4. Fails if: absorption takes its share before the light that leaves
// is counted, or diffuse light enters uniform in the cosine.
TEST(HalfSpace, WithoutBoundary) {
  constexpr HalfSpaceRow rows[] = {{.2, .035230524, .046264871},  {.5, .115225878, .146544381},
                                   {.8, .285254503, .341866848},  {.9, .414947479, .478024489},
                                   {.95, .535540989, .596668780}, {.99, .752720717, .794563653},
                                   {.999, .912845335, .929713285}};
  expect_rows(rows, 1, 1e-4);
}

// Claim: the same behind a smooth boundary of eta 1.3, per incident flux, specular reflection left out. Source: an
// independent discrete-ordinates computation that agrees with the published index-matched tables to every digit.
// Tolerance: four standard errors, each below 3e-4. Fails if: light is reflected inside as from outside (eta for
// 1/eta), or the shares are per entered flux.
TEST(HalfSpace, Refracting) {
  constexpr HalfSpaceRow rows[] = {{.2, .0177012, .0185364},  {.5, .0624064, .0648408},
                                   {.8, .1782415, .1821254},  {.9, .2857857, .2883414},
                                   {.95, .4008805, .3997895}, {.99, .6453965, .6305632},
                                   {.999, .8567556, .8248008}};
  expect_rows(rows, 1.3, 3e-4);
}

/// Chandrasekhar's H function of isotropic scattering, by iteration of 1/H(mu) = sqrt(1-c) + c/2 integral of
/// mu' H(mu') / (mu + mu').
class HFunction {
 public:
  explicit HFunction(double albedo) : albedo_(albedo), at_nodes_(kNodes, 1) {
    for (int round = 0; round < 300; ++round) {
      std::vector<double> next;
      for (int i = 0; i < kNodes; ++i) next.push_back((*this)(node(i)));
      at_nodes_ = next;
    }
  }
  double operator()(double cosine) const {
    double sum = 0;
    for (int i = 0; i < kNodes; ++i) sum += node(i) * at_nodes_[std::size_t(i)] / (cosine + node(i)) / kNodes;
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }

 private:
  static constexpr int kNodes = 400;
  static double node(int i) { return (i + .5) / kNodes; }
  double albedo_;
  std::vector<double> at_nodes_;
};

// Claim: the albedo by cosine of entry is 1 - sqrt(1-c) H(mu), and light that entered along the normal leaves with
// radiance in proportion to H(mu) / (1 + mu). Source: Chandrasekhar 1960, chapter V. Tolerance: four standard errors;
// the means over a bin against five points of it. Fails if: the
// radiance is not divided by the cosine, or entry and exit are mixed up.
TEST(HalfSpace, ByAngle) {
  constexpr double albedo = .9;
  const HFunction h(albedo);
  const auto mean = [](const WalkedCosine& bin, const auto& f) {
    return test::integral([&](double c) { return 2 * c * f(c); }, bin.low, bin.high) /
           (bin.high * bin.high - bin.low * bin.low);
  };
  const SlabWalks diffuse = walk_slab(medium_of_albedo(albedo), {}, kDiffuseEntry, walks_of_seed(200000, 7));
  ASSERT_EQ(diffuse.albedo_by_entry.size(), 20u);
  for (const WalkedCosine& bin : diffuse.albedo_by_entry)
    expect_walked(bin.value, mean(bin, [&](double c) { return 1 - std::sqrt(1 - albedo) * h(c); }), .015,
                  "entry at " + std::to_string(bin.high));

  const SlabWalks normal = walk_slab(medium_of_albedo(albedo), {}, kNormalEntry, walks_of_seed(200000, 8));
  EXPECT_TRUE(normal.albedo_by_entry.empty());
  const auto radiance = [&](double c) { return h(c) / (1 + c); };
  const double flux = mean({0, 1, {}}, radiance);
  double sum = 0;
  for (const WalkedCosine& bin : normal.back.angular_exit) {
    expect_walked(bin.value, mean(bin, radiance) / flux, .05, "exit at " + std::to_string(bin.high));
    sum += bin.value.value * (bin.high * bin.high - bin.low * bin.low);
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

// Claim: in a white furnace a half space that absorbs nothing cannot be seen: what leaves in a direction and what is
// reflected there add up to the light that comes from there. So the radiance of what leaves is (1 - F) / (1 - F_bar) of
// a Lambert emitter's, and all light comes back whatever its angle of entry. Source: the second law. Tolerance: four
// standard errors. Fails if: exit is counted by the cosine inside, or entry weighted without Fresnel's transmittance.
TEST(HalfSpace, WhiteFurnaceByAngle) {
  constexpr double eta = 1.4;
  const SlabWalks walked = walk_slab(medium_of_albedo(1, eta), {}, kDiffuseEntry, walks_of_seed(8000, 12));
  expect_walked(walked.energy, 1, 1e-6, "energy");
  const auto transmitted = [](double c) { return 2 * c * fresnel_transmittance(c, eta); };
  for (const WalkedCosine& bin : walked.back.angular_exit)
    expect_walked(bin.value,
                  test::integral(transmitted, bin.low, bin.high) / (bin.high * bin.high - bin.low * bin.low) /
                      walked.entered,
                  .1, "exit at " + std::to_string(bin.high));
  double sum = 0;
  for (const WalkedCosine& bin : walked.albedo_by_entry) {
    expect_walked(bin.value, 1, .3, "entry at " + std::to_string(bin.high));
    sum += bin.value.value * test::integral(transmitted, bin.low, bin.high) / walked.entered;
  }
  EXPECT_NEAR(sum, 1, .01);
}

// Claim: a beam at an angle brings back 1 - sqrt(1-c) H(mu) too. Source: as above. Fails if: the beam's cosine is
// taken for a sine.
TEST(HalfSpace, ObliqueBeam) {
  const HFunction h(.8);
  for (const double cosine : {.1, .6}) {
    const SlabWalks walked = walk_slab(medium_of_albedo(.8), {}, {false, cosine}, walks_of_seed(100000, 9));
    expect_walked(walked.back.total, 1 - std::sqrt(.2) * h(cosine), 2e-4, std::to_string(cosine));
  }
}

// Claim: of a beam along the normal, these shares leave within .1, 1 and 5 mean free paths. Source: an independent
// computation by Fourier transform, index-matched. Tolerance: four standard errors, each below 7e-4. Fails if: the
// distance is measured along the path, or a ring counts what its neighbour should.
TEST(HalfSpace, Searchlight) {
  const struct {
    double albedo, within[3];
  } rows[] = {{.5, {.17553, .77697, .99743}}, {.9, {.09470, .55646, .96859}}};
  for (const auto& row : rows) {
    LaboratorySettings settings = walks_of_seed(1000000, 11);
    settings.radii = {.1, 1, 5};
    const SlabWalks walked = walk_slab(medium_of_albedo(row.albedo), {}, kNormalEntry, settings);
    const double total = walked.back.total.value;
    double sum = walked.back.beyond.value;
    for (std::size_t i = 0; i < 3; ++i) {
      const WalkedRing& ring = walked.back.rings[i];
      expect_walked({ring.within.value / total, ring.within.error / total}, row.within[i], 7e-4,
                    std::to_string(row.albedo) + " within " + std::to_string(ring.high));
      EXPECT_NEAR(ring.profile.value * test::pi * (ring.high * ring.high - ring.low * ring.low),
                  ring.share.value, 1e-12);
      sum += ring.share.value;
    }
    EXPECT_NEAR(sum, total, 1e-9);
  }
}

}  // namespace
}  // namespace opaline
