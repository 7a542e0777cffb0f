// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/volume/nearest_sample.h"

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace opaline {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<float, 3, bg::cs::cartesian>;
using Entry = std::pair<Point, std::uint32_t>;

Point point_of(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

std::vector<Entry> entries_of(std::span<const SurfaceSample> samples) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < samples.size(); ++i)
    entries.emplace_back(point_of(samples[i].position), std::uint32_t(i));
  return entries;
}

}  // namespace

struct NearestSample::Tree {
  explicit Tree(std::span<const SurfaceSample> all) : samples(all), index(entries_of(all)) {}

  std::span<const SurfaceSample> samples;
  bg::index::rtree<Entry, bg::index::linear<16>> index;
};

NearestSample::NearestSample(std::span<const SurfaceSample> samples)
    : tree_(std::make_unique<const Tree>(samples)) {}
NearestSample::~NearestSample() = default;

std::uint32_t NearestSample::at(const Vec3f& position, const Vec3f& normal) const {
  const auto is_of_sheet = [&](const Entry& entry) {
    return dot(tree_->samples[entry.second].normal, normal) >= 0;
  };
  for (auto it = tree_->index.qbegin(bg::index::nearest(point_of(position), 1) &&
                                     bg::index::satisfies(is_of_sheet));
       it != tree_->index.qend(); ++it)
    return it->second;
  const auto any = tree_->index.qbegin(bg::index::nearest(point_of(position), 1));
  return any->second;
}

RgbF NearestSample::interpolate(std::span<const RgbF> values, const Vec3f& position, const Vec3f& normal,
                                float radius) const {
  const Vec3f reach(radius);
  const bg::model::box<Point> box(point_of(position - reach), point_of(position + reach));
  RgbF sum;
  float weights = 0;
  for (auto it = tree_->index.qbegin(bg::index::intersects(box)); it != tree_->index.qend(); ++it) {
    const SurfaceSample& sample = tree_->samples[it->second];
    const Vec3f apart = sample.position - position;
    const float t2 = dot(apart, apart) / (radius * radius);
    if (t2 >= 1 || dot(sample.normal, normal) < 0) continue;
    const float weight = sample.area * (1 - t2) * (1 - t2);
    sum += values[it->second] * weight;
    weights += weight;
  }
  return weights > 0 ? sum / weights : values[at(position, normal)];
}

}  // namespace opaline
