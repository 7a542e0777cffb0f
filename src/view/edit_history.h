// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of undo.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace opaline {

/// Lists of edits, one current; at most 1000. Steps share the texts they have in common with the step before.
class EditHistory {
 public:
  using Edits = std::vector<std::string>;

  const Edits& edits() const { return edits_; }
  std::size_t place() const { return at_; }
  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < steps_.size(); }
  /// Edits of another step; go_to makes it the current one.
  Edits edits_at(std::size_t place) const;
  void go_to(std::size_t place);
  /// Adds a step after the current one; later ones are forgotten.
  void push(Edits edits);
  /// Replaces the current step.
  void replace(Edits edits);

 private:
  using Step = std::vector<std::shared_ptr<const std::string>>;
  Step step_of(const Edits& edits) const;

  std::vector<Step> steps_{Step{}};
  std::size_t at_ = 0;
  Edits edits_;  // texts of steps_[at_]
};

}  // namespace opaline
