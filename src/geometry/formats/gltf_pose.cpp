// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/formats/gltf_pose.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "asset_files/gltf_accessor.h"

namespace opaline {
namespace {

Vec3d linear(const Transform& t, const Vec3d& v) {
  return t.x * v.x + t.y * v.y + t.z * v.z;
}

Transform& add(Transform& sum, const Transform& t, double weight) {
  sum.x += t.x * weight;
  sum.y += t.y * weight;
  sum.z += t.z * weight;
  sum.translation += t.translation * weight;
  return sum;
}

// ---- morph targets ----------------------------------------------------------------------------------------

/// The node's weights, or the mesh's; none: all are 0.
const std::vector<double>& morph_weights(const GltfModel& gltf, std::size_t node, const GltfState* state) {
  if (state != nullptr)
    if (const auto moved = state->weights.find(std::uint32_t(node)); moved != state->weights.end())
      return moved->second;
  const auto own = gltf.node_weights.find(node);
  return own != gltf.node_weights.end() ? own->second : gltf.meshes[gltf.nodes[node].mesh].weights;
}

/// The vectors of a target's attribute; empty: it has none.
std::vector<Vec3d> target_vectors(const GltfModel& gltf, const GltfAttributes& target, const char* name,
                                  std::size_t vertices) {
  const auto found = target.find(name);
  if (found == target.end()) return {};
  std::vector<Vec3d> vectors = read_vectors(gltf, found->second);
  if (vectors.size() != vertices)
    fail_at(gltf.path, record_name("accessors", found->second),
            std::string("has the wrong number of vectors for the morph target ") + name,
            std::to_string(vertices) + ", the number of positions", std::to_string(vectors.size()));
  return vectors;
}

void morph(const GltfModel& gltf, const std::vector<double>& weights, const GltfPrimitive& primitive,
           const std::string& place, GltfPart& part) {
  if (weights.size() != primitive.targets.size())
    fail_at(gltf.path, place, "does not have as many morph targets as weights",
            std::to_string(weights.size()), std::to_string(primitive.targets.size()));
  for (std::size_t t = 0; t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    const auto moved = [&](const char* name) {
      return target_vectors(gltf, primitive.targets[t], name, part.positions.size());
    };
    const std::vector<Vec3d> positions = moved("POSITION"), normals = moved("NORMAL"),
                             tangents = moved("TANGENT");
    for (std::size_t i = 0; i < positions.size(); ++i) part.positions[i] += positions[i] * weights[t];
    for (std::size_t i = 0; i < std::min(normals.size(), part.normals.size()); ++i)
      part.normals[i] += Vec3f(normals[i] * weights[t]);
    for (std::size_t i = 0; i < std::min(tangents.size(), part.tangents.size()); ++i)
      part.tangents[i].direction += Vec3f(tangents[i] * weights[t]);
  }
}

// ---- skins ------------------------------------------------------------------------------------------------

/// From the mesh's space at bind time to the scene's, by joint.
std::vector<Transform> joint_matrices(const GltfModel& gltf, std::size_t skin_index, const GltfState* state) {
  const GltfRecord skin = gltf.record("skins", skin_index);
  const std::vector<std::uint32_t> joints = skin.indices("joints");
  const std::uint32_t bind = skin.index("inverseBindMatrices");
  if (joints.empty()) skin.fail("joints", "is empty", "the nodes that move the mesh");
  if (bind != kNoRecord && bind >= gltf.accessors.size())
    skin.fail("inverseBindMatrices", "refers to nothing", "one of the accessors", std::to_string(bind));
  std::vector<Transform> inverse(joints.size());
  if (bind != kNoRecord) inverse = read_matrices(gltf, bind);
  if (inverse.size() < joints.size())
    fail_at(gltf.path, record_name("accessors", bind), "has fewer matrices than the skin has joints",
            std::to_string(joints.size()), std::to_string(inverse.size()));
  std::vector<Transform> matrices;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j] >= gltf.nodes.size())
      skin.fail("joints", "refers to nothing", "below " + std::to_string(gltf.nodes.size()),
                std::to_string(joints[j]));
    matrices.push_back(compose(node_to_world(gltf, joints[j], state), inverse[j]));
  }
  return matrices;
}

/// Sums the joints' matrices at each vertex, one set of four joints after the other.
class SkinBlend {
 public:
  SkinBlend(const GltfModel& gltf, std::vector<Transform> joints, std::size_t vertices)
      : gltf_(gltf),
        joints_(std::move(joints)),
        blended_(vertices, kZero),
        sums_(vertices),
        first_(vertices) {}

  void add_set(std::uint32_t joints, std::uint32_t weights) {
    check_unsigned(gltf_, joints);
    check_weights(weights);
    const std::vector<std::array<double, 4>> indices = read(joints), shares = read(weights);
    for (std::size_t i = 0; i < indices.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        if (!(indices[i][k] < double(joints_.size())))
          fail_at(gltf_.path, record_name("accessors", joints),
                  "element " + std::to_string(i) + " names no joint",
                  "below " + std::to_string(joints_.size()), std::to_string(std::size_t(indices[i][k])));
        if (!(shares[i][k] >= 0 && std::isfinite(shares[i][k])))
          fail_at(gltf_.path, record_name("accessors", weights),
                  "element " + std::to_string(i) + " is not a weight", "0 or more",
                  std::to_string(shares[i][k]));
        add(blended_[i], joints_[std::size_t(indices[i][k])], shares[i][k]);
        sums_[i] += shares[i][k];
      }
    if (!has_first_)
      for (std::size_t i = 0; i < indices.size(); ++i) first_[i] = std::size_t(indices[i][0]);
    has_first_ = true;
  }

  /// Weighted mean at each vertex; one without weights follows its first joint.
  /// out   uneven: number of vertices with weights not adding up to 1
  std::vector<Transform> run(std::size_t& uneven) {
    constexpr double kRounding = .01;  // rounding of weights in bytes
    for (std::size_t i = 0; i < blended_.size(); ++i) {
      if (std::abs(sums_[i] - 1) > kRounding) ++uneven;
      Transform mean = kZero;
      blended_[i] = sums_[i] > 0 ? add(mean, blended_[i], 1 / sums_[i]) : joints_[first_[i]];
    }
    return std::move(blended_);
  }

 private:
  static constexpr Transform kZero{{}, {}, {}, {}};

  void check_weights(std::uint32_t index) const {
    const GltfAccessor& accessor = gltf_.accessors[index];
    constexpr std::size_t kFloats = 5126;
    if (accessor.component != kFloats && !accessor.is_normalized)
      fail_at(gltf_.path, record_name("accessors", index), "cannot hold weights",
              "floats or normalized integers", "a componentType of " + std::to_string(accessor.component));
  }

  std::vector<std::array<double, 4>> read(std::uint32_t index) const {
    std::vector<std::array<double, 4>> all = read_quadruples(gltf_, index);
    if (all.size() != blended_.size())
      fail_at(gltf_.path, record_name("accessors", index), "has the wrong number of vertices for the skin",
              std::to_string(blended_.size()) + ", the number of positions", std::to_string(all.size()));
    return all;
  }

  const GltfModel& gltf_;
  std::vector<Transform> joints_, blended_;
  std::vector<double> sums_;
  std::vector<std::size_t> first_;
  bool has_first_ = false;
};

std::vector<Transform> blended_joints(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive,
                                      const GltfState* state, const std::string& place, GltfPart& part) {
  SkinBlend blend(gltf, joint_matrices(gltf, gltf.nodes[node].skin, state), part.positions.size());
  for (std::size_t set = 0;; ++set) {
    const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set)),
               weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
    blend.add_set(joints->second, weights->second);
  }
  std::size_t uneven = 0;
  std::vector<Transform> blended = blend.run(uneven);
  if (uneven > 0)
    part.warnings.push_back(gltf.path + ": " + place + ": the joints' weights of " + std::to_string(uneven) +
                            " vertices do not sum to 1 and are normalized");
  return blended;
}

/// Transforms normals by the inverse transpose. Returns true if most vertices are mirrored.
bool skin(const std::vector<Transform>& blended, GltfPart& part) {
  std::size_t mirrored = 0;
  for (std::size_t i = 0; i < blended.size(); ++i) {
    const Transform& t = blended[i];
    const Transform cofactors{cross(t.y, t.z), cross(t.z, t.x), cross(t.x, t.y), {}};
    const bool is_mirrored = dot(t.x, cofactors.x) < 0;
    mirrored += is_mirrored ? 1 : 0;
    part.positions[i] = transform_point(t, part.positions[i]);
    if (!part.normals.empty()) {
      const Vec3d normal = normalized(linear(cofactors, Vec3d(part.normals[i])));
      part.normals[i] = is_finite(normal) ? Vec3f(is_mirrored ? -normal : normal) : Vec3f();
    }
    if (!part.tangents.empty()) {
      Tangent& tangent = part.tangents[i];
      const Vec3d direction = normalized(linear(t, Vec3d(tangent.direction)));
      tangent.direction = is_finite(direction) ? Vec3f(direction) : Vec3f();
      if (is_mirrored) tangent.side = -tangent.side;
    }
  }
  return 2 * mirrored > blended.size();
}

}  // namespace

bool is_skinned(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive) {
  return gltf.nodes[node].skin != kNoRecord && primitive.attributes.contains("JOINTS_0") &&
         primitive.attributes.contains("WEIGHTS_0");
}

bool is_posed(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive) {
  return is_skinned(gltf, node, primitive) ||
         (!primitive.targets.empty() &&
          std::ranges::any_of(morph_weights(gltf, node, nullptr), [](double w) { return w != 0; }));
}

bool pose(const GltfModel& gltf, std::size_t node, const std::optional<Transform>& instance,
          const GltfPrimitive& primitive, const GltfState* state, const std::string& place, GltfPart& part) {
  const std::vector<double>& weights = morph_weights(gltf, node, state);
  if (!primitive.targets.empty() && !weights.empty()) morph(gltf, weights, primitive, place, part);
  if (is_skinned(gltf, node, primitive))
    return skin(blended_joints(gltf, node, primitive, state, place, part), part);
  if (state == nullptr && !instance) return false;
  Transform placed = instance.value_or(Transform{});
  if (state != nullptr) placed = compose(node_to_world(gltf, node, state), placed);
  return skin(std::vector<Transform>(part.positions.size(), placed), part);
}

}  // namespace opaline
