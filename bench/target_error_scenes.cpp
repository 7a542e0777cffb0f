// SPDX-License-Identifier: GPL-3.0-or-later
#include "target_error_scenes.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "input/presets.h"

namespace opaline {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A closed surface over two turning parameters, or, with poles, over latitude and longitude.
void write_grid(const std::string& path, int rows, int columns, bool poles,
                const std::function<Vec3d(double, double)>& at) {
  std::ofstream file(path);
  const auto vertex = [&](const Vec3d& p) { file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n'; };
  const int rings = poles ? rows - 1 : rows;
  for (int r = 0; r < rings; ++r)
    for (int c = 0; c < columns; ++c)
      vertex(at(poles ? double(r + 1) / rows : double(r) / rows, double(c) / columns));
  const auto id = [&](int r, int c) { return 1 + (r % rings) * columns + c % columns; };
  for (int r = 0; r < (poles ? rings - 1 : rings); ++r)
    for (int c = 0; c < columns; ++c) {
      file << "f " << id(r, c) << ' ' << id(r, c + 1) << ' ' << id(r + 1, c + 1) << '\n';
      file << "f " << id(r, c) << ' ' << id(r + 1, c + 1) << ' ' << id(r + 1, c) << '\n';
    }
  if (!poles) return;
  vertex(at(0, 0));
  vertex(at(1, 0));
  const int top = rings * columns + 1;
  for (int c = 0; c < columns; ++c) {
    file << "f " << top << ' ' << id(0, c + 1) << ' ' << id(0, c) << '\n';
    file << "f " << top + 1 << ' ' << id(rings - 1, c) << ' ' << id(rings - 1, c + 1) << '\n';
  }
}

/// A ball with hills and furrows.
Vec3d asteroid(double u, double v) {
  const double theta = u * kTurn / 2, phi = v * kTurn;
  const Vec3d d{std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
  const double hills = .18 * std::sin(5 * d.x + 1) * std::sin(6 * d.y) + .1 * std::sin(9 * d.z + 2 * d.x);
  return d * (1 + hills);
}

/// A tube along a trefoil.
Vec3d knot(double u, double v) {
  const auto middle = [](double t) {
    return Vec3d{std::sin(t) + 2 * std::sin(2 * t), -std::sin(3 * t), std::cos(t) - 2 * std::cos(2 * t)};
  };
  const double t = u * kTurn;
  const Vec3d along = normalized(middle(t + 1e-4) - middle(t - 1e-4)),
              side = normalized(cross(along, Vec3d{.1, 1, .2})), up = cross(side, along);
  return middle(t) + side * (.45 * std::cos(v * kTurn)) + up * (.45 * std::sin(v * kTurn));
}

/// A vessel with a thin wall, turned about y.
Vec3d vase(double u, double v) {
  const bool inside = u > .5;
  const double height = inside ? 2 * (1 - u) : 2 * u;
  const double outer = (.55 + .25 * std::sin(3.6 * height)) * std::sqrt(std::min(1., 12 * height)),
               wall = .07 * std::min(1., 8 * (1 - height));
  const double radius = inside ? std::max(0., outer - wall) : outer;
  const double y = 2 * (inside ? .06 + .94 * height : height);
  return {u == 0 || u == 1 ? 0 : radius * std::sin(v * kTurn), y,
          u == 0 || u == 1 ? 0 : radius * std::cos(v * kTurn)};
}

Medium preset(const std::string& name) {
  for (const Preset& p : presets())
    if (p.name == name) return {name, p.coefficients, p.eta, ProfileKind::dipole};
  throw std::runtime_error("no preset " + name);
}

Shape shape(const std::string& name, ShapeSource source, std::size_t medium = 0) {
  Shape made;
  made.name = name;
  made.source = std::move(source);
  made.medium = medium;
  return made;
}

/// Seen from a distance of five times the radius, a little from above.
Scene view(std::vector<Shape> shapes, std::vector<Medium> media, std::vector<Light> lights, double radius) {
  Scene scene;
  scene.media = std::move(media);
  scene.shapes = std::move(shapes);
  scene.lights = std::move(lights);
  scene.camera.position = {radius, 2 * radius, 4.5 * radius};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.field_of_view = 28;
  scene.film.resolution = {128, 128};
  scene.settings.seed = 1;
  return scene;
}

Light point(const Vec3d& position, double intensity) {
  return {"point", PointLight{position, Rgb(intensity)}};
}
Light sun(const Vec3d& direction) {
  return {"sun", DirectionalLight{normalized(direction), Rgb(1)}};
}
Light sky(double radiance) {
  return {"sky", Surroundings{Rgb(radiance)}};
}
Light panel(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  return {"panel", QuadLight{corner, u, v, Rgb(1)}};
}

}  // namespace

std::vector<NamedScene> calibration_scenes(const std::string& folder) {
  const auto path = [&](const char* name) { return folder + "/" + name + ".obj"; };
  write_grid(path("asteroid"), 80, 160, true, asteroid);
  write_grid(path("knot"), 400, 40, false, knot);
  write_grid(path("vase"), 200, 120, true, vase);
  const auto mesh = [&](const char* name, double size) {
    Shape made = shape(name, MeshFile{path(name), false, size});
    made.to_world.translation.y = -.5 * size * (std::string(name) == "knot" ? .4 : .9);
    return made;
  };
  Shape blocker = shape("blocker", QuadShape{{-4, 14, -30}, {0, 0, 60}, {14, 0, 0}});
  blocker.medium.reset();
  blocker.reflectance = {};
  const Medium wax{"wax", ArtistMedium{{.85, .6, .3}, {2.4, 1.2, .5}, 0}, 1.4, ProfileKind::dipole};
  return {
      {"torus, skin2, two points", view({shape("torus", TorusShape{{}, 10, 4})}, {preset("skin2")},
                                        {point({40, 30, 20}, 1e3), point({-30, 20, -40}, 2e3)}, 14)},
      {"box, cream, sun",
       view({shape("box", BoxShape{{-8, -8, -8}, {8, 8, 8}})}, {preset("cream")}, {sun({-1, -2, -1.5})}, 13)},
      {"vase, wholemilk, panel and sky", view({mesh("vase", 80)}, {preset("wholemilk")},
                                              {panel({-60, 60, 60}, {0, 0, -40}, {40, 0, 0}), sky(.1)}, 40)},
      {"knot, ketchup, point", view({mesh("knot", 60)}, {preset("ketchup")}, {point({30, 80, 40}, 1e4)}, 30)},
      {"asteroid, potato, ball lamp", view({mesh("asteroid", 30)}, {preset("potato")},
                                           {{"lamp", SphereLight{{30, 30, 20}, 6, Rgb(1)}}}, 17)},
      {"slab, apple, lit from behind",
       view({shape("slab", SlabShape{{}, 30, 30, 4})}, {preset("apple")}, {sun({.3, 1, .2})}, 20)},
      {"asteroid, chicken1, sun and sky",
       view({mesh("asteroid", 60)}, {preset("chicken1")}, {sun({1, -1, -.3}), sky(.05)}, 34)},
      {"knot, skimmilk, panel",
       view({mesh("knot", 50)}, {preset("skimmilk")}, {panel({-20, 60, -10}, {30, 0, 0}, {0, 0, 30})}, 25)},
      {"three balls, chicken2, apple and cream, sun",
       view({shape("large", SphereShape{{-8, 0, 0}, 10}, 0), shape("middle", SphereShape{{9, -4, 4}, 6}, 1),
             shape("small", SphereShape{{6, 6, 8}, 2}, 2)},
            {preset("chicken2"), preset("apple"), preset("cream")}, {sun({-1, -1.5, -1})}, 17)},
      {"vase, spectralon, point",
       view({mesh("vase", 30)}, {preset("spectralon")}, {point({40, 60, 50}, 1e3)}, 15)},
      {"knot, wax, two points",
       view({mesh("knot", 90)}, {wax}, {point({90, 60, 60}, 1e3), point({-60, 30, -90}, 2e3)}, 45)},
      {"box behind an edge, potato, point",
       view({shape("box", BoxShape{{-10, -10, -10}, {10, 10, 10}}), blocker}, {preset("potato")},
            {point({10, 60, 30}, 1e3)}, 17)},
      {"large torus, wholemilk, sun",
       view({shape("torus", TorusShape{{}, 60, 20})}, {preset("wholemilk")}, {sun({-2, -1, -.5})}, 80)},
  };
}

}  // namespace opaline
