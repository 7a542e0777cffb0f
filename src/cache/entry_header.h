// SPDX-License-Identifier: GPL-3.0-or-later
// The text in front of a cache entry, which HDF5 leaves alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cache/content_hash.h"
#include "cache/entry_file.h"
#include "cache/hdf5_file.h"

namespace opaline {

using EntryHeader = std::array<char, kUserBlock>;

/// One line a data set.
std::string listing_of(const std::vector<BlobPlace>& sets);

/// hash: of the listing and, behind it, the payload, which is all after the header
std::string header_text(const EntryName& name, const std::string& listing, std::uint64_t payload,
                        const StageKey& hash);
/// True if the header is this text and zeros after it.
bool is_header(const EntryHeader& header, const std::string& text);

/// Unchecked content of a header.
struct StatedEntry {
  std::string listing;
  std::uint64_t payload = 0;
};
/// Nothing for a header that this program would not have written for an entry of this name.
std::optional<StatedEntry> read_header(const EntryHeader& header, const EntryName& name);

/// The data sets of a listing; nothing if a line is no such line, or a set does not lie behind the header
/// within file_bytes.
std::optional<std::vector<BlobPlace>> read_listing(const std::string& listing, std::uint64_t file_bytes);

/// Reason not to use an entry, from its header; it follows the name: "is truncated".
std::string reason_of(const EntryHeader& header, std::uint64_t payload);

}  // namespace opaline
