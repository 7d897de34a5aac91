// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/body_measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/text.h"
#include "kinemark/data/interval_refits.h"
#include "kinemark/stages/analysis/body/balance.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/body/body_statement.h"
#include "kinemark/stages/analysis/body/coordinate_smoother.h"
#include "kinemark/stages/analysis/body/measure_errors.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kEdge_s = 0.08;  // at both ends, where a smoother knows one side only
constexpr std::int64_t kLeastStretch = 5;
constexpr std::int64_t kAtOnce = 5;  // refits that are there side by side

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
    const bool momentum_known = estimate->momentum.rows() > 0 && estimate->momentum.allFinite();
    contact_ = feet_on_ground(*estimate, record_.up, record_.time.rate_hz);
    if (record_.contact.rows() > 0) contact_ = contact_.array() || record_.contact.array();
    plan(*estimate);
    std::vector<double> values;
    for (const auto& slot : slots_) values.push_back(slot.definition->value(view_of(slot, *estimate)));
    std::vector<MeasureErrors> errors;
    if (options_.refits > 0)
      if (auto s = refit(*estimate, errors); !s) return s;
    const BodyStatement statement(record_, smoothers_, options_, momentum_known);
    for (std::size_t i = 0; i < slots_.size(); ++i)
      out.measures.push_back(statement.state(slots_[i], values[i], errors.empty() ? nullptr : &errors[i]));
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

  [[nodiscard]] BodyView view_of(const BodySlot& slot, const BodySeries& series) const {
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

  const BodyRecord& record_;
  const Mechanics& mechanics_;
  const BodyMeasureOptions& options_;
  std::vector<BodyStretch> stretches_;
  std::vector<std::optional<CoordinateSmoother>> smoothers_;
  Eigen::MatrixX<bool> contact_;
  std::vector<BodySlot> slots_;
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
  if (auto s = data::check_interval_refits(refits, level); !s) return s;
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
                  fmt::format("span '{}' has fewer than {} frames between the first and the last {:g} s "
                              "of the motion",
                              stretch.name, kLeastStretch, kEdge_s));
  }
  BodyMeasures out;
  if (auto s = BodyMeasurement(record, mechanics, options, std::move(stretches)).measure(out); !s)
    return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::analysis
