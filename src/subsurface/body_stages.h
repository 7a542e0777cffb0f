// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs and services for the preparation of one body.
#pragma once

#include <memory>
#include <span>

#include "bodies/body.h"
#include "stages/body_keys.h"
#include "stages/stage_keys.h"
#include "stages/stage_store.h"

namespace opaline {

struct BodyStages {
  const PrecomputeInput& input;
  std::span<const Light> lights;  ///< recentred
  std::span<const MeshKeys> mesh_keys;
  Body& body;
  const BodyKeys& keys;
  StageStore& store;
  const WalkStore& walks;
  bool expects_edits;
  std::size_t most_cache_places;  ///< limit of the body's surface cache; known at `finish`

  /// Key of the light transmitted at the samples from all lights.
  StageKey transmitted_key() const {
    return opaline::transmitted_key(keys.samples_key, keys.light_keys, lights, keys.tint_key);
  }
  void note(const std::string& text) { store.note(body.plan.name, text); }
  void note(const std::string& result, ResultSource source, const char* computed) {
    store.note(body.plan.name, result, source, computed);
  }
};

/// State of a method, created if there is none.
template <class State>
State& state_of(Body& body) {
  std::unique_ptr<MethodState>& state = body.states[State::kMethod];
  if (state == nullptr) state = std::make_unique<State>();
  return static_cast<State&>(*state);
}
/// in    body: prepared by the method
template <class State>
const State& state_of(const Body& body) {
  return static_cast<const State&>(*body.states.at(State::kMethod));
}

}  // namespace opaline
