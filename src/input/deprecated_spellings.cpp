// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/deprecated_spellings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "opaline/error.h"
#include "scene/source_place.h"

namespace opaline {
namespace {

struct OldSpelling {
  std::string_view old, now;
};

// Old values of "profile", now "normalized_diffusion" with this "fit".
constexpr OldSpelling kFits[] = {{"normalized_diffusion_searchlight", "searchlight"},
                                 {"normalized_diffusion_dmfp", "dmfp"},
                                 {"normalized_diffusion_refit", "refit"}};

Node* member_of(Node& object, std::string_view key) {
  return const_cast<Node*>(find_member(object, key));
}

void warn(Document& document, const Node& node, const std::string& old, const std::string& now) {
  document.warnings.push_back(text_at(place_at(document, node.key_offset, node.override_index),
                                      fmt::format("'{}' is deprecated; use '{}'", old, now)));
}

void erase(Node& object, const Node* member) {
  object.children.erase(object.children.begin() + (member - object.children.data()));
}

void replace_eta(Document& document, Node& medium, const std::string& path) {
  Node* eta = member_of(medium, "eta");
  if (eta == nullptr) return;
  warn(document, *eta, path + "eta", path + "specular_ior");
  const Node* present = member_of(medium, "specular_ior");
  if (present != nullptr && present->override_index == eta->override_index)
    throw error_at(document, eta->key_offset, eta->override_index,
                   "'eta' and 'specular_ior' have the same meaning", "one of the two");
  eta->key = "specular_ior";
  if (present != nullptr) erase(medium, present);
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

}  // namespace

void replace_deprecated_spellings(Document& document, Node& medium, const std::string& path) {
  replace_eta(document, medium, path);
  replace_profile(document, medium, path);
}

void replace_deprecated_spellings(Document& document) {
  if (Node* media = member_of(document.root, "media"))
    for (Node& medium : media->children)
      replace_deprecated_spellings(document, medium, "media." + printable(medium.key) + '.');
}

}  // namespace opaline
