// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/entry_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <regex>

#include "cache/content_hash.h"
#include "cache/entry_header.h"
#include "cache/hdf5_file.h"
#include "core/atomic_file.h"
#include "core/machine_memory.h"
#include "opaline/error.h"

namespace opaline {
namespace {

struct Descriptor {
  int number = -1;
  Descriptor(int number_) : number(number_) {}
  Descriptor(Descriptor&& other) noexcept : number(std::exchange(other.number, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Fills the buffer; false if the file has fewer bytes.
bool read_all(int descriptor, std::span<char> bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t got = ::read(descriptor, bytes.data() + at, bytes.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += std::size_t(got);
  }
  return true;
}

StageKey hash_of(const std::string& listing, std::string_view payload) {
  ContentHash hash;
  hash.add(listing.data(), listing.size());
  hash.add(payload.data(), payload.size());
  return hash.value();
}

/// An entry's file, and the content of its header.
struct OpenFile {
  Descriptor file;
  std::uint64_t size = 0;
  EntryHeader header;
  StatedEntry stated;
  std::uint64_t payload() const { return size - kUserBlock; }
};

std::variant<OpenFile, NoEntry, BadEntry> open_file(const std::string& folder, const EntryName& name) {
  Descriptor file(
      ::open((folder + '/' + file_name(name)).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  if (file.number < 0 && errno == ENOENT) return NoEntry{};
  if (file.number < 0 && (errno == ELOOP || errno == ENXIO)) return BadEntry{"is not a regular file"};
  if (file.number < 0) return BadEntry{std::string("cannot be opened: ") + std::strerror(errno)};
  struct stat status {};
  if (::fstat(file.number, &status) != 0 || !S_ISREG(status.st_mode))
    return BadEntry{"is not a regular file"};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < kUserBlock) return BadEntry{"is truncated"};
  EntryHeader header;
  if (!read_all(file.number, header)) return BadEntry{"cannot be read"};
  const std::optional<StatedEntry> stated = read_header(header, name);
  if (!stated || stated->payload != size - kUserBlock) return BadEntry{reason_of(header, size - kUserBlock)};
  return OpenFile{std::move(file), size, header, *stated};
}

}  // namespace

std::string file_name(const EntryName& name) {
  return name.stage + '-' + hex(name.key) + ".h5";
}

std::optional<EntryName> parse_file_name(const std::string& name) {
  static const std::regex form("([a-z]+)-([0-9a-f]{16})([0-9a-f]{16})\\.h5");
  std::smatch parts;
  if (!std::regex_match(name, parts, form)) return {};
  return EntryName{parts[1], {std::stoull(parts[2], nullptr, 16), std::stoull(parts[3], nullptr, 16)}};
}

std::variant<BlobReader, NoEntry, BadEntry> open_entry(const std::string& folder, const EntryName& name,
                                                       std::uint64_t most_bytes) {
  auto opened = open_file(folder, name);
  if (const auto* bad = std::get_if<BadEntry>(&opened)) return *bad;
  if (std::holds_alternative<NoEntry>(opened)) return NoEntry{};
  const OpenFile& open = std::get<OpenFile>(opened);
  if (open.size > most_bytes) return BadEntry{"is larger than its result"};
  if (open.size > available_memory() / 4) return BadEntry{"is too large for the available memory"};
  ZeroedArray<char> bytes(open.size);
  std::ranges::copy(open.header, bytes.begin());
  if (!read_all(open.file.number, std::span(bytes).subspan(kUserBlock))) return BadEntry{"cannot be read"};
  const std::string_view payload(bytes.data() + kUserBlock, open.payload());
  const std::string& listing = open.stated.listing;
  if (!is_header(open.header, header_text(name, listing, payload.size(), hash_of(listing, payload))))
    return BadEntry{"is damaged"};
  auto sets = read_listing(listing, open.size);
  if (!sets) return BadEntry{"is damaged"};
  ::futimens(open.file.number, nullptr);
  return BlobReader(std::move(bytes), std::move(*sets));
}

std::string check_entry(const std::string& folder, const EntryName& name) {
  const auto opened = open_file(folder, name);
  if (const auto* bad = std::get_if<BadEntry>(&opened)) return bad->reason;
  if (std::holds_alternative<NoEntry>(opened)) return {};
  const OpenFile& open = std::get<OpenFile>(opened);
  const std::string& listing = open.stated.listing;
  ContentHash hash;
  hash.add(listing.data(), listing.size());
  std::vector<char> piece(1 << 20);
  for (std::uint64_t left = open.payload(); left > 0;) {
    const std::span<char> part =
        std::span(piece).first(std::size_t(std::min<std::uint64_t>(left, piece.size())));
    if (!read_all(open.file.number, part)) return "cannot be read";
    hash.add(part.data(), part.size());
    left -= part.size();
  }
  if (!is_header(open.header, header_text(name, listing, open.payload(), hash.value())) ||
      !read_listing(listing, open.size))
    return "is damaged";
  return {};
}

bool write_entry(const std::string& folder, const EntryName& name, std::uint64_t most_bytes,
                 const std::function<void(BlobWriter&)>& fill) {
  const std::string path = folder + '/' + file_name(name);
  std::error_code ignored;
  if (std::filesystem::is_symlink(path, ignored))
    std::filesystem::remove(path, ignored);  // entries are never links
  AtomicFile file(path);
  const Hdf5Turn turn;
  Hdf5Writer writer;
  fill(writer);
  const std::string_view bytes = writer.bytes();
  if (bytes.size() < kUserBlock) throw run_failed(path, "HDF5 cannot create it");
  if (bytes.size() > most_bytes) return false;
  const std::string_view payload = bytes.substr(kUserBlock);
  const std::string listing = listing_of(writer.arrays());
  std::string header = header_text(name, listing, payload.size(), hash_of(listing, payload));
  require(header.size() <= kUserBlock, "the data sets of an entry are listed in its header");
  header.resize(kUserBlock);
  file.append(header);
  file.append(payload);
  file.commit_unflushed();
  return true;
}

}  // namespace opaline
