// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/shared_roughness.h"

#include <map>
#include <mutex>
#include <tuple>

namespace opaline {
namespace {

/// The table of a key, made once.
template <class Key, class Make>
auto shared_table(const Key& key, const Make& make) {
  constexpr std::size_t kMost = 64;
  static std::mutex mutex;
  static std::map<Key, decltype(make())> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  if (known.size() >= kMost) known.clear();
  return known[key] = make();
}

}  // namespace

std::shared_ptr<const RoughnessRange> shared_roughness(double eta, float anisotropy,
                                                       std::optional<float> roughness) {
  return shared_table(std::tuple(eta, anisotropy, roughness.value_or(-1)), [&] {
    return roughness ? std::make_shared<const RoughnessRange>(eta, anisotropy, *roughness)
                     : std::make_shared<const RoughnessRange>(eta, anisotropy);
  });
}

std::shared_ptr<const AnisotropyRange> shared_anisotropies(double eta) {
  return shared_table(eta, [&] { return std::make_shared<const AnisotropyRange>(eta); });
}

}  // namespace opaline
