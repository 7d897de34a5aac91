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
#include "kinemark/stages/analysis/path/low_pass.h"

namespace kinemark::analysis {
namespace {

constexpr double kHighestCutOff = 0.45;          // cycles per sample
constexpr std::int64_t kPilotRefits = 40;        // that tell the energy of noise
constexpr std::int64_t kColumns = 12;            // that are smoothed side by side, at most
constexpr std::int64_t kBatchSamples = 1 << 18;  // at once, so that an hour needs no more memory
constexpr std::int64_t kNoiseRows = 256;         // whose noise is made at once
constexpr double kLocal_s = 0.15;                // farthest neighbour that tells local energy
constexpr std::uint64_t kPilotStream = 1ULL << 62;
constexpr std::uint64_t kDisplacementStream = 1ULL << 61;

constexpr double kFlatBelow = 6.0;  // energy over that of noise, below which a pilot is flatter

// Noise on the samples that are seen: white of a deviation, or of a model where there are some.
struct Noise {
  const std::vector<bool>* seen;
  double sd;
  std::uint64_t seed, stream;
  const ColouredNoise* coloured = nullptr;
  const Eigen::MatrixXd* shape = nullptr;

  [[nodiscard]] const math::NoiseModel* model(std::int64_t number) const {
    return coloured == nullptr ? nullptr : &coloured->draws[at(number % std::ssize(coloured->draws))];
  }
  [[nodiscard]] std::uint64_t stream_of(std::int64_t number) const {
    return mix64(stream) ^ static_cast<std::uint64_t>(number);
  }
};

Noise noise_of(const Recording& recording, std::uint64_t seed, std::uint64_t stream) {
  return {.seen = &recording.seen,
          .sd = recording.noise_sd_m,
          .seed = seed,
          .stream = stream,
          .coloured = recording.noise.get(),
          .shape = recording.noise_shape.size() > 0 ? &recording.noise_shape : nullptr};
}

bool was_filtered(const Recording& recording) {
  return recording.noise != nullptr && recording.noise->model.kind == math::NoiseKind::filtered;
}

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

// Noise of a model added, and the filter applied to what stands there where the model has one; `noise`, where
// not null, gets what was added after the filter, with as many columns.
void add_coloured(SeriesMatrix& to, std::int64_t column, std::int64_t axes, const Noise& noise,
                  std::int64_t number, SeriesMatrix* noise_alone) {
  const auto& model = *noise.model(number);
  const auto stream = noise.stream_of(number);
  SeriesMatrix add = noise_before_filter(model, to.rows(), axes, noise.seed, stream);
  if (noise.shape != nullptr) add *= *noise.shape;
  if (model.order > 0) {
    const LowPassFilter filter(model, to.rows());
    SeriesMatrix path = to.middleCols(column, axes);
    filter.apply(path);
    filter.apply(add);
    to.middleCols(column, axes) = path;
  }
  add_floor(model, add, 0, axes, noise.seed, stream);
  for (std::int64_t i = 0; i < to.rows(); ++i)
    if (!(*noise.seen)[at(i)]) add.row(i).setZero();
  to.middleCols(column, axes) += add;
  if (noise_alone != nullptr) noise_alone->middleCols(column, axes) = add;
}

// Noise of one recording added to as many columns from `column` on as `axes` says.
void add_noise(SeriesMatrix& to, std::int64_t column, std::int64_t axes, const Noise& noise,
               std::int64_t number) {
  const std::uint64_t stream = noise.stream_of(number);
  std::vector<double> normals;
  for (std::int64_t first = 0; first < to.rows(); first += kNoiseRows) {
    const std::int64_t rows = std::min(kNoiseRows, to.rows() - first);
    normals.resize(at(rows * axes));
    math::fill_normals(noise.seed, stream, first * axes, normals);
    const double* from = normals.data();
    for (std::int64_t i = first; i < first + rows; ++i, from += axes) {
      if (!(*noise.seen)[at(i)]) continue;
      double* values = to.data() + i * to.cols() + column;
      if (noise.shape == nullptr)
        for (std::int64_t k = 0; k < axes; ++k) values[k] += noise.sd * from[k];
      else
        Eigen::Map<Eigen::VectorXd>(values, axes) +=
            noise.sd * (*noise.shape * Eigen::Map<const Eigen::VectorXd>(from, axes));
    }
  }
}

// Recordings first .. first + count side by side, as many columns each as the path has.
// Noise that is white at the file goes the shorter way, with the same numbers.
SeriesMatrix simulated(const SeriesMatrix& path, const Noise& noise, std::int64_t first, std::int64_t count,
                       SeriesMatrix* noise_alone = nullptr) {
  const auto axes = path.cols();
  SeriesMatrix out = path.replicate(1, count);
  for (std::int64_t k = 0; k < count; ++k) {
    const auto* model = noise.model(first + k);
    Noise white = noise;
    if (model != nullptr) white.sd = std::sqrt(model->variance);
    if (noise_alone == nullptr && (model == nullptr || model->kind == math::NoiseKind::white))
      add_noise(out, axes * k, axes, white, first + k);
    else
      add_coloured(out, axes * k, axes, noise, first + k, noise_alone);
  }
  return out;
}

void displace(RefitBatch& batch, const RefitNumbers& numbers) {
  const auto count = std::ssize(numbers.displacements);
  if (count == 0) return;
  std::vector<double> factors(at(count));
  for (std::int64_t k = 0; k < batch.count; ++k) {
    math::fill_normals(numbers.seed, kDisplacementStream + static_cast<std::uint64_t>(batch.first + k), 0,
                       factors);
    SeriesMatrix moved = factors[0] * numbers.displacements[0];
    for (std::int64_t i = 1; i < count; ++i) moved += factors[at(i)] * numbers.displacements[at(i)];
    for (auto* path : {&batch.simulated, &batch.less, &batch.least})
      if (path->size() > 0) path->middleCols(moved.cols() * k, moved.cols()) += moved;
  }
}

// What is left of increments' amplitude where `energy` is seen and `noise` is expected in it.
double kept_of(double energy, double noise, bool flatter) {
  if (!(energy > 0.0)) return 0.0;
  const double times = flatter && energy < kFlatBelow * noise ? 2.0 : 1.0;
  return std::sqrt(std::clamp(1.0 - times * noise / energy, 0.0, 1.0));
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

SeriesMatrix with_noise(const SeriesMatrix& path, const Recording& recording, std::uint64_t seed,
                        std::uint64_t stream, std::int64_t number) {
  const Noise noise = noise_of(recording, seed, stream);
  SeriesMatrix alone = SeriesMatrix::Zero(path.rows(), path.cols());
  if (noise.coloured == nullptr)
    add_noise(alone, 0, path.cols(), noise, number);
  else
    add_coloured(alone, 0, path.cols(), noise, number, nullptr);
  return path + alone;
}

double noise_let_through(const Recording& recording, std::int64_t number) {
  const auto& draws = recording.noise->draws;
  const auto& model = draws[at(number % std::ssize(draws))];
  const double half = std::min(kHighestCutOff, kLessSmooth * recording.choice.half_power);
  constexpr int kSteps = 128;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {  // as many below the cut-off as above
    const double u = (i + 0.5) / kSteps, f = 0.5 * u * u;
    const double gain = math::gain_of(math::LowPass::spline, recording.choice.order, half, f);
    sum += model.power(f) * gain * gain * 2.0 * u / kSteps;
  }
  return sum;
}

SeriesMatrix smoothed(const Recording& recording, double factor) {
  SeriesMatrix out = recording.x;
  smoother_of(recording, factor).smooth(out);
  return out;
}

Eigen::MatrixXd noise_shape(const Recording& recording, const SeriesMatrix& smooth) {
  // Twice the logarithm of the likelihood that unequal axes add: of noise alike along three axes it is above
  // this in one of 70,000 recordings (5 degrees of freedom).
  constexpr double kUnequal = 30.0;
  constexpr std::int64_t kLags = 50;
  const Eigen::Index axes = recording.x.cols();
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(axes, axes);
  SeriesMatrix left = recording.x - smooth;
  double count = 0.0;
  for (std::int64_t i = 0; i < left.rows(); ++i) {
    if (!recording.seen[at(i)]) left.row(i).setZero();
    squares += left.row(i).transpose() * left.row(i);
    count += recording.seen[at(i)] ? 1.0 : 0.0;
  }
  const double all = squares.trace(), mean = all / static_cast<double>(axes);
  if (!(mean > 0.0)) return {};
  // As many samples as white noise would need to know its covariance as well (Bartlett 1946).
  double alike = 1.0;
  for (std::int64_t lag = 1; lag <= std::min<std::int64_t>(kLags, left.rows() - 1); ++lag) {
    const double together =
        left.topRows(left.rows() - lag).cwiseProduct(left.bottomRows(left.rows() - lag)).sum() / all;
    alike += 2.0 * together * together;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shape(squares / mean);
  const double unequal = -count / alike * shape.eigenvalues().cwiseMax(1e-12).array().log().sum();
  return unequal > kUnequal ? Eigen::MatrixXd(shape.operatorSqrt()) : Eigen::MatrixXd();
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
  const Noise added = noise_of(recording, seed, stream ^ kPilotStream);
  const std::int64_t batch = batch_of(fit);
  for (std::int64_t begin = 0; begin < kPilotRefits; begin += batch) {
    const std::int64_t in_batch = std::min(batch, kPilotRefits - begin);
    // Of a path that is filtered or coloured the noise alone; else what the smoother does to the path, too.
    SeriesMatrix deviations =
        simulated(recording.noise ? SeriesMatrix(SeriesMatrix::Zero(n, axes)) : fit, added, begin, in_batch);
    smoother.smooth(deviations);
    if (!recording.noise)
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
    const double kept = kept_of(local[i], local_noise[i], recording.noise != nullptr);
    pilot.row(i + 1) = pilot.row(i) + kept * increments.row(i);
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
  pilot = ((pilot.rowwise() - mean) * shrink).rowwise() + mean;
  if (!was_filtered(recording)) return pilot;
  SeriesMatrix again = pilot;
  LowPassFilter(recording.noise->model, n).apply(again);
  return 2.0 * pilot - again;
}

void for_each_batch(const Recording& recording, const SeriesMatrix& path, const RefitNumbers& numbers,
                    const std::function<void(const RefitBatch&)>& visit) {
  const auto less = smoother_of(recording, kLessSmooth);
  std::optional<math::DifferenceSmoother> least;
  if (numbers.least_too) least.emplace(smoother_of(recording, kLeastSmooth));
  const Noise noise = noise_of(recording, numbers.seed, numbers.stream);
  const std::int64_t batch = batch_of(path);
  // Without a filter the noise is what differs from the smoothed path.
  const bool filtered =
      std::ranges::any_of(recording.noise ? recording.noise->draws : std::vector<math::NoiseModel>{},
                          [](const auto& draw) { return draw.order > 0; });
  SeriesMatrix smooth_path = numbers.noise_too && !filtered ? path : SeriesMatrix{};
  if (smooth_path.size() > 0) less.smooth(smooth_path);
  RefitBatch out;
  for (out.first = 0; out.first < numbers.count; out.first += batch) {
    out.count = std::min(batch, numbers.count - out.first);
    const bool alone = numbers.noise_too && filtered;
    if (alone) out.noise.resize(path.rows(), path.cols() * out.count);
    out.simulated = simulated(path, noise, out.first, out.count, alone ? &out.noise : nullptr);
    out.less = out.simulated;
    less.smooth(out.less);
    if (alone) less.smooth(out.noise);
    if (smooth_path.size() > 0) {
      out.noise = out.less;
      for (std::int64_t k = 0; k < out.count; ++k)
        out.noise.middleCols(path.cols() * k, path.cols()) -= smooth_path;
    }
    if (least) {
      out.least = out.simulated;
      least->smooth(out.least);
    }
    displace(out, numbers);
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
