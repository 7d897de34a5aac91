// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/slip.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {
namespace {

constexpr std::int64_t kLeastSlipFrames = 64;
constexpr std::int64_t kBlocksASide = 8;
constexpr double kEdge = 0.1;  ///< of the frames at either end, excluded from the search
/// Noise of the poses biases a joint's position equally in both halves; this share of it is subtracted.
constexpr double kOpenDiffers = 0.99;
constexpr double kAtOnce = 0.5;           ///< share of the way that a slip makes at its frame
constexpr Eigen::Index kPartBeside = 50;  ///< compared there: this part of the frames on either side,
constexpr Eigen::Index kLeastBeside = 4;  ///< but no fewer than so many
constexpr double kAlsoShare =
    0.5;  ///< a slipped marker shifts the pose: others that move by less than this share are not reported

constexpr double kBeyondDoubt = 3.0;  ///< standard deviations between two halves of a recording

struct Path {
  std::vector<std::int64_t> frames;
  Eigen::Matrix3Xd x;  ///< in the segment, m
};

Path path_in_segment(const Samples& samples, const SegmentPoses& poses, int marker) {
  Path path;
  for (std::size_t f = 0; f < poses.known.size(); ++f)
    if (poses.known[f] && samples.seen(static_cast<std::int64_t>(f), marker))
      path.frames.push_back(static_cast<std::int64_t>(f));
  path.x.resize(3, static_cast<Eigen::Index>(path.frames.size()));
  for (std::size_t i = 0; i < path.frames.size(); ++i)
    path.x.col(static_cast<Eigen::Index>(i)) =
        poses.to_segment(path.frames[i], samples.x(path.frames[i], marker));
  return path;
}

/// Where the running sum of the departure from the mean is longest.
Eigen::Index change_point(const Path& path) {
  const Eigen::Vector3d mean = path.x.rowwise().mean();
  const auto n = path.x.cols();
  const auto edge = static_cast<Eigen::Index>(kEdge * static_cast<double>(n));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Index best = n / 2;
  double longest = -1.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    sum += path.x.col(i) - mean;
    if (i < edge || i >= n - edge || sum.norm() <= longest) continue;
    longest = sum.norm();
    best = i + 1;
  }
  return best;
}

/// Mean of some columns and the variance of that mean (sum over axes), from blocks; infinite with one column
/// or none.
struct Part {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double variance = 0.0;
};
Part summarise(const Eigen::Ref<const Eigen::Matrix3Xd>& x) {
  const std::int64_t n = x.cols(), blocks = std::min(kBlocksASide, n);
  if (blocks < 2) return {.variance = std::numeric_limits<double>::infinity()};
  Part part;
  part.mean = x.rowwise().mean();
  for (std::int64_t b = 0; b < blocks; ++b) {
    const auto from = n * b / blocks, to = n * (b + 1) / blocks;
    part.variance += (x.middleCols(from, to - from).rowwise().mean() - part.mean).squaredNorm();
  }
  part.variance /= static_cast<double>(blocks * (blocks - 1));
  return part;
}

/// Whether most of the way is made at once. Skin that slides with a movement slower than the recording is
/// long also lies elsewhere before than after, and gets there with the movement.
bool jumps(const Path& path, Eigen::Index at, const Eigen::Vector3d& way) {
  const Eigen::Index n = path.x.cols(),
                     beside = std::min({std::max(kLeastBeside, n / kPartBeside), at, n - at});
  const Eigen::Vector3d jump = path.x.middleCols(at, beside).rowwise().mean() -
                               path.x.middleCols(at - beside, beside).rowwise().mean();
  return jump.dot(way) >= kAtOnce * way.squaredNorm();
}

std::optional<data::Finding> compare_marker(const Path& path, const SlipOptions& options) {
  if (path.x.cols() < kLeastSlipFrames) return std::nullopt;
  const Eigen::Index at = change_point(path);
  const Part before = summarise(path.x.leftCols(at)), after = summarise(path.x.rightCols(path.x.cols() - at));
  data::Finding slip{.kind = data::FindingKind::marker_slip,
                     .first_frame = path.frames[static_cast<std::size_t>(at)],
                     .size = (after.mean - before.mean).norm(),
                     .size_sd = std::sqrt(before.variance + after.variance)};
  // NaN is not reported as a slip.
  if (!(slip.size >= options.least_m) || !(slip.size >= options.sure_sd * slip.size_sd)) return std::nullopt;
  if (!jumps(path, at, after.mean - before.mean)) return std::nullopt;
  return slip;
}

void find_marker_slips(const Samples& samples, const SegmentPoses& poses, const SlipOptions& options,
                       std::vector<data::Finding>& slips) {
  std::vector<data::Finding> found;
  double largest = 0.0;
  for (const int marker : poses.markers) {
    auto slip = compare_marker(path_in_segment(samples, poses, marker), options);
    if (!slip) continue;
    slip->subject = samples.trajectories.names[static_cast<std::size_t>(marker)];
    slip->partner = poses.name;
    slip->last_frame = samples.trajectories.frames() - 1;
    largest = std::max(largest, slip->size);
    found.push_back(std::move(*slip));
  }
  for (data::Finding& slip : found)
    if (slip.size >= kAlsoShare * largest) slips.push_back(std::move(slip));
}

/// The joint's position in each segment, first half against second.
void find_joint_slips(const Samples& samples, const data::SegmentLayout& layout, int joint,
                      const std::vector<SegmentPoses>& poses, const SlipOptions& options,
                      std::vector<data::Finding>& slips) {
  const auto& j = layout.joints[static_cast<std::size_t>(joint)];
  const SegmentPoses& a = poses[static_cast<std::size_t>(j.parent)];
  const SegmentPoses& b = poses[static_cast<std::size_t>(j.child)];
  const RelativeMotion motion = measure_motion(a, b);
  if (static_cast<std::int64_t>(motion.frames.size()) < kLeastSlipFrames) return;
  std::array<RelativeMotion, 2> halves = {motion, motion};
  const auto middle = motion.frames.begin() + static_cast<std::ptrdiff_t>(motion.frames.size() / 2);
  halves[0].frames.assign(motion.frames.begin(), middle);
  halves[1].frames.assign(middle, motion.frames.end());
  const JointFit first = fit_score(samples, a, b, halves[0], data::JointKind::ball),
                 second = fit_score(samples, a, b, halves[1], data::JointKind::ball);
  for (const int side : {0, 1}) {
    const Eigen::Vector3d shift = second.centre.segment<3>(3 * side) - first.centre.segment<3>(3 * side);
    const auto chance = [&](const JointFit& fit) -> Matrix6 {
      return fit.scatter + (1.0 - kOpenDiffers) * fit.open;
    };
    const Matrix6 both = chance(first) + chance(second);
    const Eigen::Matrix3d covariance = both.block<3, 3>(3 * side, 3 * side);
    const double far = std::sqrt(shift.dot(covariance.ldlt().solve(shift)));
    if (!(shift.norm() >= options.least_m) || !(far >= options.sure_sd)) continue;
    const Eigen::Vector3d along = shift.normalized();
    const int segment = side == 0 ? j.parent : j.child;
    slips.push_back({.kind = data::FindingKind::joint_slip,
                     .subject = j.name,
                     .partner = layout.segments[static_cast<std::size_t>(segment)].name,
                     .first_frame = *middle,
                     .last_frame = samples.trajectories.frames() - 1,
                     .size = shift.norm(),
                     .size_sd = std::sqrt(along.dot(covariance * along))});
  }
}

}  // namespace

Status SlipOptions::check() const {
  if (!(sure_sd > 0.0))
    return fail(Code::usage, fmt::format("slips sure at {} SD; need more than 0", sure_sd));
  if (!(least_m >= 0.0)) return fail(Code::usage, fmt::format("least slip of {} m; need 0 or more", least_m));
  return {};
}

Result<std::vector<data::Finding>> find_slips(const data::Trajectories& trajectories,
                                              const data::SegmentLayout& layout, const SlipOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = layout.validate(trajectories.markers()); !s) return std::unexpected(s.error());
  const Samples samples{trajectories, {}};
  std::vector<SegmentPoses> poses;
  std::vector<data::Finding> slips;
  for (const auto& segment : layout.segments) {
    poses.push_back(find_segment_poses(samples, segment.name, segment.markers));
    find_marker_slips(samples, poses.back(), options, slips);
  }
  for (int j = 0; j < static_cast<int>(layout.joints.size()); ++j)
    find_joint_slips(samples, layout, j, poses, options, slips);
  return slips;
}

bool is_within_repeatability(const data::Finding& slip, const data::Skeleton& skeleton) {
  if (slip.kind != data::FindingKind::joint_slip) return false;
  const auto joint = std::ranges::find(skeleton.joints, slip.subject, &data::SkeletonJoint::name);
  if (joint == skeleton.joints.end()) return false;
  const bool parent = skeleton.segments[static_cast<std::size_t>(joint->parent_segment)].name == slip.partner;
  const auto& repeats = parent ? joint->repeatability_in_parent : joint->repeatability_in_child;
  const auto& accuracy = parent ? joint->covariance_in_parent : joint->covariance_in_child;
  const Eigen::Matrix3d& C = repeats.allFinite() ? repeats : accuracy;
  if (!C.allFinite()) return true;
  const int worst = joint->kind == data::JointKind::hinge ? 1 : 2;
  const double variance =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues()[worst];
  return !(slip.size > kBeyondDoubt * std::sqrt(4.0 * std::max(variance, 0.0) + slip.size_sd * slip.size_sd));
}

}  // namespace kinemark::skeleton
