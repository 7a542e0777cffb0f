// SPDX-License-Identifier: GPL-3.0-or-later
// A medium's radial profiles and random walks as arrays. opaline/__init__.py documents the result.
#include "python/profile_binding.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <numbers>

#include "benchmark/profile_request.h"
#include "opaline/enumerations.h"
#include "python/interruptible.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace opaline {
namespace {

using Numbers = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

/// in    value_of: of each element
template <class Elements, class ValueOf>
Numbers array_of(const Elements& elements, const ValueOf& value_of) {
  auto* const values = new std::vector<double>;
  const nb::capsule owner(values,
                          [](void* owned) noexcept { delete static_cast<std::vector<double>*>(owned); });
  for (const auto& element : elements) values->push_back(value_of(element));
  return Numbers(values->data(), {values->size()}, owner);
}

/// Ends of neighbouring intervals, one more than those.
template <class Intervals>
Numbers ends_of(const Intervals& intervals) {
  std::vector<double> ends;
  for (const auto& interval : intervals) {
    if (ends.empty()) ends.push_back(interval.low);
    ends.push_back(interval.high);
  }
  return array_of(ends, [](double end) { return end; });
}

void add_walked(nb::dict& owner, const char* name, const WalkedValue& walked) {
  owner[name] = walked.value;
  owner[(name + std::string("_error")).c_str()] = walked.error;
}

template <class Elements, class Member>
void add_walked(nb::dict& owner, const char* name, const Elements& elements, const Member& member) {
  owner[name] = array_of(elements, [&](const auto& element) { return (element.*member).value; });
  owner[(name + std::string("_error")).c_str()] =
      array_of(elements, [&](const auto& element) { return (element.*member).error; });
}

nb::dict walks_dict(const WalkedFace& face) {
  nb::dict walks;
  add_walked(walks, "share", face.total);
  add_walked(walks, "uncollided", face.uncollided);
  add_walked(walks, "profile", face.rings, &WalkedRing::profile);
  add_walked(walks, "within", face.rings, &WalkedRing::within);
  walks["cosine"] = ends_of(face.angular_exit);
  add_walked(walks, "angular_exit", face.angular_exit, &WalkedCosine::value);
  return walks;
}

nb::dict model_dict(const ModelFace& model, const WalkedFace& walked, bool has_walks) {
  const auto mean = [&](const WalkedRing& ring) {
    const double area = std::numbers::pi * (ring.high - ring.low) * (ring.high + ring.low);
    return (model.within(ring.high) - model.within(ring.low)) / area;
  };
  nb::dict values;
  values["share"] = model.total();
  if (has_walks) values["shape_difference"] = shape_difference(model, walked);
  values["profile"] = array_of(walked.rings, mean);
  values["within"] = array_of(walked.rings, [&](const WalkedRing& ring) { return model.within(ring.high); });
  return values;
}

nb::dict face_dict(const ProfileRequest& request, const ProfiledChannel& channel, WalkedFace SlabWalks::*face,
                   double height) {
  const WalkedFace& diffuse = channel.diffuse.*face;
  const bool has_walks = channel.diffuse.walks > 0;
  nb::dict values, models;
  values["r"] = ends_of(diffuse.rings);
  if (has_walks) {
    values["walks_diffuse"] = walks_dict(diffuse);
    values["walks_normal"] = walks_dict(channel.normal.*face);
  }
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind)
    if (has_kind(request, kind))
      models[nb::str(kProfileNames[kind].data(), kProfileNames[kind].size())] =
          model_dict({&channel.models[kind], height}, diffuse, has_walks);
  values["models"] = models;
  if (height == 0 && channel.layered_diffusion) values["layers_normal"] = *channel.layered_diffusion;
  return values;
}

nb::dict report_dict(const ProfileReport& report) {
  nb::dict channels;
  for (const ProfiledChannel& channel : report.channels) {
    nb::dict values;
    values["back"] = face_dict(report.request, channel, &SlabWalks::back, 0);
    if (report.is_slab())
      values["through"] = face_dict(report.request, channel, &SlabWalks::through, report.request.thickness);
    values["walks"] = channel.diffuse.walks;
    if (channel.diffuse.walks > 0) {
      add_walked(values, "unfinished", channel.diffuse.unfinished);
      values["cosine"] = ends_of(channel.diffuse.albedo_by_entry);
      add_walked(values, "albedo_by_entry", channel.diffuse.albedo_by_entry, &WalkedCosine::value);
    }
    channels[channel.name.c_str()] = values;
  }
  nb::dict result;
  result["medium"] = report.request.name;
  result["eta"] = report.request.eta;
  result["g"] = report.request.g;
  result["thickness"] = report.request.thickness;
  result["channels"] = channels;
  return result;
}

nb::dict profile(const std::string& medium, const std::string& scene,
                 const std::optional<std::string>& scene_text, std::optional<double> thickness,
                 std::optional<double> eta, std::optional<double> g, std::optional<std::uint64_t> walks,
                 std::uint64_t seed, const std::vector<std::string>& profiles) {
  constexpr std::uint64_t kMostWalks = 1'000'000'000;
  if (walks > kMostWalks) throw nb::value_error("walks: 0 to 1,000,000,000");
  const GivenProfile given{medium, scene, scene_text, eta, g, thickness, walks, seed, profiles, ""};
  return report_dict(
      interruptible([&](Monitor& monitor) { return measure_profiles(profile_request(given), monitor); }));
}

}  // namespace

void add_profile(nb::module_& module) {
  module.def("profile", &profile, "medium"_a, "scene"_a, "scene_text"_a.none(), "thickness"_a.none(),
             "eta"_a.none(), "g"_a.none(), "walks"_a.none(), "seed"_a, "profiles"_a);
}

}  // namespace opaline
