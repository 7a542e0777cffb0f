// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>

#include "asset_files/gltf_accessor.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// The shorter arc between two rotations (Shoemake 1985).
std::vector<double> slerp(std::span<const double> a, std::span<const double> b, double t) {
  const double norm = std::sqrt(dot(a, a) * dot(b, b));
  const double cosine = norm > 0 ? dot(a, b) / norm : 1, sign = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(std::abs(cosine), 1.)), sine = std::sin(angle);
  constexpr double kSmall = 1e-6;
  const double of_a = sine > kSmall ? std::sin((1 - t) * angle) / sine : 1 - t,
               of_b = sine > kSmall ? std::sin(t * angle) / sine : t;
  std::vector<double> mean(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mean[i] = of_a * a[i] + sign * of_b * b[i];
  return mean;
}

/// A body scaled to 0, to hide it, becomes a speck: a mesh needs an area, and a camera its directions.
Vec3d kept_open(Vec3d scale, std::span<const double> values) {
  constexpr double kSpeck = 1e-3;  // relative to the largest scale
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(scale[axis]) < kSpeck * largest) scale[axis] = std::copysign(kSpeck * largest, scale[axis]);
  return scale;
}

}  // namespace

GltfAnimation::GltfAnimation(const GltfModel& gltf, std::size_t index) : gltf_(gltf) {
  const GltfRecord animation = gltf.record("animations", index);
  const std::vector<GltfRecord> samplers = animation.records("samplers");
  for (const GltfRecord& channel : animation.records("channels")) add_channel(channel, samplers);
}

void GltfAnimation::add_channel(const GltfRecord& channel, std::span<const GltfRecord> samplers) {
  const GltfRecord target = channel.need("target").record("target");
  const std::string path = target.text("path");
  if (!target.has("node") || path == "pointer") return;  // belongs to an extension
  static const std::map<std::string, Path> kPaths{{"translation", Path::translation},
                                                  {"rotation", Path::rotation},
                                                  {"scale", Path::scale},
                                                  {"weights", Path::weights}};
  const auto found = kPaths.find(path);
  if (found == kPaths.end())
    target.fail("path", "is unknown", "translation, rotation, scale or weights", '"' + path + '"');
  Channel read{target.index("node"), found->second, Between::linear, {}, {}, 3};
  if (read.node >= gltf_.nodes.size())
    target.fail("node", "refers to nothing", "below " + std::to_string(gltf_.nodes.size()),
                std::to_string(read.node));
  const GltfNode& node = gltf_.nodes[read.node];
  if (read.path != Path::weights && node.placed && std::holds_alternative<Transform>(*node.placed))
    fail_at(gltf_.path, record_name("nodes", read.node), "has a matrix and cannot be animated",
            "translation, rotation and scale");
  if (read.path == Path::rotation) read.width = 4;
  if (read.path == Path::weights) {
    read.width = 0;
    if (node.mesh != kNoRecord)
      for (const GltfPrimitive& primitive : gltf_.meshes[node.mesh].primitives)
        read.width = std::max(read.width, primitive.targets.size());
    if (read.width == 0) return;  // the mesh has no targets
  }
  const std::uint32_t sampler = channel.need("sampler").index("sampler");
  if (sampler >= samplers.size())
    channel.fail("sampler", "refers to nothing", "below " + std::to_string(samplers.size()),
                 std::to_string(sampler));
  read_sampler(samplers[sampler], read);
  constexpr std::size_t kMostNumbers = 50'000'000;
  numbers_ += read.times.size() + read.values.size();
  if (numbers_ > kMostNumbers)
    channel.fail("sampler", "makes the animation too long", "at most 5e7 numbers", std::to_string(numbers_));
  duration_ = std::max(duration_, read.times.back());
  channels_.push_back(std::move(read));
}

void GltfAnimation::read_sampler(const GltfRecord& sampler, Channel& channel) const {
  const std::string between = sampler.text("interpolation", "LINEAR");
  if (between != "LINEAR" && between != "STEP" && between != "CUBICSPLINE")
    sampler.fail("interpolation", "is unknown", "LINEAR, STEP or CUBICSPLINE", '"' + between + '"');
  channel.between = between == "STEP"     ? Between::step
                    : between == "LINEAR" ? Between::linear
                                          : Between::spline;
  const auto accessor = [&](const char* key) {
    const std::uint32_t index = sampler.need(key).index(key);
    if (index >= gltf_.accessors.size())
      sampler.fail(key, "refers to nothing", "below " + std::to_string(gltf_.accessors.size()),
                   std::to_string(index));
    return index;
  };
  const std::uint32_t input = accessor("input"), output = accessor("output");
  channel.times = read_numbers(gltf_, input, 1);
  for (std::size_t i = 0; i < channel.times.size(); ++i)
    if (!std::isfinite(channel.times[i]) || (i > 0 && channel.times[i] < channel.times[i - 1]))
      fail_at(gltf_.path, record_name("accessors", input), "element " + std::to_string(i) + " is not a time",
              "finite seconds, in ascending order", std::to_string(channel.times[i]));
  channel.values = read_numbers(gltf_, output, channel.path == Path::weights ? 1 : channel.width);
  const std::size_t wanted =
      channel.times.size() * channel.width * (channel.between == Between::spline ? 3 : 1);
  if (channel.values.size() != wanted)
    fail_at(gltf_.path, record_name("accessors", output), "has the wrong number of values for its keys",
            std::to_string(wanted) + " numbers", std::to_string(channel.values.size()));
  for (const double value : channel.values)
    if (!std::isfinite(value))
      fail_at(gltf_.path, record_name("accessors", output), "has a value that is not finite");
}

std::vector<double> GltfAnimation::Channel::at(double seconds) const {
  const std::size_t stride = between == Between::spline ? 3 * width : width,
                    middle = between == Between::spline ? width : 0;
  const auto numbers = [&](std::size_t key, std::size_t offset) {
    return std::span(values).subspan(key * stride + offset, width);
  };
  const auto after = std::ranges::upper_bound(times, seconds);
  const std::size_t next = std::size_t(after - times.begin());
  if (next == 0 || next == times.size() || between == Between::step) {
    const auto value = numbers(next == 0 ? 0 : next - 1, middle);
    return {value.begin(), value.end()};
  }
  const double step = times[next] - times[next - 1], t = (seconds - times[next - 1]) / step;
  const auto a = numbers(next - 1, middle), b = numbers(next, middle);
  if (between == Between::linear && path == Path::rotation) return slerp(a, b, t);
  std::vector<double> mean(width);
  if (between == Between::linear) {
    for (std::size_t i = 0; i < width; ++i) mean[i] = (1 - t) * a[i] + t * b[i];
    return mean;
  }
  const auto out = numbers(next - 1, 2 * width), in = numbers(next, 0);  // Hermite, tangents by second
  for (std::size_t i = 0; i < width; ++i)
    mean[i] = (1 + 2 * t) * (1 - t) * (1 - t) * a[i] + t * (1 - t) * (1 - t) * step * out[i] +
              t * t * (3 - 2 * t) * b[i] - t * t * (1 - t) * step * in[i];
  return mean;
}

GltfState GltfAnimation::at(double seconds) const {
  GltfState state;
  std::map<std::uint32_t, GltfPlacement> moved;
  for (const Channel& channel : channels_) {
    const std::vector<double> value = channel.at(seconds);
    if (channel.path == Path::weights) {
      state.weights[channel.node] = value;
      continue;
    }
    const auto& own = gltf_.nodes[channel.node].placed;
    GltfPlacement& placement =
        moved.try_emplace(channel.node, own ? std::get<GltfPlacement>(*own) : GltfPlacement{}).first->second;
    if (channel.path == Path::translation) placement.translation = {value[0], value[1], value[2]};
    if (channel.path == Path::scale)
      placement.scale = kept_open({value[0], value[1], value[2]}, channel.values);
    if (channel.path == Path::rotation && dot(value, value) > 0)
      placement.rotation = {value[0], value[1], value[2], value[3]};
  }
  for (const auto& [node, placement] : moved) state.placed[node] = placement.to_parent();
  return state;
}

bool GltfAnimation::moves(std::uint32_t node) const {
  for (std::size_t steps = 0; node != kNoRecord && steps <= gltf_.nodes.size(); ++steps) {
    for (const Channel& channel : channels_)
      if (channel.node == node && channel.path != Path::weights) return true;
    node = gltf_.nodes[node].parent;
  }
  return false;
}

bool GltfAnimation::changes_weights(std::uint32_t node) const {
  return std::ranges::any_of(channels_, [&](const Channel& channel) {
    return channel.node == node && channel.path == Path::weights;
  });
}

std::shared_ptr<const GltfAnimation> load_animation(const std::shared_ptr<const GltfModel>& gltf,
                                                    std::size_t index) {
  static std::mutex mutex;
  static std::shared_ptr<const GltfModel> model;  // the animation refers to it
  static std::shared_ptr<const GltfAnimation> last;
  static std::size_t index_of_last = 0;
  const std::lock_guard lock(mutex);
  if (last == nullptr || model != gltf || index_of_last != index) {
    last = std::make_shared<const GltfAnimation>(*gltf, index);
    model = gltf;
    index_of_last = index;
  }
  return last;
}

std::string animation_name(const GltfModel& gltf, std::size_t index) {
  try {
    if (std::string name = gltf.record("animations", index).text("name"); !name.empty()) return name;
  } catch (const Error&) {  // not an object, or its name is no text
  }
  return std::to_string(index);
}

std::size_t find_animation(const GltfModel& gltf, const std::string& name) {
  const std::size_t count = gltf.count("animations");
  if (count == 0) throw bad_file(gltf.path, "has no animations", "no \"animation_time\"");
  if (name.empty()) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back(animation_name(gltf, i));
    if (names.back() == name || std::to_string(i) == name) return i;
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw bad_file(gltf.path, "has no such animation" + did_you_mean(name, known), join(known),
                 '"' + name + '"');
}

}  // namespace opaline
