// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/stage_key.h"

#include <fmt/format.h>

#include "cache/content_hash.h"

namespace opaline {

struct KeyBuilder::State {
  ContentHash hash;
};

std::string hex(const StageKey& key) {
  return fmt::format("{:016x}{:016x}", key.high, key.low);
}

KeyBuilder::KeyBuilder(std::string_view stage, std::uint64_t version) : state_(std::make_unique<State>()) {
  add_bytes(stage.data(), stage.size());
  add(version);
}

KeyBuilder::~KeyBuilder() = default;

StageKey KeyBuilder::key() const {
  return state_->hash.value();
}

KeyBuilder& KeyBuilder::add_bytes(const void* bytes, std::size_t size) {
  const std::uint64_t length = size;
  state_->hash.add(&length, sizeof length);
  state_->hash.add(bytes, size);
  return *this;
}

}  // namespace opaline
