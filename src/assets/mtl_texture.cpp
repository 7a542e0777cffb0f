// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/mtl_texture.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/text_lines.h"

namespace opaline {
namespace {

/// An option of the format with its maximum number of words.
struct Option {
  std::string_view name;
  std::size_t words;
  bool are_numbers = true;
};

// Wavefront's "MTL material format", version 4.2.
constexpr std::array<Option, 13> kOptions{{{"-blendu", 1, false},
                                           {"-blendv", 1, false},
                                           {"-bm", 1},
                                           {"-boost", 1},
                                           {"-cc", 1, false},
                                           {"-clamp", 1, false},
                                           {"-imfchan", 1, false},
                                           {"-mm", 2},
                                           {"-o", 3},
                                           {"-s", 3},
                                           {"-t", 3},
                                           {"-texres", 1},
                                           {"-type", 1, false}}};

class StatementReader {
 public:
  explicit StatementReader(std::string_view text) : rest_(text) {}

  MtlTexture run() {
    do {
      for (const Option* option = next_option(); option != nullptr; option = next_option()) {
        next_word(rest_);
        read(*option);
      }
    } while (skip_unknown_option());
    rest_ = trimmed(rest_);
    if (rest_.size() > 1 && rest_.front() == '"' && rest_.back() == '"')
      rest_ = rest_.substr(1, rest_.size() - 2);
    texture_.name = rest_;
    return std::move(texture_);
  }

 private:
  const Option* next_option() {
    std::string_view ahead = rest_;
    const auto found = std::ranges::find(kOptions, next_word(ahead), &Option::name);
    return found == kOptions.end() ? nullptr : &*found;
  }

  /// Skips an option before the file's name with its numbers and switches; false: none.
  bool skip_unknown_option() {
    std::string_view behind = rest_;
    std::string text(next_word(behind));
    const bool is_option =
        text.size() > 1 && text[0] == '-' && std::isalpha(static_cast<unsigned char>(text[1]));
    if (!is_option || trimmed(behind).empty()) return false;
    while (true) {
      std::string_view ahead = behind;
      const std::string word(next_word(ahead));
      const bool is_value = number_of(word) || word == "on" || word == "off";
      if (!is_value || trimmed(ahead).empty()) break;
      text += ' ' + word;
      behind = ahead;
    }
    rest_ = behind;
    texture_.not_carried.push_back(text);
    return true;
  }

  /// Options may have fewer numbers, before the file's name.
  void read(const Option& option) {
    std::string text(option.name);
    std::vector<double> numbers;
    std::string word;
    for (std::size_t i = 0; i < option.words; ++i) {
      std::string_view behind = rest_;
      word = next_word(behind);
      const std::optional<double> number = number_of(word);
      if (option.are_numbers && !number) break;
      rest_ = behind;
      text += ' ' + word;
      if (number) numbers.push_back(*number);
    }
    if (!apply(option.name, numbers, word)) texture_.not_carried.push_back(text);
  }

  /// False if not supported.
  bool apply(std::string_view name, const std::vector<double>& numbers, const std::string& word) {
    if (name == "-clamp" || name == "-cc") return word == "off";
    if (name == "-t") return std::ranges::all_of(numbers, [](double n) { return n == 0; });
    if (numbers.empty()) return name != "-bm" && name != "-mm" && name != "-o" && name != "-s";
    if (name == "-s") return set_pair(numbers, 1, texture_.scale);
    if (name == "-o") return set_pair(numbers, 0, texture_.offset);
    if (name == "-bm") return set(numbers[0], texture_.bump);
    if (name == "-mm") return numbers.size() == 2 && set_range(numbers[0], numbers[1]);
    return true;  // resolution, sharpness and the like
  }

  static bool set_pair(const std::vector<double>& numbers, double otherwise, std::array<double, 2>& pair) {
    pair = {numbers[0], numbers.size() > 1 ? numbers[1] : otherwise};
    return true;
  }

  bool set_range(double base, double gain) {
    if (set(gain, texture_.gain)) texture_.base = base;
    return gain >= 0;
  }

  static bool set(double number, double& value) {
    if (number >= 0) value = number;
    return number >= 0;
  }

  std::string_view rest_;
  MtlTexture texture_;
};

}  // namespace

MtlTexture read_mtl_texture(std::string_view text) {
  return StatementReader(text).run();
}

}  // namespace opaline
