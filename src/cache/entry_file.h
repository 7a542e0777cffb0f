// SPDX-License-Identifier: GPL-3.0-or-later
// One cache entry as a file: an HDF5 file behind a header that tells whether every byte is as it was written.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "cache/hdf5_file.h"
#include "opaline/cache/stage_key.h"
#include "opaline/core/zeroed_array.h"

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

/// An entry that was found whole, in memory: what is parsed are the bytes that were checked.
struct CheckedEntry {
  ZeroedArray<char> bytes;
};

struct NoEntry {};
/// Why an entry must not be parsed, to follow its name: "is truncated".
struct BadEntry {
  std::string reason;
};

/// Checks the whole file before anyone parses any of it: the header holds the name, the length and the hash
/// (XXH3, 128 bits) of the rest, and must match byte by byte. Makes it the most recently used, where the
/// folder may be written.
std::variant<CheckedEntry, NoEntry, BadEntry> open_entry(const std::string& folder, const EntryName& name);

/// Writes an entry beside its name and renames it; returns its size in bytes.
/// error Error{run_failed} naming the file: disk full, folder not writable
std::uint64_t write_entry(const std::string& folder, const EntryName& name,
                          const std::function<void(Hdf5Writer&)>& fill);

}  // namespace opaline
