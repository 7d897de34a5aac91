// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/functional.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/skeleton/functional/description.h"
#include "kinemark/stages/skeleton/functional/internal/assemble.h"

namespace kinemark::skeleton {
namespace {

constexpr EnumNames<FunctionalMethod::constant_distance> kMethods{
    "score", "sara", "gamage", "gamage-plain", "cylinder", "constant-distance"};
constexpr EnumNames<Sides::child> kSides{"both", "parent", "child"};

data::SkeletonSegment describe_segment(const SegmentPoses& poses) {
  data::SkeletonSegment out;
  out.name = poses.name;
  out.kind = poses.kind;
  out.markers = poses.markers;
  out.x_in_segment = poses.x_in_segment;
  return out;
}

/// Noise of all markers together, from every segment with an estimate.
double common_noise(const std::vector<SegmentPoses>& poses) {
  double squares = 0.0, weight = 0.0;
  for (const SegmentPoses& p : poses) {
    if (p.known_frames == 0 || std::isnan(p.noise_sd_m)) continue;
    const double w = static_cast<double>(p.markers.size()) * 3.0 - 6.0;
    squares += w * p.noise_sd_m * p.noise_sd_m;
    weight += w;
  }
  return weight > 0.0 ? std::sqrt(squares / weight) : kNaN;
}

void warn_of_odd_frames(const SegmentPoses& poses, const TimeBase& time, data::Skeleton& skeleton) {
  if (poses.odd_frames == 0) return;
  skeleton.warnings.push_back(
      fmt::format("The markers of '{}' do not keep their shape in {} frames, first at {:.3f} s ({:.1f} mm "
                  "against {:.1f} mm "
                  "usually): labels swapped, or a marker elsewhere? These frames were left out.",
                  poses.name, poses.odd_frames, time.time_s(poses.first_odd_frame), 1e3 * poses.odd_rms_m,
                  1e3 * poses.usual_rms_m));
}

/// The report's centre carried into the segments' axes: mean over the frames it was found in.
void carry_into_segments(const ConstantDistanceFit& fit, const internal::JointTask& task, JointFit& out) {
  const auto carry = [&](const SegmentPoses& poses, int side) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double n = 0.0;
    for (std::size_t f = 0; f < poses.known.size(); ++f) {
      if (!poses.known[f] || fit.state[f] != data::CentreState::determined) continue;
      const Eigen::Vector3d p = poses.to_segment(static_cast<std::int64_t>(f), fit.centre_in_world[f]);
      sum += p;
      squares += p * p.transpose();
      n += 1.0;
    }
    if (n < 2.0) return false;
    const Eigen::Vector3d mean = sum / n;
    out.centre.segment<3>(3 * side) = mean;
    out.covariance.block<3, 3>(3 * side, 3 * side) = squares / n - mean * mean.transpose();
    return true;
  };
  out.in_parent = carry(task.parent, 0);
  out.in_child = carry(task.child, 1);
  out.repeatability = out.covariance;
  out.method = "constant distance";
}

/// Add one joint to the skeleton. Returns a sentence on failure or on deviations from the requested method,
/// else an empty one.
std::string find_joint(const Samples& samples, const internal::JointTask& task,
                       const FunctionalOptions& options, std::size_t j, data::Skeleton& skeleton,
                       bool& placed) {
  std::string why;
  data::SkeletonJoint& out = skeleton.joints[j];
  if (options.method == FunctionalMethod::constant_distance) {
    const auto fit =
        fit_constant_distance(samples, task.parent.markers, task.child.markers, options.constant_distance);
    if (!fit) return fit.error().message;
    JointFit carried;
    carry_into_segments(*fit, task, carried);
    internal::describe(carried, task.motion, out);
    if (!carried.in_parent && !carried.in_child)
      out.description =
          fmt::format("distances of the markers from the joint keep to {:.1f} mm", 1e3 * fit->distance_sd_m);
    internal::place_joint(*fit, j, skeleton);
    placed = true;
    if (fit->complete.size() < fit->markers.size())
      why = fmt::format(
          "no two frames show all {} markers; the distances are those of {} markers in {} of the {} frames "
          "that "
          "show these, and the others' follow from them",
          fit->markers.size(), fit->complete.size(), fit->chosen.size(), fit->complete_frames);
    return why;
  }
  const auto fit = internal::fit_joint(samples, task, options, why);
  if (!fit) return why;
  internal::describe(*fit, task.motion, out);
  internal::place_joint(samples, task, *fit, j, skeleton);
  placed = true;
  return why;
}

Status check_input(const data::Trajectories& trajectories, const data::SegmentLayout& layout,
                   const FunctionalOptions& options) {
  if (auto s = options.check(); !s) return s;
  if (auto s = trajectories.validate(); !s) return s;
  if (auto s = layout.validate(trajectories.markers()); !s) return s;
  const auto samples = static_cast<std::size_t>(trajectories.frames() * trajectories.markers());
  if (!options.mask.empty() && options.mask.size() != samples)
    return fail(Code::usage, fmt::format("mask of {} samples for {}", options.mask.size(), samples));
  if (layout.segments.size() < 2)
    return fail(
        Code::bad_input,
        fmt::format("all {} markers are on one segment; a joint needs two that move against each other",
                    trajectories.markers()));
  if (layout.joints.empty())
    return fail(Code::bad_input, fmt::format("{} segments and no joint between any", layout.segments.size()));
  return {};
}

}  // namespace

std::string_view to_string(FunctionalMethod method) { return kMethods[method]; }

Result<FunctionalMethod> parse_functional_method(std::string_view name) {
  return kMethods.parse(name, "method");
}

std::string_view to_string(Sides sides) { return kSides[sides]; }

Result<Sides> parse_sides(std::string_view name) { return kSides.parse(name, "side"); }

Status FunctionalOptions::check() const {
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage, fmt::format("marker noise of {} m; need 0 or more", noise_sd_m));
  return constant_distance.check();
}

Result<data::Skeleton> find_joints(const data::Trajectories& trajectories, const data::SegmentLayout& layout,
                                   const FunctionalOptions& options) {
  if (auto s = check_input(trajectories, layout, options); !s) return std::unexpected(s.error());
  const Samples samples{trajectories, options.mask};
  data::Skeleton skeleton;
  skeleton.markers = trajectories.names;
  skeleton.time = trajectories.time;
  std::vector<SegmentPoses> poses;
  for (const auto& segment : layout.segments) {
    poses.push_back(
        find_segment_poses(samples, segment.name, segment.markers, {.noise_sd_m = options.noise_sd_m}));
    skeleton.segments.push_back(describe_segment(poses.back()));
    warn_of_odd_frames(poses.back(), trajectories.time, skeleton);
  }
  const double noise = options.noise_sd_m > 0.0 ? options.noise_sd_m : common_noise(poses);
  skeleton.noise_sd_m = noise;
  for (SegmentPoses& p : poses)
    if (std::isnan(p.noise_sd_m)) p.noise_sd_m = noise;
  for (const auto& joint : layout.joints) {
    data::SkeletonJoint out;
    out.name = joint.name;
    out.parent_segment = joint.parent;
    out.child_segment = joint.child;
    out.covariance_in_parent.setConstant(kNaN);
    out.covariance_in_child.setConstant(kNaN);
    out.range_of_motion_rad = kNaN;
    out.description = "nothing can be known";
    skeleton.joints.push_back(std::move(out));
  }
  skeleton.allocate_centres();
  bool any = false;
  std::string first;
  for (std::size_t j = 0; j < layout.joints.size(); ++j) {
    const auto& joint = layout.joints[j];
    const SegmentPoses& parent = poses[static_cast<std::size_t>(joint.parent)];
    const SegmentPoses& child = poses[static_cast<std::size_t>(joint.child)];
    const internal::JointTask task{joint, parent, child, measure_motion(parent, child)};
    bool placed = false;
    const std::string why = find_joint(samples, task, options, j, skeleton, placed);
    any = any || placed;
    if (why.empty()) continue;
    skeleton.warnings.push_back(fmt::format("Joint '{}': {}.", joint.name, why));
    if (first.empty()) first = fmt::format("joint '{}': {}", joint.name, why);
  }
  if (!any) return fail(Code::bad_input, first);
  internal::add_lengths(skeleton);
  return skeleton;
}

}  // namespace kinemark::skeleton
