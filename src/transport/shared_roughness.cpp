// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/shared_roughness.h"

#include <map>
#include <mutex>
#include <tuple>

namespace opaline {

std::shared_ptr<const RoughnessRange> shared_roughness(double eta, float anisotropy,
                                                       std::optional<float> roughness) {
  using Key = std::tuple<double, float, float>;
  constexpr std::size_t kMost = 64;
  static std::mutex mutex;
  static std::map<Key, std::shared_ptr<const RoughnessRange>> known;
  const std::lock_guard lock(mutex);
  const Key key{eta, anisotropy, roughness.value_or(-1)};
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  if (known.size() >= kMost) known.clear();
  return known[key] = roughness ? std::make_shared<const RoughnessRange>(eta, anisotropy, *roughness)
                                : std::make_shared<const RoughnessRange>(eta, anisotropy);
}

}  // namespace opaline
