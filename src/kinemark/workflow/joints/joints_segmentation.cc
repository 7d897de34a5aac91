// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/joints_segmentation.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/skeleton/topology/marker_sets.h"

namespace kinemark::workflow {
namespace {

constexpr std::size_t kMarkersNamed = 8;
constexpr double kLeastSpreadSaid_m = 0.05e-3;  ///< less is 0.0 mm
constexpr skeleton::SegmentationOptions kRules;

std::vector<std::string> names_of(const std::vector<int>& which, const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const int m : which) out.push_back(names[at(m)]);
  return out;
}

/// Some of the markers of a recording.
data::Trajectories pick(const data::Trajectories& all, const std::vector<int>& which) {
  auto out = data::Trajectories::all_missing(names_of(which, all.names), all.time);
  for (std::int64_t f = 0; f < all.frames(); ++f)
    for (std::size_t k = 0; k < which.size(); ++k) {
      const auto m = static_cast<std::int64_t>(k);
      if (!all.present(f, which[k])) continue;
      out.x(f, m) = all.x(f, which[k]);
      out.state[out.index(f, m)] = all.state[all.index(f, which[k])];
    }
  return out;
}

void renumber(std::vector<int>& markers, const std::vector<int>& which) {
  for (int& m : markers) m = which[at(m)];
}

/// What was found of some of the markers, in the numbers of all.
void renumber(skeleton::Topology& topology, const std::vector<int>& which, std::size_t all) {
  for (auto& segment : topology.layout.segments) renumber(segment.markers, which);
  std::vector<skeleton::MarkerEvidence> evidence(all);
  for (std::size_t k = 0; k < which.size(); ++k) evidence[at(which[k])] = topology.markers[k];
  topology.markers = std::move(evidence);
  renumber(topology.left_out, which);
  for (auto& [a, b] : topology.never_together) {
    a = which[at(a)];
    b = which[at(b)];
  }
}

void renumber(skeleton::Segmentation& found, const std::vector<int>& which) {
  for (auto& segment : found.layout.segments) renumber(segment.markers, which);
  renumber(found.unplaced, which);
  for (auto& joint : found.joints) {
    renumber(joint.parent, which);
    renumber(joint.child, which);
    for (auto& rival : joint.rivals) {
      renumber(rival.parent, which);
      renumber(rival.child, which);
    }
  }
}

/// Variance of an estimate for each axis, the worst side; across the axis of a hinge.
double worst_sd(const data::SkeletonJoint& joint) {
  double worst = 0.0;
  for (const auto* c : {&joint.covariance_in_parent, &joint.covariance_in_child}) {
    if (!c->allFinite()) return std::numeric_limits<double>::infinity();
    const Eigen::Vector3d v =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(*c, Eigen::EigenvaluesOnly).eigenvalues();
    worst = std::max(worst, joint.kind == data::JointKind::hinge ? (v[0] + v[1]) / 2.0 : v.sum() / 3.0);
  }
  return std::sqrt(worst);
}

/// The spread of rivals is an error of the place in a direction that nobody knows.
void add_spread(data::Skeleton& skeleton, std::size_t j, double spread_m) {
  auto& joint = skeleton.joints[j];
  const double variance = spread_m * spread_m / (joint.kind == data::JointKind::hinge ? 2.0 : 3.0);
  const Eigen::Matrix3d more = variance * Eigen::Matrix3d::Identity();
  joint.covariance_in_parent += more;
  joint.covariance_in_child += more;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    double* c = skeleton.covariance.data() + 6 * skeleton.index(f, static_cast<std::int64_t>(j));
    for (const int diagonal : {0, 3, 5}) c[diagonal] += variance;
  }
  for (auto& length : skeleton.lengths)
    if (at(length.joint_a) == j || at(length.joint_b) == j)
      length.sd_m = std::hypot(length.sd_m, std::sqrt(variance));
  if (spread_m < kLeastSpreadSaid_m) return;
  joint.description += fmt::format(
      "; rivals of its segmentation place it {:.1f} mm away (RMS), which widens this to {:.1f} mm and is in "
      "the SD",
      1e3 * spread_m, 1e3 * worst_sd(joint));
}

/// Joints of the layout that the skeleton has, and their segments.
void keep_known(const data::Skeleton& skeleton, data::SegmentLayout& layout) {
  std::erase_if(layout.joints, [&](const auto& joint) {
    return std::ranges::find(skeleton.joints, joint.name, &data::SkeletonJoint::name) ==
           skeleton.joints.end();
  });
  data::SegmentLayout kept;
  std::vector<int> number(layout.segments.size(), -1);
  for (std::size_t s = 0; s < layout.segments.size(); ++s) {
    const bool used = std::ranges::any_of(
        layout.joints, [&](const auto& joint) { return at(joint.parent) == s || at(joint.child) == s; });
    if (!used) continue;
    number[s] = static_cast<int>(kept.segments.size());
    kept.segments.push_back(std::move(layout.segments[s]));
  }
  for (auto& joint : layout.joints)
    kept.joints.push_back({joint.name, number[at(joint.parent)], number[at(joint.child)]});
  layout = std::move(kept);
}

std::vector<std::string> words_of(const JointsFound& outcome) {
  const auto& found = *outcome.segmentation;
  const auto& names = outcome.markers;
  std::vector<std::string> out{describe_origin(found)};
  const auto list = [&](const std::vector<int>& which) {
    return join_names(names_of(which, names), kMarkersNamed);
  };
  if (!found.model_outputs.empty())
    out.push_back(fmt::format("Points that a model made of markers, by their names, were left out: {}.",
                              list(found.model_outputs)));
  for (const auto& aside : found.aside)
    out.push_back(
        fmt::format("Marker '{}' was put aside: its name says {}, but its distances to the markers there "
                    "vary by {:.0f} mm (median SD).",
                    names[at(aside.marker)], aside.segment, 1e3 * aside.distance_sd_m));
  if (!found.over_joints.empty())
    out.push_back(fmt::format("On neither side of a joint, as they lie over it or beside it: {}.",
                              list(found.over_joints)));
  if (!found.unplaced.empty())
    out.push_back(fmt::format("On no segment of a joint that was looked for: {}.", list(found.unplaced)));
  return out;
}

}  // namespace

Result<data::SegmentLayout> find_segmentation(const JointsOptions& options, const data::Trajectories& markers,
                                              JointsFound& outcome) {
  auto named = skeleton::segment_by_names(markers, kRules);
  if (!named) return std::unexpected(named.error());
  if (*named) {
    outcome.segmentation = std::move(**named);
    return outcome.segmentation->layout;
  }
  std::vector<int> which, outputs;
  const auto is_output = skeleton::find_model_outputs(markers.names);
  for (int m = 0; m < static_cast<int>(markers.markers()); ++m)
    (is_output[at(m)] ? outputs : which).push_back(m);
  const auto chosen = pick(markers, which);
  skeleton::TopologyOptions topology_options;
  topology_options.noise_sd_m = options.noise_sd_m;
  auto topology = skeleton::find_topology(chosen, topology_options);
  if (!topology) return std::unexpected(topology.error());
  if (topology->layout.segments.size() < 2)
    return fail(Code::bad_input,
                fmt::format("all {} markers keep their distances: they are on one segment, or "
                            "nothing moved, so no joint can be found",
                            chosen.markers()));
  auto found = skeleton::segment_by_data(chosen, *topology, kRules);
  if (!found) return std::unexpected(found.error());
  renumber(*found, which);
  renumber(*topology, which, at(markers.markers()));
  found->model_outputs = std::move(outputs);
  outcome.topology = std::move(*topology);
  outcome.segmentation = std::move(*found);
  return outcome.segmentation->layout;
}

std::string describe_origin(const skeleton::Segmentation& found) {
  const auto known = std::ranges::count_if(found.joints, &skeleton::JudgedJoint::known);
  const std::string joints = fmt::format("{} of {} joints are known", known, found.joints.size());
  if (found.from_names)
    return fmt::format("Segments from the markers' names ({}); {}.", join_names(found.sets, kMarkersNamed),
                       joints);
  return fmt::format(
      "Segments from how the markers move, as their names are of no known set: {} segmentation{} "
      "compared; {}.",
      found.rivals, found.rivals == 1 ? "" : "s", joints);
}

void settle_segmentation(JointsFound& outcome) {
  if (!outcome.segmentation) return;
  auto& found = *outcome.segmentation;
  auto& skeleton = outcome.skeleton;
  std::map<std::string, std::string> left_out;
  for (const auto& bad : outcome.left_out) left_out[bad.name] = bad.description();
  std::vector<std::uint8_t> keep(skeleton.joints.size(), 0);
  for (auto& joint : found.joints) {
    if (!joint.known) continue;
    const auto is = std::ranges::find(skeleton.joints, joint.name, &data::SkeletonJoint::name);
    if (is == skeleton.joints.end()) {
      joint.known = false;
      const auto why = std::ranges::find_if(left_out, [&](const auto& bad) {
        return bad.first == joint.name || bad.first == joint.parent_name || bad.first == joint.child_name;
      });
      joint.reason = why == left_out.end() ? "no centre fits its markers" : why->second;
      continue;
    }
    const auto j = static_cast<std::size_t>(is - skeleton.joints.begin());
    add_spread(skeleton, j, joint.spread_m);
    if (const double sd = worst_sd(*is); !(sd <= kRules.most_sd_m)) {
      joint.known = false;
      joint.reason =
          std::isfinite(sd)
              ? fmt::format("the markers leave it open by {:.0f} mm (SD for each axis{}; {:.0f} at most)",
                            1e3 * sd, is->kind == data::JointKind::hinge ? ", across the hinge's" : "",
                            1e3 * kRules.most_sd_m)
              : "no markers tell how well it is known";
      continue;
    }
    keep[j] = 1;
  }
  std::ranges::stable_partition(found.joints, &skeleton::JudgedJoint::known);
  skeleton = keep_joints(skeleton, keep);
  keep_known(skeleton, outcome.layout);
  std::vector<std::string> words = words_of(outcome);
  for (const auto& joint : found.joints) {
    if (joint.known) continue;
    outcome.remarks.gates.push_back({.name = "determined",
                                     .passed = false,
                                     .value = 0.0,
                                     .bound = 1.0,
                                     .unit = "joints",
                                     .sentence = joint.sentence(outcome.markers)});
    words.push_back(outcome.remarks.gates.back().sentence);
  }
  if (skeleton.joints.empty()) {
    outcome.remarks.gates.push_back(
        {.name = "any_joint",
         .passed = false,
         .value = 0.0,
         .bound = 1.0,
         .unit = "joints",
         .sentence = "No joint is determined. Name the segments of the body in a file "
                     "(--segments), or record a movement of the joint with three markers or "
                     "more, not in a line, on either side."});
    words.push_back(outcome.remarks.gates.back().sentence);
  }
  outcome.remarks.warnings.insert(outcome.remarks.warnings.begin(), words.begin(), words.end());
}

data::Skeleton keep_joints(const data::Skeleton& skeleton, const std::vector<std::uint8_t>& keep) {
  if (std::ranges::all_of(keep, [](auto k) { return k != 0; })) return skeleton;
  data::Skeleton out;
  out.markers = skeleton.markers;
  out.time = skeleton.time;
  out.noise_sd_m = skeleton.noise_sd_m;
  std::ranges::copy_if(skeleton.warnings, std::back_inserter(out.warnings), [&](const auto& warning) {
    for (std::size_t j = 0; j < keep.size(); ++j)
      if (!keep[j] && warning.contains(fmt::format("'{}'", skeleton.joints[j].name))) return false;
    return true;
  });
  std::vector<int> segment(skeleton.segments.size(), -1), joint(skeleton.joints.size(), -1);
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
    if (keep[j])
      for (const int s : {skeleton.joints[j].parent_segment, skeleton.joints[j].child_segment})
        segment[at(s)] = 0;
  for (std::size_t s = 0; s < segment.size(); ++s) {
    if (segment[s] < 0) continue;
    segment[s] = static_cast<int>(out.segments.size());
    out.segments.push_back(skeleton.segments[s]);
  }
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (!keep[j]) continue;
    joint[j] = static_cast<int>(out.joints.size());
    out.joints.push_back(skeleton.joints[j]);
    out.joints.back().parent_segment = segment[at(skeleton.joints[j].parent_segment)];
    out.joints.back().child_segment = segment[at(skeleton.joints[j].child_segment)];
  }
  for (auto length : skeleton.lengths) {
    length.joint_a = joint[at(length.joint_a)];
    length.joint_b = joint[at(length.joint_b)];
    if (length.joint_a >= 0 && length.joint_b >= 0) out.lengths.push_back(std::move(length));
  }
  out.allocate_centres();
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      if (!keep[j]) continue;
      const std::size_t from = skeleton.index(f, static_cast<std::int64_t>(j)), to = out.index(f, joint[j]);
      out.state[to] = skeleton.state[from];
      std::copy_n(skeleton.centre_in_world.data() + 3 * from, 3, out.centre_in_world.data() + 3 * to);
      std::copy_n(skeleton.covariance.data() + 6 * from, 6, out.covariance.data() + 6 * to);
    }
  return out;
}

}  // namespace kinemark::workflow
