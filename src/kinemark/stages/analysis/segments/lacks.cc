// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/internal/lacks.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/core/nearest_name.h"
#include "kinemark/data/likely_pairs.h"

namespace kinemark::analysis::internal {
namespace {

// Outputs that lack the same, or things that are lacked together.
struct LackGroup {
  std::set<std::string> lacks;
  std::vector<std::string> without;
  bool alike = true;  // each of them lacks all of it
};

// Things of one kind that are not there: "marker 'A', 'B'".
struct LackKind {
  std::string kind;
  std::vector<std::string> names;
};

std::pair<std::string, std::string> kind_and_name(const SegmentDefinition& d, const std::string& name,
                                                  const std::vector<std::string>& markers) {
  if (std::ranges::find(d.parameters, name, &SegmentDefinition::Parameter::name) != d.parameters.end())
    return {"value of", fmt::format(" '{}'", name)};
  if (const auto l = std::ranges::find(d.landmarks, name, &SegmentDefinition::Landmark::name);
      l != d.landmarks.end())
    return {fmt::format("landmark '{}' of the trial '{}'", name, l->trial), ""};
  if (name == "progression") return {"direction of progression", ""};
  const auto near = nearest_names(name, markers, 1);
  if (!near.empty() && near.front() == name) return {"sample of marker", fmt::format(" '{}'", name)};
  return {"marker",
          fmt::format(" '{}'{}", name, near.empty() ? "" : fmt::format(" (there is '{}')", near.front()))};
}

std::string lack_sentence(const SegmentDefinition& d, const LackGroup& group,
                          const std::vector<std::string>& markers) {
  std::vector<LackKind> kinds;
  for (const auto& lacked : group.lacks) {
    auto [kind, name] = kind_and_name(d, lacked, markers);
    auto at = std::ranges::find(kinds, kind, &LackKind::kind);
    if (at == kinds.end()) at = kinds.insert(kinds.end(), {kind, {}});
    at->names.push_back(std::move(name));
  }
  std::vector<std::string> parts;
  for (const auto& [kind, names] : kinds) parts.push_back(kind + fmt::format("{}", fmt::join(names, ",")));
  return fmt::format("Not computed: {}; there is no {}{}.", fmt::join(group.without, ", "),
                     fmt::join(parts, ", no "), group.alike ? "" : ", and each needs one of them or more");
}

// Markers that are lacked and that the recording probably has under other names, as an option.
std::string likely_names(const SegmentDefinition& d, const std::vector<LackGroup>& groups,
                         const std::vector<std::string>& markers) {
  std::set<std::string> lacked;
  for (const auto& group : groups)
    for (const auto& name : group.lacks)
      if (kind_and_name(d, name, markers).first == "marker") lacked.insert(name);
  const std::vector<std::string> wanted(lacked.begin(), lacked.end());
  return data::rename_option(data::find_likely_pairs(wanted, markers));
}

// Groups that lack something in common become one: who brings no markers of the trunk lacks arms and head
// with them.
void join_groups(std::vector<LackGroup>& groups) {
  for (std::size_t i = 0; i < groups.size();) {
    const auto shares = [&](const std::string& name) { return groups[i].lacks.contains(name); };
    const auto other = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(i) + 1, groups.end(),
                                    [&](const LackGroup& g) { return std::ranges::any_of(g.lacks, shares); });
    if (other == groups.end()) {
      ++i;
      continue;
    }
    groups[i].alike = false;
    groups[i].lacks.insert(other->lacks.begin(), other->lacks.end());
    groups[i].without.insert(groups[i].without.end(), other->without.begin(), other->without.end());
    groups.erase(other);
  }
}

}  // namespace

std::vector<std::string> lack_sentences(const SegmentDefinition& definition,
                                        std::span<const std::string> names, const SegmentGraph& graph,
                                        const std::vector<std::string>& markers) {
  std::vector<LackGroup> groups;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (graph.lacks[i].empty() || names[i].empty()) continue;
    auto at = std::ranges::find(groups, graph.lacks[i], &LackGroup::lacks);
    if (at == groups.end()) at = groups.insert(groups.end(), {.lacks = graph.lacks[i], .without = {}});
    at->without.push_back(names[i]);
  }
  join_groups(groups);
  std::vector<std::string> out;
  for (const auto& group : groups) out.push_back(lack_sentence(definition, group, markers));
  if (const auto option = likely_names(definition, groups, markers); !option.empty())
    out.push_back(fmt::format("Likely: {}", option));
  return out;
}

}  // namespace kinemark::analysis::internal
