// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres as mesh files, with fewer triangles than the built-in ones: a child process loads them sooner.
#pragma once

#include <sstream>

#include "geometry/builtin_shapes.h"
#include "scratch_folder.h"

namespace opaline {

/// An OBJ file of 5120 triangles about the origin, kept until the process ends. in: radius in mm
inline std::string ball_file(double radius) {
  static const ScratchFolder folder;
  std::ostringstream name;
  name << folder.file("ball-") << radius << ".obj";
  if (std::filesystem::exists(name.str())) return name.str();
  SphereShape sphere;
  sphere.radius = radius;
  sphere.fineness = kLeastFineness;
  const SourceMesh mesh = tessellate(sphere, "ball");
  std::ostringstream text;
  text.precision(9);
  for (const Vec3d& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Vec3f& n : mesh.normals) text << "vn " << n.x << ' ' << n.y << ' ' << n.z << '\n';
  for (const auto& t : mesh.triangles) {
    text << 'f';
    for (const std::uint32_t corner : t) text << ' ' << corner + 1 << "//" << corner + 1;
    text << '\n';
  }
  put_bytes(name.str(), text.str());
  return name.str();
}

}  // namespace opaline
