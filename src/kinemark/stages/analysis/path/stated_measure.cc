// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/stated_measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/stages/analysis/path/internal/refit_values.h"
#include "kinemark/stages/analysis/path/pivot.h"
#include "kinemark/stages/analysis/path/refits.h"

namespace kinemark::analysis {
namespace {

constexpr double kRestCounts =
    0.05;                         // share of a stretch at rest from which a path's length is an upper bound
constexpr double kApart = 2.0;    // deviations, from which two estimates are not one with noise
constexpr double kTooWide = 0.5;  // half-width over value
constexpr double kMostlyDoubt = 2.0;  // spread among refits with most noise over that with least
constexpr double kBand_hz = 12.0;     // up to which tremor is looked for

void remark(data::Measure& measure, std::string_view sentence) {
  if (!measure.remark.empty()) measure.remark += "; ";
  measure.remark += sentence;
}

void only_at_most(data::Measure& measure, std::string_view why) {
  measure.interval.kind = data::IntervalKind::at_most;
  measure.interval.low = kNaN;
  remark(measure, why);
}

void only_at_least(data::Measure& measure, std::string_view why) {
  measure.interval.kind = data::IntervalKind::at_least;
  measure.interval.high = kNaN;
  remark(measure, why);
}

// The ratio of an unlikeness and its ends; from 1 on there is none.
Pivoted ratio_of(const Pivoted& p) {
  const auto ratio = [](double unlike) { return unlike < 1.0 ? 1.0 / std::sqrt(1.0 - unlike) : INFINITY; };
  return {.value = ratio(p.value),
          .sd = 0.5 * p.sd / std::pow(1.0 - p.value, 1.5),
          .low = ratio(p.low),
          .high = ratio(p.high)};
}

std::string method_of(const PathDefinition& definition, const StretchSummary& stretch) {
  if (definition.pivot == Pivot::raw_squared)
    return stretch.refits > 0 ? fmt::format("unsmoothed, {} refits of noise", stretch.refits) : "unsmoothed";
  std::string out = fmt::format("order {}, {:.3g} Hz", stretch.order, kLessSmooth * stretch.cut_off_hz);
  if (stretch.refits == 0) return out;
  if (definition.pivot == Pivot::of_derivative)
    out += fmt::format(", interval {:.3g} Hz", kLeastSmooth * stretch.cut_off_hz);
  return out + fmt::format(", {} refits", stretch.refits);
}

// Values whose half-width over them says something: sizes, not instants and logarithms.
bool is_size(const PathDefinition& definition) {
  return definition.what.quantity != data::Quantity::time &&
         definition.what.quantity != data::Quantity::ratio &&
         definition.what.quantity != data::Quantity::count;
}

// Sizes and deviations cannot be below 0, whatever the bias that is taken off.
double at_least_none(const PathDefinition& definition, double value) {
  return is_size(definition) || definition.what.id.ends_with("_sd") ? std::max(0.0, value) : value;
}

// Peaks and what needs derivatives beyond the first: what a filter takes first.
bool is_peak(const PathDefinition& definition) {
  return definition.weakness == Weakness::extreme_of_constant || definition.pivot == Pivot::of_derivative;
}

// What holds too few of simulated discrete movements where noise is correlated (70 and 93 %): upper ends of
// jerk, and the speed between two instants that the noise moves.
bool fails_under_correlation(const PathDefinition& definition) {
  return definition.weakness == Weakness::upper_alone_if_discrete ||
         definition.weakness == Weakness::of_instants;
}

// Why there is no interval, or an empty text.
std::string no_interval(const PathDefinition& definition, const StretchSummary& stretch,
                        const PathFrame& frame) {
  if (stretch.refits == 0) return "no interval was asked for";
  if (stretch.longest_gap_s > kLongestGap_s)
    return fmt::format("no interval: what happened in a gap of {:.2g} s is not known", stretch.longest_gap_s);
  if (!stretch.no_noise.empty()) return "no interval: " + stretch.no_noise;
  if (stretch.below_noise > 0.0 && definition.pivot != Pivot::raw_squared)
    return fmt::format("no interval: the movement about its slow trend is below {} the noise of {:.2g} mm",
                       stretch.below_noise < 1.0 ? "half" : fmt::format("{:g} times", stretch.below_noise),
                       1e3 * stretch.noise_sd_m);
  if (definition.needs_slow_noise && stretch.slow_noise_unknown)
    return fmt::format(
        "no interval: the noise below 2 Hz cannot be distinguished from movement (between {:.2g} and {:.2g} "
        "mm); "
        "state it",
        1e3 * stretch.slow_low_m, 1e3 * stretch.slow_high_m);
  if (stretch.correlated && frame.discrete && fails_under_correlation(definition))
    return "no interval: the noise is correlated, and an upper end would not hold between two rests";
  if (!stretch.velocity_jumps.empty() && definition.at_jumps == AtJumps::unbounded)
    return fmt::format("no interval: the velocity jumps ({}), and jerk has no bound there",
                       stretch.velocity_jumps);
  if (stretch.peak_at_jump && definition.at_jumps == AtJumps::of_speed)
    return fmt::format(
        "no interval: the velocity jumps ({}) where it is largest, and smoothing adds to it there",
        stretch.velocity_jumps);
  if (stretch.filtered_within && is_peak(definition))
    return "no interval: the spectrum falls within the movement's band as behind a low-pass, how much that "
           "took away is "
           "not in the data";
  return {};
}

// The interval of the smoothed path, widened to hold what a fit with sharp starts and stops gives where the
// two are further apart than noise brings them.
bool hold_both(const SharpValue& sharp, double value, Pivoted& ends) {
  if (std::isfinite(sharp.value) && !(std::abs(sharp.value - value) > kApart * ends.sd)) return false;
  const double low = std::fmin(ends.low, sharp.low), high = std::fmax(ends.high, sharp.high);
  const bool wider = low < ends.low || high > ends.high;
  ends.low = low, ends.high = high;
  return wider;
}

void put_interval(data::Measure& measure, const PathDefinition& definition, const Pivoted& pivoted,
                  const PathFrame& frame, const StretchSummary& stretch) {
  auto& interval = measure.interval;
  interval.kind = data::IntervalKind::two_sided;
  interval.low = at_least_none(definition, pivoted.low);
  interval.high = at_least_none(definition, pivoted.high);
  interval.approximate = definition.weakness == Weakness::approximate ||
                         (definition.weakness == Weakness::approximate_if_discrete && frame.discrete);
  const bool square = definition.pivot == Pivot::squared || definition.pivot == Pivot::raw_squared;
  if (square && pivoted.low <= 0.0)
    only_at_most(measure, "not distinguishable from 0");
  else if (definition.pivot == Pivot::of_ratio && std::isinf(pivoted.high))
    only_at_least(measure, "what it is divided by is not distinguishable from 0");
  else if (definition.pivot == Pivot::of_ratio && pivoted.low <= 1.0)
    only_at_most(measure, "not distinguishable from 1");
  else if (definition.weakness == Weakness::lengthened_at_rest && frame.share_at_rest > kRestCounts)
    only_at_most(measure, fmt::format("{:.0f} % of the span are at rest, where noise can only lengthen",
                                      100.0 * frame.share_at_rest));
  else if (definition.weakness == Weakness::extreme_of_constant && frame.steady)
    only_at_most(measure, "the speed hardly changes, so that its largest value is the noise's");
  else if (definition.weakness == Weakness::upper_if_discrete && frame.discrete)
    only_at_most(measure, "before and behind a movement noise can only lengthen it");
  else if (definition.weakness == Weakness::upper_alone)
    only_at_most(measure, "noise can only lengthen it");
  else if (definition.weakness == Weakness::upper_alone_if_discrete && frame.discrete)
    only_at_most(measure, "a start has jerk that no filter passes");
  if (!stretch.velocity_jumps.empty() && definition.at_jumps == AtJumps::at_least) {
    interval.kind = data::IntervalKind::at_least;
    interval.low = std::isnan(interval.low) ? 0.0 : interval.low;
    interval.high = kNaN;
    remark(measure,
           fmt::format("the velocity jumps ({}), quicker than samples can tell", stretch.velocity_jumps));
  }
  if (definition.pivot == Pivot::raw_squared && stretch.filtered_hz < kBand_hz) {
    interval.kind = data::IntervalKind::at_least;
    interval.low = std::isnan(interval.low) ? 0.0 : interval.low;
    interval.high = kNaN;
    measure.remark.clear();
    remark(measure,
           fmt::format("its spectrum falls as behind a low-pass at {:.2g} Hz: what it had above may be lost",
                       stretch.filtered_hz));
  }
  if (interval.kind == data::IntervalKind::two_sided && is_size(definition) &&
      0.5 * (interval.high - interval.low) > kTooWide * std::abs(measure.value))
    remark(measure, "the interval is too wide to support a claim");
}

}  // namespace

data::Measure state_measure(const PathDefinition& definition, const StretchSummary& stretch,
                            const PathFrame& frame, const MeasureNumbers& numbers) {
  data::Measure out{.id = std::string(definition.what.id),
                    .subject = stretch.subject,
                    .region = stretch.region,
                    .start_s = stretch.start_s,
                    .end_s = stretch.end_s,
                    .quantity = definition.what.quantity};
  out.share_not_measured = stretch.share_not_measured;
  out.method = method_of(definition, stretch);
  out.interval.level = stretch.level;
  const bool square = definition.pivot == Pivot::squared || definition.pivot == Pivot::raw_squared;
  auto pivoted = definition.pivot == Pivot::of_ratio
                     ? ratio_of(wide_pivot_of_square(internal::unlikeness(numbers.estimate),
                                                     numbers.deviations, stretch.level))
                 : square ? wide_pivot_of_square(numbers.estimate, numbers.deviations, stretch.level)
                          : wide_pivot(numbers.estimate, numbers.deviations, stretch.level);
  if (std::isinf(pivoted.value)) pivoted.value = numbers.estimate;
  // Thinning leaves next to no bias: what the refits find of it is as uncertain as it is large.
  if (numbers.thinned) pivoted.value = 0.5 * (pivoted.value + numbers.estimate);
  const std::string why_none = no_interval(definition, stretch, frame);
  if (definition.weakness == Weakness::needs_change && frame.steady) {
    remark(out, "the speed hardly changes");
    return out;
  }
  if (!std::isfinite(numbers.estimate)) {
    remark(out, definition.applies == Applies::discrete   ? "the span does not begin and end at rest"
                : definition.applies == Applies::periodic ? "the movement does not repeat"
                : definition.applies == Applies::round    ? "the movement does not go around"
                : definition.applies == Applies::closed || definition.applies == Applies::whole
                    ? "the movement does not come back to where it was"
                    : "too little movement");
    return out;
  }
  out.uncorrected = numbers.estimate;
  out.value = at_least_none(definition, std::isfinite(pivoted.value) ? pivoted.value : numbers.estimate);
  if (definition.pivot == Pivot::whole_number) out.value = std::round(out.value);
  if (!why_none.empty()) {
    remark(out, why_none);
    return out;
  }
  if (!std::isfinite(pivoted.value)) {
    remark(out, "no interval: too many of the refits do not determine it");
    return out;
  }
  Pivoted ends = pivoted;
  if (definition.pivot == Pivot::of_derivative)
    ends = wide_pivot(numbers.estimate_of_interval, numbers.deviations_of_interval, stretch.level);
  out.sd = std::isfinite(ends.low) ? ends.sd : pivoted.sd;  // of the interval that stands beside it
  if (definition.pivot == Pivot::of_derivative && !(ends.low <= out.value && out.value <= ends.high)) {
    out.value = at_least_none(definition, ends.value);  // as the interval has it
    out.uncorrected = numbers.estimate_of_interval;
    remark(out, "depends on how strongly the path is smoothed: value and interval of the weaker smoothing");
  }
  if (!std::isfinite(ends.low)) return out;
  const bool sharp = hold_both(numbers.sharp, out.value, ends);
  put_interval(out, definition, ends, frame, stretch);
  if (sharp && out.interval.kind == data::IntervalKind::two_sided)
    remark(out,
           "smoothing rounds off sharp starts and stops: the interval holds what a fit with them gives, too");
  if (numbers.doubt > kMostlyDoubt) remark(out, "most of the interval's width is doubt about the noise");
  return out;
}

}  // namespace kinemark::analysis
