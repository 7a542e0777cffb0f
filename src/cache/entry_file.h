// SPDX-License-Identifier: GPL-3.0-or-later
// One cache entry as a file: an HDF5 file, for other tools, behind a header that tells whether every byte is
// as it was written, and where its data sets lie. This program copies them from there and has HDF5 parse
// nothing: HDF5 trusts what it finds in a file, and what stands in a cache's folder may have been put there
// by anyone.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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
/// Nothing for names that no entry has.
std::optional<EntryName> parse_file_name(const std::string& name);

struct NoEntry {};
/// Why an entry must not be used, to follow its name: "is truncated".
struct BadEntry {
  std::string reason;
};

/// Checks the whole file before anyone looks into it: the header holds the name, where the data sets lie, and
/// the length and the hash (XXH3, 128 bits) of the rest, and must match byte by byte. Makes the entry the
/// most recently used, where the folder may be written.
/// in    most_bytes: a larger file is bad and not read;
/// what the key stands for cannot have more
std::variant<BlobReader, NoEntry, BadEntry> open_entry(const std::string& folder, const EntryName& name,
                                                       std::uint64_t most_bytes);

/// Why open_entry would not take the entry, by its own; empty if it would. Takes no memory of the file's
/// size.
std::string check_entry(const std::string& folder, const EntryName& name);

/// Writes an entry beside its name and renames it; false, and nothing is written, if it is larger than
/// most_bytes.
/// error Error{run_failed} naming the file: disk full, folder not writable
bool write_entry(const std::string& folder, const EntryName& name, std::uint64_t most_bytes,
                 const std::function<void(BlobWriter&)>& fill);

}  // namespace opaline
