// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/plausibility/plausibility.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/functional/score.h"

namespace kinemark::skeleton {
namespace {

constexpr EnumNames<BodyFigure::noise> kFigures{"shape", "spread", "gap",  "distance",
                                                "reach", "length", "noise"};
constexpr double kMm = 1e3;
/// Joints whose figure is this share of the worst or more are left out with it: what a bad joint does to its
/// neighbours is less.
constexpr double kWithWorst = 0.5;

double number_or_infinity(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

std::vector<std::string> names_of(const std::vector<std::string>& names, const std::vector<int>& which) {
  std::vector<std::string> out;
  for (const int m : which) out.push_back(names[at(m)]);
  return out;
}

/// Markers of both segments of a joint.
template <class Segments>
std::vector<std::string> markers_of(const std::vector<std::string>& names, const Segments& segments,
                                    int parent, int child) {
  auto out = names_of(names, segments[at(parent)].markers);
  const auto more = names_of(names, segments[at(child)].markers);
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

double spread_of(const Eigen::Matrix3Xd& x) {
  double widest = 0.0;
  for (Eigen::Index a = 0; a < x.cols(); ++a)
    for (Eigen::Index b = 0; b < a; ++b)
      if (const double d = (x.col(a) - x.col(b)).norm(); d > widest) widest = d;
  return widest;
}

/// RMS change of the distances between a joint and the markers of its segments, over the frames that place
/// it.
double distance_change(const data::Trajectories& markers, const data::Skeleton& skeleton, std::size_t j) {
  const auto& joint = skeleton.joints[j];
  double worst = 0.0;
  for (const int s : {joint.parent_segment, joint.child_segment})
    for (const int m : skeleton.segments[at(s)].markers) {
      double n = 0.0, sum = 0.0, squares = 0.0;
      for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
        const auto state = skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))];
        if (state != data::CentreState::determined || !markers.present(f, m)) continue;
        const double d = (markers.x(f, m) - skeleton.centre(f, static_cast<std::int64_t>(j))).norm();
        n += 1.0;
        sum += d;
        squares += d * d;
      }
      if (n < 2.0) continue;
      worst =
          std::max(worst, number_or_infinity(std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)))));
    }
  return worst;
}

/// Distance of a joint from the nearest marker of the segment that it is farther from.
double reach_of(const data::Skeleton& skeleton, std::size_t j) {
  const auto& joint = skeleton.joints[j];
  double reach = 0.0;
  for (const bool parent : {true, false}) {
    const auto& covariance = parent ? joint.covariance_in_parent : joint.covariance_in_child;
    const auto& x = skeleton.segments[at(parent ? joint.parent_segment : joint.child_segment)].x_in_segment;
    if (!covariance.allFinite() || x.cols() == 0) continue;
    const Eigen::Vector3d& centre = parent ? joint.centre_in_parent : joint.centre_in_child;
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < x.cols(); ++k)
      if (const double d = (x.col(k) - centre).norm(); d < nearest) nearest = d;
    reach = std::max(reach, nearest);
  }
  return reach;
}

/// What is left of the worst of each kind, and of what is nearly as bad.
void keep_worst(std::vector<Implausible>& found) {
  double worst = 0.0;
  for (const auto& f : found) worst = std::max(worst, f.value_m);
  std::erase_if(found, [&](const Implausible& f) { return f.value_m < kWithWorst * worst; });
}

/// One joint in the words of a figure.
Implausible joint_found(const data::Skeleton& skeleton, std::size_t j, BodyFigure figure, double value_m,
                        double least_m, double most_m) {
  const auto& joint = skeleton.joints[j];
  return {
      .name = joint.name,
      .other = {},
      .figure = figure,
      .value_m = value_m,
      .least_m = least_m,
      .most_m = most_m,
      .markers = markers_of(skeleton.markers, skeleton.segments, joint.parent_segment, joint.child_segment)};
}

/// Trace of a joint's covariance, in the segment that knows it less.
double doubt_of(const data::SkeletonJoint& joint) {
  const auto trace = [](const Eigen::Matrix3d& c) { return c.allFinite() ? c.trace() : 0.0; };
  return std::max(trace(joint.covariance_in_parent), trace(joint.covariance_in_child));
}

void judge_lengths(const data::Skeleton& skeleton, const PlausibilityOptions& options,
                   const std::vector<double>& change, std::vector<Implausible>& found) {
  for (const auto& length : skeleton.lengths) {
    if (length.length_m >= options.least_length_m && length.length_m <= options.most_length_m) continue;
    const auto a = at(length.joint_a), b = at(length.joint_b);
    const double doubt_a = doubt_of(skeleton.joints[a]), doubt_b = doubt_of(skeleton.joints[b]);
    const bool first = doubt_a != doubt_b ? doubt_a > doubt_b : change[a] > change[b];
    found.push_back(joint_found(skeleton, first ? a : b, BodyFigure::length,
                                number_or_infinity(length.length_m), options.least_length_m,
                                options.most_length_m));
    found.back().other = skeleton.joints[first ? b : a].name;
  }
}

}  // namespace

std::string_view to_string(BodyFigure figure) { return kFigures[figure]; }

Status PlausibilityOptions::check() const {
  if (!(most_noise_m > 0.0) || !std::isfinite(most_noise_m))
    return fail(Code::usage, fmt::format("noise of {} m at most; need more than 0", most_noise_m));
  if (!(least_length_m >= 0.0) || !(most_length_m > least_length_m) || !std::isfinite(most_length_m))
    return fail(Code::usage, fmt::format("lengths from {} to {} m; need 0 or more, then more", least_length_m,
                                         most_length_m));
  return {};
}

std::string Implausible::description() const {
  const std::string value =
      std::isfinite(value_m) ? fmt::format("{:.{}f} mm", kMm * value_m, value_m < 0.1 ? 1 : 0) : "no number";
  const std::string who = fmt::format("{} '{}'", is_segment ? "segment" : "joint", name);
  const std::string most = fmt::format("{:.0f} mm or less is expected of a body", kMm * most_m);
  switch (figure) {
    case BodyFigure::shape:
      return fmt::format("{}: its markers leave a rigid shape by {} (RMS per axis); {}", who, value, most);
    case BodyFigure::spread:
      return fmt::format("{}: two of its markers are {} apart; {}", who, value, most);
    case BodyFigure::gap:
      return fmt::format("{}: its two segments place it {} apart (RMS per axis); {}", who, value, most);
    case BodyFigure::distance:
      return fmt::format("{}: its distance from a marker of its segments changes by {} (RMS); {}", who, value,
                         most);
    case BodyFigure::reach:
      return fmt::format("{}: it lies {} from the nearest marker of a segment; {}", who, value, most);
    case BodyFigure::noise:
      return fmt::format("{}: with it the markers' noise is {} per axis; {}", who, value, most);
    case BodyFigure::length:
      break;
  }
  return fmt::format(
      "{}: it lies {} from joint '{}' of the same segment; {:.0f} to {:.0f} mm are expected of a body", who,
      value, other, kMm * least_m, kMm * most_m);
}

std::string Implausible::sentence() const {
  std::string out = description() + ".";
  out.front() = is_segment ? 'S' : 'J';
  return out;
}

std::vector<Implausible> judge_layout(const data::Trajectories& markers, const data::SegmentLayout& layout,
                                      const PlausibilityOptions& options) {
  const Samples samples{markers, {}};
  std::vector<Implausible> found;
  std::vector<SegmentPoses> poses;
  std::vector<std::uint8_t> bad;
  for (const auto& segment : layout.segments) {
    poses.push_back(find_segment_poses(samples, segment.name, segment.markers));
    const double noise = poses.back().noise_sd_m, spread = spread_of(poses.back().x_in_segment);
    const auto add = [&](BodyFigure figure, double value, double most) {
      found.push_back({.is_segment = true,
                       .name = segment.name,
                       .other = {},
                       .figure = figure,
                       .value_m = value,
                       .most_m = most,
                       .markers = names_of(markers.names, segment.markers)});
    };
    const auto before = found.size();
    if (noise > options.most_noise_m)
      add(BodyFigure::shape, noise, options.most_noise_m);
    else if (spread > options.most_length_m)
      add(BodyFigure::spread, spread, options.most_length_m);
    bad.push_back(found.size() > before);
  }
  for (const auto& joint : layout.joints) {
    const auto &a = poses[at(joint.parent)], &b = poses[at(joint.child)];
    if (bad[at(joint.parent)] || bad[at(joint.child)]) continue;
    const RelativeMotion motion = measure_motion(a, b);
    const JointFit fit = fit_score(samples, a, b, motion, data::JointKind::ball);
    if (!fit.in_parent) continue;
    const double gap = number_or_infinity(fit.residual_rms_m / std::numbers::sqrt3);
    if (gap > options.most_noise_m)
      found.push_back({.name = joint.name,
                       .other = {},
                       .figure = BodyFigure::gap,
                       .value_m = gap,
                       .most_m = options.most_noise_m,
                       .markers = markers_of(markers.names, layout.segments, joint.parent, joint.child)});
  }
  return found;
}

std::vector<Implausible> judge_skeleton(const data::Trajectories& markers, const data::Skeleton& skeleton,
                                        const PlausibilityOptions& options) {
  std::vector<Implausible> changing, far, lengths;
  std::vector<double> change;
  std::size_t worst = 0;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    change.push_back(distance_change(markers, skeleton, j));
    if (change[j] > change[worst]) worst = j;
    if (change[j] > options.most_noise_m)
      changing.push_back(
          joint_found(skeleton, j, BodyFigure::distance, change[j], 0.0, options.most_noise_m));
    if (const double reach = number_or_infinity(reach_of(skeleton, j)); reach > options.most_length_m)
      far.push_back(joint_found(skeleton, j, BodyFigure::reach, reach, 0.0, options.most_length_m));
  }
  judge_lengths(skeleton, options, change, lengths);
  if (!changing.empty()) {
    keep_worst(changing);
    return changing;
  }
  if (!far.empty()) return far;
  if (!lengths.empty()) return lengths;
  if (skeleton.noise_sd_m > options.most_noise_m && !skeleton.joints.empty())
    return {joint_found(skeleton, worst, BodyFigure::noise, skeleton.noise_sd_m, 0.0, options.most_noise_m)};
  return {};
}

data::SegmentLayout leave_out(const data::SegmentLayout& layout, std::span<const Implausible> what) {
  const auto named = [&](bool segment, const std::string& name) {
    return std::ranges::any_of(
        what, [&](const Implausible& w) { return w.is_segment == segment && w.name == name; });
  };
  data::SegmentLayout out;
  std::vector<int> number(layout.segments.size(), -1);
  for (std::size_t s = 0; s < layout.segments.size(); ++s) {
    if (named(true, layout.segments[s].name)) continue;
    number[s] = static_cast<int>(out.segments.size());
    out.segments.push_back(layout.segments[s]);
  }
  for (const auto& joint : layout.joints) {
    const int parent = number[at(joint.parent)], child = number[at(joint.child)];
    if (parent >= 0 && child >= 0 && !named(false, joint.name))
      out.joints.push_back({joint.name, parent, child});
  }
  return out;
}

}  // namespace kinemark::skeleton
