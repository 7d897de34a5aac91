// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/articulated.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/data/filtering.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/articulated/chain/joint_tree.h"
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"
#include "kinemark/stages/skeleton/articulated/geometry/hold_hinges.h"
#include "kinemark/stages/skeleton/articulated/recording/continuity.h"
#include "kinemark/stages/skeleton/articulated/recording/findings.h"
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"
#include "kinemark/stages/skeleton/articulated/recording/skin.h"

namespace kinemark::skeleton {
namespace {

using articulated::ChainFitOptions;
using articulated::ChainSamples;
using articulated::FittedChain;
using articulated::HingeAxis;
using data::CentreState;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRobustDof =
    30.0;  // of Student's t: lowers weights beyond some five SDs, costs nothing below
constexpr double kMm = 1e3;
constexpr std::size_t kSegmentsNamed = 8;

/// The noise of filtered markers follows itself in time: frames nearer to each other than a filter lets
/// through say the same twice.
struct NoiseInTime {
  bool filtered = false;
  std::int64_t frames = 0;  ///< of the recording whose noise is independent
};

NoiseInTime noise_in_time(const data::Trajectories& markers) {
  NoiseInTime out{.frames = markers.frames()};
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    if (!data::was_filtered(markers, m)) continue;
    out.filtered = true;
    const double apart = markers.time.rate_hz / (2.0 * markers.filters[at(m)].cutoff_hz);
    if (apart > 1.0)
      out.frames = std::min(
          out.frames, static_cast<std::int64_t>(std::ceil(static_cast<double>(markers.frames()) / apart)));
  }
  return out;
}

/// Everything that is known on the direction, in the chain's order of segments and joints.
struct Work {
  const data::Trajectories& markers;
  const data::SegmentLayout& layout;
  const ArticulatedOptions& options;
  articulated::JointTree tree;
  articulated::ChainInput input;
  FittedChain fit;
  articulated::RecordingPass pass;
  articulated::Continuity continuity;
  NoiseInTime noise;
};

Status check_input(const data::Trajectories& markers, const data::SegmentLayout& layout,
                   const ArticulatedOptions& options) {
  if (auto s = markers.validate(); !s) return s;
  if (auto s = options.check(); !s) return s;
  if (auto s = layout.validate(markers.markers()); !s) return s;
  if (auto s = articulated::check_tree(layout); !s) return s;
  if (!options.kinds.empty() && options.kinds.size() != layout.segments.size())
    return fail(Code::usage, fmt::format("{} kinds for {} segments; need one each", options.kinds.size(),
                                         layout.segments.size()));
  std::size_t count = 0;
  for (const auto& s : layout.segments) count += s.markers.size();
  if (count < 3)
    return fail(Code::bad_input,
                fmt::format("{} markers in all; a joint between two segments needs three or more", count));
  return {};
}

ChainFitOptions fit_options(const Work& w) {
  ChainFitOptions out;
  out.noise_sd_m = w.options.noise_sd_m;
  out.robust_dof = w.options.robust ? kRobustDof : 0.0;
  out.frames_max = static_cast<int>(std::min<std::int64_t>(w.options.max_fit_frames, w.noise.frames));
  out.marker_noise = w.options.soft_tissue;
  out.most_noise_m = w.options.most_noise_m;
  out.most_reach_m = w.options.most_reach_m;
  out.most_change_m = w.options.most_change_m;
  out.threads = w.options.threads;
  if (!w.options.kinds.empty())
    for (const int s : w.tree.segment_order) out.kind.push_back(w.options.kinds[at(s)]);
  for (const int m : w.input.marker) out.marker_names.push_back(w.markers.names[at(m)]);
  return out;
}

/// Take markers whose position on their segment is not known out of all frames.
void blank_dropped_markers(const FittedChain& fit, ChainSamples& samples) {
  for (int m = 0; m < samples.markers; ++m) {
    if (fit.marker_weight[at(m)] > 0.0) continue;
    for (std::int64_t f = 0; f < samples.frames; ++f)
      std::fill_n(samples.x.data() + 3 * (f * samples.markers + m), 3,
                  std::numeric_limits<double>::quiet_NaN());
  }
}

data::SkeletonSegment describe_segment(const Work& w, int chain_segment) {
  const int s = w.tree.segment_order[at(chain_segment)];
  data::SkeletonSegment out{.name = w.layout.segments[at(s)].name,
                            .kind = w.fit.chain.kind[at(chain_segment)]};
  std::vector<int> placed;
  for (const int m : w.fit.chain.layout.markers_of(chain_segment))
    if (w.fit.marker_weight[at(m)] > 0.0) placed.push_back(m);  // the others' positions are not known
  out.x_in_segment.resize(3, static_cast<Eigen::Index>(placed.size()));
  for (std::size_t i = 0; i < placed.size(); ++i) {
    out.markers.push_back(w.input.marker[at(placed[i])]);
    out.x_in_segment.col(static_cast<Eigen::Index>(i)) = w.fit.chain.marker.col(placed[i]);
  }
  return out;
}

/// An axis that can be named: lines show none, and noise alone has none.
bool shows_axis(const articulated::ObservedMotion& seen) {
  return !seen.still && seen.axis_in_parent.squaredNorm() > 0.0;
}

bool is_hinge(const Work& w, const articulated::ObservedMotion& seen) {
  return shows_axis(seen) && (w.options.joint == data::JointChoice::hinge ||
                              (w.options.joint == data::JointChoice::automatic && seen.one_axis));
}

Status pass_over(Work& w, const Progress& progress) {
  auto pass = articulated::pass_over(w.fit, w.input.samples, w.options.threads, progress);
  if (!pass) return std::unexpected(pass.error());
  w.pass = std::move(*pass);
  return {};
}

/// Hinges whose position along the axis the motion leaves open. One that was asked for may rotate about other
/// axes too; its position is then known.
std::vector<HingeAxis> find_open_hinges(const Work& w) {
  std::vector<HingeAxis> out;
  for (int j = 0; j < w.fit.chain.joints(); ++j)
    if (const auto seen = articulated::observe_motion(w.fit, w.pass, j); seen.one_axis && is_hinge(w, seen))
      out.push_back({.joint = j, .in_parent = seen.axis_in_parent, .in_child = seen.axis_in_child});
  return out;
}

data::SkeletonJoint describe_joint(const Work& w, int j, const articulated::ObservedMotion& seen,
                                   double common_sd_m) {
  const int layout_joint = w.tree.joint_order[at(j)];
  const auto& named = w.layout.joints[at(layout_joint)];
  data::SkeletonJoint out{.name = named.name, .parent_segment = named.parent, .child_segment = named.child};
  const bool hinge = is_hinge(w, seen);
  out.kind = hinge ? data::JointKind::hinge : data::JointKind::ball;
  out.range_of_motion_rad = seen.range_rad;
  out.method = "articulated";
  out.description = articulated::describe_motion(seen, hinge, common_sd_m);
  // The chain may see the joint from its other side.
  const bool reversed = w.tree.holder[at(layout_joint)] != named.parent;
  Vector3d above = w.fit.chain.joint.col(j), below = Vector3d::Zero();
  Matrix3d above_C = w.fit.joint_covariance(j, true), below_C = w.fit.joint_covariance(j, false);
  Vector3d above_axis = seen.axis_in_parent, below_axis = seen.axis_in_child;
  if (reversed) {
    std::swap(above, below);
    std::swap(above_C, below_C);
    std::swap(above_axis, below_axis);
  }
  out.centre_in_parent = above;
  out.centre_in_child = below;
  out.covariance_in_parent = above_C;
  out.covariance_in_child = below_C;
  out.repeatability_in_parent = above_C;
  out.repeatability_in_child = below_C;
  if (hinge) {
    out.axis_in_parent = above_axis;
    out.axis_in_child = below_axis;
    out.axis_sd_rad = seen.axis_sd_rad;
    out.axis_covariance_in_parent =
        seen.axis_sd_rad * seen.axis_sd_rad *
        (Matrix3d::Identity() - out.axis_in_parent * out.axis_in_parent.transpose());
    out.axis_repeatability_in_parent = out.axis_covariance_in_parent;
  }
  return out;
}

/// Mean over determined frames of the error that all of them share, m^2 (trace).
double common_variance(const Work& w, int j) {
  double sum = 0.0, n = 0.0;
  for (std::size_t f = 0; f < w.pass.state[at(j)].size(); ++f) {
    if (w.pass.state[at(j)][f] != CentreState::determined) continue;
    sum += math::symmetric3_trace(w.pass.common[at(j)].data() + 6 * f);
    n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

void widen_hinge(const Work& w, data::Skeleton& skeleton, int j) {
  const int layout_joint = w.tree.joint_order[at(j)];
  const data::SkeletonJoint& joint = skeleton.joints[at(layout_joint)];
  const bool reversed = w.tree.holder[at(layout_joint)] != joint.parent_segment;
  articulated::widen_along_axis(w.pass.sampled, w.fit.chain.layout.parent[at(j)],
                                reversed ? joint.axis_in_child : joint.axis_in_parent, layout_joint,
                                w.fit.chain.scale(), skeleton);
}

/// One joint's centres, by its own frames or by its path.
void write_centres(const Work& w, int j, data::Skeleton& skeleton, JointSummary& summary) {
  const int layout_joint = w.tree.joint_order[at(j)];
  const articulated::SmoothedPath& path = w.continuity.path[at(j)];
  const double shared = common_variance(w, j) / 3.0;
  const double widest = w.options.max_bridge_sd_m * w.options.max_bridge_sd_m;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const auto k = static_cast<std::size_t>(f);
    const std::size_t to = skeleton.index(f, layout_joint);
    CentreState state = w.pass.state[at(j)][k];
    Vector3d centre = w.pass.points[at(j)][k].position;
    const bool alone = state == CentreState::determined;
    Matrix3d C = state == CentreState::undetermined
                     ? Matrix3d::Zero()
                     : articulated::load_symmetric(w.pass.covariance[at(j)].data() + 6 * k);
    if (!path.position.empty() && path.known(k) && !(alone && w.noise.filtered)) {
      const Matrix3d own = path.covariance_at(k);
      if (alone || own.trace() < widest) {
        state = alone ? CentreState::determined : CentreState::bridged;
        centre = path.position[k];
        C = own + (alone ? articulated::load_symmetric(w.pass.common[at(j)].data() + 6 * k)
                         : Matrix3d(shared * Matrix3d::Identity()));
      }
    }
    switch (state) {
      case CentreState::determined:
        ++summary.determined;
        break;
      case CentreState::bridged:
        ++summary.bridged;
        break;
      case CentreState::ambiguous:
        ++summary.ambiguous;
        break;
      case CentreState::undetermined:
        ++summary.undetermined;
        break;
    }
    skeleton.state[to] = state;
    if (state == CentreState::undetermined) continue;
    std::copy_n(centre.data(), 3, skeleton.centre_in_world.data() + 3 * to);
    articulated::store_symmetric(skeleton.covariance.data() + 6 * to, C);
  }
  summary.common_sd_m = std::sqrt(3.0 * shared);
  summary.white_jerk = path.position.empty() ? 0.0 : w.continuity.prior[at(j)].white_jerk;
}

/// Along a hinge's axis its position is not known, nor is that part of a length from it.
double open_variance(const Work& w, const data::Skeleton& skeleton, const FittedChain::Length& length,
                     int chain_joint) {
  const auto& joint = skeleton.joints[at(w.tree.joint_order[at(chain_joint)])];
  if (joint.kind != data::JointKind::hinge) return 0.0;
  const bool on_parent = joint.parent_segment == w.tree.segment_order[at(length.segment)];
  const double along = length.direction.dot(on_parent ? joint.axis_in_parent : joint.axis_in_child);
  return std::pow(along * w.fit.chain.scale(), 2);
}

void write_lengths(const Work& w, data::Skeleton& skeleton) {
  for (const auto& l : w.fit.lengths()) {
    const double open = open_variance(w, skeleton, l, l.joint_a) + open_variance(w, skeleton, l, l.joint_b);
    int a = w.tree.joint_order[at(l.joint_a)], b = w.tree.joint_order[at(l.joint_b)];
    if (a > b) std::swap(a, b);
    const int segment = w.tree.segment_order[at(l.segment)];
    skeleton.lengths.push_back({.name = w.layout.segments[at(segment)].name,
                                .joint_a = a,
                                .joint_b = b,
                                .length_m = l.length_m,
                                .sd_m = std::sqrt(l.sd_m * l.sd_m + open)});
  }
}

void write_warnings(const Work& w, data::Skeleton& skeleton) {
  auto& warnings = skeleton.warnings;
  warnings = w.fit.warnings;
  const auto name = [&](int chain_marker) { return w.markers.names[at(w.input.marker[at(chain_marker)])]; };
  const auto slips = articulated::find_slipped_markers(w.fit, w.input.samples, w.pass);
  for (const auto& slip : slips)
    warnings.push_back(
        fmt::format("marker '{}' sits {:.1f} mm elsewhere on its segment from {:.2f} s on: "
                    "did it slip?",
                    name(slip.marker), kMm * slip.distance_m, w.markers.time.time_s(slip.frame)));
  const auto swaps = articulated::find_swapped_markers(w.fit, w.input.samples, w.pass);
  for (const auto& swap : swaps)
    warnings.push_back(fmt::format(
        "markers '{}' and '{}' have exchanged names in about {} frames, the first at {:.2f} s",
        name(swap.marker_a), name(swap.marker_b), swap.frames, w.markers.time.time_s(swap.first_frame)));
  for (const auto& loose : articulated::find_loose_markers(w.fit, w.input.samples, w.pass)) {
    // What a slip or another's name explains is no movement on the segment.
    const bool explained =
        std::ranges::any_of(slips, [&](const auto& s) { return s.marker == loose.marker; }) ||
        std::ranges::any_of(
            swaps, [&](const auto& s) { return s.marker_a == loose.marker || s.marker_b == loose.marker; });
    if (!explained)
      warnings.push_back(
          fmt::format("marker '{}' moves on its segment by {:.1f} mm beside a noise of {:.1f} mm",
                      name(loose.marker), kMm * loose.rms_m, kMm * w.fit.noise_sd_m));
  }
  std::vector<std::string> two;
  for (int s = 0; s < w.fit.chain.segments(); ++s)
    if (w.fit.chain.kind[at(s)] == data::SegmentKind::line && w.fit.chain.layout.markers_of(s).size() == 2)
      two.push_back("'" + w.layout.segments[at(w.tree.segment_order[at(s)])].name + "'");
  if (!two.empty())
    warnings.push_back(
        fmt::format("joints are taken to lie on the line through the two markers of {}: how far off "
                    "it they are is not in the error bars",
                    join_names(two, kSegmentsNamed)));
  for (std::size_t j = 0; j < w.continuity.prior.size() && w.options.continuity; ++j)
    if (w.continuity.path[j].position.empty()) {
      const auto& joint = w.layout.joints[at(w.tree.joint_order[j])].name;
      const auto determined = std::ranges::count(w.pass.state[j], CentreState::determined);
      warnings.push_back(
          determined < articulated::kLeastFollowed
              ? fmt::format(
                    "joint '{}': nothing was smoothed, for {} frames alone determine it; {} are needed",
                    joint, determined, articulated::kLeastFollowed)
              : fmt::format("joint '{}': nothing was smoothed, for the determined frames do not follow "
                            "each other in time",
                            joint));
    }
  if (!w.pass.misfits.empty())
    warnings.push_back(
        fmt::format("{} of {} frames are not explained by rigid segments and noise of {:.2f} mm",
                    w.pass.misfits.size(), w.markers.frames(), kMm * w.fit.noise_sd_m));
}

ArticulatedFit assemble(const Work& w) {
  ArticulatedFit out;
  data::Skeleton& skeleton = out.skeleton;
  out.refined = w.fit.refined;
  const auto J = static_cast<int>(w.layout.joints.size());
  skeleton.markers = w.markers.names;
  skeleton.time = w.markers.time;
  skeleton.noise_sd_m = w.fit.noise_sd_m;
  skeleton.segments.resize(w.layout.segments.size());
  for (int s = 0; s < w.fit.chain.segments(); ++s)
    skeleton.segments[at(w.tree.segment_order[at(s)])] = describe_segment(w, s);
  skeleton.joints.resize(w.layout.joints.size());
  out.joints.resize(w.layout.joints.size());
  std::vector<articulated::ObservedMotion> seen;
  for (int j = 0; j < J; ++j) {
    seen.push_back(articulated::observe_motion(w.fit, w.pass, j));
    skeleton.joints[at(w.tree.joint_order[at(j)])] =
        describe_joint(w, j, seen.back(), std::sqrt(common_variance(w, j)));
  }
  skeleton.allocate_centres();
  for (int j = 0; j < J; ++j) write_centres(w, j, skeleton, out.joints[at(w.tree.joint_order[at(j)])]);
  for (const auto& flagged : w.pass.flagged)
    for (int j = 0; j < J; ++j)
      if (w.pass.state[at(j)][static_cast<std::size_t>(flagged.frame)] != CentreState::determined)
        out.joints[at(w.tree.joint_order[at(j)])].modes += static_cast<std::int64_t>(flagged.modes.size());
  for (int j = 0; j < J; ++j) {
    const int joint = w.tree.joint_order[at(j)];
    if (seen[at(j)].still)
      articulated::widen_all_around(joint, w.fit.chain.scale(), skeleton);
    else if (skeleton.joints[at(joint)].kind == data::JointKind::hinge)
      widen_hinge(w, skeleton, j);
  }
  out.marker_noise_sd_m.assign(w.markers.names.size(), std::numeric_limits<double>::quiet_NaN());
  for (int m = 0; m < w.fit.chain.markers(); ++m)
    if (w.fit.marker_weight[at(m)] > 0.0)
      out.marker_noise_sd_m[at(w.input.marker[at(m)])] =
          w.fit.noise_sd_m / std::sqrt(w.fit.marker_weight[at(m)]);
  write_lengths(w, skeleton);
  write_warnings(w, skeleton);
  for (int j = 0; j < J && w.options.joint == data::JointChoice::hinge; ++j)
    if (!shows_axis(seen[at(j)]))
      skeleton.warnings.push_back(fmt::format(
          "joint '{}': a hinge was asked for, but no axis can be seen; it is given as a ball joint",
          w.layout.joints[at(w.tree.joint_order[at(j)])].name));
  return out;
}

}  // namespace

Status ArticulatedOptions::check() const {
  if (!std::isfinite(noise_sd_m) || noise_sd_m < 0.0)
    return fail(Code::usage, fmt::format("noise is {} m; need 0 (estimated) or more", noise_sd_m));
  if (max_fit_frames < 20)
    return fail(Code::usage, fmt::format("{} frames for the geometry; need 20 or more", max_fit_frames));
  if (!(most_noise_m > 0.0) || !(most_reach_m > 0.0) || !(most_change_m > 0.0))
    return fail(Code::usage,
                fmt::format("bounds of a first geometry are {} m of noise, {} m of reach and {} m of change; "
                            "need more than 0",
                            most_noise_m, most_reach_m, most_change_m));
  if (!std::isfinite(max_bridge_sd_m) || max_bridge_sd_m <= 0.0)
    return fail(Code::usage, fmt::format("largest bridged SD is {} m; need more than 0", max_bridge_sd_m));
  if (threads < 0) return fail(Code::usage, fmt::format("{} threads; need 0 (all cores) or more", threads));
  return {};
}

Result<ArticulatedFit> fit_articulated(const data::Trajectories& markers, const data::SegmentLayout& layout,
                                       const ArticulatedOptions& options, const Progress& progress) {
  if (auto s = check_input(markers, layout, options); !s) return std::unexpected(s.error());
  Work w{.markers = markers, .layout = layout, .options = options, .tree = articulated::JointTree(layout)};
  w.input = articulated::arrange(markers, layout, w.tree);
  w.noise = noise_in_time(markers);
  auto fit = fit_chain(w.input.samples, w.input.layout, fit_options(w), progress);
  if (!fit) return std::unexpected(fit.error());
  w.fit = std::move(*fit);
  blank_dropped_markers(w.fit, w.input.samples);
  if (auto s = pass_over(w, progress); !s) return std::unexpected(s.error());
  if (const auto hinges = find_open_hinges(w); !hinges.empty()) {
    hold_hinges(w.input.samples, hinges, w.fit);
    if (auto s = pass_over(w, progress); !s) return std::unexpected(s.error());
  }
  const std::size_t J = layout.joints.size();
  if (options.continuity)
    w.continuity =
        articulated::follow_paths(w.fit, w.input.samples, markers.time.rate_hz, options.threads, w.pass);
  else
    w.continuity = {.prior = std::vector<articulated::PathPrior>(J),
                    .path = std::vector<articulated::SmoothedPath>(J)};
  ArticulatedFit out = assemble(w);
  articulated::account_for_skin(markers, out.skeleton);
  return out;
}

}  // namespace kinemark::skeleton
