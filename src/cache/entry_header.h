// SPDX-License-Identifier: GPL-3.0-or-later
// Text header of a cache entry, in HDF5's user block.
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

/// One line per data set.
std::string listing_of(const std::vector<BlobPlace>& sets);

/// hash: of the listing followed by the payload, everything after the header
std::string header_text(const EntryName& name, const std::string& listing, std::uint64_t payload,
                        const StageKey& hash);
/// True if the header is this text and zeros after it.
bool is_header(const EntryHeader& header, const std::string& text);

/// Unchecked content of a header.
struct StatedEntry {
  std::string listing;
  std::uint64_t payload = 0;
};
/// Empty for a header not written by this program for an entry of this name.
std::optional<StatedEntry> read_header(const EntryHeader& header, const EntryName& name);

/// Data sets of a listing; empty if a line is malformed, or a set is outside the payload of file_bytes.
std::optional<std::vector<BlobPlace>> read_listing(const std::string& listing, std::uint64_t file_bytes);

/// Reason not to use an entry, from its header, as a predicate of its name: "is truncated".
std::string reason_of(const EntryHeader& header, std::uint64_t payload);

}  // namespace opaline
