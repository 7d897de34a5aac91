// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/seal.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "kinemark/io/set_mark.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kSearched = 64UL << 10;

bool is_digit(unsigned char c) { return std::isdigit(c) != 0 || (c >= 'a' && c <= 'f'); }

}  // namespace

std::string sealed_mark(std::string_view set) {
  return set.empty() ? std::string() : fmt::format("{} {}={}", set_mark(set), kSumKey, kNoSum);
}

std::size_t find_mark(std::string_view text, std::string_view key) {
  for (auto at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1)) {
    const auto digits = text.find_first_not_of("=\": ", at + key.size());
    if (digits == std::string_view::npos) return digits;
    const auto found = text.substr(digits, kNoSum.size());
    if (found.size() == kNoSum.size() && std::ranges::all_of(found, is_digit)) return digits;
  }
  return std::string_view::npos;
}

Seal check_seal(std::string_view text) {
  const auto at = find_mark(text.substr(0, kSearched), kSumKey);
  if (at == std::string_view::npos) return Seal::none;
  const auto after = text.substr(at + kNoSum.size());
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (const auto part : {text.substr(0, at), kNoSum, after})
    XXH3_64bits_update(state.get(), part.data(), part.size());
  const auto sum = fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
  return sum == text.substr(at, kNoSum.size()) ? Seal::whole : Seal::broken;
}

std::string broken_seal() {
  return fmt::format(
      "its content is not what was written: {} does not fit, so it was edited or damaged since; make it "
      "anew, or take that sum out of it to use it as it is",
      kSumKey);
}

}  // namespace kinemark::io
