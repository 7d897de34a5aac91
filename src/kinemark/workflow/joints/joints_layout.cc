// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/joints_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/workflow/joints/internal/joints_segmentation.h"

namespace kinemark::workflow {
namespace {

constexpr std::size_t kNamesListed = 8;

Result<data::SegmentLayout> find_layout(const JointsOptions& options, const data::Trajectories& markers,
                                        JointsFound& outcome) {
  if (options.segments) return *options.segments;
  if (markers.markers() < 4)
    return fail(
        Code::bad_input,
        fmt::format("{} markers in all; a joint needs 4 at least, three on one segment and one on another",
                    markers.markers()));
  return find_segmentation(options, markers, outcome);
}

/// The worst of what was left out in words, how many more there are, and what to do.
Status refuse(const JointsOptions& options, const JointsFound& outcome) {
  const auto worst = std::ranges::max_element(outcome.left_out, {}, &skeleton::Implausible::value_m);
  const auto more = outcome.left_out.size() - 1;
  std::string next = propose_next_step(options, outcome);
  next.pop_back();
  next.front() = static_cast<char>(next.front() - 'A' + 'a');
  return fail(
      Code::bad_input,
      fmt::format("no joint of a body can be found: {}{}; {}", worst->description(),
                  more > 0 ? fmt::format(", and {} more such segments or joints were left out", more) : "",
                  next));
}

/// Names of segments that no joint is left of.
std::vector<std::string> lonely_segments(const data::SegmentLayout& layout) {
  std::vector<std::string> out;
  for (int s = 0; s < static_cast<int>(layout.segments.size()); ++s)
    if (std::ranges::none_of(layout.joints,
                             [&](const auto& joint) { return joint.parent == s || joint.child == s; }))
      out.push_back(layout.segments[at(s)].name);
  return out;
}

}  // namespace

Status lay_out(const JointsOptions& options, const data::Trajectories& markers, JointsFound& outcome) {
  auto layout = find_layout(options, markers, outcome);
  if (!layout) return std::unexpected(layout.error());
  outcome.layout = std::move(*layout);
  if (outcome.segmentation && outcome.layout.joints.empty()) return {};
  const bool lines_alone = options.method == "articulated" && options.of_subject;
  if (lines_alone) {
    // Joints of a single marker cannot be asked for; of a layout that nobody wrote they are no one's wish.
    const auto joints = outcome.layout.joints.size();
    std::erase_if(outcome.layout.joints, [&](const auto& joint) {
      return outcome.layout.segments[at(joint.parent)].markers.size() < 2 ||
             outcome.layout.segments[at(joint.child)].markers.size() < 2;
    });
    if (outcome.layout.joints.empty())
      return fail(Code::bad_input,
                  fmt::format("none of the {} joints lies between two segments of two markers or more, "
                              "which the articulated method needs; name the segments in a file, or use "
                              "another method",
                              joints));
    if (const auto lonely = lonely_segments(outcome.layout); !lonely.empty())
      outcome.remarks.warnings.push_back(fmt::format(
          "Left out, as the articulated method needs two markers on a segment and on one beside it: {}.",
          join(lonely)));
  }
  if (const auto bad = skeleton::judge_layout(markers, outcome.layout); !bad.empty())
    if (auto s = leave_out(options, bad, outcome.layout, outcome); !s) return s;
  return {};
}

Status leave_out(const JointsOptions& options, std::span<const skeleton::Implausible> bad,
                 data::SegmentLayout& layout, JointsFound& outcome) {
  outcome.left_out.insert(outcome.left_out.end(), bad.begin(), bad.end());
  layout = skeleton::leave_out(layout, bad);
  // Of segments that nobody named nothing was asked: that none of their joints is determined is a result.
  return layout.joints.empty() && !outcome.segmentation ? refuse(options, outcome) : Status();
}

std::vector<data::SegmentLayout> trees_of(const data::SegmentLayout& layout) {
  const auto S = layout.segments.size();
  std::vector<int> tree(S);
  std::iota(tree.begin(), tree.end(), 0);
  for (const auto& joint : layout.joints) {
    const int from = tree[at(joint.child)], to = tree[at(joint.parent)];
    std::ranges::replace(tree, from, to);
  }
  std::vector<data::SegmentLayout> out;
  for (int t = 0; t < static_cast<int>(S); ++t) {
    if (std::ranges::count(tree, t) < 2) continue;
    data::SegmentLayout part;
    std::vector<int> number(S, -1);
    for (std::size_t s = 0; s < S; ++s) {
      if (tree[s] != t) continue;
      number[s] = static_cast<int>(part.segments.size());
      part.segments.push_back(layout.segments[s]);
    }
    for (const auto& joint : layout.joints)
      if (number[at(joint.parent)] >= 0)
        part.joints.push_back({joint.name, number[at(joint.parent)], number[at(joint.child)]});
    out.push_back(std::move(part));
  }
  return out;
}

Error with_left_out(const JointsFound& outcome, const Error& error) {
  if (outcome.left_out.empty()) return error;
  Error out = error;
  std::vector<std::string> names;
  for (const auto& bad : outcome.left_out) names.push_back("'" + bad.name + "'");
  out.message += fmt::format(" (left out, as they are no body's: {})", join_some(names, kNamesListed));
  return out;
}

std::string propose_next_step(const JointsOptions& options, const JointsFound& outcome) {
  std::vector<std::string> loose, joints;
  for (const auto& bad : outcome.left_out) {
    if (!bad.is_segment) joints.push_back("'" + bad.name + "'");
    for (const auto& marker : bad.markers)
      if (bad.is_segment && std::ranges::find(loose, marker) == loose.end()) loose.push_back(marker);
  }
  const std::string without =
      loose.empty() ? "" : fmt::format(", without the markers {}", join_names(loose, kNamesListed));
  if (!options.segments)
    return fmt::format("Name the segments of the body in a file (--segments){}.", without);
  if (joints.empty()) return fmt::format("Name the segments{}.", without);
  return fmt::format("Look at the markers of both segments of {}, or leave {} out of the segments file{}.",
                     join_names(joints, kNamesListed), joints.size() == 1 ? "this joint" : "these joints",
                     without);
}

}  // namespace kinemark::workflow
