// SPDX-License-Identifier: GPL-3.0-or-later
// Small changes to an input, drawn from a seed.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace opaline::fuzz {

using Random = std::mt19937_64;

/// A number from 0 to below `end`, which is at least 1.
inline std::size_t below(Random& random, std::size_t end) {
  return std::size_t(random() % end);
}

/// A number as text: of everyday size, at the ends of a type's range, or none at all.
std::string any_number(Random& random);

/// One to eight changes: bits, bytes, runs of them, numbers in the text, words, and parts of another input.
/// in    other: an input of the corpus; words: may be empty
std::string mutated(std::string bytes, const std::string& other, const std::vector<std::string>& words,
                    Random& random);

}  // namespace opaline::fuzz
