// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/entry_header.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>

namespace opaline {
namespace {

// Raised on changes of the header, of the members of a struct in an entry, or of the form of keys. Stages have
// versions of their own, in their keys.
constexpr int kFormat = 4;
constexpr std::string_view kMagic = "opaline cache entry, format ";
constexpr std::string_view kPayload = "payload ";

std::string first_lines(const EntryName& name) {
  return fmt::format("{}{}\nstage {}\nkey {}\n", kMagic, kFormat, name.stage, hex(name.key));
}

std::string text_of(const EntryHeader& header) {
  return {header.data(), strnlen(header.data(), header.size())};
}

/// Reads an integer and the text expected after it; false if either is missing.
bool take_number(std::string_view& text, std::string_view behind, std::uint64_t& value) {
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{}) return false;
  text.remove_prefix(std::size_t(rest - text.data()));
  if (!text.starts_with(behind)) return false;
  text.remove_prefix(behind.size());
  return true;
}

bool is_within(const BlobPlace& set, std::uint64_t file_bytes) {
  if (set.count == 0) return set.item_bytes > 0;
  return set.item_bytes > 0 && set.offset >= kUserBlock && set.offset <= file_bytes &&
         set.count <= (file_bytes - set.offset) / set.item_bytes;
}

}  // namespace

std::string listing_of(const std::vector<BlobPlace>& sets) {
  std::string listing;
  for (const BlobPlace& set : sets)
    listing += fmt::format("{} {} x {} at {}\n", set.name, set.count, set.item_bytes, set.offset);
  return listing;
}

std::string header_text(const EntryName& name, const std::string& listing, std::uint64_t payload,
                        const StageKey& hash) {
  return fmt::format("{}{}{}{} bytes, xxh3-128 {}\n", first_lines(name), listing, kPayload, payload,
                     hex(hash));
}

bool is_header(const EntryHeader& header, const std::string& text) {
  const std::string_view bytes(header.data(), header.size());
  return bytes.starts_with(text) && bytes.find_first_not_of('\0', text.size()) == bytes.npos;
}

std::optional<StatedEntry> read_header(const EntryHeader& header, const EntryName& name) {
  const std::string text = text_of(header), first = first_lines(name);
  if (!text.starts_with(first)) return {};
  const std::size_t end = text.find('\n' + std::string(kPayload), first.size() - 1);
  if (end == text.npos) return {};
  StatedEntry stated{text.substr(first.size(), end + 1 - first.size()), 0};
  std::string_view rest = std::string_view(text).substr(end + 1 + kPayload.size());
  if (!take_number(rest, " bytes, ", stated.payload)) return {};
  return stated;
}

std::optional<std::vector<BlobPlace>> read_listing(const std::string& listing, std::uint64_t file_bytes) {
  std::vector<BlobPlace> sets;
  for (std::string_view text = listing; !text.empty();) {
    const std::size_t space = text.find(' ');
    if (space == text.npos) return {};
    std::uint64_t count = 0, item_bytes = 0, offset = 0;
    const std::string name(text.substr(0, space));
    text.remove_prefix(space + 1);
    if (!take_number(text, " x ", count) || !take_number(text, " at ", item_bytes) ||
        !take_number(text, "\n", offset))
      return {};
    sets.push_back({name, count, item_bytes, offset});
    if (!is_within(sets.back(), file_bytes)) return {};
  }
  return sets;
}

std::string reason_of(const EntryHeader& header, std::uint64_t payload) {
  const std::string text = text_of(header);
  if (!text.starts_with(kMagic)) return "is not a cache entry";
  if (!text.starts_with(fmt::format("{}{}\n", kMagic, kFormat)))
    return fmt::format("does not have this program's version {}", kFormat);
  const std::size_t at = text.find('\n' + std::string(kPayload));
  std::uint64_t stated = 0;
  if (at != text.npos)
    std::from_chars(text.data() + at + 1 + kPayload.size(), text.data() + text.size(), stated);
  return payload < stated ? "is truncated" : "is damaged";
}

}  // namespace opaline
