// SPDX-License-Identifier: GPL-3.0-or-later
// A field over a surface from its means over cells.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "support/statistics.h"
#include "support/surfaces.h"
#include "volume/cell_fit.h"

namespace opaline {
namespace {

using namespace test;

using FieldOf = std::function<double(const Vec3d&)>;

struct Sampled {
  World world;
  SurfaceSamples surface;
  std::vector<Piece> pieces;
  std::vector<std::uint32_t> cell_of;  ///< of each piece

  Sampled(World w, std::size_t samples, double share = .01)  // share: of a cell in a piece
      : world(std::move(w)), surface(samples_on(world, samples)) {
    pieces = dense_pieces(world, share * surface.area / double(samples));
    const NearestSample nearest(surface.samples, &world);
    for (const Piece& piece : pieces) cell_of.push_back(nearest.at(Vec3f(piece.position), piece.geometric));
  }

  std::vector<RgbF> means(const FieldOf& field) const {
    std::vector<double> sums(surface.samples.size()), areas(sums.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      sums[cell_of[i]] += pieces[i].area * field(pieces[i].position);
      areas[cell_of[i]] += pieces[i].area;
    }
    std::vector<RgbF> result;
    for (std::size_t s = 0; s < sums.size(); ++s)
      result.push_back(RgbF(Rgb(areas[s] > 0 ? sums[s] / areas[s] : 0)));
    return result;
  }
  std::vector<RgbF> no_errors() const { return std::vector<RgbF>(surface.samples.size()); }
};

// Claim: the cell that a point falls into is the nearest sample of its sheet, and cells found so have the samples' areas.
// Source: surface_shares.h. Tolerance: 1 % rms over cells of a torus and of a thin box with creases, of pieces of
// 1/2000 of a cell (of 1/100: 3 %). Fails if: sheets are told apart otherwise than where the areas were made.
TEST(NearestSample, CellsHaveTheSamplesAreas) {
  for (const ShapeSource& shape :
       {ShapeSource(TorusShape{{}, 20, 3, 5}), ShapeSource(BoxShape{{-10, -10, -.3}, {10, 10, .3}})}) {
    const Sampled sampled(world_of({shape}, NormalMode::faceted), 1000, .0005);
    std::vector<double> areas(sampled.surface.samples.size());
    for (std::size_t i = 0; i < sampled.pieces.size(); ++i)
      areas[sampled.cell_of[i]] += sampled.pieces[i].area;
    double squares = 0, whole = 0;
    for (std::size_t s = 0; s < areas.size(); ++s) {
      squares += std::pow(areas[s] - double(sampled.surface.samples[s].area), 2);
      whole += std::pow(double(sampled.surface.samples[s].area), 2);
    }
    EXPECT_LT(std::sqrt(squares / whole), .01);
  }
}

// Claim: cells below a share of the mean area are never the nearest, the others keep their numbers. Source: the cut
// surface has slivers with inaccurate exitance. Fails if: slivers are kept, or numbers count the kept cells alone.
TEST(NearestSample, LeavesOutSlivers) {
  std::vector<SurfaceSample> samples(3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].centroid = Vec3f(float(i), 0, 0);
    samples[i].position = Vec3f(0, 5, 0);  // unused
    samples[i].normal = Vec3f(0, 1, 0);
    samples[i].area = i == 1 ? .1f : 1;
  }
  const Vec3f beside(1.1f, 0, 0), up(0, 1, 0);
  EXPECT_EQ(NearestSample::by_centroids(samples, 1).at(beside, up), 1u);
  EXPECT_EQ(NearestSample::by_centroids(samples, 1, .2).at(beside, up), 2u);
}

// Claim: a quadratic on a plane comes out of its cells' means as it was. Source: the fit has those terms, and means of
// them. Tolerance: .5 % of its range, inside: cells are no regular hexagons; means taken for values would be 1.5 % off.
// Fails if: the means of the quadratic terms leave out the cells' own extent, or a term is missing.
TEST(CellFit, QuadraticsComeOut) {
  const Sampled sampled(world_of({floor_quad(10)}), 400);
  const FieldOf field = [](const Vec3d& p) {
    return 300 + 3 * p.x + p.z + 1.5 * p.x * p.x - p.x * p.z - .5 * p.z * p.z;
  };
  const CellFit fit(sampled.surface.samples, sampled.means(field), sampled.no_errors());
  double worst = 0;
  for (std::size_t i = 0; i < sampled.pieces.size(); i += 7) {
    const Piece& piece = sampled.pieces[i];
    if (std::max(std::abs(piece.position.x), std::abs(piece.position.z)) > 6) continue;
    const CellFit::Value found = fit.at(Vec3f(piece.position), piece.geometric);
    worst = std::max(worst, std::abs(double(found.value.x) - field(piece.position)));
    EXPECT_EQ(found.noise.x, 0);
  }
  EXPECT_LT(worst, .005 * 200);
}

// Claim: noise in the means is foretold at points, and makes no bias. Source: the fit is linear. Tolerance: of 300 draws
// the spread is known to 4 %: 15 %, for the blending is foretold by a constant; the mean within 4 standard errors. Fails
// if: the fit's weights are left out of the noise.
TEST(CellFit, NoiseIsForetold) {
  const Sampled sampled(world_of({SphereShape{{}, 10}}), 300);
  const FieldOf field = [](const Vec3d& p) { return 100 + p.x + p.y; };
  const std::vector<RgbF> means = sampled.means(field);
  std::vector<RgbF> errors(means.size(), RgbF(5.0f));
  std::mt19937 engine(1);
  std::normal_distribution<float> gauss(0, 5);
  std::array<Mean, 8> values;
  std::array<double, 8> stated{};
  for (int draw = 0; draw < 300; ++draw) {
    std::vector<RgbF> noisy = means;
    for (RgbF& mean : noisy) mean += RgbF(gauss(engine));
    const CellFit fit(sampled.surface.samples, noisy, errors);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Piece& piece = sampled.pieces[i * sampled.pieces.size() / values.size()];
      const CellFit::Value found = fit.at(Vec3f(piece.position), piece.geometric);
      values[i].add(double(found.value.x));
      stated[i] = double(found.noise.x);
    }
  }
  double squares = 0, stated_squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += values[i].variance();
    stated_squares += stated[i] * stated[i];
    const Piece& piece = sampled.pieces[i * sampled.pieces.size() / values.size()];
    EXPECT_NEAR(values[i].mean(), field(piece.position), 4 * values[i].error() + .1);
  }
  EXPECT_NEAR(std::sqrt(stated_squares / squares), 1, .15);
  EXPECT_LT(std::sqrt(squares / double(values.size())), .6 * 5);  // less than one cell's
}

// Claim: what the fit misses of a field that is no quadratic is foretold, and falls fast with finer cells. Source: what
// fits miss of the means they were made of. Tolerance: a factor of 2 either way, rms over the surface. Fails if: the
// surprise of one cell is taken for its own alone, or noise for surprise.
TEST(CellFit, ShapeIsForetold) {
  double before = 0;
  for (const std::size_t samples : {500, 2000}) {
    const Sampled sampled(world_of({SphereShape{{}, 10}}), samples);
    const FieldOf field = [](const Vec3d& p) {
      return std::exp(2 * std::sin(.7 * p.x) + std::sin(.8 * p.y));
    };
    const CellFit fit(sampled.surface.samples, sampled.means(field), sampled.no_errors());
    double off = 0, foretold = 0, whole = 0;
    for (std::size_t i = 0; i < sampled.pieces.size(); i += 7) {
      const Piece& piece = sampled.pieces[i];
      const CellFit::Value found = fit.at(Vec3f(piece.position), piece.geometric);
      off += std::pow(double(found.value.x) - field(piece.position), 2);
      foretold += std::pow(double(found.shape.x), 2);
      whole += std::pow(field(piece.position), 2);
    }
    EXPECT_LT(std::sqrt(foretold / off), 2) << samples;
    EXPECT_GT(std::sqrt(foretold / off), .5) << samples;
    const double error = std::sqrt(off / whole);
    if (before > 0) {
      EXPECT_LT(error, .25 * before);
    }
    before = error;
  }
}

// Claim: what a reader was told to expect, and what it read before, changes no bit of what it reads. Source: the header;
// crops and tiles have the bytes of the whole picture. Fails if: cells at the rim of
// what is expected are missing.
TEST(CellFit, ReadersAgree) {
  const Sampled sampled(world_of({SphereShape{{}, 10}}), 800);
  const FieldOf field = [](const Vec3d& p) { return 20 + p.x + std::sin(p.y); };
  const CellFit fit(sampled.surface.samples, sampled.means(field), sampled.no_errors());
  CellFit::Reader reader(fit);
  const auto position = [&](std::size_t i) { return Vec3f(sampled.pieces[i].position); };
  std::mt19937 engine(1);
  for (std::size_t i = 0; i + 40 < sampled.pieces.size(); i += 97) {
    const std::size_t other = engine() % sampled.pieces.size();
    if (i % 2 == 0) reader.expect(std::array{position(i), position(i + 1), position(i + 2)});
    if (i % 5 == 0) reader.expect(std::array{position(i), position(other)});
    for (const std::size_t at : {i, i + 2, i + 40, other}) {
      const Vec3f& normal = sampled.pieces[at].geometric;
      const CellFit::Value read = reader.at(position(at), normal), alone = fit.at(position(at), normal);
      ASSERT_EQ(read.value, alone.value);
      ASSERT_EQ(read.shape, alone.shape);
    }
  }
}

// Claim: weights that are kept give each field the fit that it has without them, bit for bit, whatever was fitted before.
// Source: they depend on where the cells lie alone. Fails if: means are taken into the weights, or those of one chunk of
// cells go to the next.
TEST(CellFit, KeptWeightsGiveTheSameFit) {
  const Sampled sampled(world_of({TorusShape{{}, 9, 4, 5}}), 700);
  const std::vector<SurfaceSample>& samples = sampled.surface.samples;
  const CellWeights weights(samples);
  for (const double slope : {2., -.7}) {
    const std::vector<RgbF> means =
        sampled.means([&](const Vec3d& p) { return 40 + slope * p.x + std::sin(p.z); });
    const std::vector<RgbF> errors(means.size(), RgbF(float(std::abs(slope))));
    const CellFit kept(weights, means, errors), anew(samples, means, errors);
    for (std::size_t i = 0; i < sampled.pieces.size(); i += 31) {
      const Vec3f position(sampled.pieces[i].position);
      const CellFit::Value a = kept.at(position, sampled.pieces[i].geometric),
                           b = anew.at(position, sampled.pieces[i].geometric);
      EXPECT_EQ(a.value, b.value);
      EXPECT_EQ(a.noise, b.noise);
      EXPECT_EQ(a.shape, b.shape);
    }
  }
}

// Claim: extremes are finite: no cell, one, cells in a row, all in one place, a point far away. Source: the header. Fails
// if: an equation without neighbours is divided by.
TEST(CellFit, Extremes) {
  const World world = world_of({floor_quad(10)});
  SurfaceSamples all = samples_on(world, 50);
  for (const std::size_t count : {0, 1, 2, 3}) {
    std::vector<SurfaceSample> samples(all.samples.begin(), all.samples.begin() + std::ptrdiff_t(count));
    const CellFit fit(samples, std::vector<RgbF>(count, RgbF(3)), std::vector<RgbF>(count, RgbF(1)));
    for (const Vec3f& at : {Vec3f{0, 0, 0}, Vec3f{1e6f, 0, 0}}) {
      const CellFit::Value found = fit.at(at, {0, 1, 0});
      EXPECT_TRUE(is_finite(found.value) && is_finite(found.noise) && is_finite(found.shape)) << count;
      EXPECT_NEAR(found.value.x, count > 0 ? 3 : 0, .01) << count;
    }
  }
  std::vector<SurfaceSample> same(9, all.samples[0]);
  const CellFit fit(same, std::vector<RgbF>(9, RgbF(3)), std::vector<RgbF>(9, RgbF(1)));
  EXPECT_NEAR(fit.at(same[0].position, {0, 1, 0}).value.x, 3, .01);
}

}  // namespace
}  // namespace opaline
