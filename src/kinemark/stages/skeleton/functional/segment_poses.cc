// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/segment_poses.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/check.h"

namespace kinemark::skeleton {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kShapeFrames = 3000;  ///< more tell the shape no better than noise allows
constexpr int kRounds = 60;
constexpr double kSettled_m = 1e-9;
/// Least share of the whole shape's inertia about a line that the visible markers must have.
constexpr double kInertiaShare = 1e-2;
constexpr double kOnLine = 1e-6;  ///< inertia about a line over that across it

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  return Eigen::Matrix3d{{0.0, -v.z(), v.y()}, {v.z(), 0.0, -v.x()}, {-v.y(), v.x(), 0.0}};
}

/// Sum over points d about their mean of |d|^2 I - d d'.
Eigen::Matrix3d inertia(const Eigen::Matrix3d& scatter) {
  return scatter.trace() * Eigen::Matrix3d::Identity() - scatter;
}

double smallest_eigenvalue(const Eigen::Matrix3d& m) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0);
}

struct FramePose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  double squares = 0.0;  ///< of the residuals, m^2
  int visible = 0;
  double least_inertia = 0.0;  ///< m^2
};

/// The shape while it is being found, and what a frame shows of it.
class Shape {
 public:
  Shape(const Samples& samples, const std::vector<int>& markers)
      : samples_(samples), markers_(markers), places_(3, static_cast<Eigen::Index>(markers.size())) {
    places_.setConstant(kNone);
  }

  [[nodiscard]] bool placed(std::size_t k) const { return !std::isnan(places_(0, at(k))); }
  [[nodiscard]] int seen(std::int64_t frame) const {
    return static_cast<int>(std::ranges::count_if(markers_, [&](int m) { return samples_.seen(frame, m); }));
  }

  /// Scatter of what a frame shows, in world.
  [[nodiscard]] Eigen::Matrix3d scatter(std::int64_t frame) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int n = 0;
    for (const int m : markers_) {
      if (!samples_.seen(frame, m)) continue;
      mean += samples_.x(frame, m);
      ++n;
    }
    mean /= std::max(n, 1);
    for (const int m : markers_) {
      if (!samples_.seen(frame, m)) continue;
      const Eigen::Vector3d d = samples_.x(frame, m) - mean;
      squares += d * d.transpose();
    }
    return squares;
  }

  void start(std::int64_t frame) {
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (samples_.seen(frame, markers_[k])) places_.col(at(k)) = samples_.x(frame, markers_[k]);
  }

  [[nodiscard]] FramePose pose(std::int64_t frame) const {
    FramePose p{.rotation = Eigen::Matrix3d::Identity(), .origin = Eigen::Vector3d::Zero()};
    Eigen::Vector3d world = Eigen::Vector3d::Zero(), local = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < markers_.size(); ++k) {
      if (!placed(k) || !samples_.seen(frame, markers_[k])) continue;
      world += samples_.x(frame, markers_[k]);
      local += places_.col(at(k));
      ++p.visible;
    }
    if (p.visible < 3) return p;
    world /= p.visible;
    local /= p.visible;
    Eigen::Matrix3d product = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < markers_.size(); ++k) {
      if (!placed(k) || !samples_.seen(frame, markers_[k])) continue;
      const Eigen::Vector3d d = places_.col(at(k)) - local;
      product += (samples_.x(frame, markers_[k]) - world) * d.transpose();
      squares += d * d.transpose();
    }
    p.least_inertia = smallest_eigenvalue(inertia(squares));
    p.rotation = kabsch(product);
    p.origin = world - p.rotation * local;
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (placed(k) && samples_.seen(frame, markers_[k]))
        p.squares +=
            (samples_.x(frame, markers_[k]) - p.rotation * places_.col(at(k)) - p.origin).squaredNorm();
    return p;
  }

  /// Inertia about a line of all that is placed; 0 where the markers lie on one.
  [[nodiscard]] double least_inertia() const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int n = 0;
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (placed(k)) {
        mean += places_.col(at(k));
        ++n;
      }
    mean /= std::max(n, 1);
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (placed(k)) squares += (places_.col(at(k)) - mean) * (places_.col(at(k)) - mean).transpose();
    const double least = smallest_eigenvalue(inertia(squares));
    return least > kOnLine * squares.trace() ? least : 0.0;
  }

  /// One round over the frames: poses, then every marker's mean place in them. Returns the largest change.
  double improve(const std::vector<std::int64_t>& frames, bool trim) {
    const double least = kInertiaShare * least_inertia();
    std::vector<FramePose> poses;
    std::vector<std::int64_t> used;
    std::vector<double> mean_squares;
    for (const std::int64_t f : frames) {
      const FramePose p = pose(f);
      if (p.visible < 3 || p.least_inertia < least) continue;
      poses.push_back(p);
      used.push_back(f);
      mean_squares.push_back(p.squares / std::max(1, 3 * p.visible - 6));
    }
    double limit = std::numeric_limits<double>::infinity();
    if (trim && !mean_squares.empty()) {
      auto sorted = mean_squares;
      const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
      std::ranges::nth_element(sorted, middle);
      if (*middle > 0.0) limit = 25.0 * *middle;
    }
    Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, places_.cols());
    std::vector<int> counts(markers_.size(), 0);
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (mean_squares[i] > limit) continue;
      for (std::size_t k = 0; k < markers_.size(); ++k) {
        if (!samples_.seen(used[i], markers_[k])) continue;
        sums.col(at(k)) +=
            poses[i].rotation.transpose() * (samples_.x(used[i], markers_[k]) - poses[i].origin);
        ++counts[k];
      }
    }
    double change = 0.0;
    for (std::size_t k = 0; k < markers_.size(); ++k) {
      if (counts[k] == 0) continue;
      const Eigen::Vector3d now = sums.col(at(k)) / counts[k];
      change = std::max(change, placed(k) ? (now - places_.col(at(k))).norm() : 1.0);
      places_.col(at(k)) = now;
    }
    return change;
  }

  /// Origin to the mean, z along the longest extent, y along the least.
  void turn_into_axes() {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int n = 0;
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (placed(k)) {
        mean += places_.col(at(k));
        ++n;
      }
    if (n == 0) return;
    places_.colwise() -= mean / n;
    for (std::size_t k = 0; k < markers_.size(); ++k)
      if (placed(k)) squares += places_.col(at(k)) * places_.col(at(k)).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
    Eigen::Matrix3d axes;
    axes.col(2) = solver.eigenvectors().col(2);
    axes.col(0) = solver.eigenvectors().col(1);
    // A sign that depends on the markers alone: the first placed marker is not on the negative side.
    for (const int axis : {2, 0}) {
      for (std::size_t k = 0; k < markers_.size(); ++k) {
        if (!placed(k)) continue;
        if (axes.col(axis).dot(places_.col(at(k))) < 0.0) axes.col(axis) *= -1.0;
        break;
      }
    }
    axes.col(1) = axes.col(2).cross(axes.col(0));
    places_ = (axes.transpose() * places_).eval();
  }

  [[nodiscard]] const Eigen::Matrix3Xd& places() const { return places_; }
  void set_places(const Eigen::Matrix3Xd& places) { places_ = places; }

 private:
  static Eigen::Index at(std::size_t k) { return static_cast<Eigen::Index>(k); }
  const Samples& samples_;
  const std::vector<int>& markers_;
  Eigen::Matrix3Xd places_;
};

/// Up to kShapeFrames frames with three markers or more, evenly drawn; the first of the list starts the
/// shape.
std::vector<std::int64_t> shape_frames(const Shape& shape, std::int64_t frames) {
  std::vector<std::int64_t> good;
  for (std::int64_t f = 0; f < frames; ++f)
    if (shape.seen(f) >= 3) good.push_back(f);
  const auto n = static_cast<std::int64_t>(good.size());
  if (n <= kShapeFrames) return good;
  std::vector<std::int64_t> drawn;
  for (std::int64_t i = 0; i < kShapeFrames; ++i)
    drawn.push_back(good[static_cast<std::size_t>(i * n / kShapeFrames)]);
  return drawn;
}

std::int64_t best_start(const Shape& shape, const std::vector<std::int64_t>& frames) {
  std::int64_t best = frames.front();
  int most = 0;
  double largest = -1.0;
  for (const std::int64_t f : frames) {
    const int n = shape.seen(f);
    if (n < most) continue;
    const double now = smallest_eigenvalue(inertia(shape.scatter(f)));
    if (n == most && now <= largest) continue;
    most = n;
    largest = now;
    best = f;
  }
  return best;
}

/// A segment without poses: markers along z at the places that their distances tell.
void lay_on_line(const Samples& samples, SegmentPoses& out) {
  out.kind = data::SegmentKind::line;
  const auto K = out.markers.size();
  if (K == 2) {
    double sum = 0.0, squares = 0.0;
    std::int64_t n = 0;
    for (std::int64_t f = 0; f < samples.trajectories.frames(); ++f) {
      if (!samples.seen(f, out.markers[0]) || !samples.seen(f, out.markers[1])) continue;
      const double d = (samples.x(f, out.markers[1]) - samples.x(f, out.markers[0])).norm();
      sum += d;
      squares += d * d;
      ++n;
    }
    out.x_in_segment.setConstant(kNone);
    if (n == 0) return;
    const double length = sum / static_cast<double>(n);
    out.x_in_segment.setZero();
    out.x_in_segment(2, 0) = 0.5 * length;
    out.x_in_segment(2, 1) = -0.5 * length;
    const double variance = std::max(0.0, squares / static_cast<double>(n) - length * length);
    if (n > 1) out.noise_sd_m = std::sqrt(0.5 * variance);
    return;
  }
  if (K == 1) {
    out.x_in_segment.setZero();
    return;
  }
  out.x_in_segment.topRows(2).setZero();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

SegmentPoses without_poses(const Samples& samples, const std::string& name, const std::vector<int>& markers) {
  const auto n = static_cast<std::size_t>(samples.trajectories.frames());
  SegmentPoses out;
  out.name = name;
  out.markers = markers;
  out.noise_sd_m = kNone;
  out.x_in_segment = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(markers.size()));
  out.known.assign(n, 0);
  out.world_from_segment.assign(n, Eigen::Matrix3d::Identity());
  out.origin.assign(n, Eigen::Vector3d::Zero());
  return out;
}

/// Poses of all frames, noise, and the frames that do not fit.
void pose_all_frames(const Shape& shape, const SegmentPoseOptions& options, SegmentPoses& out) {
  const std::int64_t frames = static_cast<std::int64_t>(out.known.size());
  std::vector<double> rms(out.known.size(), kNone), usual;
  double squares = 0.0, freedom = 0.0;
  const double share = 1e-4 * shape.least_inertia();
  if (share == 0.0) return;
  std::vector<double> least(out.known.size(), 0.0);
  for (std::int64_t f = 0; f < frames; ++f) {
    const FramePose p = shape.pose(f);
    const auto i = static_cast<std::size_t>(f);
    if (p.visible < 3 || !(p.least_inertia > share)) continue;
    out.known[i] = 1;
    out.world_from_segment[i] = p.rotation;
    out.origin[i] = p.origin;
    least[i] = p.least_inertia;
    rms[i] = std::sqrt(p.squares / (3 * p.visible - 6));
    usual.push_back(rms[i]);
  }
  if (usual.empty()) return;
  out.usual_rms_m = median(usual);
  double odd_squares = 0.0;
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto i = static_cast<std::size_t>(f);
    if (!out.known[i]) continue;
    if (out.usual_rms_m > 0.0 && rms[i] > options.odd_factor * out.usual_rms_m && rms[i] > 1e-6) {
      out.known[i] = 0;
      if (out.odd_frames++ == 0) out.first_odd_frame = f;
      odd_squares += rms[i] * rms[i];
      continue;
    }
    const double dof = 3 * shape.pose(f).visible - 6;
    squares += rms[i] * rms[i] * dof;
    freedom += dof;
  }
  if (out.odd_frames > 0) out.odd_rms_m = std::sqrt(odd_squares / static_cast<double>(out.odd_frames));
  freedom -= static_cast<double>(3 * out.markers.size()) - 6.0;
  out.noise_sd_m = freedom > 0.0 ? std::sqrt(squares / freedom) : kNone;
  if (options.noise_sd_m > 0.0) out.noise_sd_m = options.noise_sd_m;
  const double sd = out.noise_sd_m;
  for (std::size_t i = 0; i < out.known.size(); ++i) {
    if (!out.known[i]) continue;
    if (!std::isnan(sd) && sd > options.max_turn_sd_rad * std::sqrt(least[i])) out.known[i] = 0;
    out.known_frames += out.known[i];
  }
}

}  // namespace

Eigen::Matrix3d kabsch(const Eigen::Matrix3d& sum_world_segment) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_world_segment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  const Eigen::Matrix3d v = svd.matrixV();
  if ((u * v.transpose()).determinant() < 0.0) u.col(2) *= -1.0;
  return u * v.transpose();
}

Eigen::Matrix3d PoseNoise::at(const Eigen::Matrix3d& world_from_segment, const Eigen::Vector3d& x) const {
  const Eigen::Matrix3d arm = world_from_segment * cross_matrix(x - visible_mean);
  return mean_variance * Eigen::Matrix3d::Identity() + arm * turn * arm.transpose();
}

PoseNoise pose_noise(const Samples& samples, const SegmentPoses& poses, std::int64_t frame) {
  PoseNoise noise;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int n = 0;
  const auto visible = [&](std::size_t k) {
    return samples.seen(frame, poses.markers[k]) &&
           !std::isnan(poses.x_in_segment(0, static_cast<Eigen::Index>(k)));
  };
  for (std::size_t k = 0; k < poses.markers.size(); ++k) {
    if (!visible(k)) continue;
    noise.visible_mean += poses.x_in_segment.col(static_cast<Eigen::Index>(k));
    ++n;
  }
  if (n == 0) return noise;
  noise.visible_mean /= n;
  for (std::size_t k = 0; k < poses.markers.size(); ++k) {
    if (!visible(k)) continue;
    const Eigen::Vector3d d = poses.x_in_segment.col(static_cast<Eigen::Index>(k)) - noise.visible_mean;
    squares += d * d.transpose();
  }
  const double variance = std::isnan(poses.noise_sd_m) ? 0.0 : poses.noise_sd_m * poses.noise_sd_m;
  noise.mean_variance = variance / n;
  noise.turn = variance * inertia(squares).inverse();
  return noise;
}

SegmentPoses find_segment_poses(const Samples& samples, const std::string& name,
                                const std::vector<int>& markers, const SegmentPoseOptions& options) {
  SegmentPoses out = without_poses(samples, name, markers);
  Shape shape(samples, markers);
  const auto drawn =
      markers.size() < 3 ? std::vector<std::int64_t>{} : shape_frames(shape, samples.trajectories.frames());
  if (drawn.empty()) {
    lay_on_line(samples, out);
    return out;
  }
  shape.start(best_start(shape, drawn));
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const double change = shape.improve(drawn, round > 2);
    if (change < kSettled_m || (round > 8 && change > 0.98 * before && change < 1e-6)) break;
    before = change;
  }
  shape.turn_into_axes();
  out.x_in_segment = shape.places();
  out.kind = data::SegmentKind::solid;
  pose_all_frames(shape, options, out);
  if (out.known_frames == 0) lay_on_line(samples, out);
  return out;
}

SegmentPoses pose_known_shape(const Samples& samples, const std::string& name,
                              const std::vector<int>& markers, const Eigen::Matrix3Xd& x_in_segment,
                              const SegmentPoseOptions& options) {
  check(x_in_segment.cols() == static_cast<Eigen::Index>(markers.size()), "one place a marker");
  SegmentPoses out = without_poses(samples, name, markers);
  Shape shape(samples, markers);
  shape.set_places(x_in_segment);
  out.x_in_segment = x_in_segment;
  out.kind = data::SegmentKind::solid;
  pose_all_frames(shape, options, out);
  return out;
}

}  // namespace kinemark::skeleton
