// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/internal/lacks.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/core/nearest_name.h"

namespace kinemark::analysis::internal {
namespace {

std::string lack_sentence(const SegmentDefinition& d, const std::set<std::string>& lacks,
                          const std::vector<std::string>& without, const std::vector<std::string>& markers) {
  std::vector<std::string> parts;
  for (const auto& name : lacks) {
    if (std::ranges::find(d.parameters, name, &SegmentDefinition::Parameter::name) != d.parameters.end()) {
      parts.push_back(fmt::format("value of '{}'", name));
    } else if (const auto l = std::ranges::find(d.landmarks, name, &SegmentDefinition::Landmark::name);
               l != d.landmarks.end()) {
      parts.push_back(fmt::format("landmark '{}' of the trial '{}'", name, l->trial));
    } else if (name == "progression") {
      parts.emplace_back("direction of progression");
    } else {
      const auto near = nearest_names(name, markers, 1);
      const bool label = !near.empty() && near.front() == name;
      parts.push_back(
          fmt::format("{} '{}'{}", label ? "sample of marker" : "marker", name,
                      near.empty() || label ? "" : fmt::format(" (there is '{}')", near.front())));
    }
  }
  return fmt::format("Not computed: {}; there is no {}.", fmt::join(without, ", "),
                     fmt::join(parts, ", no "));
}

}  // namespace

std::vector<std::string> lack_sentences(const SegmentDefinition& definition,
                                        std::span<const std::string> names, const SegmentGraph& graph,
                                        const std::vector<std::string>& markers) {
  std::vector<std::pair<std::set<std::string>, std::vector<std::string>>> groups;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (graph.lacks[i].empty() || names[i].empty()) continue;
    auto at = std::ranges::find(groups, graph.lacks[i], &decltype(groups)::value_type::first);
    if (at == groups.end()) at = groups.insert(groups.end(), {graph.lacks[i], {}});
    at->second.push_back(names[i]);
  }
  std::vector<std::string> out;
  for (const auto& [lacks, without] : groups)
    out.push_back(lack_sentence(definition, lacks, without, markers));
  return out;
}

}  // namespace kinemark::analysis::internal
