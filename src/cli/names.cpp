// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/names.h"

namespace opaline {

const char* name_of(Method method) {
  return method == Method::lambert ? "lambert" : method == Method::direct ? "direct" : "hierarchical";
}

const char* name_of(EvaluatorKind evaluator) {
  switch (evaluator) {
    case EvaluatorKind::automatic:
      return "automatic";
    case EvaluatorKind::dual_tree:
      return "dual_tree";
    case EvaluatorKind::surface_cache:
      return "surface_cache";
    case EvaluatorKind::classic:
      return "classic";
    case EvaluatorKind::brute_force:
      return "brute_force";
  }
  return "";
}

const char* name_of(EntryStrategy strategy) {
  return strategy == EntryStrategy::chords ? "chords" : "disc_axes";
}

const char* name_of(PixelFilter filter) {
  return filter == PixelFilter::gaussian ? "gaussian" : "box";
}

const char* name_of(const LightSource& source) {
  struct Names {
    const char* operator()(const PointLight&) const { return "point"; }
    const char* operator()(const DirectionalLight&) const { return "directional"; }
    const char* operator()(const SphereLight&) const { return "sphere"; }
    const char* operator()(const QuadLight&) const { return "quad"; }
    const char* operator()(const Surroundings&) const { return "surroundings"; }
  };
  return std::visit(Names{}, source);
}

}  // namespace opaline
