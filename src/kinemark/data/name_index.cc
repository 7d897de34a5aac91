// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/name_index.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinemark/core/index.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kMostListed = 12;

std::string first_few(const std::vector<std::string>& names) {
  if (names.empty()) return "none";
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMostListed));
  auto text = fmt::format("{}", fmt::join(names.begin(), end, ", "));
  if (names.size() > kMostListed) text += fmt::format(", and {} more", names.size() - kMostListed);
  return text;
}

}  // namespace

std::string_view without_prefix(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

NameIndex::NameIndex(const std::vector<std::string>& names) : names_(names) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto index = static_cast<std::int64_t>(i);
    const std::string_view bare = without_prefix(names_[i]);
    exact_.try_emplace(names_[i], index);
    if (!bare.empty() && bare.size() < names_[i].size()) behind_prefix_[std::string(bare)].push_back(index);
  }
}

std::int64_t NameIndex::find(std::string_view name) const {
  if (const auto exact = exact_.find(name); exact != exact_.end()) return exact->second;
  const auto behind = behind_prefix_.find(name);
  return behind != behind_prefix_.end() && behind->second.size() == 1 ? behind->second.front() : -1;
}

bool NameIndex::ambiguous(std::string_view name) const {
  const auto behind = behind_prefix_.find(name);
  return !exact_.contains(name) && behind != behind_prefix_.end() && behind->second.size() > 1;
}

std::string NameIndex::instead_of(std::string_view name) const {
  if (!ambiguous(name)) return first_few(names_);
  std::vector<std::string> carriers;
  for (const std::int64_t i : behind_prefix_.find(name)->second) carriers.push_back(names_[at(i)]);
  return first_few(carriers) + " (several subjects: need the full name)";
}

}  // namespace kinemark::data
