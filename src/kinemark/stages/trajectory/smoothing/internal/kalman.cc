// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/kalman.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/internal/choose.h"
#include "kinemark/stages/trajectory/smoothing/internal/error_bars.h"
#include "kinemark/stages/trajectory/smoothing/internal/gap_correction.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

std::vector<Series> parts_of(const std::vector<Series>& all) {
  std::vector<Series> parts;
  for (const Series& series : all)
    for (const Series& part : windows(series)) parts.push_back(part);
  return parts;
}

/// Variance of a derivative in noise units, scaled to what the data show.
/// @param left  factor on what a gap or an end adds
double scaled(double variance, int derivative, const BarScale& scale, double left) {
  const auto d = static_cast<std::size_t>(derivative);
  const double around = std::min(variance, scale.interior[d]);
  return scale.seen[d] * around + left * scale.added[d] * (variance - around);
}

class Writer {
 public:
  Writer(const MarkerSamples& samples, MarkerResult& result, double noise_sd_m)
      : samples_(samples), result_(result), noise_variance_(noise_sd_m * noise_sd_m) {
    const auto n = static_cast<std::size_t>(samples.frames);
    for (Array<double>* values : {&result.x, &result.velocity, &result.acceleration, &result.jerk})
      values->assign(3 * n, kNaN);
    if (std::isnan(noise_sd_m)) return;
    for (Array<double>* values : {&result.velocity_sd, &result.acceleration_sd, &result.jerk_sd})
      values->assign(3 * n, kNaN);
    result.covariance.assign(6 * n, kNaN);
  }

  /// Results of the axes from `first_axis` on, at all frames.
  /// @param left  frames x 4, factor on what gaps add; empty: 1
  void take(const Series& series, int first_axis, const std::vector<double>& state,
            const std::vector<double>& variance, const BarScale& scale, const std::vector<double>& left) {
    Array<double>* const values[4] = {&result_.x, &result_.velocity, &result_.acceleration, &result_.jerk};
    Array<double>* const sds[4] = {nullptr, &result_.velocity_sd, &result_.acceleration_sd, &result_.jerk_sd};
    for (std::int64_t f = 0; f < series.frames; ++f) {
      for (int d = 0; d < 4; ++d) {
        const auto i = static_cast<std::size_t>(4 * f + d);
        const double v = noise_variance_ * scaled(variance[i], d, scale, left.empty() ? 1.0 : left[i]);
        for (int axis = 0; axis < series.axes; ++axis) {
          const auto to = static_cast<std::size_t>(3 * f + first_axis + axis);
          (*values[d])[to] = state[static_cast<std::size_t>((f * series.axes + axis) * 4 + d)];
          if (result_.covariance.empty()) continue;
          if (d > 0)
            (*sds[d])[to] = std::sqrt(v);
          else
            result_.covariance[at(6 * f) + math::kSymmetric3Diagonal[at(first_axis + axis)]] = v;
        }
      }
    }
  }

  /// Off-diagonal covariances: the smoother keeps the correlation of the samples.
  void correlate(const data::Trajectories* in) {
    for (std::int64_t f = 0; f < samples_.frames && !result_.covariance.empty(); ++f) {
      double* c = result_.covariance.data() + 6 * f;
      c[1] = c[2] = c[4] = std::isnan(c[0]) ? kNaN : 0.0;
      if (in == nullptr || samples_.present[static_cast<std::size_t>(f)] == 0) continue;
      const double* r = in->covariance.data() + 6 * in->index(f, result_.marker);
      for (const auto& [off, a, b] : math::kSymmetric3Pairs) {
        const double rho = r[off] / std::sqrt(r[a] * r[b]);
        if (std::abs(rho) <= 1.0) c[off] = rho * std::sqrt(c[a] * c[b]);
      }
    }
  }

  /// Keep what was there before and what may be bridged; forget the rest.
  void bridge(const SmoothOptions& options) {
    const std::int64_t n = samples_.frames;
    for (std::int64_t f = 0; f < n;) {
      std::int64_t end = f;
      while (end < n && samples_.present[static_cast<std::size_t>(end)] == 0) ++end;
      if (end > f) {
        const bool fill = f > 0 && end < n && may_bridge(f, end, options);
        for (std::int64_t k = f; k < end; ++k) {
          if (fill)
            result_.state[static_cast<std::size_t>(k)] = data::SampleState::interpolated;
          else
            forget(k);
        }
        (fill ? result_.account.bridged : result_.account.left_missing) += end - f;
      }
      f = std::max(f + 1, end);
    }
  }

 private:
  [[nodiscard]] bool may_bridge(std::int64_t begin, std::int64_t end, const SmoothOptions& options) const {
    if (!(static_cast<double>(end - begin) * samples_.interval_s <= options.max_bridge_s) ||
        result_.covariance.empty())
      return false;
    for (std::int64_t f = begin; f < end; ++f)
      for (const std::size_t d : math::kSymmetric3Diagonal)
        if (!(std::sqrt(result_.covariance[at(6 * f) + d]) <= options.max_bridge_sd_m)) return false;
    return true;
  }

  void forget(std::int64_t f) {
    for (Array<double>* values : {&result_.x, &result_.velocity, &result_.acceleration, &result_.jerk,
                                  &result_.velocity_sd, &result_.acceleration_sd, &result_.jerk_sd})
      if (!values->empty()) std::fill_n(values->begin() + 3 * f, 3, kNaN);
    if (!result_.covariance.empty()) std::fill_n(result_.covariance.begin() + 6 * f, 6, kNaN);
  }

  const MarkerSamples& samples_;
  MarkerResult& result_;
  double noise_variance_;
};

/// Error that a criterion expects, without the part of the noise that no filter changes.
double expected_error(const data::FilterCandidate& candidate, double noise_sd_m) {
  return candidate.criterion - noise_sd_m * noise_sd_m;
}

/// What the choice weighed: "the least expected error (SURE) of ...", or which order had less and why it was
/// not taken.
std::string describe_choice(const Choice& choice, const SmoothOptions& options, bool gcv) {
  const std::string criterion = gcv ? "cross-validated error" : "expected error (SURE)";
  const std::string tried = options.order > 0         ? "all cut-offs tried at this order"
                            : options.cutoff_hz > 0.0 ? "all orders tried at this cut-off"
                                                      : "all orders and cut-offs tried";
  const auto& all = choice.candidates;
  const auto least = std::ranges::min_element(all, {}, &data::FilterCandidate::criterion);
  const auto taken = std::ranges::find(all, choice.order, &data::FilterCandidate::order);
  if (least == all.end() || taken == all.end() || !(least->criterion < taken->criterion))
    return fmt::format("the least {} of {}", criterion, tried);
  const double mine = expected_error(*taken, choice.noise_sd_m),
               its = expected_error(*least, choice.noise_sd_m);
  return fmt::format("order {} has {:.2g} % less {}, which is too little to give up jerk for", least->order,
                     mine > 0.0 ? 100.0 * (mine - its) / mine : 0.0, criterion);
}

/// "; N gaps are corrected ...", over the axes where these have filters of their own.
std::string describe_correction(const std::vector<GapCorrection>& corrections) {
  std::int64_t gaps = 0, hidden = std::numeric_limits<std::int64_t>::max();
  double left = 0.0;
  for (const GapCorrection& one : corrections) {
    gaps = std::max(gaps, one.gaps);
    hidden = std::min(hidden, one.hidden);
    left = std::max(left, one.error_left);
  }
  return fmt::format(
      "; {} {} corrected by what {} or more spans like {} show when hidden, where {:.0f} % of the error "
      "in "
      "velocity or less is left",
      gaps, gaps == 1 ? "gap is" : "gaps are", hidden, gaps == 1 ? "it" : "them", std::ceil(100.0 * left));
}

void describe(const Choice& choice, double cutoff_hz, const SmoothOptions& options,
              const std::vector<GapCorrection>& corrections, data::MarkerAccount& account) {
  const bool gcv = options.method == FilterMethod::gcv;
  account.criterion_name = options.order > 0 && options.cutoff_hz > 0.0 ? "" : gcv ? "GCV, m^2" : "SURE, m^2";
  account.candidates = choice.candidates;
  const std::string filter = fmt::format("order {}, cut-off {:.3g} Hz", choice.order, cutoff_hz);
  if (!choice.enough) {
    account.criterion_name.clear();
    account.description =
        fmt::format("{}: taken as they are, {} samples are too few to choose by.", filter, account.measured);
    return;
  }
  if (account.criterion_name.empty()) {
    account.description = fmt::format("{}: as asked.", filter);
    return;
  }
  account.description = fmt::format("{}: {}", filter, describe_choice(choice, options, gcv));
  if (cutoff_hz != choice.cutoff_hz)
    account.description += fmt::format(
        "; for positions alone {:.3g} Hz, moved towards the best for velocities", choice.cutoff_hz);
  if (!corrections.empty()) account.description += describe_correction(corrections);
  account.description += ".";
}

}  // namespace

void smooth_kalman(const MarkerSamples& samples, const data::Trajectories& in, const SmoothOptions& options,
                   MarkerResult& result) {
  data::MarkerAccount& account = result.account;
  std::vector<Array<double>> columns, judged_columns;
  ChooseOptions choosing;
  choosing.criterion = options.method == FilterMethod::gcv ? Criterion::gcv : Criterion::sure;
  choosing.order = options.order;
  choosing.cutoff_hz = options.cutoff_hz;
  choosing.noise_sd_m = options.noise_sd_m;
  choosing.rate_hz = in.time.rate_hz;
  const std::vector<Series> judged = parts_of(samples.series(samples.judged, judged_columns));
  Choice choice = choose(judged, choosing);
  double cutoff_hz = choice.cutoff_hz;
  account.noise_from = options.noise_sd_m > 0.0 ? "given" : "data";
  if (std::isnan(choice.noise_sd_m)) {
    account.noise_from = samples.has_covariance ? "covariance" : "";
    if (samples.has_covariance) choice.noise_sd_m = samples.typical_sd_m;
  }
  const double noise = choice.noise_sd_m;
  const bool free =
      choosing.criterion == Criterion::sure && choice.enough && noise > 0.0 && options.cutoff_hz == 0.0;
  if (free) cutoff_hz = refine_cutoff(judged, choice.order, choice.cutoff_hz, noise);
  BarScale scale;
  scale.interior.fill(std::numeric_limits<double>::infinity());
  if (choice.enough && noise > 0.0) scale = scale_bars(judged, choice.order, cutoff_hz, noise);

  Writer writer(samples, result, noise);
  std::vector<GapCorrection> corrections;
  int axis = 0;
  for (const Series& series : samples.series(samples.present, columns)) {
    std::vector<double> state(static_cast<std::size_t>(series.frames * series.axes * 4));
    std::vector<double> variance(static_cast<std::size_t>(series.frames * 4));
    smooth_series(series, choice.order, cutoff_hz, {state.data(), variance.data()});
    GapCorrection corrected;
    if (free)
      corrected = correct_gaps(judged, series, choice.order, cutoff_hz,
                               static_cast<std::int64_t>(options.max_bridge_s / samples.interval_s), state);
    writer.take(series, axis, state, variance, scale, corrected.left);
    if (corrected.gaps > 0) corrections.push_back(std::move(corrected));
    axis += series.axes;
  }
  writer.correlate(samples.has_covariance ? &in : nullptr);
  writer.bridge(options);

  account.used.order = choice.order;
  account.used.cutoff_hz = cutoff_hz;
  account.used.noise_sd_m = noise;
  account.process_noise =
      noise * noise * samples.interval_s * std::pow(corner_rad_s(choice.order, cutoff_hz), 2 * choice.order);
  for (std::size_t d = 0; d < 4; ++d) {
    account.bar_scale[d] = std::sqrt(scale.seen[d]);
    account.gap_bar_scale[d] = std::sqrt(scale.added[d]);
  }
  describe(choice, cutoff_hz, options, corrections, account);
}

}  // namespace kinemark::trajectory::smoothing
