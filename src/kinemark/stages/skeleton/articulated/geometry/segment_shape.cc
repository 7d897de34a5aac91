// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

constexpr std::int64_t kFewFrames = 2;  // more than this must tie a marker to three others

Eigen::Map<const Vector3d> position(const ChainSamples& samples, std::int64_t frame, int marker) {
  return Eigen::Map<const Vector3d>(samples.frame(frame) + 3 * marker);
}

// Mean squared distance less its noise, and how many frames tell it.
double distance2(const ChainSamples& samples, int a, int b, double sigma_m, std::int64_t& count) {
  double sum = 0.0;
  count = 0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (!samples.seen(f, a) || !samples.seen(f, b)) continue;
    sum += (position(samples, f, a) - position(samples, f, b)).squaredNorm();
    ++count;
  }
  return count == 0 ? 0.0 : std::max(sum / static_cast<double>(count) - 6.0 * sigma_m * sigma_m, 0.0);
}

// Points with these squared distances (classical scaling), about their mean; z longest, then x.
Eigen::Matrix3Xd scaled(const Eigen::MatrixXd& d2) {
  const Eigen::Index n = d2.rows();
  const Eigen::MatrixXd centring =
      Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(-0.5 * centring * d2 * centring);
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, n);
  const std::array<int, 3> axes{2, 0, 1};
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(n, 3); ++i) {
    const Eigen::Index e = n - 1 - i;
    points.row(axes[i]) =
        eigen.eigenvectors().col(e).transpose() * std::sqrt(std::max(eigen.eigenvalues()[e], 0.0));
  }
  return points;
}

// False for a marker that no frame ties to the others.
bool placed(const Eigen::Matrix3Xd& shape, Eigen::Index marker) { return !std::isnan(shape(0, marker)); }

// About the mean, in principal axes; what the kind leaves out is dropped.
void make_principal(Eigen::Matrix3Xd& points, SegmentKind kind) {
  Vector3d mean = Vector3d::Zero();
  double count = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!placed(points, i)) continue;
    mean += points.col(i);
    count += 1.0;
  }
  points.colwise() -= (mean / std::max(count, 1.0)).eval();
  Matrix3d scatter = Matrix3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (placed(points, i)) scatter += points.col(i) * points.col(i).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(scatter);
  Matrix3d own_from_old;
  own_from_old.row(2) = eigen.eigenvectors().col(2).transpose();
  own_from_old.row(0) = eigen.eigenvectors().col(1).transpose();
  own_from_old.row(1) = own_from_old.row(2).cross(own_from_old.row(0));
  points = (own_from_old * points).eval();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!placed(points, i)) continue;
    if (kind != SegmentKind::solid) points(1, i) = 0.0;
    if (kind == SegmentKind::line) points(0, i) = 0.0;
  }
}

// Each known marker's mean position in the segment's axes, over frames that fix these axes.
void average_positions(const ChainSamples& samples, std::span<const int> markers,
                       const std::vector<int>& known, std::span<const int> targets, Eigen::Matrix3Xd& shape) {
  std::vector<int> known_markers;
  Eigen::Matrix3Xd known_shape(3, known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    known_markers.push_back(markers[known[i]]);
    known_shape.col(i) = shape.col(known[i]);
  }
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, shape.cols());
  Eigen::VectorXd count = Eigen::VectorXd::Zero(shape.cols());
  Matrix3d R;
  Vector3d o;
  double spread = 0.0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (!rigid_pose(samples, f, known_markers, known_shape, SegmentKind::solid, R, o, spread)) continue;
    for (const int t : targets) {
      if (!samples.seen(f, markers[t])) continue;
      sum.col(t) += spread * (R.transpose() * (position(samples, f, markers[t]) - o));
      count[t] += spread;
    }
  }
  for (const int t : targets) {
    if (count[t] > 0.0) shape.col(t) = sum.col(t) / count[t];
  }
}

struct Triangle {
  std::array<int, 3> corner{-1, -1, -1};
  double quality = -1.0;
};

Triangle best_triangle(const ChainSamples& samples, std::span<const int> markers) {
  Triangle best;
  const int n = static_cast<int>(markers.size());
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < a; ++b) {
      for (int c = 0; c < b; ++c) {
        std::int64_t count = 0;
        double area = 0.0;
        for (std::int64_t f = 0; f < samples.frames && count < 300; ++f) {
          if (!samples.seen(f, markers[a]) || !samples.seen(f, markers[b]) || !samples.seen(f, markers[c]))
            continue;
          if (count < 50) {
            const Vector3d ab = position(samples, f, markers[b]) - position(samples, f, markers[a]);
            const Vector3d ac = position(samples, f, markers[c]) - position(samples, f, markers[a]);
            area += ab.cross(ac).norm();
          }
          ++count;
        }
        if (count < 3) continue;
        area /= static_cast<double>(std::min<std::int64_t>(count, 50));
        const double quality = area * std::sqrt(static_cast<double>(count));
        if (quality > best.quality) best = {{a, b, c}, quality};
      }
    }
  }
  return best;
}

}  // namespace

bool rigid_pose(const ChainSamples& samples, std::int64_t frame, std::span<const int> markers,
                const Eigen::Matrix3Xd& shape, SegmentKind kind, Matrix3d& rotation, Vector3d& origin,
                double& spread) {
  Vector3d mean_x = Vector3d::Zero();
  Vector3d mean_m = Vector3d::Zero();
  int n = 0;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!samples.seen(frame, markers[i]) || !placed(shape, static_cast<Eigen::Index>(i))) continue;
    mean_x += position(samples, frame, markers[i]);
    mean_m += shape.col(i);
    ++n;
  }
  if (n < (kind == SegmentKind::line ? 2 : 3)) return false;
  mean_x /= n;
  mean_m /= n;
  Matrix3d A = Matrix3d::Zero();
  Matrix3d S = Matrix3d::Zero();
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!samples.seen(frame, markers[i]) || !placed(shape, static_cast<Eigen::Index>(i))) continue;
    const Vector3d m = shape.col(i) - mean_m;
    A += (position(samples, frame, markers[i]) - mean_x) * m.transpose();
    S += m * m.transpose();
  }
  if (kind == SegmentKind::line) {
    const Vector3d z = A.col(2).normalized();
    const Vector3d x = z.unitOrthogonal();
    rotation << x, z.cross(x), z;
    spread = S(2, 2);
  } else {
    rotation = nearest_rotation(A);
    // Markers on a line still have a pose, but one that hardly determines the rotation about that line.
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(S, Eigen::EigenvaluesOnly);
    spread = axes.eigenvalues()[1] + 1e-6 * axes.eigenvalues()[2];
  }
  origin = mean_x - rotation * mean_m;
  return true;
}

Result<Eigen::Matrix3Xd> segment_shape(const ChainSamples& samples, std::span<const int> markers,
                                       SegmentKind kind, double sigma_m) {
  const int n = static_cast<int>(markers.size());
  Eigen::MatrixXd d2 = Eigen::MatrixXd::Zero(n, n);
  bool all_pairs = true;
  std::int64_t count = 0;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < a; ++b) {
      d2(a, b) = d2(b, a) = distance2(samples, markers[a], markers[b], sigma_m, count);
      all_pairs = all_pairs && count > 0;
    }
  }
  Eigen::Matrix3Xd shape;
  const bool line = kind == SegmentKind::line;
  if (all_pairs && (n <= 3 || line)) {
    shape = scaled(d2);
  } else {
    const Triangle start = best_triangle(samples, markers);
    if (start.quality < 0.0) {
      return fail(Code::bad_input,
                  "a segment has no three markers that are seen together in three frames or more; its shape "
                  "cannot be known");
    }
    std::vector<int> known(start.corner.begin(), start.corner.end());
    Eigen::MatrixXd corner(3, 3);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) corner(i, j) = d2(known[i], known[j]);
    }
    shape = Eigen::Matrix3Xd::Constant(3, n, std::numeric_limits<double>::quiet_NaN());
    const Eigen::Matrix3Xd triangle = scaled(corner);
    for (int i = 0; i < 3; ++i) shape.col(known[i]) = triangle.col(i);
    while (static_cast<int>(known.size()) < n) {
      int next = -1;
      std::int64_t most = 0;
      for (int t = 0; t < n; ++t) {
        if (std::find(known.begin(), known.end(), t) != known.end()) continue;
        std::int64_t frames = 0;
        for (std::int64_t f = 0; f < samples.frames; ++f) {
          if (!samples.seen(f, markers[t])) continue;
          int others = 0;
          for (const int k : known) others += samples.seen(f, markers[k]) ? 1 : 0;
          if (others >= 3) ++frames;
        }
        if (frames > std::max<std::int64_t>(most, kFewFrames)) {
          most = frames;
          next = t;
        }
      }
      if (next < 0) break;
      const std::array<int, 1> target{next};
      average_positions(samples, markers, known, target, shape);
      known.push_back(next);
      for (int round = 0; round < 3; ++round) average_positions(samples, markers, known, known, shape);
    }
  }
  if (n >= 3 && !line) {
    std::vector<int> all;
    for (int i = 0; i < n; ++i) {
      if (placed(shape, i)) all.push_back(i);
    }
    for (int round = 0; round < 8; ++round) average_positions(samples, markers, all, all, shape);
  }
  make_principal(shape, kind);
  return shape;
}

}  // namespace kinemark::skeleton::articulated
