// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/entry_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <regex>

#include "cache/content_hash.h"
#include "opaline/core/atomic_file.h"
#include "opaline/core/error.h"

namespace opaline {
namespace {

// Of the header and of the data sets behind it; stages have versions of their own, in their keys.
constexpr int kFormat = 1;
constexpr std::string_view kMagic = "opaline cache entry, format ";

using Header = std::array<char, kUserBlock>;

Header header_of(const EntryName& name, std::uint64_t payload, const StageKey& hash) {
  const std::string text = fmt::format("{}{}\nstage {}\nkey {}\npayload {} bytes, xxh3-128 {}\n", kMagic,
                                       kFormat, name.stage, hex(name.key), payload, hex(hash));
  Header header{};
  text.copy(header.data(), header.size());
  return header;
}

struct Descriptor {
  int number = -1;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// As many bytes as there is room for; false if the file has less.
bool read_all(int descriptor, std::span<char> bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t got = ::read(descriptor, bytes.data() + at, bytes.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += std::size_t(got);
  }
  return true;
}

StageKey hash_of(std::string_view bytes) {
  ContentHash hash;
  hash.add(bytes.data(), bytes.size());
  return hash.value();
}

/// What a header that is not the expected one suggests.
std::string reason_of(const Header& header, std::uint64_t payload) {
  const std::string text(header.data(), strnlen(header.data(), header.size()));
  if (!text.starts_with(kMagic)) return "is not a cache entry";
  const std::string own = fmt::format("{}{}\n", kMagic, kFormat);
  if (!text.starts_with(own)) return fmt::format("is of another version than this program's {}", kFormat);
  const std::size_t at = text.find("\npayload ");
  std::uint64_t stated = 0;
  if (at != std::string::npos) std::from_chars(text.data() + at + 9, text.data() + text.size(), stated);
  return payload < stated ? "is truncated" : "is damaged";
}

}  // namespace

std::string file_name(const EntryName& name) {
  return name.stage + '-' + hex(name.key) + ".h5";
}

std::optional<EntryName> parse_file_name(const std::string& name) {
  static const std::regex form("(samples|light|octree|exitance)-([0-9a-f]{16})([0-9a-f]{16})\\.h5");
  std::smatch parts;
  if (!std::regex_match(name, parts, form)) return {};
  return EntryName{parts[1], {std::stoull(parts[2], nullptr, 16), std::stoull(parts[3], nullptr, 16)}};
}

std::variant<CheckedEntry, NoEntry, BadEntry> open_entry(const std::string& folder, const EntryName& name) {
  const Descriptor file{::open((folder + '/' + file_name(name)).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.number < 0 && errno == ENOENT) return NoEntry{};
  if (file.number < 0) return BadEntry{std::string("cannot be opened: ") + std::strerror(errno)};
  struct stat status {};
  if (::fstat(file.number, &status) != 0 || !S_ISREG(status.st_mode))
    return BadEntry{"is not a regular file"};
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size < kUserBlock) return BadEntry{"is truncated"};
  CheckedEntry entry;
  entry.bytes.resize(size);
  if (!read_all(file.number, entry.bytes)) return BadEntry{"cannot be read"};
  const std::string_view payload(entry.bytes.data() + kUserBlock, size - kUserBlock);
  Header header{};
  std::copy_n(entry.bytes.data(), kUserBlock, header.data());
  if (header != header_of(name, payload.size(), hash_of(payload)))
    return BadEntry{reason_of(header, payload.size())};
  ::futimens(file.number, nullptr);
  return entry;
}

std::uint64_t write_entry(const std::string& folder, const EntryName& name,
                          const std::function<void(Hdf5Writer&)>& fill) {
  AtomicFile file(folder + '/' + file_name(name));
  const Hdf5Turn turn;
  Hdf5Writer writer;
  fill(writer);
  const std::string_view bytes = writer.bytes();
  if (bytes.size() < kUserBlock) throw run_failed(folder + '/' + file_name(name), "HDF5 cannot make it");
  const std::string_view payload = bytes.substr(kUserBlock);
  const Header header = header_of(name, payload.size(), hash_of(payload));
  file.append({header.data(), header.size()});
  file.append(payload);
  file.commit_unflushed();
  return bytes.size();
}

}  // namespace opaline
