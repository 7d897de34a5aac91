// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/pipeline/joints/segments_file.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kNamesListed = 8;

Result<data::SegmentLayout> find_layout(const JointsJob& job, const data::Trajectories& markers,
                                        JointsOutcome& outcome) {
  if (!job.segments.empty()) return read_segments(job.segments, markers.names);
  if (markers.markers() < 4)
    return fail(
        Code::bad_input,
        fmt::format("{} markers in all; a joint needs 4 at least, three on one segment and one on another",
                    markers.markers()));
  skeleton::TopologyOptions options;
  options.noise_sd_m = job.noise_sd_m;
  auto topology = skeleton::find_topology(markers, options);
  if (!topology) return std::unexpected(topology.error());
  outcome.warnings.push_back(fmt::format("Found in the data: {} segments, {} joints.",
                                         topology->layout.segments.size(), topology->layout.joints.size()));
  if (topology->layout.segments.size() < 2)
    return fail(Code::bad_input,
                fmt::format("all {} markers keep their distances: they are on one segment, or "
                            "nothing moved, so no joint can be found",
                            markers.markers()));
  outcome.warnings.insert(outcome.warnings.end(), topology->warnings.begin(), topology->warnings.end());
  outcome.topology = std::move(*topology);
  return outcome.topology->layout;
}

/// What the likelihood of a chain can be asked about: the largest tree of segments with two markers or more.
Result<data::SegmentLayout> largest_tree(const data::SegmentLayout& layout,
                                         std::vector<std::string>& warnings) {
  const auto S = layout.segments.size();
  const auto usable = [&](int s) { return layout.segments[static_cast<std::size_t>(s)].markers.size() >= 2; };
  std::vector<int> tree(S);
  std::iota(tree.begin(), tree.end(), 0);
  for (const auto& joint : layout.joints) {
    if (!usable(joint.parent) || !usable(joint.child)) continue;
    const int from = tree[static_cast<std::size_t>(joint.child)],
              to = tree[static_cast<std::size_t>(joint.parent)];
    std::ranges::replace(tree, from, to);
  }
  int best = 0;
  for (const int t : tree)
    if (std::ranges::count(tree, t) > std::ranges::count(tree, best)) best = t;
  if (static_cast<std::size_t>(std::ranges::count(tree, best)) == S) return layout;
  data::SegmentLayout out;
  std::vector<int> number(S, -1);
  std::string left;
  for (std::size_t s = 0; s < S; ++s) {
    if (tree[s] == best) {
      number[s] = static_cast<int>(out.segments.size());
      out.segments.push_back(layout.segments[s]);
    } else {
      left += (left.empty() ? "" : ", ") + layout.segments[s].name;
    }
  }
  for (const auto& joint : layout.joints) {
    const int parent = number[static_cast<std::size_t>(joint.parent)],
              child = number[static_cast<std::size_t>(joint.child)];
    if (parent >= 0 && child >= 0) out.joints.push_back({joint.name, parent, child});
  }
  if (out.joints.empty())
    return fail(Code::bad_input,
                fmt::format("none of the {} joints found lies between two segments of two markers or more, "
                            "which the articulated method needs; name the segments in a file, or use another "
                            "method",
                            layout.joints.size()));
  warnings.push_back(fmt::format(
      "Left out, as the articulated method needs two markers on a segment and one tree of them: {}.", left));
  return out;
}

/// The worst of what was left out in words, how many more there are, and what to do.
Status refuse(const JointsJob& job, const JointsOutcome& outcome) {
  const auto worst = std::ranges::max_element(outcome.left_out, {}, &skeleton::Implausible::value_m);
  const auto more = outcome.left_out.size() - 1;
  std::string next = propose_next_step(job, outcome);
  next.pop_back();
  next.front() = static_cast<char>(next.front() - 'A' + 'a');
  return fail(Code::bad_input,
              fmt::format("no joint of a body can be found: {}{}; {}", worst->description(),
                          more > 0 ? fmt::format(", and {} more such segments or joints were left out", more) : "",
                          next));
}

}  // namespace

Status lay_out(const JointsJob& job, const data::Trajectories& markers, JointsOutcome& outcome) {
  auto layout = find_layout(job, markers, outcome);
  const auto of_recording = [&](const Error& error) -> Status {
    return job.segments.empty() ? Status(fail_at(job.input.string(), error)) : std::unexpected(error);
  };
  if (!layout) return of_recording(layout.error());
  outcome.layout = std::move(*layout);
  if (const auto bad = skeleton::judge_layout(markers, outcome.layout); !bad.empty()) {
    if (auto s = leave_out(job, bad, outcome); !s) return fail_at(job.input.string(), s.error());
  } else if (job.method == "articulated" && outcome.topology) {
    auto tree = largest_tree(outcome.layout, outcome.warnings);
    if (!tree) return of_recording(tree.error());
    outcome.layout = std::move(*tree);
  }
  return {};
}

Status leave_out(const JointsJob& job, std::span<const skeleton::Implausible> bad, JointsOutcome& outcome) {
  outcome.left_out.insert(outcome.left_out.end(), bad.begin(), bad.end());
  outcome.layout = skeleton::leave_out(outcome.layout, bad);
  if (outcome.layout.joints.empty()) return refuse(job, outcome);
  if (job.method != "articulated") return {};
  auto tree = largest_tree(outcome.layout, outcome.warnings);
  if (!tree) return refuse(job, outcome);
  outcome.layout = std::move(*tree);
  return {};
}

Error with_left_out(const JointsOutcome& outcome, const Error& error) {
  if (outcome.left_out.empty()) return error;
  Error out = error;
  std::vector<std::string> names;
  for (const auto& bad : outcome.left_out) names.push_back("'" + bad.name + "'");
  out.message += fmt::format(" (left out, as they are no body's: {})", join_some(names, kNamesListed));
  return out;
}

std::string propose_next_step(const JointsJob& job, const JointsOutcome& outcome) {
  std::vector<std::string> loose, joints;
  for (const auto& bad : outcome.left_out) {
    if (!bad.is_segment) joints.push_back("'" + bad.name + "'");
    for (const auto& marker : bad.markers)
      if (bad.is_segment && std::ranges::find(loose, marker) == loose.end()) loose.push_back(marker);
  }
  const std::string without =
      loose.empty() ? "" : fmt::format(", without the markers {}", join_names(loose, kNamesListed));
  if (job.segments.empty()) return fmt::format("Name the segments of the body in a file (--segments){}.", without);
  if (joints.empty()) return fmt::format("Name the segments{}.", without);
  return fmt::format("Look at the markers of both segments of {}, or leave {} out of the segments file{}.",
                     join_names(joints, kNamesListed), joints.size() == 1 ? "this joint" : "these joints", without);
}

}  // namespace kinemark::pipeline
