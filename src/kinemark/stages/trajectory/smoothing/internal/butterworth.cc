// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/internal/cutoff.h"
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr int kClassicOrder = 2;
constexpr double kClassicCutoffHz = 12.0;
constexpr double kMostOfHalfRate = 0.98;  ///< of a classic cut-off that the rate does not allow
constexpr std::int64_t kShortest = 12;    ///< stretches that choose a cut-off

struct Plan {
  int order = 0;
  double cutoff_hz = 0.0;  ///< as asked of butterworth()
  bool corrected = true;
  bool filters = true;
};

/// Share of white noise that passes (rms, squared) after `derivative` differences, and that the filter takes
/// away.
struct NoiseShares {
  std::array<double, 4> passes{};
  double taken = 0.0;
};

NoiseShares noise_shares(const Plan& plan, double rate_hz) {
  NoiseShares shares;
  std::vector<math::Biquad> sections;
  if (plan.filters) {
    const double cutoff = plan.cutoff_hz / rate_hz;
    sections = math::butterworth_lowpass(plan.order,
                                         plan.corrected ? math::two_pass_cutoff(plan.order, cutoff) : cutoff);
  }
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double f = 0.5 * (i + 0.5) / kSteps;
    const double both = std::pow(math::amplitude(sections, f), 2);
    double power = both * both / kSteps;
    shares.taken += (1.0 - both) * (1.0 - both) / kSteps;
    for (double& share : shares.passes) {
      share += power;
      power *= difference_power(f, 1.0 / rate_hz);
    }
  }
  return shares;
}

Plan make_plan(const MarkerSamples& samples, const SmoothOptions& options, double rate_hz,
               const std::vector<Stretch>& all, data::MarkerAccount& account) {
  if (options.method == FilterMethod::none) {
    account.description = "Not filtered; two-point differences.";
    return {.filters = false};
  }
  if (options.method == FilterMethod::classic) {
    const double asked = options.cutoff_hz > 0.0 ? options.cutoff_hz : kClassicCutoffHz;
    const double cutoff = std::min(asked, 0.5 * kMostOfHalfRate * rate_hz);
    account.description = fmt::format(
        "The chain of 1986: order {} both ways, {:.3g} Hz each way and {:.3g} Hz together, two-point "
        "differences.",
        kClassicOrder, cutoff, rate_hz * math::two_pass_half_power(kClassicOrder, cutoff / rate_hz));
    return {kClassicOrder, cutoff, false, true};
  }
  Plan plan{options.order > 0 ? options.order : 2, options.cutoff_hz, options.correct_cutoff, true};
  if (plan.cutoff_hz > 0.0) {
    account.description = fmt::format("Order {} both ways, {:.3g} Hz as asked.", plan.order, plan.cutoff_hz);
    return plan;
  }
  CutoffProblem problem{{}, plan.order, rate_hz};
  for (const Stretch& stretch : sample_of(all))
    if (stretch.length() >= kShortest)
      for (int axis = 0; axis < 3; ++axis) problem.columns.push_back(column(samples.x, stretch, axis));
  const bool winter = options.cutoff_rule == CutoffRule::winter;
  if (problem.columns.empty()) {
    plan.cutoff_hz = std::min(6.0, 0.25 * rate_hz);
    account.description =
        fmt::format("{:.3g} Hz: no span of {} samples to choose a cut-off by.", plan.cutoff_hz, kShortest);
  } else {
    plan.cutoff_hz = winter ? winter_cutoff_hz(problem) : challis_cutoff_hz(problem);
    account.description = fmt::format("Order {} both ways, {:.3g} Hz by {}.", plan.order, plan.cutoff_hz,
                                      winter ? "Winter's residual analysis" : "Challis' whitest residual");
  }
  return plan;
}

/// Noise per axis from the residual, assuming that it is all noise; NaN without measured samples.
double noise_from(const MarkerSamples& samples, const MarkerResult& result, double taken) {
  double sum = 0.0, count = 0.0;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (samples.judged[static_cast<std::size_t>(f)] == 0) continue;
    for (std::int64_t i = 3 * f; i < 3 * f + 3; ++i) {
      const double r = samples.x[static_cast<std::size_t>(i)] - result.x[static_cast<std::size_t>(i)];
      sum += r * r;
      count += 1.0;
    }
  }
  return count > 0.0 && taken > 0.0 ? std::sqrt(sum / count / taken) : kNaN;
}

}  // namespace

Status smooth_butterworth(const MarkerSamples& samples, const SmoothOptions& options, double rate_hz,
                          MarkerResult& result) {
  data::MarkerAccount& account = result.account;
  if (!samples.time_s.empty())
    return fail(Code::not_supported,
                fmt::format("marker '{}' is not seen at even times, which filter {} needs; use kalman",
                            account.name, to_string(options.method)));
  const auto all = stretches(samples.present);
  const Plan plan = make_plan(samples, options, rate_hz, all, account);
  const auto n = static_cast<std::size_t>(3 * samples.frames);
  Array<double>* const values[4] = {&result.x, &result.velocity, &result.acceleration, &result.jerk};
  for (Array<double>* v : values) v->assign(n, kNaN);
  for (const Stretch& stretch : all) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> x = column(samples.x, stretch, axis);
      if (plan.filters) butterworth(x, plan.order, plan.cutoff_hz, rate_hz, plan.corrected);
      for (int d = 0; d < 4; ++d) {
        if (d > 0) x = differences(x, samples.interval_s);
        for (std::int64_t f = stretch.begin; f < stretch.end; ++f)
          (*values[d])[static_cast<std::size_t>(3 * f + axis)] =
              x[static_cast<std::size_t>(f - stretch.begin)];
      }
    }
  }

  const NoiseShares shares = noise_shares(plan, rate_hz);
  double noise = options.noise_sd_m;
  account.noise_from = noise > 0.0 ? "given" : samples.has_covariance ? "covariance" : "data";
  if (noise <= 0.0)
    noise = samples.has_covariance ? samples.typical_sd_m : noise_from(samples, result, shares.taken);
  if (std::isnan(noise)) account.noise_from.clear();
  account.used.order = plan.order;
  account.used.cutoff_hz = !plan.filters ? kNaN
                           : plan.corrected
                               ? plan.cutoff_hz
                               : rate_hz * math::two_pass_half_power(plan.order, plan.cutoff_hz / rate_hz);
  account.used.noise_sd_m = noise;
  account.left_missing = samples.frames;
  for (const Stretch& stretch : all) account.left_missing -= stretch.length();
  if (std::isnan(noise)) return {};
  Array<double>* const sds[4] = {nullptr, &result.velocity_sd, &result.acceleration_sd, &result.jerk_sd};
  result.covariance.assign(2 * n, kNaN);
  for (int d = 1; d < 4; ++d) sds[d]->assign(n, kNaN);
  for (std::size_t i = 0; i < n; ++i) {
    for (int d = 1; d < 4; ++d)
      if (!std::isnan((*values[d])[i]))
        (*sds[d])[i] = noise * std::sqrt(shares.passes[static_cast<std::size_t>(d)]);
  }
  const double variance = noise * noise * shares.passes[0];
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    if (samples.present[static_cast<std::size_t>(f)] == 0) continue;
    math::pack_isotropic3(variance, result.covariance.data() + 6 * f);
  }
  return {};
}

}  // namespace kinemark::trajectory::smoothing
