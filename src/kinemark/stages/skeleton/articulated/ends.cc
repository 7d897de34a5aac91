// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/ends.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/math/se3.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"
#include "kinemark/stages/skeleton/functional/skin_evidence.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"

namespace kinemark::skeleton {
namespace {

using data::CentreState;
using data::SkeletonEnd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRoomMarkers = 4;
constexpr double kRoom_m = 0.5;  ///< of the points that stand for the room, from the segment's mean
/// A gap so many times that of noise, and no smaller, is no point that stays.
constexpr double kMoves = 3.0, kMoves_m = 2e-3;
constexpr double kHalfWay = 0.5;
/// Markers' worth of numbers that a frame's pose takes: six of three each, shared with the segment beside it.
constexpr double kPoseTakes = 1.5;
constexpr std::int64_t kFitFrames = 1500;  ///< that place the markers on their segments
constexpr std::int64_t kLeastFollowed = 10;
constexpr double kWidest_m = 0.02;  ///< an end known worse (root of the trace) is not bridged
constexpr double kMm = 1e3;

void set_frame(SkeletonEnd& end, std::int64_t f, CentreState state, const Vector3d& x, const Matrix3d& C) {
  end.state[at(f)] = state;
  std::copy_n(x.data(), 3, end.centre_in_world.data() + 3 * f);
  math::pack_symmetric3(0.5 * (C + C.transpose()), end.covariance_in_world.data() + 6 * f);
}

SkeletonEnd empty_end(const data::SegmentLayout::End& of, int segment, std::int64_t frames) {
  SkeletonEnd out{.name = of.name, .segment = segment, .marker = of.marker};
  out.centre_in_world.assign(3 * at(frames), kNaN);
  out.covariance_in_world.assign(6 * at(frames), kNaN);
  out.state.assign(at(frames), CentreState::undetermined);
  return out;
}

/// The markers of one segment, and points that stand still for the room, behind them.
data::Trajectories with_room(const data::Trajectories& markers, const data::SkeletonSegment& segment,
                             Eigen::Matrix3Xd& room) {
  std::vector<std::string> names;
  for (const int m : segment.markers) names.push_back(markers.names[at(m)]);
  const auto K = static_cast<std::int64_t>(names.size());
  for (int k = 0; k < kRoomMarkers; ++k) names.push_back(fmt::format("room\n{}", k));
  auto out = data::Trajectories::all_missing(std::move(names), markers.time);
  Vector3d mean = Vector3d::Zero();
  double n = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t k = 0; k < K; ++k) {
      const int m = segment.markers[at(k)];
      if (!markers.present(f, m)) continue;
      out.x(f, k) = markers.x(f, m);
      out.state[out.index(f, k)] = data::SampleState::measured;
      mean += markers.x(f, m);
      n += 1.0;
    }
  mean /= std::max(n, 1.0);
  room.resize(3, kRoomMarkers);
  room << mean, mean + kRoom_m * Vector3d::UnitX(), mean + kRoom_m * Vector3d::UnitY(),
      mean + kRoom_m * Vector3d::UnitZ();
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t k = 0; k < kRoomMarkers; ++k) {
      out.x(f, K + k) = room.col(k);
      out.state[out.index(f, K + k)] = data::SampleState::measured;
    }
  return out;
}

/// Normal equations of c = R p + y over frames: the point in the room, then on the segment. Noise of a
/// rotation shortens what it carries, and least squares then lie too near to the markers: every rotation is
/// made longer by what its noise takes, (I - G)^-1 with G = (tr T I - T) / 2 and T its covariance, and
/// carries the mean of the visible markers, whose noise has no part in it. What is left of the bias is of the
/// order of its square.
struct RoomSums {
  Matrix6 normal = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  Matrix3d lost = Matrix3d::Zero();  ///< of the normal matrix by noise, had it been left there

  void add(const Samples& samples, const SegmentPoses& poses, std::int64_t f) {
    const PoseNoise noise = pose_noise(samples, poses, f);
    const Matrix3d& T = noise.rotation_covariance;
    const Matrix3d G = 0.5 * (T.trace() * Matrix3d::Identity() - T);
    const Matrix3d R = poses.world_from_segment[at(f)] * (Matrix3d::Identity() - G).inverse();
    const Vector3d mean = poses.to_world(f, noise.visible_mean);
    normal.diagonal().array() += 1.0;
    normal.topRightCorner<3, 3>() -= R;
    normal.bottomLeftCorner<3, 3>() -= R.transpose();
    right.head<3>() += mean - R * noise.visible_mean;
    right.tail<3>() -= R.transpose() * mean - noise.visible_mean;
    lost += 2.0 * G;
  }
  RoomSums& operator+=(const RoomSums& other) {
    normal += other.normal;
    right += other.right;
    lost += other.lost;
    return *this;
  }
  /// @param open  covariance of what lack of motion leaves open; may be null
  [[nodiscard]] Vector6 solve(double gap_m, Matrix6* open) const {
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(normal);
    const double prior = data::kJointPriorSd_m,
                 share = gap_m * gap_m / (3.0 * prior * prior) + 1e-12 * normal(0, 0);
    Vector6 out = Vector6::Zero();
    for (int i = 0; i < 6; ++i) {
      const Vector6 e = eigen.eigenvectors().col(i);
      const double value = std::max(eigen.eigenvalues()(i), 0.0) + share;
      const double by_noise = std::min(1.0, e.tail<3>().dot(lost * e.tail<3>()) / value);
      const double left = prior * std::min(1.0, by_noise * by_noise + share / value);
      out += e * (e.dot(right) / value);
      if (open != nullptr) *open += left * left * e * e.transpose();
    }
    return out;
  }
};

/// What errors of the markers' places on their segment, which all frames share, make of the joint with the
/// room: each marker's by the frames that show it, less what the frames' poses take of these.
Matrix6 by_shape(const Samples& samples, const SegmentPoses& poses, const std::vector<std::int64_t>& frames,
                 const RoomSums& sums, const Vector3d& x) {
  const auto K = poses.x_in_segment.cols();
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(6, 3 * K);
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(K);
  const double variance = poses.noise_sd_m * poses.noise_sd_m;
  for (const auto f : frames) {
    const PoseNoise noise = pose_noise(samples, poses, f);
    const Matrix3d& R = poses.world_from_segment[at(f)];
    const Matrix3d turn = math::skew(x - noise.visible_mean) * noise.rotation_covariance / variance;
    for (Eigen::Index k = 0; k < K; ++k) {
      const Vector3d place = poses.x_in_segment.col(k);
      if (!place.allFinite() || !samples.seen(f, poses.markers[at(k)])) continue;
      seen(k) += 1.0;
      const Matrix3d by_marker = noise.mean_variance / variance * Matrix3d::Identity() -
                                 turn * math::skew(place - noise.visible_mean);
      moved.block<3, 3>(0, 3 * k) += R * by_marker;
      moved.block<3, 3>(3, 3 * k) -= by_marker;
    }
  }
  const double in_frame = std::max(seen.sum() / static_cast<double>(frames.size()), 3.0);
  const double kept = 1.0 - kPoseTakes / in_frame;
  for (Eigen::Index k = 0; k < K; ++k)
    moved.middleCols<3>(3 * k) *=
        std::sqrt(variance / (kept * std::clamp(seen(k), 1.0, static_cast<double>(kFitFrames))));
  const Matrix6 solved = (sums.normal + 1e-9 * sums.normal(0, 0) * Matrix6::Identity()).inverse();
  return solved * moved * moved.transpose() * solved;
}

/// Blocks of a jackknife: two seconds of half a minute, as what is seen is alike in a movement.
constexpr std::int64_t kRoomBlocks = 15;

/// A joint with the room from all frames with a pose: place, scatter between parts of the recording, what
/// lack of motion leaves open, and what the error of the markers' places on their segment, common to all
/// frames, adds.
void fit_to_room(const Samples& samples, const SegmentPoses& poses, const RelativeMotion& motion,
                 JointFit& fit) {
  const auto n = std::ssize(motion.frames);
  const std::int64_t blocks = std::min<std::int64_t>(kRoomBlocks, n / 2);
  std::vector<RoomSums> parts(at(blocks));
  for (std::ptrdiff_t i = 0; i < n; ++i) parts[at(i * blocks / n)].add(samples, poses, motion.frames[at(i)]);
  RoomSums all;
  for (const auto& part : parts) all += part;
  fit.open.setZero();
  fit.centre = all.solve(fit.residual_rms_m, &fit.open);
  fit.scatter.setZero();
  for (std::size_t left = 0; left < parts.size(); ++left) {
    RoomSums rest;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (k != left) rest += parts[k];
    const Vector6 d = rest.solve(fit.residual_rms_m, nullptr) - fit.centre;
    fit.scatter += static_cast<double>(blocks - 1) / static_cast<double>(blocks) * d * d.transpose();
  }
  fit.covariance = fit.scatter + fit.open;
  if (poses.noise_sd_m > 0.0)
    fit.covariance += by_shape(samples, poses, motion.frames, all, fit.centre.tail<3>());
}

/// RMS distance from where a point of the segment is said to be that noise of the poses makes.
double gap_by_noise(const Samples& samples, const SegmentPoses& poses, const RelativeMotion& motion,
                    const Vector3d& x) {
  double squares = 0.0;
  for (const auto f : motion.frames)
    squares += pose_noise(samples, poses, f).at(poses.world_from_segment[at(f)], x).trace();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(motion.frames.size(), 1)));
}

/// Which joint of the end's segment comes first, how far it is, and how well that is known.
void measure_length(const data::Skeleton& skeleton, SkeletonEnd& end) {
  for (std::size_t j = 0; j < skeleton.joints.size() && end.joint < 0; ++j) {
    const auto& joint = skeleton.joints[j];
    const bool above = joint.parent_segment == end.segment;
    if (!above && joint.child_segment != end.segment) continue;
    const Vector3d d = end.x_in_segment - (above ? joint.centre_in_parent : joint.centre_in_child);
    const Matrix3d C = end.covariance + (above ? joint.covariance_in_parent : joint.covariance_in_child);
    end.joint = static_cast<int>(j);
    end.length_m = d.norm();
    end.length_sd_m = std::sqrt(d.normalized().dot(C * d.normalized()));
  }
}

std::string length_words(const data::Skeleton& skeleton, const SkeletonEnd& end) {
  if (end.joint < 0) return "";
  return fmt::format("; {:.1f} mm (SD {:.1f}) from {}", kMm * end.length_m, kMm * end.length_sd_m,
                     skeleton.joints[at(end.joint)].name);
}

/// The point of a segment that stays where it is in the room; false: nothing can be said of it.
bool place_fixed(const data::Trajectories& markers, data::Skeleton& skeleton, SkeletonEnd& end) {
  const auto& segment = skeleton.segments[at(end.segment)];
  Eigen::Matrix3Xd room;
  const auto moving = with_room(markers, segment, room);
  const Samples samples{moving, {}};
  std::vector<int> on_segment, on_room;
  for (int k = 0; k < static_cast<int>(segment.markers.size()); ++k) on_segment.push_back(k);
  for (int k = 0; k < kRoomMarkers; ++k) on_room.push_back(static_cast<int>(segment.markers.size()) + k);
  const auto still = pose_known_shape(samples, "room", on_room, room);
  const auto poses = pose_known_shape(samples, segment.name, on_segment, segment.x_in_segment,
                                      {.noise_sd_m = skeleton.noise_sd_m});
  const RelativeMotion motion = measure_motion(still, poses);
  JointFit fit = fit_score(samples, still, poses, motion, data::JointKind::ball);
  if (!fit.in_parent) return false;
  fit_to_room(samples, poses, motion, fit);
  const SkinSlide slide = measure_skin_slide(samples, still, poses, motion, fit);
  Vector6 centre = fit.centre;
  Matrix6 covariance = fit.covariance;
  if (slide.known) {
    const SkinEvidence evidence = find_skin(samples, still, poses, motion, fit);
    end.skin = account_of_skin(evidence, slide);
    // As a joint of two segments: half-way to the expected place where skin is seen, else the whole way
    // counts as error, as likely as the movements leave it.
    Vector6 rest = slide.shift;
    if (end.skin.verdict == data::SkinVerdict::follows) rest *= 1.0 - kHalfWay;
    centre += slide.shift - rest;
    covariance += calc_skin_probability(evidence) * (positive_part(slide.covariance - slide.noise) +
                                                     (1.0 - slide.none) * rest * rest.transpose());
  }
  end.x_in_segment = centre.tail<3>();
  end.covariance = covariance.bottomRightCorner<3, 3>();
  end.gap_m = fit.residual_rms_m;
  const double noise = gap_by_noise(samples, poses, motion, end.x_in_segment);
  Matrix3d in_room = covariance.topLeftCorner<3, 3>();
  if (end.gap_m > kMoves * noise && end.gap_m > kMoves_m) {
    skeleton.warnings.push_back(fmt::format(
        "'{}' does not stay where it is: its places in the room and on '{}' lie {:.1f} mm apart (RMS), by "
        "noise {:.1f} mm; the joint moves in the room, or the markers on the segment",
        end.name, segment.name, kMm * end.gap_m, kMm * noise));
    if (end.skin.verdict != data::SkinVerdict::follows)
      in_room += (end.gap_m * end.gap_m - noise * noise) / 3.0 * Matrix3d::Identity();
  }
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    set_frame(end, f, poses.known[at(f)] != 0 ? CentreState::determined : CentreState::bridged,
              centre.head<3>(), in_room);
  measure_length(skeleton, end);
  end.description = fmt::format("{:.0f} deg of motion: stays in the room, known to {:.1f} mm{}",
                                motion.range_rad * kDegPerRad, kMm * std::sqrt(in_room.trace()),
                                length_words(skeleton, end));
  return true;
}

/// Covariance of the position of the end's marker on its segment by noise, and of what slides of skin do to
/// the place that a pose gives it; both in the segment, m^2.
struct TipError {
  Matrix3d on_segment = Matrix3d::Zero(), by_skin = Matrix3d::Zero();
};

/// Covariance of a point of one segment of a joint by slides of its markers over the joint's posture, m^2.
Matrix3d slides_at(const Samples& samples, const SegmentPoses& parent, const SegmentPoses& child,
                   data::JointKind kind, bool on_child, const Vector3d& x) {
  if (parent.known_frames == 0 || child.known_frames == 0) return Matrix3d::Zero();
  const RelativeMotion motion = measure_motion(parent, child);
  const JointFit fit = fit_score(samples, parent, child, motion, kind);
  if (!fit.in_parent) return Matrix3d::Zero();
  const SkinSlide slide = measure_skin_slide(samples, parent, child, motion, fit);
  const double own = on_child ? slide.own_child_m : slide.own_parent_m,
               softer = std::max(slide.own_child_m, slide.own_parent_m);
  if (!slide.known || !(own > 0.0)) return Matrix3d::Zero();
  const Eigen::Matrix3Xd& markers = (on_child ? child : parent).x_in_segment;
  const Vector3d mean = markers.rowwise().mean();
  const Eigen::Matrix3Xd arms = markers.colwise() - mean;
  const Matrix3d squares = arms * arms.transpose();
  const Matrix3d inertia = squares.trace() * Matrix3d::Identity() - squares, lever = math::skew(x - mean);
  const auto M = static_cast<double>(arms.cols());
  const double common = own / softer * slide.common_m, turn = own / softer * slide.turn_m;
  const double likely = calc_skin_probability(find_skin(samples, parent, child, motion, fit));
  return likely * motion.sd_rad.squaredNorm() *
         ((own * own / M + common * common) * Matrix3d::Identity() +
          lever * (own * own * inertia.inverse() + turn * turn * M / squares.trace() * Matrix3d::Identity()) *
              lever.transpose());
}

TipError error_of(const Samples& samples, const data::Skeleton& skeleton,
                  const std::vector<SegmentPoses>& poses, const SkeletonEnd& end) {
  TipError out;
  const SegmentPoses& own = poses[at(end.segment)];
  double seen = 0.0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    if (own.known[at(f)] != 0 && samples.seen(f, end.marker)) {
      out.on_segment += pose_noise(samples, own, f).at(Matrix3d::Identity(), end.x_in_segment) +
                        skeleton.noise_sd_m * skeleton.noise_sd_m * Matrix3d::Identity();
      seen += 1.0;
    }
  if (seen > 0.0) out.on_segment /= seen * std::min(seen, static_cast<double>(kFitFrames));
  for (const auto& joint : skeleton.joints)
    if (joint.parent_segment == end.segment || joint.child_segment == end.segment)
      out.by_skin += slides_at(samples, poses[at(joint.parent_segment)], poses[at(joint.child_segment)],
                               joint.kind, joint.child_segment == end.segment, end.x_in_segment);
  return out;
}

/// A segment's end: its marker's place, carried by the segment's pose.
bool place_tip(const data::Trajectories& markers, data::Skeleton& skeleton, SkeletonEnd& end) {
  const auto& segment = skeleton.segments[at(end.segment)];
  const auto column = std::ranges::find(segment.markers, end.marker) - segment.markers.begin();
  if (column == std::ssize(segment.markers)) return false;
  end.x_in_segment = segment.x_in_segment.col(column);
  const Samples samples{markers, {}};
  std::vector<SegmentPoses> poses;
  for (const auto& one : skeleton.segments)
    poses.push_back(pose_known_shape(samples, one.name, one.markers, one.x_in_segment,
                                     {.noise_sd_m = skeleton.noise_sd_m}));
  const SegmentPoses& own = poses[at(end.segment)];
  const TipError error = error_of(samples, skeleton, poses, end);
  end.covariance = error.on_segment + error.by_skin;
  const Matrix3d common = end.covariance;

  std::vector<articulated::PathPoint> points(at(skeleton.frames()));
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    if (own.known[at(f)] != 0)
      points[at(f)] = {
          .position = own.to_world(f, end.x_in_segment),
          .information =
              pose_noise(samples, own, f).at(own.world_from_segment[at(f)], end.x_in_segment).inverse()};
  articulated::SmoothedPath path;
  if (std::ranges::count_if(points, articulated::holds_a_position) >= kLeastFollowed)
    if (const auto prior = articulated::find_path_prior(points, markers.time.rate_hz); prior.follows)
      path = articulated::smooth_path(points, markers.time.rate_hz, prior.white_jerk);
  std::int64_t placed = 0;
  double squares = 0.0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const bool alone = articulated::holds_a_position(points[at(f)]);
    const bool smooth = !path.position.empty() && path.known(at(f));
    if (!alone && !smooth) continue;
    const Matrix3d of_frame = smooth ? path.covariance_at(at(f)) : points[at(f)].information.inverse();
    if (!alone && of_frame.trace() > kWidest_m * kWidest_m) continue;
    const Matrix3d& R = own.world_from_segment[at(f)];
    const Matrix3d shared =
        alone ? Matrix3d(R * common * R.transpose()) : Matrix3d(common.trace() / 3.0 * Matrix3d::Identity());
    set_frame(end, f, alone ? CentreState::determined : CentreState::bridged,
              smooth ? path.position[at(f)] : points[at(f)].position, of_frame + shared);
    squares += (of_frame + shared).trace();
    ++placed;
  }
  measure_length(skeleton, end);
  end.description = fmt::format(
      "marker '{}': placed in {} of {} frames, SD {:.1f} mm{}", markers.names[at(end.marker)], placed,
      skeleton.frames(), kMm * std::sqrt(squares / static_cast<double>(std::max<std::int64_t>(placed, 1))),
      length_words(skeleton, end));
  return placed > 0;
}

}  // namespace

void place_ends(const data::Trajectories& markers, std::span<const data::SegmentLayout::End> ends,
                data::Skeleton& skeleton) {
  for (const auto& wanted : ends) {
    const auto segment = std::ranges::find(skeleton.segments, wanted.segment, &data::SkeletonSegment::name);
    if (segment == skeleton.segments.end()) {
      skeleton.warnings.push_back(
          fmt::format("'{}' was not placed: segment '{}' was left out", wanted.name, wanted.segment));
      continue;
    }
    const bool has_pose = segment->markers.size() >= 3 && segment->kind != data::SegmentKind::line;
    auto end = empty_end(wanted, static_cast<int>(segment - skeleton.segments.begin()), skeleton.frames());
    if (has_pose && (end.stays() ? place_fixed(markers, skeleton, end) : place_tip(markers, skeleton, end)))
      skeleton.ends.push_back(std::move(end));
    else
      skeleton.warnings.push_back(fmt::format(
          "'{}' was not placed: segment '{}' shows no pose; it needs three markers that are not on a line",
          wanted.name, wanted.segment));
  }
}

}  // namespace kinemark::skeleton
