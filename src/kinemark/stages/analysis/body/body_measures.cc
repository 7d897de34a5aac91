// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/body_measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/analysis/body/balance.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/body/coordinate_smoother.h"
#include "kinemark/stages/analysis/body/measure_errors.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/pivot.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kEdge_s = 0.08;       // at both ends, where a smoother knows one side only
constexpr double kLongestGap_s = 0.2;  // beyond which nobody knows what happened
constexpr std::int64_t kLeastStretch = 5;
constexpr double kInstant = 0.25;     // of where it can be, the widest interval of an instant
constexpr std::int64_t kAtOnce = 5;   // refits that are there side by side
constexpr double kTooWide = 0.5;      // half-width over value
constexpr double kMovesAtAll = 0.25;  // variance over that of its errors

/// One number to compute: which definition, of which stretch, of whom.
struct Slot {
  const BodyDefinition* definition;
  const BodyStretch* stretch;
  Index a = 0, b = 0;
  data::Side side = data::Side::left;
};

/// How much of a stretch a coordinate is not determined in.
struct Gaps {
  double share = 0.0;  // of the samples
  double longest_s = 0.0;
};

void remark(data::Measure& measure, const std::string& sentence) {
  if (!measure.remark.empty()) measure.remark += "; ";
  measure.remark += sentence;
}

// Rates of a smooth coordinate; those of the first and last samples are their neighbours'.
void put_rates(const VectorXd& q, double rate_hz, Index c, BodySeries& out) {
  const auto n = q.size();
  const auto inside = differentiate(q, kDerivativeMargin, n - 2 * kDerivativeMargin, rate_hz);
  out.q.col(c) = q;
  for (Index f = 0; f < n; ++f) {
    const auto i = std::clamp<Index>(f - kDerivativeMargin, 0, n - 2 * kDerivativeMargin - 1);
    out.v(f, c) = inside.v(i, 0);
    out.a(f, c) = inside.a(i, 0);
  }
}

class BodyMeasurement {
 public:
  BodyMeasurement(const BodyRecord& record, const Mechanics& mechanics, const BodyMeasureOptions& options,
                  std::vector<BodyStretch> stretches)
      : record_(record), mechanics_(mechanics), options_(options), stretches_(std::move(stretches)) {}

  Status measure(BodyMeasures& out) {
    if (auto s = prepare(out); !s) return s;
    auto estimate = version([](const CoordinateSmoother& c, Index) { return c.estimate(); });
    if (!estimate) return std::unexpected(estimate.error());
    momentum_known_ = estimate->momentum.rows() > 0 && estimate->momentum.allFinite();
    contact_ = feet_on_ground(*estimate, record_.up, record_.time.rate_hz);
    if (record_.contact.rows() > 0) contact_ = contact_.array() || record_.contact.array();
    plan(*estimate);
    std::vector<double> values;
    for (const auto& slot : slots_) values.push_back(slot.definition->value(view_of(slot, *estimate)));
    std::vector<MeasureErrors> errors;
    if (options_.refits > 0)
      if (auto s = refit(*estimate, errors); !s) return s;
    for (std::size_t i = 0; i < slots_.size(); ++i)
      state(slots_[i], values[i], errors.empty() ? nullptr : &errors[i], out);
    return {};
  }

 private:
  // A smoother for each coordinate that moves and is determined often enough.
  Status prepare(BodyMeasures& out) {
    smoothers_.resize(at(record_.size()));
    std::vector<std::string> without, disagree;
    for (Index c = 0; c < record_.size(); ++c) {
      if (!record_.measured[at(c)]) continue;
      std::vector<bool> seen(at(record_.frames()));
      double squares = 0.0, count = 0.0;
      for (std::int64_t f = 0; f < record_.frames(); ++f) {
        seen[at(f)] = record_.determined(f, c);
        const double sd = seen[at(f)] && record_.q_sd.size() > 0 ? record_.q_sd(f, c) : kNaN;
        if (std::isfinite(sd)) squares += sd * sd, count += 1.0;
      }
      const double stated = count > 0.0 ? std::sqrt(squares / count) : kNaN;
      auto smoother =
          CoordinateSmoother::create(record_.q.col(c), std::move(seen), stated, record_.time.rate_hz);
      if (!smoother) {
        without.push_back(record_.names[at(c)]);
        continue;
      }
      if (smoother->noise().white > 1.15 * stated) disagree.push_back(record_.names[at(c)]);
      smoothers_[at(c)] = std::move(*smoother);
    }
    if (std::ranges::none_of(smoothers_, [](const auto& s) { return s.has_value(); }))
      return fail(Code::bad_input, "no coordinate is free to move and determined in 30 frames or more");
    move_side_by_side();
    if (!without.empty())
      out.notes.push_back(
          "not measured, as fewer than 30 of their samples are determined or no smoother fits them: " +
          join_names(without, 8));
    if (!disagree.empty())
      out.notes.push_back(
          "samples differ by more than 15 % more from each other than their deviations "
          "tell, and the larger noise counts: " +
          join_names(disagree, 8));
    return {};
  }

  // Each smoother knows what moves by more than its errors beside its own coordinate.
  void move_side_by_side() {
    Eigen::MatrixXd poses = Eigen::MatrixXd::Zero(record_.frames(), record_.size());
    for (Index c = 0; c < record_.size(); ++c) {
      if (!smoothers_[at(c)]) continue;
      const auto& pilot = smoothers_[at(c)]->pilot();
      const auto noise = smoothers_[at(c)]->noise();
      const double variance = (pilot.array() - pilot.mean()).square().mean();
      if (variance > kMovesAtAll * (noise.white * noise.white + noise.slow * noise.slow))
        poses.col(c) = standardized(pilot);
    }
    const auto shared = std::make_shared<const Eigen::MatrixXd>(std::move(poses));
    for (Index c = 0; c < record_.size(); ++c)
      if (smoothers_[at(c)]) smoothers_[at(c)]->move_beside(shared, c);
  }

  // The motion with what `samples` gives of each coordinate.
  template <class Samples>
  Result<BodySeries> version(const Samples& samples) const {
    BodySeries out;
    out.q = record_.q;
    out.v = out.a = Eigen::MatrixXd::Zero(record_.frames(), record_.size());
    for (Index c = 0; c < record_.size(); ++c) {
      const auto& smoother = smoothers_[at(c)];
      if (smoother) put_rates(samples(*smoother, c), record_.time.rate_hz, c, out);
    }
    if (auto s = mechanics_(out); !s) return std::unexpected(s.error());
    return out;
  }

  [[nodiscard]] bool is_asked(const BodyDefinition& definition) const {
    const auto& asked = options_.measures;
    return asked.empty() || std::ranges::find(asked, definition.what.id) != asked.end();
  }
  [[nodiscard]] bool is_chosen(Index c) const {
    const auto& chosen = options_.coordinates;
    return chosen.empty() || std::ranges::find(chosen, c) != chosen.end();
  }

  // All slots, stretch by stretch: each coordinate with all its measures, pairs, the body.
  void plan(const BodySeries& estimate) {
    for (const auto& stretch : stretches_) {
      for (Index c = 0; c < record_.size(); ++c) {
        const auto side = side_of_name(record_.names[at(c)]);
        if (!smoothers_[at(c)] || !is_chosen(c)) continue;
        if (!stretch.context.empty() && !side.empty() && side != stretch.context) continue;
        for (const auto& definition : body_definitions())
          if (is_asked(definition) &&
              (definition.scope == BodyScope::coordinate ||
               (definition.scope == BodyScope::torque && estimate.tau.size() > 0 && record_.driven[at(c)])))
            slots_.push_back({&definition, &stretch, c});
      }
      for (const auto& [a, b] : options_.pairs)
        for (const auto& definition : body_definitions())
          if (is_asked(definition) && definition.scope == BodyScope::pair && smoothers_[at(a)] &&
              smoothers_[at(b)])
            slots_.push_back({&definition, &stretch, a, b});
      plan_body(stretch, estimate);
    }
  }

  void plan_body(const BodyStretch& stretch, const BodySeries& estimate) {
    if (estimate.centre.rows() == 0) return;
    const bool stands = !estimate.outline[0].empty() || !estimate.outline[1].empty();
    for (const auto& definition : body_definitions()) {
      const bool named = !options_.measures.empty();
      if (!is_asked(definition) || (!named && !options_.coordinates.empty())) continue;
      if (definition.scope == BodyScope::body || (definition.scope == BodyScope::support && stands))
        slots_.push_back({&definition, &stretch});
      if (definition.scope != BodyScope::side) continue;
      for (const auto side : data::kBothSides)
        if (!estimate.outline[data::index_of(side)].empty() &&
            (stretch.context.empty() || stretch.context == data::to_string(side)))
          slots_.push_back({&definition, &stretch, 0, 0, side});
    }
  }

  [[nodiscard]] BodyView view_of(const Slot& slot, const BodySeries& series) const {
    return {series, record_, contact_,  slot.stretch->first, slot.stretch->count,
            slot.a, slot.b,  slot.side, options_.normalized};
  }

  // Simulated again, some at a time: versions side by side, then measures side by side.
  Status refit(const BodySeries& estimate, std::vector<MeasureErrors>& errors) const {
    const auto pilot = version([](const CoordinateSmoother& c, Index) { return c.pilot(); });
    if (!pilot) return std::unexpected(pilot.error());
    const auto smooth = version([](const CoordinateSmoother& c, Index) { return c.smoothed_pilot(); });
    if (!smooth) return std::unexpected(smooth.error());
    for (const auto& slot : slots_)
      errors.emplace_back(*slot.definition, view_of(slot, estimate), view_of(slot, *pilot),
                          view_of(slot, *smooth), options_.refits);
    const std::int64_t batches = std::max<std::int64_t>(1, options_.refits / kAtOnce);
    for (std::int64_t batch = 0; batch < batches; ++batch) {
      const auto first = batch * options_.refits / batches,
                 count = (batch + 1) * options_.refits / batches - first;
      std::vector<std::optional<BodySeries>> versions(at(count));
      parallel_for(count, 1, options_.threads, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
          if (auto again = version([&](const CoordinateSmoother& coordinate, Index c) {
                return coordinate.refit(options_.seed, static_cast<std::uint64_t>(c) + 1, first + k);
              }))
            versions[at(k)] = std::move(*again);
      });
      parallel_for(std::ssize(slots_), 1, options_.threads, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
          std::vector<NumberedView> views;
          for (std::int64_t k = 0; k < count; ++k)
            if (versions[at(k)]) views.push_back({first + k, view_of(slots_[at(i)], *versions[at(k)])});
          errors[at(i)].add(views);
        }
      });
    }
    return {};
  }

  [[nodiscard]] Gaps gaps_in(const Eigen::MatrixX<bool>& known, Index c, const BodyStretch& stretch) const {
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
  [[nodiscard]] Gaps gaps_of(const Slot& slot) const {
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
  [[nodiscard]] std::vector<std::string> held_in(const BodyStretch& stretch) const {
    std::vector<std::string> out;
    for (Index c = 0; c < record_.size(); ++c)
      if (record_.measured[at(c)] && !record_.is_root[at(c)] &&
          gaps_in(record_.determined, c, stretch).longest_s > kLongestGap_s)
        out.push_back(record_.names[at(c)]);
    return out;
  }

  // The movement of a coordinate in the stretch is smaller than half of its errors.
  [[nodiscard]] bool below_noise(const Slot& slot) const {
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

  [[nodiscard]] std::string subject_of(const Slot& slot) const {
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

  [[nodiscard]] std::string method_of(const Slot& slot) const {
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
  [[nodiscard]] bool rests_on_smoothed(const Slot& slot) const {
    const auto is_smoothed = [](const std::optional<CoordinateSmoother>& s) {
      return s && std::isfinite(s->cut_off_hz());
    };
    if (slot.definition->scope == BodyScope::pair)
      return is_smoothed(smoothers_[at(slot.a)]) || is_smoothed(smoothers_[at(slot.b)]);
    return std::ranges::any_of(smoothers_, is_smoothed);
  }

  // Whether anything tells of errors: of the coordinate, of the pair, of any.
  [[nodiscard]] bool errors_known(const Slot& slot) const {
    const auto has = [](const std::optional<CoordinateSmoother>& s) {
      return s && (s->noise().white > 0.0 || s->noise().slow > 0.0);
    };
    const auto scope = slot.definition->scope;
    if (scope == BodyScope::coordinate) return has(smoothers_[at(slot.a)]);
    return std::ranges::any_of(smoothers_, has);
  }

  // Why there is no value, or an empty text.
  [[nodiscard]] std::string no_value(const Slot& slot, double value, const Gaps& gaps) const {
    if (gaps.share >= 1.0) return "nothing fixes it in this stretch";
    if (slot.definition->scope == BodyScope::torque) {
      const auto unknown = gaps_in(record_.torque_known, slot.a, *slot.stretch);
      if (unknown.share > 0.0)
        return fmt::format("the torque is not determined in {:.0f} % of the stretch",
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

  [[nodiscard]] std::string no_interval(const Slot& slot, const Gaps& gaps) const {
    if (options_.refits == 0) return "no interval was asked for";
    if (gaps.longest_s > kLongestGap_s)
      return fmt::format("no interval: what happened in {:.2g} s without data is not known", gaps.longest_s);
    if (!errors_known(slot)) return "no interval: no deviation is stated, and the samples show no noise";
    if (slot.definition->scope == BodyScope::coordinate && slot.definition->what.id != "joint_mean" &&
        below_noise(slot))
      return "no interval: it moves by less than half of its errors";
    return {};
  }

  void state(const Slot& slot, double value, const MeasureErrors* errors, BodyMeasures& out) const {
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
      out.measures.push_back(std::move(measure));
      return;
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
    out.measures.push_back(std::move(measure));
  }

  void put_interval(const Slot& slot, double found_value, const MeasureErrors& errors,
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
  void put_instant(const Slot& slot, const Pivoted& found, double value, const MeasureErrors::Reach& reach,
                   data::Measure& measure) const {
    const bool lag = slot.definition->scope == BodyScope::pair;
    const auto most = lag ? slot.stretch->count / 4 : slot.stretch->count - 1;
    const double last = static_cast<double>(most) / record_.time.rate_hz, first = lag ? -last : 0.0;
    const bool edge = value <= first || value >= last;
    const double low = std::min(found.low, value + reach.before),
                 high = std::max(found.high, value + reach.after);
    if (edge || high - low > kInstant * (last - first)) {
      remark(measure, edge ? "no interval: it is at an end of the stretch"
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
  [[nodiscard]] Pivoted pivot_of(const BodyDefinition& definition, double value,
                                 const std::vector<double>& deviations) const {
    const bool jumps = definition.is_instant() || definition.what.quantity == data::Quantity::share;
    return jumps ? wide_pivot(value, deviations, options_.level) : pivot(value, deviations, options_.level);
  }

  const BodyRecord& record_;
  const Mechanics& mechanics_;
  const BodyMeasureOptions& options_;
  std::vector<BodyStretch> stretches_;
  std::vector<std::optional<CoordinateSmoother>> smoothers_;
  Eigen::MatrixX<bool> contact_;
  bool momentum_known_ = false;  // in all frames
  std::vector<Slot> slots_;
};

}  // namespace

std::string side_of_name(const std::string& name) {
  for (const char* end : {"_l", "_L", "_left", "Left", "_lt"})
    if (name.ends_with(end)) return "Left";
  for (const char* end : {"_r", "_R", "_right", "Right", "_rt"})
    if (name.ends_with(end)) return "Right";
  return {};
}

Status BodyMeasureOptions::check() const {
  constexpr std::int64_t kLeastRefits = 39;
  if (refits != 0 && refits < kLeastRefits)
    return fail(Code::usage,
                fmt::format("{} refits are too few for an interval; need {} or more, or 0 for none", refits,
                            kLeastRefits));
  if (!(level > 0.5 && level < 1.0))
    return fail(Code::usage, fmt::format("intervals of level {:g}; need one above 0.5 and below 1", level));
  for (const auto& id : measures) {
    const auto* definition = find_body_definition(id);
    if (definition == nullptr)
      return fail(Code::usage, fmt::format("there is no measure '{}' of a motion", id));
    if (definition->scope == BodyScope::pair && pairs.empty())
      return fail(Code::usage, fmt::format("{} is of two coordinates; name them with --couple A,B", id));
  }
  return {};
}

Result<BodyMeasures> measure_body(const BodyRecord& record, const Mechanics& mechanics,
                                  const BodyMeasureOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  const auto edge = std::max<std::int64_t>(
      kDerivativeMargin, static_cast<std::int64_t>(std::ceil(kEdge_s * record.time.rate_hz)));
  constexpr std::int64_t kLeastFrames = 30;
  if (record.frames() < std::max(kLeastFrames, 2 * edge + kLeastStretch))
    return fail(Code::bad_input,
                fmt::format("the motion has {} frames; {} or more are needed", record.frames(),
                            std::max(kLeastFrames, 2 * edge + kLeastStretch)));
  auto stretches = options.stretches;
  if (stretches.empty()) stretches.push_back({.count = record.frames()});
  for (auto& stretch : stretches) {
    const auto last = std::min(stretch.first + stretch.count, record.frames() - edge);
    stretch.first = std::max(stretch.first, edge);
    stretch.count = last - stretch.first;
    if (stretch.count < kLeastStretch)
      return fail(Code::bad_input,
                  fmt::format("stretch '{}' has fewer than {} frames between the first and the last {:g} s "
                              "of the motion",
                              stretch.name, kLeastStretch, kEdge_s));
  }
  BodyMeasures out;
  if (auto s = BodyMeasurement(record, mechanics, options, std::move(stretches)).measure(out); !s)
    return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::analysis
