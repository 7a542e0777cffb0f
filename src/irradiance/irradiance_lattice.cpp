// SPDX-License-Identifier: GPL-3.0-or-later
#include "irradiance/irradiance_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/random.h"

namespace opaline {
namespace {

constexpr int kLines = 8;  // along a side of a cell
// Width of the random offset of a line, over its grid square; src/exitance/README.md has the comparison.
constexpr float kFreedom = 0.5f;

std::size_t largest_axis(const Vec3d& v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

std::size_t bytes_of(const IrradianceLattice::Cell& cell) {
  const std::size_t of_point =
      sizeof(SurfacePoint) + sizeof(float) + sizeof(RgbF) + cell.lights.size() * sizeof(float);
  return sizeof cell + cell.points.size() * of_point;
}

}  // namespace

void set_held_lights(std::vector<PointTransfers>& lights,
                     std::span<const std::optional<std::size_t>> before) {
  std::vector<PointTransfers> now(before.size());
  for (std::size_t l = 0; l < before.size(); ++l)
    if (before[l] && *before[l] < lights.size()) now[l] = std::move(lights[*before[l]]);
  lights = std::move(now);
}

// Intersections of a cell's lines with the surface.
struct IrradianceLattice::Crossings {
  Crossings(const Key& key, const Vec3d& low_, double step_, std::uint64_t seed_, Cell& cell_)
      : low(low_), step(step_), seed(hash_bits(seed_, key.level)), cell(cell_) {
    for (const std::int64_t k : key.corner) seed = hash_bits(seed, std::uint64_t(k));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const std::uint64_t family =
          hash_bits(hash_bits(hash_bits(seed_, key.level * 3 + k), std::uint64_t(key.corner[i])),
                    std::uint64_t(key.corner[j]));
      for (std::size_t n = 0; n < kLines * kLines; ++n) {
        const std::uint64_t bits = hash_bits(family, n);
        const auto place = [](std::uint64_t u) { return 0.5f + kFreedom * (float(u) * 0x1p-24f - 0.5f); };
        shifts[k][n] = {place(bits >> 40), place(bits & 0xffffff)};
      }
    }
  }
  const std::array<float, 2>& line(std::size_t axis, int x, int y) const {
    return shifts[axis][std::size_t(x * kLines + y)];
  }

  Vec3d low;  // corner of the cell
  double step;
  std::uint64_t seed;  // seed of the cell
  Cell& cell;
  std::array<std::array<std::array<float, 2>, kLines * kLines>, 3> shifts;  // line offsets
};

IrradianceLattice::IrradianceLattice(std::vector<bool> is_own_mesh, double spacing,
                                     const OuterBoundary& boundary, int light_samples, bool holds_lights)
    : is_own_mesh_(std::move(is_own_mesh)),
      spacing_(spacing),
      boundary_(boundary),
      light_samples_(light_samples),
      holds_lights_(holds_lights) {}

bool IrradianceLattice::is_of(const std::vector<bool>& is_own_mesh, double spacing,
                              const OuterBoundary& boundary, int light_samples) const {
  return is_own_mesh == is_own_mesh_ && spacing == spacing_ && boundary == boundary_ &&
         light_samples == light_samples_;
}

void IrradianceLattice::set_lights(std::span<const std::optional<std::size_t>> before) {
  for (Shard& shard : shards_)
    for (auto& [key, cell] : shard.cells) set_held_lights(cell.lights, before);
}

void IrradianceLattice::next_picture() {
  ++picture_;
  if (bytes_ <= kMostBytes) return;
  for (Shard& shard : shards_) shard.cells.clear();
  bytes_ = 0;
}

double IrradianceLattice::spacing(std::uint32_t level) const {
  return std::ldexp(level % 2 == 0 ? spacing_ : spacing_ / std::numbers::sqrt2, -int(level / 2));
}

std::size_t IrradianceLattice::Hash::operator()(const Key& key) const {
  std::uint64_t hash = hash_bits(key.level, 0);
  for (const std::int64_t k : key.corner) hash = hash_bits(hash, std::uint64_t(k));
  return hash;
}

std::vector<IrradianceLattice::Key> IrradianceLattice::keys_near(std::span<const SurfacePoint> points,
                                                                 std::span<const std::uint32_t> chosen,
                                                                 double reach, std::uint32_t level) const {
  const double side = spacing(level) * double(kLines);
  const auto range = [&](double low, double high) {
    return std::pair(std::int64_t(std::floor((low - reach) / side)),
                     std::int64_t(std::floor((high + reach) / side)));
  };
  Vec3d low(points[chosen.front()].position), high = low;
  for (const std::uint32_t i : chosen) widen(low, high, Vec3d(points[i].position));
  const auto is_near = [&](const Vec3d& p, const std::array<std::int64_t, 3>& corner) {
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double left = double(corner[axis]) * side,
                   gap = std::max({0.0, left - p[axis], p[axis] - left - side});
      square += gap * gap;
    }
    return square < reach * reach;
  };
  std::vector<Key> keys;
  const auto add_around = [&](const Vec3d& from, const Vec3d& to, std::span<const std::uint32_t> among) {
    const auto [x0, x1] = range(from.x, to.x);
    const auto [y0, y1] = range(from.y, to.y);
    const auto [z0, z1] = range(from.z, to.z);
    for (std::int64_t x = x0; x <= x1; ++x)
      for (std::int64_t y = y0; y <= y1; ++y)
        for (std::int64_t z = z0; z <= z1; ++z)
          if (std::ranges::any_of(among, [&](std::uint32_t i) {
                return is_near(Vec3d(points[i].position), {x, y, z});
              }))
            keys.push_back({{x, y, z}, level});
  };
  const Vec3d size = high - low;
  if (max_component(size) < 4 * reach) {
    add_around(low, high, chosen);
    return keys;
  }
  for (std::size_t m = 0; m < chosen.size(); ++m) {
    const Vec3d p(points[chosen[m]].position);
    add_around(p, p, chosen.subspan(m, 1));
  }
  std::ranges::sort(keys, {}, &Key::corner);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

const IrradianceLattice::Cell& IrradianceLattice::cell(const Key& key, const PointIrradianceInput& lighting) {
  Shard& shard = shards_[Hash()(key) % shards_.size()];
  const std::lock_guard lock(shard.mutex);
  const auto known = shard.cells.find(key);
  if (known == shard.cells.end()) {
    Cell& cell = shard.cells.emplace(key, make_cell(key, lighting)).first->second;
    light(cell, lighting);
    bytes_ += bytes_of(cell);
    return cell;
  }
  if (known->second.picture != picture_) light(known->second, lighting);
  return known->second;
}

// Traces shadow rays only to lights without cached results.
void IrradianceLattice::light(Cell& cell, const PointIrradianceInput& lighting) const {
  cell.picture = picture_;
  if (cell.points.empty()) return;
  std::vector<std::uint64_t> keys(cell.points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = hash_bits(cell.seed, i);
  std::vector<SurfacePoint> bent;
  if (lighting.bend) bent = cell.points;
  for (std::size_t i = 0; i < bent.size(); ++i) bent[i].width = std::sqrt(cell.areas[i]);
  const std::vector<float> factors = bend_all(lighting, bent);
  PointIrradianceInput here = lighting;
  here.points = lighting.bend ? bent : cell.points;
  here.keys = keys;
  here.boundary = lighting.boundary;  // with the textures of the present world
  here.light_samples = light_samples_;
  here.variance = {};
  if (holds_lights_) add_transfers(here, cell.lights);
  cell.entered = holds_lights_ ? combine_lights(cell.lights, here) : irradiance_at(here);
  for (std::size_t i = 0; i < factors.size(); ++i) cell.entered[i] = cell.entered[i] * factors[i];
}

IrradianceLattice::Cell IrradianceLattice::make_cell(const Key& key,
                                                     const PointIrradianceInput& lighting) const {
  const double side = spacing(key.level) * double(kLines);
  Vec3d low;
  for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = double(key.corner[axis]) * side;
  Cell cell;
  const std::vector<LineQuery::Triangle> triangles =
      LineQuery::triangles_in(lighting.rays, Vec3f(low), float(side));
  if (triangles.empty()) return cell;
  Crossings crossings(key, low, spacing(key.level), hash_bits(lighting.seed, 3003), cell);
  for (const LineQuery::Triangle& triangle : triangles)
    if (triangle.mesh < is_own_mesh_.size() && is_own_mesh_[triangle.mesh])
      add_crossings(lighting.rays, triangle, crossings);
  if (cell.points.empty()) return cell;
  cell.low = cell.high = cell.points.front().position;
  for (const SurfacePoint& point : cell.points) widen(cell.low, cell.high, point.position);
  cell.seed = crossings.seed;
  return cell;
}

// Intersects a triangle with the lines along the axis nearest to its normal, within the cell.
void IrradianceLattice::add_crossings(const RayScene& rays, const LineQuery::Triangle& triangle,
                                      Crossings& crossings) const {
  const double step = crossings.step, per_step = 1 / step;
  const Vec3d a = (Vec3d(triangle.corners[0]) - crossings.low) * per_step,
              ab = Vec3d(triangle.corners[1] - triangle.corners[0]) * per_step,
              ac = Vec3d(triangle.corners[2] - triangle.corners[0]) * per_step, normal = cross(ab, ac);
  const std::size_t k = largest_axis(normal), i = (k + 1) % 3, j = (k + 2) % 3;
  const double area = normal[k];
  if (!(std::abs(area) > 0)) return;
  const auto lines = [&](std::size_t axis) {
    const double low = a[axis] + std::min({0.0, ab[axis], ac[axis]}),
                 high = a[axis] + std::max({0.0, ab[axis], ac[axis]});
    return std::pair(std::max(0, int(low)), std::min(kLines - 1, int(high)));
  };
  const auto [first_i, last_i] = lines(i);
  const auto [first_j, last_j] = lines(j);
  const double per_area = 1 / area;
  const auto stands_for = float(step * step * length(normal) / std::abs(area));
  for (int x = first_i; x <= last_i; ++x)
    for (int y = first_j; y <= last_j; ++y) {
      const auto& [shift_x, shift_y] = crossings.line(k, x, y);
      const double dx = double(x) + shift_x - a[i], dy = double(y) + shift_y - a[j];
      const double u = (dx * ac[j] - dy * ac[i]) * per_area, v = (dy * ab[i] - dx * ab[j]) * per_area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const double height = a[k] + u * ab[k] + v * ac[k];
      if (height < 0 || height >= double(kLines)) continue;
      crossings.cell.points.push_back(
          rays.surface_point(triangle.mesh, triangle.triangle, float(u), float(v)));
      crossings.cell.areas.push_back(stands_for);
    }
}

}  // namespace opaline
