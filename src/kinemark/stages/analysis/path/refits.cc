// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/refits.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/normals.h"

namespace kinemark::analysis {
namespace {

constexpr double kHighestCutOff = 0.45;          // cycles per sample
constexpr std::int64_t kPilotRefits = 40;        // that tell the energy of noise
constexpr std::int64_t kColumns = 12;            // that are smoothed side by side, at most
constexpr std::int64_t kBatchSamples = 1 << 18;  // at once, so that an hour needs no more memory
constexpr std::int64_t kNoiseRows = 256;         // whose noise is made at once
constexpr double kLocal_s = 0.15;                // farthest neighbour that tells local energy
constexpr std::uint64_t kPilotStream = 1ULL << 62;

// White noise of a deviation, on the samples that are seen.
struct Noise {
  const std::vector<bool>* seen;
  double sd;
  std::uint64_t seed, stream;
};

math::DifferenceSmoother smoother_of(const Recording& recording, double factor) {
  math::DifferenceSmoother smoother(recording.seen, recording.choice.order);
  const double half_power = std::min(kHighestCutOff, recording.choice.half_power * factor);
  check(smoother.factor(half_power), "a chosen cut-off can be computed, and so can higher ones");
  return smoother;
}

// Recordings smoothed at once, so that their columns fill the smoother's vectors.
std::int64_t batch_of(const SeriesMatrix& path) {
  const std::int64_t most = kColumns / std::gcd(kColumns, path.cols());
  return std::clamp<std::int64_t>(kBatchSamples / std::max<std::int64_t>(1, path.rows()), 1, most);
}

// Noise of one recording added to as many columns from `column` on as `axes` says.
void add_noise(SeriesMatrix& to, std::int64_t column, std::int64_t axes, const Noise& noise,
               std::int64_t number) {
  const std::uint64_t stream = mix64(noise.stream) ^ static_cast<std::uint64_t>(number);
  std::vector<double> normals;
  for (std::int64_t first = 0; first < to.rows(); first += kNoiseRows) {
    const std::int64_t rows = std::min(kNoiseRows, to.rows() - first);
    normals.resize(at(rows * axes));
    math::fill_normals(noise.seed, stream, first * axes, normals);
    const double* from = normals.data();
    for (std::int64_t i = first; i < first + rows; ++i, from += axes) {
      if (!(*noise.seen)[at(i)]) continue;
      double* values = to.data() + i * to.cols() + column;
      for (std::int64_t k = 0; k < axes; ++k) values[k] += noise.sd * from[k];
    }
  }
}

// Recordings first .. first + count side by side, as many columns each as the path has.
SeriesMatrix simulated(const SeriesMatrix& path, const Noise& noise, std::int64_t first, std::int64_t count) {
  const auto axes = path.cols();
  SeriesMatrix out = path.replicate(1, count);
  for (std::int64_t k = 0; k < count; ++k) add_noise(out, axes * k, axes, noise, first + k);
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
  SeriesMatrix out = path;
  add_noise(out, 0, path.cols(), {.seen = &seen, .sd = sd, .seed = seed, .stream = stream}, number);
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
  const Noise white{
      .seen = &recording.seen, .sd = recording.noise_sd_m, .seed = seed, .stream = stream ^ kPilotStream};
  const std::int64_t batch = batch_of(fit);
  for (std::int64_t begin = 0; begin < kPilotRefits; begin += batch) {
    const std::int64_t in_batch = std::min(batch, kPilotRefits - begin);
    SeriesMatrix deviations = simulated(fit, white, begin, in_batch);
    smoother.smooth(deviations);
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t k = 0; k < in_batch; ++k) deviations.row(i).segment(axes * k, axes) -= fit.row(i);
    for (std::int64_t k = 0; k < in_batch; ++k) {
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

void for_each_batch(const Recording& recording, const SeriesMatrix& path, const RefitNumbers& numbers,
                    const std::function<void(const RefitBatch&)>& visit) {
  const auto less = smoother_of(recording, kLessSmooth);
  std::optional<math::DifferenceSmoother> least;
  if (numbers.least_too) least.emplace(smoother_of(recording, kLeastSmooth));
  const Noise noise{
      .seen = &recording.seen, .sd = recording.noise_sd_m, .seed = numbers.seed, .stream = numbers.stream};
  const std::int64_t batch = batch_of(path);
  RefitBatch out;
  for (out.first = 0; out.first < numbers.count; out.first += batch) {
    out.count = std::min(batch, numbers.count - out.first);
    out.simulated = simulated(path, noise, out.first, out.count);
    out.less = out.simulated;
    less.smooth(out.less);
    if (least) {
      out.least = out.simulated;
      least->smooth(out.least);
    }
    visit(out);
  }
}

void for_each_refit(
    const Recording& recording, const SeriesMatrix& path, std::int64_t refits, std::uint64_t seed,
    std::uint64_t stream,
    const std::function<void(std::int64_t, const SeriesMatrix&, const SeriesMatrix&)>& visit) {
  const auto axes = path.cols();
  for_each_batch(recording, path, {.count = refits, .seed = seed, .stream = stream},
                 [&](const RefitBatch& batch) {
                   for (std::int64_t k = 0; k < batch.count; ++k)
                     visit(batch.first + k, batch.less.middleCols(axes * k, axes),
                           batch.least.middleCols(axes * k, axes));
                 });
}

}  // namespace kinemark::analysis
