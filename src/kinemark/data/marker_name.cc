// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_name.h"

#include <algorithm>
#include <array>

#include "kinemark/data/name_index.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kShortestBefore = 3;  // letters before a side that ends a name

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_plain(char c) { return (c >= 'a' && c <= 'z') || is_digit(c); }
bool is_side(char c) { return c == 'l' || c == 'r'; }

/// Runs of letters and digits, in lower case.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char raw : name) {
    const char c = lower(raw);
    if (is_plain(c))
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// 'l' or 'r' of a word that says no more than a side; blank of others.
char side_of(std::string_view word) {
  if (word == "l" || word == "left") return 'l';
  return word == "r" || word == "right" ? 'r' : ' ';
}

std::string joined(const std::vector<std::string>& words, std::size_t from, std::size_t to) {
  std::string out;
  for (std::size_t i = from; i < to; ++i) out += words[i];
  return out;
}

/// Sides that are words: the first, the last, or LEFT and RIGHT glued to either end.
std::vector<MarkerStem> worded_sides(const std::vector<std::string>& words, std::string_view whole) {
  if (words.size() > 1) {
    if (const char side = side_of(words.front()); side != ' ')
      return {{side, joined(words, 1, words.size())}};
    if (const char side = side_of(words.back()); side != ' ')
      return {{side, joined(words, 0, words.size() - 1)}};
  }
  constexpr std::array<std::string_view, 2> kSides{"left", "right"};
  for (const std::string_view side : kSides) {
    if (whole.size() <= side.size()) continue;
    if (whole.starts_with(side)) return {{side.front(), std::string(whole.substr(side.size()))}};
    if (whole.ends_with(side))
      return {{side.front(), std::string(whole.substr(0, whole.size() - side.size()))}};
  }
  return {};
}

}  // namespace

std::vector<MarkerStem> read_marker_name(std::string_view name) {
  const auto words = words_of(without_prefix(name));
  const std::string whole = joined(words, 0, words.size());
  if (whole.empty()) return {};
  auto out = worded_sides(words, whole);
  if (!out.empty()) return out;
  out.push_back({.stem = whole});
  if (whole.size() > 1 && is_side(whole.front()))
    out.push_back({.side = whole.front(), .stem = whole.substr(1), .sure = false});
  const std::size_t digits = static_cast<std::size_t>(
      std::ranges::find_if_not(whole.rbegin(), whole.rend(), is_digit) - whole.rbegin());
  const std::size_t letters = whole.size() - digits;
  if (letters > kShortestBefore && is_side(whole[letters - 1]))
    out.push_back({.side = whole[letters - 1],
                   .stem = whole.substr(0, letters - 1) + whole.substr(letters),
                   .sure = false,
                   .behind = true});
  return out;
}

std::string plain_marker_name(std::string_view name) {
  const auto readings = read_marker_name(name);
  if (readings.empty()) return {};
  const auto& first = readings.front();
  return first.side == ' ' ? first.stem : first.side + first.stem;
}

}  // namespace kinemark::data
