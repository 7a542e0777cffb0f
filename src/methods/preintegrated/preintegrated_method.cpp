// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/preintegrated/preintegrated_method.h"

#include <map>
#include <mutex>

#include "methods/preintegrated/preintegrated_field.h"

namespace opaline {
namespace {

constexpr std::uint64_t kVersion = 2;

StageKey response_key(const Medium& medium, const World& world) {
  KeyBuilder key("response of balls", kVersion);
  add_profile(key, medium);  // a colour and radius are another medium under another profile
  return key.add(world.diagonal).add(world.unit).key();
}

/// One for all bodies of a medium.
std::shared_ptr<const MediumResponse> response_of(const StageKey& key, const Medium& medium,
                                                  const World& world) {
  static std::mutex mutex;
  static std::map<StageKey, std::weak_ptr<const MediumResponse>> all;
  {
    const std::scoped_lock lock(mutex);
    if (const auto kept = all.find(key); kept != all.end())
      if (auto response = kept->second.lock()) return response;
  }
  auto response = std::make_shared<const MediumResponse>(make_response(medium, world));
  const std::scoped_lock lock(mutex);
  std::erase_if(all, [](const auto& one) { return one.second.expired(); });
  all[key] = response;
  return response;
}

}  // namespace

void PreintegratedMethod::prepare(BodyStages& stages) const {
  const World& world = stages.input.world;
  const BodyPlan& body = stages.body.plan;
  auto& state = state_of<PreintegratedState>(stages.body);
  const Medium& medium = stages.input.scene.media[body.medium];
  const StageKey key = response_key(medium, world);
  stages.store.get(state.response, key, [&] { return response_of(key, medium, world); });
  const float width = state.response.value->width;
  KeyBuilder surfaces("smooth surfaces", kVersion);
  surfaces.add(width);
  for (const std::uint32_t mesh : body.meshes) surfaces.add(stages.mesh_keys[mesh].all);
  const ResultSource source = stages.store.get(state.surfaces, surfaces.key(), [&] {
    std::vector<SmoothSurface> smooth;
    for (const std::uint32_t mesh : body.meshes) smooth.push_back(smoothed(world.meshes[mesh], width));
    return smooth;
  });
  stages.note("curvature", source, "computed");
}

StageKey PreintegratedMethod::direct_key(const Body& body) const {
  return state_of<PreintegratedState>(body).response.key;
}

std::unique_ptr<Field> PreintegratedMethod::field(const RenderInput& input, const Body& body) const {
  return std::make_unique<PreintegratedField>(input, body);
}

}  // namespace opaline
