// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/legal_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kNamesShown = 8;

bool is_legal(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.';
}

std::string legal(std::string name) {
  std::ranges::replace_if(name, [](char c) { return !is_legal(c); }, '_');
  return name.empty() ? "unnamed" : name;
}

template <typename Things>
void rename(Things& things, std::set<std::string> taken, std::vector<std::string>& changed) {
  // Names that are legal keep theirs, whatever stands before them.
  std::vector<bool> kept;
  for (const auto& thing : things)
    kept.push_back(legal(thing.name) == thing.name && taken.insert(thing.name).second);
  for (std::size_t i = 0; i < things.size(); ++i) {
    auto& thing = things[i];
    if (kept[i]) continue;
    const std::string base = legal(thing.name);
    std::string name = base;
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}_{}", base, n);
    changed.push_back(fmt::format("'{}' is '{}'", thing.name, name));
    thing.name = std::move(name);
  }
}

}  // namespace

std::vector<std::string> make_names_legal(data::ModelDescription& model) {
  std::vector<std::string> changed;
  rename(model.bodies, {"world", "ground"}, changed);
  rename(model.joints, {}, changed);
  rename(model.coordinates, {}, changed);
  rename(model.markers, {}, changed);
  if (changed.empty()) return {};
  return {fmt::format("{} changed: {}", counted(std::ssize(changed), "name is", "names are"),
                      join_some(changed, kNamesShown))};
}

}  // namespace kinemark::io
