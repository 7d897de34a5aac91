// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/plate_component.h"

namespace kinemark::data {
namespace {

constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz",
                           kWordOf = "abcdefghijklmnopqrstuvwxyz0123456789";

std::string in_small_letters(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

}  // namespace

std::string plate_component(std::string_view label) {
  auto text = in_small_letters(label);
  text.resize(text.find_last_of(kLetters) + 1);
  const auto begin = text.find_last_not_of(kWordOf) + 1;
  std::string word;  // the last one, without numbers
  for (const char c : text.substr(begin))
    if (kLetters.find(c) != std::string_view::npos) word += c;
  const bool named =
      word.size() == 2 && (word[0] == 'f' || word[0] == 'm') && word[1] >= 'x' && word[1] <= 'z';
  return named ? word : std::string();
}

}  // namespace kinemark::data
