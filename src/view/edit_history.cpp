// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/edit_history.h"

#include <string_view>
#include <unordered_map>
#include <utility>

namespace opaline {
namespace {

constexpr std::size_t kMostSteps = 1000;

}  // namespace

EditHistory::Edits EditHistory::edits_at(std::size_t place) const {
  Edits edits;
  for (const std::shared_ptr<const std::string>& text : steps_[place]) edits.push_back(*text);
  return edits;
}

void EditHistory::go_to(std::size_t place) {
  edits_ = edits_at(place);
  at_ = place;
}

void EditHistory::push(Edits edits) {
  Step step = step_of(edits);
  steps_.resize(at_ + 1);
  steps_.push_back(std::move(step));
  if (steps_.size() > kMostSteps) steps_.erase(steps_.begin());
  at_ = steps_.size() - 1;
  edits_ = std::move(edits);
}

void EditHistory::replace(Edits edits) {
  steps_[at_] = step_of(edits);
  edits_ = std::move(edits);
}

EditHistory::Step EditHistory::step_of(const Edits& edits) const {
  std::unordered_map<std::string_view, std::shared_ptr<const std::string>> before;
  for (const std::shared_ptr<const std::string>& text : steps_[at_]) before.emplace(*text, text);
  Step step;
  step.reserve(edits.size());
  for (const std::string& text : edits) {
    const auto known = before.find(text);
    step.push_back(known != before.end() ? known->second : std::make_shared<const std::string>(text));
  }
  return step;
}

}  // namespace opaline
