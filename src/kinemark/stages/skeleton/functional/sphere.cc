// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/sphere.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/data/joint_choice.h"

namespace kinemark::skeleton {
namespace {

constexpr int kCorrections = 50;
constexpr double kSettled_m = 1e-9;
constexpr double kLeastSamples = 4.0;

/// Moments of one point in the still segment, about a fixed origin near the points.
struct Moments {
  double n = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), third = Eigen::Vector3d::Zero();  ///< sum v, sum v |v|^2
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();                                  ///< sum v v'
  double squares = 0.0, quartic = 0.0;                                               ///< sum |v|^2, sum |v|^4

  void add(const Eigen::Vector3d& v) {
    const double s = v.squaredNorm();
    n += 1.0;
    first += v;
    third += s * v;
    second += v * v.transpose();
    squares += s;
    quartic += s * s;
  }
  Moments& operator+=(const Moments& o) {
    n += o.n;
    first += o.first;
    third += o.third;
    second += o.second;
    squares += o.squares;
    quartic += o.quartic;
    return *this;
  }
  [[nodiscard]] Moments without(const Moments& o) const {
    Moments m = *this;
    m.n -= o.n;
    m.first -= o.first;
    m.third -= o.third;
    m.second -= o.second;
    m.squares -= o.squares;
    m.quartic -= o.quartic;
    return m;
  }
};

struct Centre {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d open =
      Eigen::Vector3d::Zero();  ///< SD along each direction due to undetermined directions, m
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  double noise_variance = 0.0;
};

/// Variance of the squared distances of one point from m over (2 r)^2: the variance of the distance.
double distance_variance(const Moments& p, const Eigen::Vector3d& m) {
  const Eigen::Vector3d mean = p.first / p.n;
  const double mean_squares = p.squares / p.n;
  const Eigen::Matrix3d cov = p.second / p.n - mean * mean.transpose();
  const Eigen::Vector3d mixed = p.third / p.n - mean * mean_squares;
  const double variance =
      p.quartic / p.n - mean_squares * mean_squares - 4.0 * m.dot(mixed) + 4.0 * m.dot(cov * m);
  const double r2 = mean_squares - 2.0 * m.dot(mean) + m.squaredNorm();
  return r2 > 0.0 ? std::max(0.0, variance) / (4.0 * r2) : 0.0;
}

Centre solve(const std::vector<Moments>& points, const SphereOptions& options) {
  Centre c;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero(), means = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (const Moments& p : points) {
    if (p.n < kLeastSamples) continue;
    const Eigen::Vector3d mean = p.first / p.n;
    spread += 2.0 * (p.second - p.n * mean * mean.transpose());
    right += p.third - mean * p.squares;
    means += p.first;
    total += p.n;
  }
  if (total == 0.0) return c;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread / total);
  c.directions = eigen.eigenvectors();
  if (options.about_axis) c.axis = c.directions.col(0);
  right /= total;
  means /= total;
  Eigen::Vector3d corrected = right;
  for (int i = 0; i < kCorrections; ++i) {
    const Eigen::Vector3d before = c.position;
    c.position.setZero();
    // A distance's variance s^2 counts in these equations as 4 r^2 s^2; the prior is weighed against that.
    const double r2 = std::max(1e-12, (eigen.eigenvalues().sum() + (means - before).squaredNorm()));
    const double prior =
        2.0 * c.noise_variance * r2 / (total * data::kJointPriorSd_m * data::kJointPriorSd_m) +
        1e-9 * eigen.eigenvalues()(2) + 1e-300;
    for (int k = options.about_axis ? 1 : 0; k < 3; ++k) {
      const Eigen::Vector3d e = c.directions.col(k);
      const double value = std::max(0.0, eigen.eigenvalues()(k));
      // The prior ties the centre to the points' mean.
      c.position += e * ((e.dot(corrected) + prior * e.dot(means)) / (value + prior));
      const double from_prior = prior / (value + prior);
      const double from_noise = std::min(1.0, 2.0 * c.noise_variance / (value + prior));
      const double drawn = options.correct_bias ? 0.0 : from_noise * std::abs(e.dot(c.position - means));
      c.open(k) = std::min(data::kJointPriorSd_m,
                           data::kJointPriorSd_m * (from_prior + from_noise * from_noise) + drawn);
    }
    if (options.about_axis) {
      c.open(0) = data::kJointPriorSd_m;
      c.position += c.axis * c.axis.dot(means);
    }
    double variance = 0.0;
    for (const Moments& p : points)
      if (p.n >= kLeastSamples) variance += p.n * distance_variance(p, c.position);
    c.noise_variance = variance / total;
    if (options.correct_bias) corrected = right - 2.0 * c.noise_variance * (means - c.position);
    if ((c.position - before).norm() < kSettled_m) break;
  }
  return c;
}

}  // namespace

SphereFit fit_spheres(const Samples& samples, const SegmentPoses& still, const std::vector<int>& moving,
                      const SphereOptions& options) {
  SphereFit fit;
  fit.radii_m = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(moving.size()),
                                          std::numeric_limits<double>::quiet_NaN());
  std::vector<std::int64_t> frames;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (std::int64_t f = 0; f < samples.trajectories.frames(); ++f) {
    if (!still.known[static_cast<std::size_t>(f)]) continue;
    const auto before = fit.samples;
    for (const int m : moving) {
      if (!samples.seen(f, m)) continue;
      origin += still.to_segment(f, samples.x(f, m));
      ++fit.samples;
    }
    if (fit.samples > before) frames.push_back(f);
  }
  fit.frames = static_cast<std::int64_t>(frames.size());
  if (fit.frames < static_cast<std::int64_t>(kLeastSamples)) return fit;
  origin /= static_cast<double>(fit.samples);

  const std::int64_t blocks = std::min<std::int64_t>(kBlocks, fit.frames / 2);
  std::vector<std::vector<Moments>> parts(static_cast<std::size_t>(blocks),
                                          std::vector<Moments>(moving.size()));
  for (std::int64_t i = 0; i < fit.frames; ++i) {
    const std::int64_t f = frames[static_cast<std::size_t>(i)];
    auto& part = parts[static_cast<std::size_t>(i * blocks / fit.frames)];
    for (std::size_t k = 0; k < moving.size(); ++k)
      if (samples.seen(f, moving[k])) part[k].add(still.to_segment(f, samples.x(f, moving[k])) - origin);
  }
  std::vector<Moments> all(moving.size());
  for (const auto& part : parts)
    for (std::size_t k = 0; k < all.size(); ++k) all[k] += part[k];

  const Centre best = solve(all, options);
  fit.found = true;
  fit.centre = origin + best.position;
  fit.axis = best.axis;
  fit.residual_rms_m = std::sqrt(best.noise_variance);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].n < 1.0) continue;
    const double r2 =
        (all[k].squares - 2.0 * best.position.dot(all[k].first)) / all[k].n + best.position.squaredNorm();
    fit.radii_m(static_cast<Eigen::Index>(k)) = std::sqrt(std::max(0.0, r2));
  }
  const double scale = static_cast<double>(blocks - 1) / static_cast<double>(blocks);
  double tilts = 0.0;
  for (const auto& part : parts) {
    std::vector<Moments> rest(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) rest[k] = all[k].without(part[k]);
    const Centre without = solve(rest, options);
    Eigen::Vector3d d = without.position - best.position;
    if (options.about_axis) {
      const Eigen::Vector3d axis = without.axis.dot(best.axis) < 0.0 ? -without.axis : without.axis;
      tilts += scale * 0.5 * (axis - best.axis).squaredNorm();
      d -= best.axis * best.axis.dot(d);
    }
    fit.covariance += scale * d * d.transpose();
  }
  fit.axis_sd_rad = std::sqrt(tilts);
  for (int k = 0; k < 3; ++k) {
    const double sd = best.open(k);
    fit.covariance += sd * sd * best.directions.col(k) * best.directions.col(k).transpose();
  }
  return fit;
}

}  // namespace kinemark::skeleton
