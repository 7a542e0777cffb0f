// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutate_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace opaline::fuzz {
namespace {

constexpr std::size_t kLongest = 1 << 16;  // bytes of an input

constexpr std::array kOddNumbers{"0",
                                 "-0",
                                 "1",
                                 "-1",
                                 "2",
                                 "255",
                                 "65536",
                                 "2147483647",
                                 "-2147483648",
                                 "4294967295",
                                 "4294967296",
                                 "18446744073709551615",
                                 "18446744073709551616",
                                 "1e-320",
                                 "1e-45",
                                 "1e-18",
                                 "1e18",
                                 "1e19",
                                 "1e38",
                                 "3.5e38",
                                 "1e308",
                                 "-1e308",
                                 "1e309",
                                 "nan",
                                 "inf",
                                 "0x10",
                                 "1e",
                                 "."};

/// From `at` on, the bytes that look like a number.
std::size_t number_length(const std::string& bytes, std::size_t at) {
  const std::size_t end = std::min(bytes.find_first_not_of("0123456789+-.eE", at), bytes.size());
  return end - at;
}

void replace_number(std::string& bytes, Random& random) {
  const std::size_t at = bytes.find_first_of("0123456789", below(random, bytes.size()));
  if (at == bytes.npos) return;
  bytes.replace(at, number_length(bytes, at), any_number(random));
}

/// The number of four or eight bytes in either order: counts and offsets of binary formats.
void replace_binary(std::string& bytes, Random& random) {
  const std::size_t width = std::size_t(1) << below(random, 4);
  if (bytes.size() < width) return;
  constexpr std::array<std::uint64_t, 10> values{
      0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, ~std::uint64_t(0)};
  std::uint64_t value =
      random() % 3 == 0 ? random() >> below(random, 64) : values[below(random, values.size())];
  const std::size_t at = below(random, bytes.size() - width + 1);
  const bool backwards = random() % 2 == 0;
  for (std::size_t i = 0; i < width; ++i, value >>= 8)
    bytes[at + (backwards ? width - 1 - i : i)] = char(value);
}

void change(std::string& bytes, const std::string& other, const std::vector<std::string>& words,
            Random& random) {
  if (bytes.empty()) bytes = other.empty() ? "0" : other;
  const std::size_t at = below(random, bytes.size());
  const std::size_t length =
      1 + below(random, std::min<std::size_t>(bytes.size() - at, random() % 4 == 0 ? 4096 : 16));
  switch (below(random, 10)) {
    case 0:
      bytes[at] = char(bytes[at] ^ (1 << below(random, 8)));
      break;
    case 1:
      bytes[at] = char(random());
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(below(random, bytes.size() + 1), bytes.substr(at, length));
      break;
    case 4:
      bytes.replace(at, length, other.substr(std::min(at, other.size()), length));
      break;
    case 5:
      bytes = bytes.substr(0, at) + other.substr(std::min(below(random, other.size() + 1), other.size()));
      break;
    case 6:
      if (!words.empty()) bytes.insert(at, words[below(random, words.size())]);
      break;
    case 7:
      replace_binary(bytes, random);
      break;
    default:
      replace_number(bytes, random);
  }
  if (bytes.size() > kLongest) bytes.resize(kLongest);
}

}  // namespace

std::string any_number(Random& random) {
  if (random() % 2 == 0) return kOddNumbers[below(random, kOddNumbers.size())];
  const double exponent = random() % 2 == 0 ? double(below(random, 6)) - 3 : double(below(random, 80)) - 40;
  const double value = (double(random() % 2000) / 1000 - 1) * std::pow(10, exponent);
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), random() % 3 == 0 ? "%.0f" : "%.6g", value);
  return text.data();
}

std::string mutated(std::string bytes, const std::string& other, const std::vector<std::string>& words,
                    Random& random) {
  const std::size_t changes = std::size_t(1) << below(random, 4);
  for (std::size_t i = 0; i < changes; ++i) change(bytes, other, words, random);
  return bytes;
}

}  // namespace opaline::fuzz
