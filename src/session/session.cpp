// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session.h"

#include <string>
#include <utility>

#include "session/session_state.h"

namespace opaline {

Session::Session(StageCache* cache) : state_(std::make_unique<State>(cache)) {}
Session::~Session() = default;

void Session::anchor(Scene scene, Monitor* monitor) {
  state_->anchor(std::move(scene), monitor);
}
void Session::edit(Scene scene) {
  state_->edit(std::move(scene));
}
void Session::expect_pictures(std::size_t pictures) {
  state_->pictures_ = pictures;
}
void Session::hold_view(bool hold) {
  state_->holds_view_ = hold;
}
void Session::match_new_session(bool matches) {
  state_->matches_new_ = matches;
}
void Session::repeat_adaptive_rays(bool repeats) {
  state_->repeats_rays_ = repeats;
}
void Session::keep_wavelengths(bool keeps) {
  state_->keeps_wavelengths_ = keeps;
}

void Session::expect_edits(bool edits) {
  state_->edits_ = edits;
}
void Session::store_walks(WalkStore store) {
  state_->walk_store_ = std::move(store);
}
void Session::prepare_rays() {
  state_->prepare_rays();
}
Image Session::first_light(Monitor* monitor) {
  return state_->first_light(monitor);
}
void Session::prepare(Monitor* monitor) {
  state_->prepare(monitor);
}

std::vector<RgbF> Session::radiant_exitance(std::size_t body, std::span<const Vec3d> points,
                                            std::span<const Vec3f> normals) {
  prepare();
  const std::size_t count = bodies().size();
  if (body >= count)
    throw bad_file({}, "no such body", "an index below " + std::to_string(count), std::to_string(body));
  require(points.size() == normals.size(), "every point has a normal");
  return opaline::radiant_exitance(bodies()[body], world(), points, normals, scene().settings);
}

const Scene& Session::scene() const {
  return state_->scene_;
}
const World& Session::world() const {
  return *state_->world_;
}
const Plan& Session::plan() const {
  return state_->plan_;
}
const RayScene& Session::rays() const {
  return *state_->rays_;
}
std::shared_ptr<const BouncedPlaces> Session::bounced_places() const {
  return state_->bounced_;
}

std::span<const Body> Session::bodies() const {
  return state_->bodies();
}
std::span<const std::uint16_t> Session::adaptive_rays() const {
  return state_->adaptive_rays_;
}
const SessionWork& Session::work() const {
  return state_->work_;
}
const std::vector<std::string>& Session::decisions() const {
  return state_->decisions_;
}
const std::vector<StageCost>& Session::costs() const {
  return state_->costs_;
}

}  // namespace opaline
