// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/path_smoother.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using State = Eigen::Matrix<double, 9, 1>;
using Square = Eigen::Matrix<double, 9, 9>;
using Tall = Eigen::Matrix<double, 9, 3>;

constexpr std::int64_t kBlock = 512;        // frames between two stored states
constexpr double kLongestGap_s = 1.0;       // without a frame that holds a place
constexpr double kPriorPlace_m2 = 1.0;      // about the first place found
constexpr double kPriorSpeed_m2_s2 = 1e2;   // limbs stay far below
constexpr double kPriorAcceleration = 1e6;  // m^2/s^4

/// Mean and covariance of (place, velocity, acceleration) before a frame is looked at.
struct Belief {
  State x = State::Zero();
  Square P = Square::Zero();
};

/// The weight that a frame's innovation z carries: (information^-1 + P)^-1, without inverting information.
struct Innovation {
  Vector3d z = Vector3d::Zero();
  Matrix3d weight = Matrix3d::Zero();
  double log_det = 0.0;
};

Innovation compare(const Vector3d& place, const Matrix3d& P, const PathPoint& point) {
  Innovation out;
  const Matrix3d B = Matrix3d::Identity() + P * point.information;
  const Matrix3d M = point.information * B.inverse();
  out.z = point.place - place;
  out.weight = 0.5 * (M + M.transpose());
  out.log_det = std::log(B.determinant());
  return out;
}

class Walk {
 public:
  Walk(double rate_hz, double white_jerk) : dt_(1.0 / rate_hz) {
    const double t = dt_, t2 = t * t, t3 = t2 * t;
    Q_ << t2 * t3 / 20, t2 * t2 / 8, t3 / 6, t2 * t2 / 8, t3 / 3, t2 / 2, t3 / 6, t2 / 2, t;
    Q_ *= white_jerk;
  }

  static Belief begin(const Vector3d& place) {
    Belief b;
    b.x.head<3>() = place;
    b.P.diagonal() << Vector3d::Constant(kPriorPlace_m2), Vector3d::Constant(kPriorSpeed_m2_s2),
        Vector3d::Constant(kPriorAcceleration);
    return b;
  }

  /// Look at a frame; returns its part of the log likelihood.
  static double update(Belief& b, const PathPoint& point) {
    if (point.information.isZero(0.0)) return 0.0;
    const Innovation i = compare(b.x.head<3>(), b.P.topLeftCorner<3, 3>(), point);
    const Tall K = b.P.leftCols<3>() * i.weight;
    b.x += K * i.z;
    b.P -= (K * b.P.topRows<3>()).eval();
    b.P = (0.5 * (b.P + b.P.transpose())).eval();
    return -0.5 * (i.z.dot(i.weight * i.z) + i.log_det);
  }

  /// On to the next frame.
  void predict(Belief& b) const {
    const double t = dt_, h = 0.5 * dt_ * dt_;
    b.x.head<3>() += t * b.x.segment<3>(3) + h * b.x.tail<3>();
    b.x.segment<3>(3) += t * b.x.tail<3>();
    b.P.topRows<3>() += t * b.P.middleRows<3>(3) + h * b.P.bottomRows<3>();
    b.P.middleRows<3>(3) += t * b.P.bottomRows<3>();
    b.P.leftCols<3>() += t * b.P.middleCols<3>(3) + h * b.P.rightCols<3>();
    b.P.middleCols<3>(3) += t * b.P.rightCols<3>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) b.P.block<3, 3>(3 * i, 3 * j).diagonal().array() += Q_(i, j);
  }

  /// What later frames say (x_given_all = x - P l, P_given_all = P - P L P), from after a frame to before it.
  static void look_back(State& l, Square& L, const Belief& b, const PathPoint& point) {
    if (point.information.isZero(0.0)) return;
    const Innovation i = compare(b.x.head<3>(), b.P.topLeftCorner<3, 3>(), point);
    const Tall U = b.P.leftCols<3>() * i.weight;
    l.head<3>() -= (U.transpose() * l).eval() + i.weight * i.z;
    const Tall LU = L * U;
    L.leftCols<3>() -= LU;
    L.topRows<3>() -= LU.transpose();
    L.topLeftCorner<3, 3>() += U.transpose() * LU + i.weight;
  }

  /// The same from a frame to the one before.
  void step_back(State& l, Square& L) const {
    const double t = dt_, h = 0.5 * dt_ * dt_;
    l.tail<3>() += t * l.segment<3>(3) + h * l.head<3>();
    l.segment<3>(3) += t * l.head<3>();
    L.rightCols<3>() += t * L.middleCols<3>(3) + h * L.leftCols<3>();
    L.middleCols<3>(3) += t * L.leftCols<3>();
    L.bottomRows<3>() += t * L.middleRows<3>(3) + h * L.topRows<3>();
    L.middleRows<3>(3) += t * L.topRows<3>();
    L = (0.5 * (L + L.transpose())).eval();
  }

 private:
  double dt_;
  Matrix3d Q_;
};

/// Frames [begin, end) without a gap too long to cross; the first place in them.
struct Piece {
  std::int64_t begin = 0, end = 0;
  Vector3d first_place = Vector3d::Zero();
};

std::vector<Piece> cut(std::span<const PathPoint> points, double rate_hz) {
  const auto F = static_cast<std::int64_t>(points.size());
  const auto longest = static_cast<std::int64_t>(kLongestGap_s * rate_hz);
  std::vector<Piece> pieces;
  std::int64_t last = 0;
  for (std::int64_t f = 0; f < F; ++f) {
    const PathPoint& point = points[static_cast<std::size_t>(f)];
    if (!holds_a_place(point)) continue;
    if (pieces.empty() || f - last > longest) {
      if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
      const std::int64_t earliest = pieces.empty() ? 0 : pieces.back().end;
      pieces.push_back({.begin = std::max(f - longest / 2, earliest), .end = F, .first_place = point.place});
    }
    last = f;
  }
  if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
  return pieces;
}

void store(SmoothedPath& path, std::size_t frame, const Vector3d& place, const Matrix3d& C) {
  path.place[frame] = place;
  math::pack_symmetric3(0.5 * (C + C.transpose()), path.covariance.data() + 6 * frame);
}

void smooth_piece(std::span<const PathPoint> points, const Piece& piece, const Walk& walk,
                  SmoothedPath& path) {
  // Forwards once, storing a state every kBlock frames; backwards block by block, forwards again in each.
  std::vector<Belief> starts;
  Belief b = Walk::begin(piece.first_place);
  for (std::int64_t f = piece.begin; f < piece.end; ++f) {
    if ((f - piece.begin) % kBlock == 0) starts.push_back(b);
    Walk::update(b, points[static_cast<std::size_t>(f)]);
    walk.predict(b);
  }
  std::vector<Belief> block(static_cast<std::size_t>(std::min(kBlock, piece.end - piece.begin)));
  State l = State::Zero();
  Square L = Square::Zero();
  for (auto s = static_cast<std::int64_t>(starts.size()) - 1; s >= 0; --s) {
    const std::int64_t begin = piece.begin + s * kBlock, end = std::min(begin + kBlock, piece.end);
    b = starts[static_cast<std::size_t>(s)];
    for (std::int64_t f = begin; f < end; ++f) {
      block[static_cast<std::size_t>(f - begin)] = b;
      Walk::update(b, points[static_cast<std::size_t>(f)]);
      walk.predict(b);
    }
    for (std::int64_t f = end - 1; f >= begin; --f) {
      const Belief& before = block[static_cast<std::size_t>(f - begin)];
      if (f + 1 < piece.end) walk.step_back(l, L);
      Walk::look_back(l, L, before, points[static_cast<std::size_t>(f)]);
      const Tall P = before.P.leftCols<3>();
      store(path, static_cast<std::size_t>(f), before.x.head<3>() - P.transpose() * l,
            before.P.topLeftCorner<3, 3>() - P.transpose() * L * P);
    }
  }
}

/// Mean over pieces of log likelihoods of windows: each begins afresh.
double likelihood_of(std::span<const PathPoint> points, const std::vector<Piece>& pieces, const Walk& walk) {
  double sum = 0.0;
  for (const Piece& piece : pieces) {
    Belief b = Walk::begin(piece.first_place);
    for (std::int64_t f = piece.begin; f < piece.end; ++f) {
      sum += Walk::update(b, points[static_cast<std::size_t>(f)]);
      walk.predict(b);
    }
  }
  return sum;
}

/// Log likelihood when every frame draws its place anew from one normal distribution.
double likelihood_of_unrelated(std::span<const PathPoint> points) {
  Vector3d mean = Vector3d::Zero();
  Matrix3d spread = Matrix3d::Zero();
  double n = 0.0;
  for (const PathPoint& p : points)
    if (holds_a_place(p)) mean += p.place, n += 1.0;
  if (n == 0.0) return 0.0;
  mean /= n;
  for (const PathPoint& p : points)
    if (holds_a_place(p)) spread += (p.place - mean) * (p.place - mean).transpose() / n;
  double sum = 0.0;
  for (const PathPoint& p : points) {
    if (!holds_a_place(p)) continue;
    const Innovation i = compare(mean, spread, p);
    sum -= 0.5 * (i.z.dot(i.weight * i.z) + i.log_det);
  }
  return sum;
}

}  // namespace

bool holds_a_place(const PathPoint& point) {
  const double mean = point.information.trace() / 3.0;
  return mean > 0.0 && point.information.determinant() > 1e-9 * mean * mean * mean;
}

Eigen::Matrix3d SmoothedPath::covariance_at(std::size_t frame) const {
  return math::unpack_symmetric3(covariance.data() + 6 * frame);
}

SmoothedPath smooth_path(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  SmoothedPath path;
  path.place.assign(points.size(), Vector3d::Constant(kNaN));
  path.covariance.assign(6 * points.size(), kNaN);
  const Walk walk(rate_hz, white_jerk);
  for (const Piece& piece : cut(points, rate_hz)) smooth_piece(points, piece, walk, path);
  return path;
}

double calc_path_likelihood(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  return likelihood_of(points, cut(points, rate_hz), Walk(rate_hz, white_jerk));
}

PathPrior find_path_prior(std::span<const PathPoint> points, double rate_hz, std::int64_t max_frames) {
  // Windows over the recording: a likelihood of the whole would cost a pass for each density tried.
  const auto F = static_cast<std::int64_t>(points.size());
  std::vector<std::span<const PathPoint>> windows;
  if (F <= max_frames) windows.push_back(points);
  for (int w = 0; F > max_frames && w < 4; ++w)
    windows.push_back(points.subspan(static_cast<std::size_t>((F - max_frames / 4) * w / 3),
                                     static_cast<std::size_t>(max_frames / 4)));
  const auto total = [&](double exponent) {
    double sum = 0.0;
    for (const auto& window : windows) sum += calc_path_likelihood(window, rate_hz, std::pow(10.0, exponent));
    return sum;
  };
  double best = -4.0, best_value = total(best);
  for (double exponent = -3.0; exponent <= 12.0; exponent += 1.0)
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  for (const double exponent : {best - 0.5, best + 0.5})
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  double unrelated = 0.0;
  for (const auto& window : windows) unrelated += likelihood_of_unrelated(window);
  return {.white_jerk = std::pow(10.0, best), .follows = best_value > unrelated};
}

}  // namespace kinemark::skeleton::articulated
