// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/packet_samples.h"

#include <algorithm>
#include <cmath>

#include "exitance/point_sums.h"

namespace opaline {
namespace {

// A sample of another sheet within h has no near field: its kernel is whole.
void add_near_part(const EvaluateInput& input, float near2, std::uint32_t sample, const Packet& packet,
                   std::size_t lane, PacketSums& sums) {
  const TreeSample& s = input.octree.samples[sample];
  const Vec3f d = Vec3f{s.x, s.y, s.z} - Vec3f{packet.x[lane], packet.y[lane], packet.z[lane]};
  const float r2 = dot(d, d), missing = 1 - far_weight(std::sqrt(r2 / near2));
  alignas(16) float kernel[4], moved[4];
  _mm_store_ps(kernel, input.kernel.table(r2));
  _mm_store_ps(moved, input.kernel.table(moved_distance2(d, input.octree.normals[sample], near2)));
  for (std::size_t c = 0; c < 3; ++c) {
    const float change = (kernel[c] - moved[c]) * s.flux[c];
    sums.exitance[c][lane] += kernel[c] * missing * s.flux[c];
    sums.sheets[c][lane] += change * change;
  }
}

Points4 load(const float* lanes) {
  return (Points4)_mm_load_ps(lanes);
}

// Sums of the four points from a lane on.
PointSums<Points4> sums_at(const EvaluateInput& input, const PacketSums& from, std::size_t lane) {
  PointSums<Points4> sums;
  sums.near_area = load(from.near_area + lane);
  Points4 square{};
  for (std::size_t c = 0; c < 3; ++c) {
    sums.near_flux[c] = load(from.near_flux[c] + lane);
    square += sums.near_flux[c] * sums.near_flux[c];
  }
  // The irradiance varies around the point by the same fraction of its mean in each channel.
  const Points4 spread = square > 0 ? load(from.near_squares + lane) / square : Points4{};
  for (std::size_t c = 0; c < 3; ++c) {
    sums.far[c] = larger(Points4{}, load(from.exitance[c] + lane));
    sums.spread[c] = load(from.spread[c] + lane);
    sums.squares[c] = load(from.squares[c] + lane);
    sums.sheets[c] = load(from.sheets[c] + lane);
    sums.hierarchy[c] = input.cloud.hierarchy[c] * float(input.tolerance) * sums.far[c];
    sums.near_squares[c] = sums.near_flux[c] * sums.near_flux[c] * spread;
  }
  return sums;
}

}  // namespace

void add_samples(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                 const std::vector<std::uint32_t>& leaves, const Packet& packet, PacketSums& sums,
                 std::vector<std::uint32_t>& room) {
  std::size_t samples = 0;
  for (const std::uint32_t leaf : leaves) samples += input.octree.nodes[leaf].count;
  room.resize(samples * kLanes);  // pairs, at most one per sample and block of lanes
  auto* wholes = reinterpret_cast<std::uint32_t(*)[2]>(room.data());
  const std::size_t count = kernels.add_leaves(lanes, leaves.data(), leaves.size(), packet, sums, wholes);
  if (!input.kernel.split) return;
  for (std::size_t i = 0; i < count; ++i)
    for (std::uint32_t bits = wholes[i][1]; bits != 0; bits &= bits - 1)
      add_near_part(input, lanes.near2, wholes[i][0], packet, std::size_t(__builtin_ctz(bits)), sums);
}

void set_exitance(const EvaluateInput& input, const PacketSums& from, std::span<const std::uint32_t> queries,
                  std::span<Exitance> result) {
  for (std::size_t lane = 0; lane < queries.size(); lane += 4) {
    const auto own = queries.subspan(lane, std::min<std::size_t>(4, queries.size() - lane));
    std::array<Points4, 3> given{};
    for (std::size_t i = 0; !input.irradiance.empty() && i < own.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) given[c][i] = input.irradiance[own[i]][c];
    const PointResult<Points4> r =
        result_from(sums_at(input, from, lane), input, input.irradiance.empty() ? nullptr : &given);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto rgb = [i](const std::array<Points4, 3>& v) { return RgbF{v[0][i], v[1][i], v[2][i]}; };
      result[own[i]] = {rgb(r.exitance), rgb(r.irradiance), rgb(r.near), rgb(r.error)};
    }
  }
}

}  // namespace opaline
