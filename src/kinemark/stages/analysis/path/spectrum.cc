// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/wide.h"
#include "kinemark/math/fourier.h"

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kLong = 2048;       // samples from which a series is thinned out first
constexpr double kAttenuation_db = 200.0;  // of what would be taken for lower frequencies

// A low-pass of unit gain at 0 by Kaiser's window: weights -half .. half of the samples about one. Both bands
// are even within the attenuation.
// @param pass, stop  ends of the bands, cycles per sample
std::vector<double> low_pass(double pass, double stop) {
  const double width = 2.0 * std::numbers::pi * (stop - pass), middle = 0.5 * (pass + stop);
  const auto half = static_cast<std::int64_t>(std::ceil(0.5 * (kAttenuation_db - 8.0) / (2.285 * width)));
  const double beta = 0.1102 * (kAttenuation_db - 8.7);
  std::vector<double> out;
  for (std::int64_t k = -half; k <= half; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(half);
    const double angle = 2.0 * std::numbers::pi * middle * static_cast<double>(k);
    const double sinc = k == 0 ? 1.0 : std::sin(angle) / angle;
    out.push_back(2.0 * middle * sinc * std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - share * share)) /
                  std::cyl_bessel_i(0.0, beta));
  }
  return out;
}

// The same weights for the next series of the same rate, as refits have it.
const std::vector<double>& weights_of(double pass, double stop) {
  thread_local double last_pass = 0.0, last_stop = 0.0;
  thread_local std::vector<double> last;
  if (last.empty() || pass != last_pass || stop != last_stop) {
    last = low_pass(pass, stop);
    last_pass = pass, last_stop = stop;
  }
  return last;
}

// The transforms that were last needed: refits of a path need the same ones over and over.
math::FourierTransform& transform_of(std::int64_t length) {
  constexpr std::size_t kKept = 4;
  thread_local std::vector<std::unique_ptr<math::FourierTransform>> kept;
  const auto found = std::ranges::find(kept, length, [](const auto& one) { return one->length(); });
  if (found != kept.end()) return **found;
  if (kept.size() == kKept) kept.erase(kept.begin());
  kept.push_back(std::make_unique<math::FourierTransform>(length));
  return *kept.back();
}

// Powers of a series of any length, added to those of the frequencies from 0 on.
void add_powers(const Eigen::Ref<const Eigen::VectorXd>& series, std::int64_t length, Eigen::VectorXd& to) {
  if (math::FourierTransform::fits(length)) {
    transform_of(length).add_power(series, to);
    return;
  }
  std::vector<double> padded(static_cast<std::size_t>(length), 0.0);
  std::copy_n(series.data(), series.size(), padded.begin());
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  for (Eigen::Index k = 0; k < to.size(); ++k) to[k] += std::norm(spectrum[static_cast<std::size_t>(k)]);
}

// Weighted sums, `step` values apart, of `taps` values each, a multiple of kLanes.
[[gnu::always_inline]] inline void weighted_sums(const double* values, const double* weights,
                                                 std::int64_t taps, std::int64_t step, double* out,
                                                 std::int64_t count) {
  for (std::int64_t q = 0; q < count; ++q) {
    const double* from = values + q * step;
    Lanes sum, value, weight;
    spread(sum, 0.0);
    for (std::int64_t k = 0; k < taps; k += kLanes) {
      load(value, from + k), load(weight, weights + k);
      sum += value * weight;
    }
    out[q] = sum_of(sum);
  }
}

// A series thinned out: how many of its values stand before the one at its first sample.
struct Thinned {
  Eigen::VectorXd values;
  std::int64_t lead = 0;
};

// Every `step`-th sample of the low-passed series, from where its first sample is first felt.
Thinned thinned(const Eigen::Ref<const Eigen::VectorXd>& series, std::int64_t step,
                const std::vector<double>& weights) {
  const auto taps = static_cast<std::int64_t>(weights.size()), half = taps / 2;
  const std::int64_t n = series.size(), room = (taps + kLanes - 1) / kLanes * kLanes;
  Thinned out{.lead = (half + step - 1) / step};
  out.values.resize(out.lead + (n - 1 + half) / step + 1);
  Eigen::VectorXd filled =
      Eigen::VectorXd::Zero((out.values.size() - 1) * step + std::max(room, half + n) + half);
  filled.segment(out.lead * step + half, n) = series;
  std::vector<double> filled_weights = weights;
  filled_weights.resize(static_cast<std::size_t>(room), 0.0);
  run_wide<weighted_sums>(static_cast<const double*>(filled.data()),
                          static_cast<const double*>(filled_weights.data()), room, step, out.values.data(),
                          static_cast<std::int64_t>(out.values.size()));
  return out;
}

// How many samples may become one, so that frequencies to `pass` cycles per sample stay apart from what folds
// onto them.
std::int64_t step_of(double pass, std::int64_t length) {
  std::int64_t step = 1;
  while (3.0 * pass * static_cast<double>(2 * step) <= 1.0 && step < 64 &&
         math::FourierTransform::fits(length / (2 * step)) && length % (2 * step) == 0)
    step *= 2;
  return step;
}

}  // namespace

Eigen::VectorXd amplitudes(const Eigen::VectorXd& series, std::int64_t length) {
  return low_amplitudes(series, length, length / 2);
}

Eigen::VectorXd low_amplitudes(const Eigen::VectorXd& series, std::int64_t length, std::int64_t highest) {
  return low_powers(series, length, highest).cwiseSqrt();
}

Eigen::VectorXd low_powers(const Eigen::MatrixXd& series, std::int64_t length, std::int64_t highest) {
  check(highest >= 0 && highest <= length / 2, "a transform has frequencies up to half a cycle per sample");
  check(length >= series.rows(), "a transform is as long as its series, or longer");
  const double pass = static_cast<double>(highest) / static_cast<double>(length);
  const std::int64_t step = series.rows() < kLong ? 1 : step_of(pass, length), few = length / step;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(highest + 1);
  for (Eigen::Index k = 0; k < series.cols(); ++k) {
    if (step == 1) {
      add_powers(series.col(k), few, out);
      continue;
    }
    const auto thin = thinned(series.col(k), step, weights_of(pass, 1.0 / static_cast<double>(step) - pass));
    // What is felt before the first sample and behind the last comes round to the other end.
    Eigen::VectorXd round = Eigen::VectorXd::Zero(few);
    for (std::int64_t q = 0; q < thin.values.size(); ++q)
      round[(q - thin.lead + few) % few] += thin.values[q];
    add_powers(round, few, out);
  }
  return static_cast<double>(step * step) * out;
}

}  // namespace kinemark::analysis
