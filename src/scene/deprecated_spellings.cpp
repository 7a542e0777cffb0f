// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/deprecated_spellings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "opaline/core/error.h"

namespace opaline {
namespace {

struct OldSpelling {
  std::string_view old, now;
};

// Keys of "settings" that are now those of "settings.laboratory".
constexpr std::string_view kOfLaboratory[] = {"instruction_set", "max_solid_angle", "near_field",
                                              "near_irradiance", "entry_strategy"};
// Values of "profile" that are now "normalized_diffusion" and this "fit".
constexpr OldSpelling kFits[] = {{"normalized_diffusion_searchlight", "searchlight"},
                                 {"normalized_diffusion_dmfp", "dmfp"},
                                 {"normalized_diffusion_refit", "refit"}};

Node* member_of(Node& object, std::string_view key) {
  return const_cast<Node*>(find_member(object, key));
}

void warn(Document& document, const Node& node, const std::string& old, const std::string& now) {
  document.warnings.push_back(text_at(place_at(document, node.key_offset, node.override_index),
                                      fmt::format("'{}' is an old spelling of '{}'", old, now)));
}

void erase(Node& object, const Node* member) {
  object.children.erase(object.children.begin() + (member - object.children.data()));
}

/// Whether the value of an old spelling replaces that of the key of today: it comes from a later override.
bool is_later(const Document& document, const Node& old, const Node& present) {
  if (old.override_index == present.override_index)
    throw error_at(document, old.key_offset, old.override_index,
                   fmt::format("'{}' and '{}' are the same", old.key, present.key), "one of the two");
  return old.override_index > present.override_index;
}

void replace_profile(Document& document, Node& medium, const std::string& path) {
  Node* profile = member_of(medium, "profile");
  if (profile == nullptr || profile->kind != Node::Kind::string) return;
  const auto old = std::ranges::find(kFits, profile->text, &OldSpelling::old);
  if (old == std::end(kFits)) return;
  warn(document, *profile, fmt::format("{}profile={}", path, old->old),
       fmt::format("{0}profile=normalized_diffusion, {0}fit={1}", path, old->now));
  profile->text = "normalized_diffusion";
  Node fit = *profile;
  fit.key = "fit";
  fit.text = old->now;
  fit.end_offset = 0;
  if (Node* present = member_of(medium, "fit")) erase(medium, present);
  medium.children.push_back(std::move(fit));
}

void move_to_laboratory(Document& document, Node& settings, std::string_view key) {
  const Node* old = member_of(settings, key);
  if (old == nullptr) return;
  warn(document, *old, fmt::format("settings.{}", key), fmt::format("settings.laboratory.{}", key));
  Node moved = *old;
  erase(settings, old);
  if (member_of(settings, "laboratory") == nullptr) {
    Node& made = settings.children.emplace_back();
    made.kind = Node::Kind::object;
    made.key = "laboratory";
    made.override_index = moved.override_index;
    made.offset = made.key_offset = moved.key_offset;
  }
  Node& laboratory = *member_of(settings, "laboratory");
  laboratory.end_offset = moved.end_offset = 0;
  Node* present = member_of(laboratory, key);
  if (present == nullptr)
    laboratory.children.push_back(std::move(moved));
  else if (is_later(document, moved, *present))
    *present = std::move(moved);
}

}  // namespace

void replace_deprecated_spellings(Document& document, Node& medium, const std::string& path) {
  if (Node* eta = member_of(medium, "eta")) {
    warn(document, *eta, path + "eta", path + "specular_ior");
    Node* present = member_of(medium, "specular_ior");
    if (present == nullptr || is_later(document, *eta, *present)) {
      eta->key = "specular_ior";
      if (present != nullptr) erase(medium, present);
    } else {
      erase(medium, eta);
    }
  }
  replace_profile(document, medium, path);
}

void replace_deprecated_spellings(Document& document) {
  if (Node* media = member_of(document.root, "media"))
    for (Node& medium : media->children)
      replace_deprecated_spellings(document, medium, "media." + printable(medium.key) + '.');
  if (Node* settings = member_of(document.root, "settings"))
    for (const std::string_view key : kOfLaboratory) move_to_laboratory(document, *settings, key);
}

}  // namespace opaline
