// SPDX-License-Identifier: GPL-3.0-or-later
// One cache entry as a file: an HDF5 file for other tools, after a header with checksums and the positions of
// its data sets. This program copies the data sets directly, without HDF5's parser: HDF5 trusts its input,
// and anyone may write to a cache's folder.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "cache/blobs.h"
#include "cache/stage_key.h"

namespace opaline {

struct EntryName {
  std::string stage;
  StageKey key;
  friend bool operator==(const EntryName&, const EntryName&) = default;
};

/// "samples-0123456789abcdef0123456789abcdef.h5"
std::string file_name(const EntryName& name);
/// Empty for other names.
std::optional<EntryName> parse_file_name(const std::string& name);

struct NoEntry {};
/// Reason not to use an entry, as a predicate of its name: "is truncated".
struct BadEntry {
  std::string reason;
};

/// Checks the whole file before any use: the header has the name, the positions of the data sets, and the
/// length and the hash (XXH3, 128 bits) of the rest, and must match byte by byte. Marks the entry as most
/// recently used, if the folder is writable.
/// in    most_bytes: upper bound for results with this key; larger files are rejected unread
std::variant<BlobReader, NoEntry, BadEntry> open_entry(const std::string& folder, const EntryName& name,
                                                       std::uint64_t most_bytes);

/// open_entry's reason not to use the entry, from its own header; empty: usable. Memory is independent of the
/// file's size.
std::string check_entry(const std::string& folder, const EntryName& name);

/// Writes an entry to a temporary file and renames it. Returns false, writing nothing, above most_bytes.
/// error Error{run_failed} naming the file: disk full, folder not writable
bool write_entry(const std::string& folder, const EntryName& name, std::uint64_t most_bytes,
                 const std::function<void(BlobWriter&)>& fill);

}  // namespace opaline
