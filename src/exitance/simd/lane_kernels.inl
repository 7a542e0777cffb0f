// SPDX-License-Identifier: GPL-3.0-or-later
// The loops of lane_kernels.h on vectors of LANES floats: included once per instruction set, after its
// lanes_*.inl with LANES, TARGET (a function attribute), the vectors V (float) and I (32-bit integers),
// lookup, lookup_32 and lookup_16 (of the first 32 and 16 segments), any, bits and total. Uses no function
// from another file: the linker would keep one copy for all machines.

#include "exitance/simd/lane_series.inl"

struct Offset {
  V x, y, z;
};

TARGET static inline V square(const Offset& d) {
  return d.x * d.x + (d.y * d.y + d.z * d.z);
}

TARGET static inline V second_moment(const std::array<float, 6>& c, const Offset& d) {
  return (c[0] * (d.x * d.x) + (c[1] * (d.y * d.y) + c[2] * (d.z * d.z))) +
         2 * (c[3] * (d.x * d.y) + (c[4] * (d.x * d.z) + c[5] * (d.y * d.z)));
}

TARGET static void add_nodes_block(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                                   const Packet& packet, PacketSums& sums, int block) {
  const V px = load(packet.x + block), py = load(packet.y + block), pz = load(packet.z + block);
  const float unit = input.table.inverse_scale2;
  V sum0{}, sum1{}, sum2{};
  for (std::size_t i = 0; i < count; ++i) {
    const OctreeNode& node = input.nodes[list[i]];
    const float trace = (node.spread[0] + node.spread[1] + node.spread[2]) * unit;
    const bool one_centroid = node.x[0] == node.x[1] && node.x[0] == node.x[2] && node.y[0] == node.y[1] &&
                              node.y[0] == node.y[2] && node.z[0] == node.z[1] && node.z[0] == node.z[2];
    if (one_centroid) {
      const Offset d{node.x[0] - px, node.y[0] - py, node.z[0] - pz};
      const Place at = find(1 + square(d) * unit);
      const V first = splat(trace), second = (2 * unit * unit) * second_moment(node.spread, d);
      sum0 += node.flux[0] * node_kernel(input.table, 0, at, first, second);
      sum1 += node.flux[1] * node_kernel(input.table, 1, at, first, second);
      sum2 += node.flux[2] * node_kernel(input.table, 2, at, first, second);
      continue;
    }
    V* const channel_sums[3] = {&sum0, &sum1, &sum2};
    for (std::size_t c = 0; c < 3; ++c) {
      if (node.flux[c] == 0) continue;
      const Offset d{node.x[c] - px, node.y[c] - py, node.z[c] - pz};
      const Place at = find(1 + square(d) * unit);
      const V second = (2 * unit * unit) * second_moment(node.spread, d);
      *channel_sums[c] += node.flux[c] * node_kernel(input.table, c, at, splat(trace), second);
    }
  }
  add_to(sums.exitance[0] + block, sum0);
  add_to(sums.exitance[1] + block, sum1);
  add_to(sums.exitance[2] + block, sum2);
}

// Channel c of an expansion, lane by lane: value, bend, slope, hessian as in Expansion.
struct ChannelSeries {
  V sums[11]{};

  TARGET inline void add(const LaneInput& input, const SourceBlock& sources, std::size_t c, int block,
                         const Vec3f& center) {
    const float unit = input.table.inverse_scale2;
    const Offset d{load(sources.x[c] + block) - center.x, load(sources.y[c] + block) - center.y,
                   load(sources.z[c] + block) - center.z};
    const Series in_q = series(input.table, c, find(1 + square(d) * unit));
    const Series f{in_q.value, in_q.first * unit, in_q.second * (unit * unit)};  // in s = d'd
    const V cxx = load(sources.spread[0] + block), cyy = load(sources.spread[1] + block),
            czz = load(sources.spread[2] + block), cxy = load(sources.spread[3] + block),
            cxz = load(sources.spread[4] + block), cyz = load(sources.spread[5] + block);
    const V trace = cxx + (cyy + czz);
    const V moment = d.x * (cxx * d.x + 2 * (cxy * d.y + cxz * d.z)) +
                     (d.y * (cyy * d.y + 2 * (cyz * d.z)) + d.z * (czz * d.z));
    const V change = f.first * trace + f.second * (2 * moment), x = relative_change(f.value, change);
    const V flux = load(sources.flux[c] + block);
    // The second moment also changes the derivatives: for a power law 1/r^3 by 5/3 and 5/2 as much.
    const V first = flux * f.first * (1 + 1.5f * x), second = flux * f.second * (1 + 2 * x);
    sums[0] += flux * with_fourth_order(f.value, change);
    sums[1] += first;
    sums[2] += first * d.x;
    sums[3] += first * d.y;
    sums[4] += first * d.z;
    const V sx = second * d.x, sy = second * d.y, sz = second * d.z;
    sums[5] += sx * d.x;
    sums[6] += sy * d.y;
    sums[7] += sz * d.z;
    sums[8] += sx * d.y;
    sums[9] += sx * d.z;
    sums[10] += sy * d.z;
  }
};

TARGET static void expand(const LaneInput& input, std::span<const SourceBlock> sources, const Vec3f& center,
                          Expansion& sum) {
  sum.empty &= sources.empty();
  for (std::size_t c = 0; c < 3; ++c) {
    ChannelSeries channel;
    for (const SourceBlock& block : sources)
      for (int lane = 0; lane < kLanes; lane += LANES) channel.add(input, block, c, lane, center);
    float totals[11];
    for (std::size_t i = 0; i < 11; ++i) totals[i] = total(channel.sums[i]);
    sum.value[c] += totals[0];
    sum.bend[c] += totals[1];
    for (std::size_t i = 0; i < 3; ++i) sum.slope[c][i] += totals[2 + i];
    for (std::size_t i = 0; i < 6; ++i) sum.hessian[c][i] += totals[5 + i];
  }
}

TARGET static void add_expansion(const Expansion& expansion, const Vec3f& center, const Packet& packet,
                                 PacketSums& sums) {
  for (int block = 0; block < kLanes; block += LANES) {
    const V x = load(packet.x + block) - center.x, y = load(packet.y + block) - center.y,
            z = load(packet.z + block) - center.z;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& h = expansion.hessian[c];
      const auto& g = expansion.slope[c];
      const float b = expansion.bend[c];
      const V hx = (2 * h[0] + b) * x + 4 * (h[3] * y + h[4] * z) - 2 * g[0];
      const V hy = (2 * h[1] + b) * y + 4 * h[5] * z - 2 * g[1];
      const V hz = (2 * h[2] + b) * z - 2 * g[2];
      add_to(sums.exitance[c] + block, expansion.value[c] + (hx * x + (hy * y + hz * z)));
    }
  }
}

struct NearSums {
  V area{}, flux0{}, flux1{}, flux2{}, squares{};
};

// Adds a sample within h in some lanes; returns the lanes with it on another sheet.
TARGET static inline std::uint32_t add_near(float near2, float inverse_near2, const TreeSample& s,
                                            const Vec3f& normal, const Packet& packet, int block, V s2,
                                            NearSums& near) {
  const V facing = load(packet.nx + block) * normal.x +
                   (load(packet.ny + block) * normal.y + load(packet.nz + block) * normal.z);
  const I within = s2<splat(near2), same = facing> splat(-0.5f);
  const V rest = 1 - s2 * inverse_near2, zero{};
  const V weight = (within & same) != 0 ? rest * rest : zero;
  near.area += weight * s.area;
  near.flux0 += weight * s.flux[0];
  near.flux1 += weight * s.flux[1];
  near.flux2 += weight * s.flux[2];
  const float squares = s.flux[0] * s.flux[0] + s.flux[1] * s.flux[1] + s.flux[2] * s.flux[2];
  near.squares += weight * (squares / s.area);
  return bits(within & ~same);
}

TARGET static std::size_t add_leaves_block(const LaneInput& input, const std::uint32_t* list,
                                           std::size_t count, const Packet& packet, PacketSums& sums,
                                           int block, std::uint32_t (*whole)[2], std::size_t wholes) {
  const V px = load(packet.x + block), py = load(packet.y + block), pz = load(packet.z + block);
  const float unit = input.table.inverse_scale2, near2 = input.near2, inverse_near2 = 1 / near2;
  V sum0{}, sum1{}, sum2{}, squares0{}, squares1{}, squares2{}, even0{}, even1{}, even2{};
  NearSums near;
  for (std::size_t i = 0; i < count; ++i) {
    const OctreeNode& leaf = input.nodes[list[i]];
    const V before0 = sum0, before1 = sum1, before2 = sum2;
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      const TreeSample& s = input.samples[k];
      const Offset d{s.x - px, s.y - py, s.z - pz};
      const V s2 = square(d);
      const V q = 1 + s2 * unit;
      const Place at = find(q);
      const bool beyond = any_less(splat(256 - 0x1p-16f), q);  // segment 16 begins at 256
      const Kernels kernel_of =
          beyond ? kernels<Reach::all>(input.table, at) : kernels<Reach::near>(input.table, at);
      const V c0 = s.flux[0] * kernel_of.c0, c1 = s.flux[1] * kernel_of.c1, c2 = s.flux[2] * kernel_of.c2;
      sum0 += c0;
      sum1 += c1;
      sum2 += c2;
      squares0 += c0 * c0;
      squares1 += c1 * c1;
      squares2 += c2 * c2;
      if (!any_less(s2, splat(near2))) continue;
      const std::uint32_t other =
          add_near(near2, inverse_near2, s, input.normals[k], packet, block, s2, near);
      if (other != 0) {
        whole[wholes][0] = k;
        whole[wholes++][1] = other << block;
      }
    }
    // Squares for equal contributions of all samples of the leaf.
    const float inverse = 1 / float(leaf.count);
    even0 += (sum0 - before0) * (sum0 - before0) * inverse;
    even1 += (sum1 - before1) * (sum1 - before1) * inverse;
    even2 += (sum2 - before2) * (sum2 - before2) * inverse;
  }
  add_to(sums.exitance[0] + block, sum0);
  add_to(sums.exitance[1] + block, sum1);
  add_to(sums.exitance[2] + block, sum2);
  add_to(sums.squares[0] + block, squares0);
  add_to(sums.squares[1] + block, squares1);
  add_to(sums.squares[2] + block, squares2);
  add_to(sums.spread[0] + block, squares0 - even0);
  add_to(sums.spread[1] + block, squares1 - even1);
  add_to(sums.spread[2] + block, squares2 - even2);
  add_to(sums.near_area + block, near.area);
  add_to(sums.near_flux[0] + block, near.flux0);
  add_to(sums.near_flux[1] + block, near.flux1);
  add_to(sums.near_flux[2] + block, near.flux2);
  add_to(sums.near_squares + block, near.squares);
  return wholes;
}

TARGET static void add_nodes(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                             const Packet& packet, PacketSums& sums) {
  for (int block = 0; block < kLanes; block += LANES)
    add_nodes_block(input, list, count, packet, sums, block);
}

TARGET static std::size_t add_leaves(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                                     const Packet& packet, PacketSums& sums, std::uint32_t (*whole)[2]) {
  std::size_t wholes = 0;
  for (int block = 0; block < kLanes; block += LANES)
    wholes = add_leaves_block(input, list, count, packet, sums, block, whole, wholes);
  return wholes;
}
