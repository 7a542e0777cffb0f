// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/write_samples.h"

#include <fmt/format.h>

#include <bit>

#include "core/atomic_file.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_samples_ply(const std::string& path, std::span<const Body> groups, const World& world) {
  std::size_t count = 0;
  for (const Body& group : groups) count += group.surface.samples.size();
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment opaline samples: mm, mm^2, W/mm^2\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float area\n"
      "property float irradiance_r\nproperty float irradiance_g\nproperty float irradiance_b\n"
      "property uint shape\nend_header\n",
      count);
  for (const Body& group : groups) {
    const std::span<const RgbF> irradiance = method_of(group.plan.method).irradiance(group);
    for (std::size_t i = 0; i < group.surface.samples.size(); ++i) {
      const SurfaceSample& s = group.surface.samples[i];
      append(bytes, out_of_world(world, Vec3d(s.position)));
      append(bytes, s.normal);
      append(bytes, float(double(s.area) * world.unit * world.unit));
      append(bytes, irradiance.empty() ? RgbF{} : irradiance[i]);
      append(bytes, s.mesh);
    }
  }
  write_file(path, bytes);
}

}  // namespace opaline
