// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/mapping.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kLeastArrangements = 20;
/// Statistics that differ by rounding alone are the same: another order of sums must not break a tie.
constexpr double kTie = 1e-9;

Status check_groups(std::span<const data::CycleCurves> groups, const MappingOptions& options) {
  const std::size_t least = options.design == Design::one_sample ? 1 : 2;
  const std::size_t most = options.design == Design::one_way ? 255 : least;
  if (groups.size() < least || groups.size() > most)
    return fail(Code::bad_input, fmt::format("{} groups of curves are given; the design '{}' takes {}",
                                             groups.size(), to_string(options.design),
                                             least == most ? fmt::format("{}", least) : "2 to 255"));
  for (const auto& group : groups) {
    if (auto valid = group.validate(); !valid) return valid;
    if (group.points != groups.front().points)
      return fail(Code::bad_input,
                  fmt::format("group '{}' has curves of {} points and group '{}' of {}; need the same number",
                              groups.front().subject, groups.front().points, group.subject, group.points));
    if (group.count() < 2)
      return fail(Code::bad_input,
                  fmt::format("group '{}' has {} curve; need at least 2", group.subject, group.count()));
    if (options.design == Design::paired && group.count() != groups.front().count())
      return fail(Code::bad_input,
                  fmt::format("group '{}' has {} curves and group '{}' {}; pairs need as many in both",
                              groups.front().subject, groups.front().count(), group.subject, group.count()));
  }
  return {};
}

/// What counts as large: the statistic itself, or its size.
class Side {
 public:
  explicit Side(const MappingOptions& options)
      : both_(options.two_sided && options.design != Design::one_way) {}
  [[nodiscard]] double height(double statistic) const { return both_ ? std::abs(statistic) : statistic; }

 private:
  bool both_;
};

double largest(std::span<const double> statistic, Side side) {
  double most = -std::numeric_limits<double>::infinity();
  for (const double s : statistic)
    if (!std::isnan(s)) most = std::max(most, side.height(s));
  return most;
}

/// Spans beyond the threshold, each of one sign, up to the interpolated crossings.
std::vector<MappedSpan> spans_of(std::span<const double> statistic, double threshold, Side side) {
  std::vector<MappedSpan> found;
  const auto beyond = [&](std::size_t p) { return side.height(statistic[p]) - threshold; };
  const auto counts = [&](std::size_t p) { return beyond(p) > 0.0; };  // false of NaN
  const auto crossing = [&](std::size_t in, std::size_t out, double sign) {
    const double a = beyond(in), b = sign * statistic[out] - threshold;
    return std::isfinite(a) && std::isfinite(b) ? a / (a - b) : 0.0;
  };
  for (std::size_t p = 0; p < statistic.size(); ++p) {
    if (!counts(p)) continue;
    const double sign = side.height(statistic[p]) == statistic[p] ? 1.0 : -1.0;
    std::size_t end = p;
    while (end + 1 < statistic.size() && counts(end + 1) && sign * statistic[end + 1] > 0.0) ++end;
    MappedSpan span{.first = static_cast<double>(p),
                    .last = static_cast<double>(end),
                    .extreme = statistic[p],
                    .integral = 0.0};
    const double before = p > 0 ? crossing(p, p - 1, sign) : 0.0;
    const double after = end + 1 < statistic.size() ? crossing(end, end + 1, sign) : 0.0;
    span.first -= before;
    span.last += after;
    span.integral = 0.5 * (before * beyond(p) + after * beyond(end));
    for (std::size_t k = p; k <= end; ++k) {
      if (side.height(statistic[k]) > side.height(span.extreme)) span.extreme = statistic[k];
      if (k > p) span.integral += 0.5 * (beyond(k - 1) + beyond(k));
    }
    found.push_back(span);
    p = end;
  }
  return found;
}

/// The share of `values` that reach `value`, ties among them.
double share_reaching(std::span<const double> values, double value) {
  const double least = value - kTie * std::abs(value);
  return static_cast<double>(std::ranges::count_if(values, [&](double v) { return v >= least; })) /
         static_cast<double>(values.size());
}

/// Exceeded by no more than the share `alpha` of the values; NaN where the largest itself is reached by more.
double threshold_of(std::vector<double> heights, double alpha) {
  std::ranges::sort(heights, std::greater<>{});
  if (share_reaching(heights, heights.front()) > alpha) return kNaN;
  return heights[static_cast<std::size_t>(alpha * static_cast<double>(heights.size()) + kTie)];
}

void judge_spans(Mapping& mapping, CurveStatistic& statistic, Arrangements& arrangements, Side side) {
  mapping.spans = spans_of(mapping.values, mapping.threshold, side);
  if (mapping.spans.empty()) return;
  std::vector<double> integrals(static_cast<std::size_t>(arrangements.count()), 0.0),
      values(statistic.points());
  for (double& most : integrals) {
    statistic.of(arrangements.next(), values);
    for (const auto& span : spans_of(values, mapping.threshold, side)) most = std::max(most, span.integral);
  }
  for (auto& span : mapping.spans) span.p = share_reaching(integrals, span.integral);
}

}  // namespace

Status MappingOptions::check() const {
  if (!(alpha > 0.0 && alpha < 1.0))
    return fail(Code::usage, fmt::format("alpha is {}; need a probability above 0 and below 1", alpha));
  if (arrangements < kLeastArrangements)
    return fail(Code::usage, fmt::format("{} arrangements are asked for; need at least {}", arrangements,
                                         kLeastArrangements));
  return {};
}

Result<Mapping> map_curves(std::span<const data::CycleCurves> groups, const MappingOptions& options) {
  if (auto ok = options.check(); !ok) return std::unexpected(ok.error());
  if (auto ok = check_groups(groups, options); !ok) return std::unexpected(ok.error());
  CurveStatistic statistic(options.design, groups);
  auto arrangements = statistic.arrangements(options.arrangements, options.seed);
  const Side side(options);

  Mapping mapping{.options = options,
                  .statistic = options.design == Design::one_way ? "F" : "t",
                  .effect_df = statistic.effect_df(),
                  .error_df = statistic.error_df(),
                  .values = std::vector<double>(statistic.points()),
                  .possible = arrangements.possible(),
                  .arrangements = arrangements.count()};
  std::vector<double> heights(static_cast<std::size_t>(arrangements.count())), values(statistic.points());
  for (double& height : heights) {
    statistic.of(arrangements.next(), values);
    if (&height == heights.data()) mapping.values = values;
    height = largest(values, side);
  }
  mapping.not_tested = std::ranges::count_if(mapping.values, [](double v) { return std::isnan(v); });
  if (mapping.not_tested == std::ssize(mapping.values)) {
    mapping.remark = "no point can be tested: at each one a curve is missing or all curves are equal";
    return mapping;
  }
  mapping.p = share_reaching(heights, heights.front());
  mapping.threshold = threshold_of(heights, options.alpha);
  if (std::isnan(mapping.threshold)) {
    mapping.remark =
        static_cast<double>(arrangements.count()) < arrangements.possible()
            ? fmt::format("{} arrangements of all that there are cannot show a difference at {}; take more",
                          arrangements.count(), options.alpha)
            : fmt::format("{} arrangements of so few curves cannot show a difference at {}; add curves",
                          arrangements.count(), options.alpha);
    return mapping;
  }
  judge_spans(mapping, statistic, arrangements, side);
  return mapping;
}

}  // namespace kinemark::analysis
