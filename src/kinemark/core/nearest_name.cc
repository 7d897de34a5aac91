// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kinemark {
namespace {

constexpr std::size_t kShortestBeginning = 3;
constexpr std::size_t kLongestWord = 100;  // nobody mistypes longer names

std::string plain(std::string_view name) {
  std::string text(name);
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '_') c = '-';
  }
  return text;
}

bool begins(std::string_view name, std::string_view with) {
  return with.size() >= kShortestBeginning && name.starts_with(with);
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = std::exchange(last, now);
  }
  return last[b.size()];
}

std::vector<std::string> nearest_names(std::string_view word, std::span<const std::string> names,
                                       std::size_t most) {
  if (word.empty() || word.size() > kLongestWord) return {};
  const std::string meant = plain(word);
  const std::size_t near = std::max<std::size_t>(1, meant.size() / 3);
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const auto& name : names) {
    const std::string candidate = plain(name);
    if (candidate.size() > kLongestWord) continue;
    const std::size_t distance = edit_distance(meant, candidate);
    // A word of one or two letters is near to every other one.
    const bool close = distance <= near && distance < std::max(meant.size(), candidate.size()) - 1;
    if (distance == 0 || close || begins(candidate, meant) || begins(meant, candidate))
      found.emplace_back(distance, name);
  }
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, std::string>::first);
  if (found.size() > most) found.resize(most);
  std::vector<std::string> nearest;
  for (auto& [distance, name] : found) nearest.push_back(std::move(name));
  return nearest;
}

}  // namespace kinemark
