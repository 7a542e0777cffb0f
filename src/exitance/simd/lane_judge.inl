// SPDX-License-Identifier: GPL-3.0-or-later
// Acceptance of sources as points or expansions, for a vector of LANES: included like lane_kernels.inl, but
// compiled without fused multiply-add, so every instruction set decides alike.

TARGET static inline V splat(float f) {
  return V{} + f;
}
TARGET static inline V load(const float* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
TARGET static inline V larger(V a, V b) {
  return a > b ? a : b;
}

TARGET static inline V beyond(const float* center, const float* half, float cluster_center,
                              float cluster_half) {
  const V d = load(center) - cluster_center;
  return larger(larger(d, -d) - load(half) - cluster_half, V{});
}

// A series in the offsets from their centres, of the samples (rms `size`) and of the points (up to `radius`),
// leaves about kernel x (offset x relative slope)^3.
TARGET static Verdict judge(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster) {
  Verdict verdict{};
  for (int block = 0; block < kLanes; block += LANES) {
    const V gx = beyond(sources.center[0] + block, sources.half[0] + block, cluster.center.x, cluster.half.x),
            gy = beyond(sources.center[1] + block, sources.half[1] + block, cluster.center.y, cluster.half.y),
            gz = beyond(sources.center[2] + block, sources.half[2] + block, cluster.center.z, cluster.half.z);
    I ok = gx * gx + (gy * gy + gz * gz) >= splat(input.near2);
    if (!any(ok)) continue;
    const V dx = load(sources.all[0] + block) - cluster.center.x,
            dy = load(sources.all[1] + block) - cluster.center.y,
            dz = load(sources.all[2] + block) - cluster.center.z;
    const V distance = square_root(dx * dx + (dy * dy + dz * dz)) - cluster.radius;
    const V size = load(sources.size + block), aside = load(sources.aside + block);
    ok &= (distance > V{}) & (size <= 0.5f * distance);
    if (!any(ok)) continue;
    const V safe = ok ? distance : splat(1.0f);
    const I q = (I)(1 + safe * safe * input.table.inverse_scale2);
    const I segment = (q - 0x3F800000) >> 22, last = I{} + (LaneTable::kSegments - 1);
    const V t = __builtin_convertvector(q & 0x003FFFFF, V) * 0x1p-22f;
    const I place = segment > last ? last : segment;
    const bool near_table = !any(place > 31);
    const V slope = 3 / safe, both = size + cluster.radius;
    I far = ok & (safe < splat(1e15f));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& chord = input.table.chord[c];
      const V kernel = near_table ? lookup_32(chord[0].data(), place) + t * lookup_32(chord[1].data(), place)
                                  : lookup(chord[0].data(), place) + t * lookup(chord[1].data(), place);
      const V share = load(sources.flux[c] + block) * kernel;
      const V rate = slope + input.table.decay[c], allowed = splat(cluster.allowed[c]);
      const V second = share * rate * rate, third = second * rate;
      ok &= (third * size * size * size <= allowed) & (second * aside * aside <= allowed);
      far &= third * both * both * both <= allowed;
    }
    verdict.points |= bits(ok) << block;
    verdict.expansion |= bits(ok & far) << block;
  }
  return verdict;
}
