// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/tiff_strips.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "opaline/error.h"

namespace opaline {
namespace {

enum Tag : std::uint64_t {
  kStripOffsets = 273,
  kStripByteCounts = 279,
  kTileOffsets = 324,
  kTileByteCounts = 325
};

/// Bytes of a number of this type; 0: not a whole number without a sign.
std::size_t bytes_of_type(std::uint64_t type) {
  constexpr std::uint64_t kShort = 3, kLong = 4, kLong8 = 16;
  return type == kShort ? 2 : type == kLong ? 4 : type == kLong8 ? 8 : 0;
}

class TiffReader {
 public:
  TiffReader(const PictureBytes& bytes, const std::string& path) : bytes_(bytes), path_(path) {
    const std::string signature = bytes.read(0, 4);
    is_big_endian_ = signature.starts_with('M');
    is_big_ = signature.find('+') != signature.npos;
  }

  void check() {
    read_directory();
    check_ends(kStripOffsets, kStripByteCounts);
    check_ends(kTileOffsets, kTileByteCounts);
  }

 private:
  struct Entry {
    std::uint64_t tag, type, count;
    std::string value;  ///< the numbers, or their place in the file
  };

  [[noreturn]] void fail(std::uint64_t end) const {
    throw bad_file(path_, "the image is truncated", "at least " + std::to_string(end) + " bytes",
                   std::to_string(bytes_.size()));
  }

  std::string read(std::uint64_t begin, std::uint64_t count) const {
    if (begin > bytes_.size() || count > bytes_.size() - begin) fail(begin + count);
    return bytes_.read(begin, count);
  }

  std::uint64_t number(std::string_view digits) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < digits.size(); ++i)
      value = value << 8 | static_cast<unsigned char>(digits[is_big_endian_ ? i : digits.size() - 1 - i]);
    return value;
  }

  void read_directory() {
    const std::size_t word = is_big_ ? 8 : 4, count_bytes = is_big_ ? 8 : 2, size = 4 + 2 * word;
    const std::uint64_t at = number(read(word, word)), count = number(read(at, count_bytes));
    if (count > bytes_.size()) fail(count);
    const std::string table = read(at + count_bytes, count * size);
    for (std::size_t i = 0; i < table.size(); i += size) {
      const std::string_view entry(table.data() + i, size);
      entries_.push_back({number(entry.substr(0, 2)), number(entry.substr(2, 2)),
                          number(entry.substr(4, word)), std::string(entry.substr(4 + word))});
    }
  }

  /// Empty without the tag.
  std::vector<std::uint64_t> numbers(Tag tag) const {
    const auto entry = std::ranges::find(entries_, std::uint64_t(tag), &Entry::tag);
    if (entry == entries_.end()) return {};
    const std::size_t size = bytes_of_type(entry->type);
    if (size == 0) return {};
    if (entry->count > bytes_.size()) fail(entry->count);
    const std::uint64_t count = entry->count * size;
    const std::string values =
        count <= entry->value.size() ? entry->value : read(number(entry->value), count);
    std::vector<std::uint64_t> numbers;
    for (std::size_t i = 0; i < count; i += size)
      numbers.push_back(number(std::string_view(values).substr(i, size)));
    return numbers;
  }

  void check_ends(Tag offsets_tag, Tag counts_tag) const {
    const std::vector<std::uint64_t> offsets = numbers(offsets_tag), counts = numbers(counts_tag);
    for (std::size_t i = 0; i < std::min(offsets.size(), counts.size()); ++i)
      if (counts[i] > bytes_.size() || offsets[i] > bytes_.size() - counts[i]) fail(offsets[i] + counts[i]);
  }

  const PictureBytes& bytes_;
  const std::string& path_;
  bool is_big_endian_ = false, is_big_ = false;
  std::vector<Entry> entries_;
};

}  // namespace

void check_tiff_strips(const PictureBytes& bytes, const std::string& path) {
  TiffReader(bytes, path).check();
}

}  // namespace opaline
