// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/body_statement.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;

constexpr double kLongestGap_s = 0.2;  // beyond which nobody knows what happened
constexpr double kInstant = 0.25;      // of where it can be, the widest interval of an instant
constexpr double kTooWide = 0.5;       // half-width over value

void remark(data::Measure& measure, const std::string& sentence) {
  if (!measure.remark.empty()) measure.remark += "; ";
  measure.remark += sentence;
}

}  // namespace

BodyStatement::Gaps BodyStatement::gaps_in(const Eigen::MatrixX<bool>& known, Index c,
                                           const BodyStretch& stretch) const {
  std::int64_t missing = 0, run = 0, longest = 0;
  for (std::int64_t f = stretch.first; f < stretch.first + stretch.count; ++f) {
    run = known(f, c) ? 0 : run + 1;
    missing += run > 0;
    longest = std::max(longest, run);
  }
  return {static_cast<double>(missing) / static_cast<double>(stretch.count),
          static_cast<double>(longest) / record_.time.rate_hz};
}

// What is not determined of all that a measure rests on: the worst of it.
BodyStatement::Gaps BodyStatement::gaps_of(const BodySlot& slot) const {
  Gaps worst;
  const auto add = [&](Index c) {
    const auto one = gaps_in(record_.determined, c, *slot.stretch);
    worst = {std::max(worst.share, one.share), std::max(worst.longest_s, one.longest_s)};
  };
  const auto scope = slot.definition->scope;
  if (scope == BodyScope::coordinate || scope == BodyScope::torque || scope == BodyScope::pair) add(slot.a);
  if (scope == BodyScope::pair) add(slot.b);
  if (scope >= BodyScope::body)
    for (Index c = 0; c < record_.size(); ++c)
      if (record_.is_root[at(c)] && smoothers_[at(c)]) add(c);
  return worst;
}

// Coordinates that carry parts of the body and are held where nothing fixes them.
std::vector<std::string> BodyStatement::held_in(const BodyStretch& stretch) const {
  std::vector<std::string> out;
  for (Index c = 0; c < record_.size(); ++c)
    if (record_.measured[at(c)] && !record_.is_root[at(c)] &&
        gaps_in(record_.determined, c, stretch).longest_s > kLongestGap_s)
      out.push_back(record_.names[at(c)]);
  return out;
}

// The movement of a coordinate in the stretch is smaller than half of its errors.
bool BodyStatement::below_noise(const BodySlot& slot) const {
  const auto noise = smoothers_[at(slot.a)]->noise();
  const double variance = noise.white * noise.white + noise.slow * noise.slow;
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::int64_t f = slot.stretch->first; f < slot.stretch->first + slot.stretch->count; ++f)
    if (record_.determined(f, slot.a)) {
      const double x = record_.q(f, slot.a) - record_.q(slot.stretch->first, slot.a);
      sum += x, squares += x * x, count += 1.0;
    }
  return count > 1.0 && variance > 0.0 &&
         squares / count - (sum / count) * (sum / count) - variance <= kMovesAtAll * variance;
}

std::string BodyStatement::subject_of(const BodySlot& slot) const {
  switch (slot.definition->scope) {
    case BodyScope::coordinate:
    case BodyScope::torque:
      return record_.names[at(slot.a)];
    case BodyScope::pair:
      return record_.names[at(slot.a)] + " and " + record_.names[at(slot.b)];
    default:
      return "whole body";
  }
}

std::string BodyStatement::method_of(const BodySlot& slot) const {
  const auto scope = slot.definition->scope;
  const bool one = scope == BodyScope::coordinate || scope == BodyScope::torque;
  std::string out;
  if (one && std::isfinite(smoothers_[at(slot.a)]->cut_off_hz()))
    out = fmt::format("smoothed at {:.3g} Hz", kLessSmooth * smoothers_[at(slot.a)]->cut_off_hz());
  else
    out = one || !rests_on_smoothed(slot) ? "as it is" : "each coordinate smoothed by itself";
  if (options_.refits > 0) out += fmt::format(", {} refits", options_.refits);
  return out;
}

// Whether any of what a measure of several coordinates rests on was smoothed.
bool BodyStatement::rests_on_smoothed(const BodySlot& slot) const {
  const auto is_smoothed = [](const std::optional<CoordinateSmoother>& s) {
    return s && std::isfinite(s->cut_off_hz());
  };
  if (slot.definition->scope == BodyScope::pair)
    return is_smoothed(smoothers_[at(slot.a)]) || is_smoothed(smoothers_[at(slot.b)]);
  return std::ranges::any_of(smoothers_, is_smoothed);
}

// Whether anything tells of errors: of the coordinate, of the pair, of any.
bool BodyStatement::errors_known(const BodySlot& slot) const {
  const auto has = [](const std::optional<CoordinateSmoother>& s) {
    return s && (s->noise().white > 0.0 || s->noise().slow > 0.0);
  };
  const auto scope = slot.definition->scope;
  if (scope == BodyScope::coordinate) return has(smoothers_[at(slot.a)]);
  return std::ranges::any_of(smoothers_, has);
}

// Why there is no value, or an empty text.
std::string BodyStatement::no_value(const BodySlot& slot, double value, const Gaps& gaps) const {
  if (gaps.share >= 1.0) return "nothing fixes it in this span";
  if (slot.definition->scope == BodyScope::torque) {
    const auto unknown = gaps_in(record_.torque_known, slot.a, *slot.stretch);
    if (unknown.share > 0.0)
      return fmt::format("the torque is not determined in {:.0f} % of the span",
                         std::max(1.0, std::round(100.0 * unknown.share)));
  }
  if (std::isfinite(value)) return {};
  switch (slot.definition->scope) {
    case BodyScope::torque:
      return "the torque is not known throughout";
    case BodyScope::pair:
      return "one of the two does not move";
    case BodyScope::support:
      return "no foot stands";
    case BodyScope::side:
      return "the foot does not stand, or the body does not travel at 0.2 m/s";
    default:
      return momentum_known_ && slot.definition->what.quantity == data::Quantity::angular_momentum
                 ? "what it is compared with is not known"
                 : "the motion of the mass centre is not known throughout";
  }
}

std::string BodyStatement::no_interval(const BodySlot& slot, const Gaps& gaps) const {
  if (options_.refits == 0) return "no interval was asked for";
  if (gaps.longest_s > kLongestGap_s)
    return fmt::format("no interval: what happened in {:.2g} s without data is not known", gaps.longest_s);
  if (!errors_known(slot)) return "no interval: no deviation is stated, and the samples show no noise";
  if (slot.definition->scope == BodyScope::coordinate && slot.definition->what.id != "joint_mean" &&
      below_noise(slot))
    return "no interval: it moves by less than half of its errors";
  return {};
}

data::Measure BodyStatement::state(const BodySlot& slot, double value, const MeasureErrors* errors) const {
  const auto& definition = *slot.definition;
  const auto& stretch = *slot.stretch;
  data::Measure measure{
      .id = std::string(definition.what.id),
      .subject = subject_of(slot),
      .context = definition.scope == BodyScope::side ? std::string(to_string(slot.side)) : stretch.context,
      .region = stretch.name,
      .cycle = stretch.cycle,
      .start_s = record_.time.time_s(stretch.first),
      .end_s = record_.time.time_s(stretch.first + stretch.count - 1)};
  const bool rotation = record_.is_rotation[at(slot.a)] || definition.scope >= BodyScope::body;
  measure.quantity = quantity_of(definition, rotation, options_.normalized);
  measure.method = method_of(slot);
  measure.interval.level = options_.level;
  const auto gaps = gaps_of(slot);
  measure.share_not_measured = gaps.share;
  if (const auto why = no_value(slot, value, gaps); !why.empty()) {
    measure.remark = why;
    return measure;
  }
  measure.uncorrected = measure.value = value;
  if (const auto why = no_interval(slot, gaps); !why.empty())
    remark(measure, why);
  else
    put_interval(slot, value, *errors, measure);
  if (definition.scope >= BodyScope::body)
    if (const auto held = held_in(stretch); !held.empty()) {
      measure.interval.approximate = true;
      remark(measure, "held where nothing fixes them: " + join_names(held, 4));
    }
  return measure;
}

void BodyStatement::put_interval(const BodySlot& slot, double found_value, const MeasureErrors& errors,
                                 data::Measure& measure) const {
  const auto& definition = *slot.definition;
  const double mirror = definition.sign < 0 ? -1.0 : 1.0;  // of what is never above 0
  auto deviations = errors.deviations();
  for (double& d : deviations)
    d = mirror * (definition.turns ? std::remainder(d, 2.0 * std::numbers::pi) : d);
  const auto found = pivot_of(definition, mirror * errors.value(), deviations);
  if (!std::isfinite(found.value)) {
    remark(measure, "no interval: too many of the refits do not determine it");
    return;
  }
  if (definition.is_instant()) {
    put_instant(slot, found, found_value, errors.reach(), measure);
    return;
  }
  const auto bounded = [&](double x) { return mirror * (definition.sign != 0 ? std::max(0.0, x) : x); };
  // The value of an extreme is the mean of the thinned one and of its pivot, as for paths.
  const double value =
      definition.curve != nullptr ? 0.5 * (mirror * errors.value() + found.value) : found.value;
  measure.value = bounded(value);
  measure.sd = found.sd;
  auto& interval = measure.interval;
  interval.kind = data::IntervalKind::two_sided;
  interval.low = std::min(bounded(found.low), bounded(found.high));
  interval.high = std::max(bounded(found.low), bounded(found.high));
  interval.approximate = definition.approximate;
  if (definition.sign != 0 && found.low <= 0.0) {
    interval.kind = mirror > 0.0 ? data::IntervalKind::at_most : data::IntervalKind::at_least;
    (mirror > 0.0 ? interval.low : interval.high) = kNaN;
    remark(measure, "not distinguishable from 0");
  } else if ((definition.sign != 0 || definition.scope == BodyScope::torque) &&
             0.5 * (found.high - found.low) > kTooWide * std::abs(measure.value)) {
    remark(measure, "the interval is too wide to support a claim");
  }
}

// An instant that jumps to another one has no bias that could be taken off.
void BodyStatement::put_instant(const BodySlot& slot, const Pivoted& found, double value,
                                const MeasureErrors::Reach& reach, data::Measure& measure) const {
  const bool lag = slot.definition->scope == BodyScope::pair;
  const auto most = lag ? slot.stretch->count / 4 : slot.stretch->count - 1;
  const double last = static_cast<double>(most) / record_.time.rate_hz, first = lag ? -last : 0.0;
  const bool edge = value <= first || value >= last;
  const double low = std::min(found.low, value + reach.before),
               high = std::max(found.high, value + reach.after);
  if (edge || high - low > kInstant * (last - first)) {
    remark(measure, edge ? "no interval: it is at an end of the span"
                         : "no interval: other instants are nearly as extreme");
    return;
  }
  measure.sd = found.sd;
  measure.interval = {.kind = data::IntervalKind::two_sided,
                      .low = std::max(first, low),
                      .high = std::min(last, high),
                      .level = options_.level,
                      .approximate = true};
}

// Shares, and instants, jump: their deviations are lopsided.
Pivoted BodyStatement::pivot_of(const BodyDefinition& definition, double value,
                                const std::vector<double>& deviations) const {
  const bool jumps = definition.is_instant() || definition.what.quantity == data::Quantity::share;
  return jumps ? wide_pivot(value, deviations, options_.level) : pivot(value, deviations, options_.level);
}

}  // namespace kinemark::analysis
