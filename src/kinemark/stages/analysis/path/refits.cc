// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/refits.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

constexpr double kHighestCutOff = 0.45;          // cycles per sample
constexpr std::int64_t kPilotRefits = 40;        // that tell the energy of noise
constexpr std::int64_t kBatch = 16;              // recordings smoothed at once, at most
constexpr std::int64_t kBatchSamples = 1 << 18;  // of all of them, so that an hour needs no more memory
constexpr double kLocal_s = 0.15;                // farthest neighbour that tells local energy
constexpr std::uint64_t kPilotStream = 1ULL << 62;

math::DifferenceSmoother smoother_of(const Recording& recording, double factor) {
  math::DifferenceSmoother smoother(recording.seen, recording.choice.order);
  const double half_power = std::min(kHighestCutOff, recording.choice.half_power * factor);
  check(smoother.factor(half_power), "a chosen cut-off can be computed, and so can higher ones");
  return smoother;
}

std::int64_t batch_of(std::int64_t samples) {
  return std::clamp<std::int64_t>(kBatchSamples / std::max<std::int64_t>(1, samples), 1, kBatch);
}

// Recordings first .. first + count side by side, as many columns each as the path has.
SeriesMatrix simulated(const Recording& recording, const SeriesMatrix& path, std::int64_t first,
                       std::int64_t count, std::uint64_t seed, std::uint64_t stream) {
  const auto axes = path.cols();
  SeriesMatrix out(path.rows(), axes * count);
  for (std::int64_t k = 0; k < count; ++k)
    out.middleCols(axes * k, axes) =
        with_noise(path, recording.seen, recording.noise_sd_m, seed, stream, first + k);
  return out;
}

// Weighted sums of neighbours, beyond the ends nothing.
Eigen::VectorXd local_sum(const Eigen::VectorXd& values, const Eigen::VectorXd& window) {
  const std::int64_t half = window.size() / 2;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(values.size());
  for (std::int64_t i = 0; i < values.size(); ++i)
    for (std::int64_t k = -half; k <= half; ++k)
      if (i + k >= 0 && i + k < values.size()) out[i] += window[k + half] * values[i + k];
  return out;
}

Eigen::VectorXd hann(std::int64_t size) {
  Eigen::VectorXd out(size);
  for (std::int64_t i = 0; i < size; ++i)
    out[i] = size == 1 ? 1.0
                       : 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                              static_cast<double>(size - 1));
  return out;
}

}  // namespace

SeriesMatrix with_noise(const SeriesMatrix& path, const std::vector<bool>& seen, double sd,
                        std::uint64_t seed, std::uint64_t stream, std::int64_t number) {
  Random random(seed, mix64(stream) ^ static_cast<std::uint64_t>(number));
  SeriesMatrix out = path;
  double* values = out.data();
  const std::int64_t columns = path.cols(), count = out.size();
  for (std::int64_t i = 0; i < count; i += 2) {
    // Both of Box and Muller's numbers, for this value and the next.
    const double size = sd * std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    if (seen[at(i / columns)]) values[i] += size * std::cos(angle);
    if (i + 1 < count && seen[at((i + 1) / columns)]) values[i + 1] += size * std::sin(angle);
  }
  return out;
}

SeriesMatrix smoothed(const Recording& recording, double factor) {
  SeriesMatrix out = recording.x;
  smoother_of(recording, factor).smooth(out);
  return out;
}

SeriesMatrix pilot_path(const Recording& recording, std::int64_t first, std::int64_t count,
                        std::uint64_t seed, std::uint64_t stream) {
  const auto smoother = smoother_of(recording, 1.0);
  SeriesMatrix fit = recording.x;
  smoother.smooth(fit);
  const std::int64_t n = fit.rows();
  const auto axes = fit.cols();
  const SeriesMatrix increments = fit.bottomRows(n - 1) - fit.topRows(n - 1);
  const Eigen::VectorXd energy = increments.rowwise().squaredNorm();
  const Eigen::RowVectorXd mean = fit.middleRows(first, count).colwise().mean();
  const SeriesMatrix stretch = fit.middleRows(first, count).rowwise() - mean;
  const Eigen::MatrixXd spread =
      stretch.transpose() * stretch / static_cast<double>(std::max<std::int64_t>(1, count - 1));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(spread);

  // What deviations of refits from the path they were made of have: energy of increments, and variance along
  // the principal components of the stretch.
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(n - 1);
  Eigen::VectorXd noise_variance = Eigen::VectorXd::Zero(axes);
  const std::int64_t batch = batch_of(n);
  for (std::int64_t begin = 0; begin < kPilotRefits; begin += batch) {
    const std::int64_t in_batch = std::min(batch, kPilotRefits - begin);
    SeriesMatrix deviations = simulated(recording, fit, begin, in_batch, seed, stream ^ kPilotStream);
    smoother.smooth(deviations);
    for (std::int64_t k = 0; k < in_batch; ++k) {
      deviations.middleCols(axes * k, axes) -= fit;
      const SeriesMatrix part = deviations.block(first, axes * k, count, axes) * solver.eigenvectors();
      const SeriesMatrix level = part.rowwise() - part.colwise().mean().eval();
      noise_variance += level.colwise().squaredNorm().transpose() / static_cast<double>(count * kPilotRefits);
    }
    noise += (deviations.bottomRows(n - 1) - deviations.topRows(n - 1)).rowwise().squaredNorm() /
             static_cast<double>(kPilotRefits);
  }
  const auto farthest = static_cast<std::int64_t>(kLocal_s * recording.rate_hz);
  const std::int64_t width = std::min((n - 1) / 4 * 2 + 1, 2 * std::min((n - 1) / 50, farthest) + 9);
  const Eigen::VectorXd window = hann(width);
  const Eigen::VectorXd local = local_sum(energy, window), local_noise = local_sum(noise, window);
  SeriesMatrix pilot = fit;
  for (std::int64_t i = 0; i + 1 < n; ++i) {
    const double kept = local[i] > 0.0 ? std::clamp(1.0 - local_noise[i] / local[i], 0.0, 1.0) : 0.0;
    pilot.row(i + 1) = pilot.row(i) + std::sqrt(kept) * increments.row(i);
  }
  pilot.rowwise() += mean - pilot.middleRows(first, count).colwise().mean();

  // Principal components, less the variance that noise has along them.
  Eigen::VectorXd kept(axes);
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const double variance = solver.eigenvalues()[axis];
    kept[axis] =
        variance > 0.0 ? std::sqrt(std::clamp(1.0 - noise_variance[axis] / variance, 0.0, 1.0)) : 0.0;
  }
  const Eigen::MatrixXd shrink =
      solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose();
  return ((pilot.rowwise() - mean) * shrink).rowwise() + mean;
}

void for_each_refit(
    const Recording& recording, const SeriesMatrix& path, std::int64_t refits, std::uint64_t seed,
    std::uint64_t stream,
    const std::function<void(std::int64_t, const SeriesMatrix&, const SeriesMatrix&)>& visit) {
  const auto less = smoother_of(recording, kLessSmooth), least = smoother_of(recording, kLeastSmooth);
  const std::int64_t batch = batch_of(path.rows());
  for (std::int64_t first = 0; first < refits; first += batch) {
    const std::int64_t count = std::min(batch, refits - first);
    SeriesMatrix a = simulated(recording, path, first, count, seed, stream);
    SeriesMatrix b = a;
    less.smooth(a);
    least.smooth(b);
    const auto axes = path.cols();
    for (std::int64_t k = 0; k < count; ++k)
      visit(first + k, a.middleCols(axes * k, axes), b.middleCols(axes * k, axes));
  }
}

}  // namespace kinemark::analysis
