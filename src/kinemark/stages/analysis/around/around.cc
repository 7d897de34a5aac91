// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/around/around.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kMostBins = 100'000;
constexpr double kWholeBins = 1e-6;  // of a bin, by which a window may differ from whole ones
constexpr double kSameInstant_s = 1e-9;

/// Values of all events in one bin: sums about the first value, which keeps differences of large numbers.
class BinSums {
 public:
  void add(double value) {
    if (count_ == 0) first_ = value;
    ++count_;
    sum_ += value - first_;
    squares_ += (value - first_) * (value - first_);
  }
  void add_missing() { ++missing_; }
  [[nodiscard]] AroundBin result() const {
    AroundBin out{.count = count_, .missing = missing_};
    const auto n = static_cast<double>(count_);
    if (count_ > 0) out.mean = first_ + sum_ / n;
    if (count_ > 1) out.sd = std::sqrt(std::max(0.0, (squares_ - sum_ * sum_ / n) / (n - 1.0)));
    return out;
  }

 private:
  std::int64_t count_ = 0, missing_ = 0;
  double first_ = 0.0, sum_ = 0.0, squares_ = 0.0;
};

/// Slope of the mean in a bin, 1/s; 0 where its neighbours have none.
double slope_at(const std::vector<AroundBin>& bins, std::size_t k, double bin_s) {
  const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(bins.size() - 1, k + 1);
  const double rise = bins[after].mean - bins[before].mean;
  return after > before && std::isfinite(rise) ? rise / (static_cast<double>(after - before) * bin_s) : 0.0;
}

void add_intervals(const AroundOptions& options, std::vector<AroundBin>& bins) {
  const double upper = 0.5 + 0.5 * options.level;
  const double z = boost::math::quantile(boost::math::normal(), upper);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    auto& bin = bins[k];
    if (bin.count < 2) continue;
    const auto n = static_cast<double>(bin.count);
    const double t = boost::math::quantile(boost::math::students_t(n - 1.0), upper);
    const double half =
        std::hypot(t * bin.sd / std::sqrt(n), z * options.clock_sd_s * slope_at(bins, k, options.bin_s));
    bin.low = bin.mean - half;
    bin.high = bin.mean + half;
  }
}

bool fits(double event_s, const ObservedSpan& span, const AroundOptions& options) {
  return event_s + options.from_s >= span.start_s - kSameInstant_s &&
         event_s + options.edge_s(options.bins()) <= span.end_s + kSameInstant_s;
}

/// The integral of a curve's lines from its first sample, of its values less the first one that is there; and
/// how many of the lines are missing.
class LineSums {
 public:
  explicit LineSums(const SampledCurve& curve) : curve_(curve) {
    const auto there = std::ranges::find_if(curve.value, [](double v) { return std::isfinite(v); });
    level_ = there == curve.value.end() ? 0.0 : *there;
    integral_.push_back(0.0);
    missing_.push_back(0);
    for (std::size_t i = 0; i + 1 < curve.time_s.size(); ++i) {
      const double middle = 0.5 * (curve.value[i] + curve.value[i + 1]) - level_;
      const bool known = std::isfinite(middle);
      integral_.push_back(integral_.back() +
                          (known ? middle * (curve.time_s[i + 1] - curve.time_s[i]) : 0.0));
      missing_.push_back(missing_.back() + (known ? 0 : 1));
    }
  }
  [[nodiscard]] bool has_lines() const { return curve_.time_s.size() > 1; }
  /// The line on which an instant lies, at or after `line`; the last one behind the curve's end.
  [[nodiscard]] std::size_t line_at(double time_s, std::size_t line) const {
    while (line + 2 < curve_.time_s.size() && curve_.time_s[line + 1] <= time_s) ++line;
    return line;
  }
  [[nodiscard]] std::size_t find_line(double time_s) const {
    const auto after = std::ranges::upper_bound(curve_.time_s, time_s) - curve_.time_s.begin();
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - 1, 0, static_cast<std::ptrdiff_t>(curve_.time_s.size()) - 2));
  }
  /// Mean over [from, to], which begins on line `first` and ends on `last`; NaN where one of these and those
  /// between is missing.
  [[nodiscard]] double mean(double from_s, std::size_t first, double to_s, std::size_t last) const {
    if (last > first && curve_.time_s[last] >= to_s) --last;  // it ends where that line begins
    if (missing_[last + 1] > missing_[first]) return kNaN;
    return level_ + (integral_to(to_s, last) - integral_to(from_s, first)) / (to_s - from_s);
  }

 private:
  [[nodiscard]] double integral_to(double time_s, std::size_t line) const {
    const double begin = curve_.time_s[line], passed = time_s - begin;
    const double slope = (curve_.value[line + 1] - curve_.value[line]) / (curve_.time_s[line + 1] - begin);
    return integral_[line] + passed * (curve_.value[line] - level_ + 0.5 * slope * passed);
  }

  const SampledCurve& curve_;
  double level_ = 0.0;
  std::vector<double> integral_;       // N
  std::vector<std::int64_t> missing_;  // N, lines before
};

/// Every event whose window is in the span, by `add(event, sums)`.
template <class Add>
void over_events(std::span<const double> events_s, const ObservedSpan& span, const AroundOptions& options,
                 const Add& add, AroundCurve& out) {
  std::vector<BinSums> sums(static_cast<std::size_t>(options.bins()));
  for (const double event_s : events_s) {
    if (!fits(event_s, span, options)) {
      ++out.outside;
      continue;
    }
    ++out.used;
    add(event_s, sums);
  }
  for (const auto& one : sums) out.bins.push_back(one.result());
  add_intervals(options, out.bins);
}

}  // namespace

std::int64_t AroundOptions::bins() const { return std::llround((to_s - from_s) / bin_s); }

Status AroundOptions::check() const {
  if (!(bin_s > 0.0) || !std::isfinite(bin_s))
    return fail(Code::usage, fmt::format("a bin of {} s; need a length above 0", bin_s));
  if (!(from_s < to_s) || !std::isfinite(from_s) || !std::isfinite(to_s))
    return fail(Code::usage,
                fmt::format("a window from {} to {} s; need FROM,TO with FROM below TO", from_s, to_s));
  const double exact = (to_s - from_s) / bin_s;
  if (exact > static_cast<double>(kMostBins))
    return fail(Code::usage, fmt::format("a window of {:.0f} bins; need {} at most", exact, kMostBins));
  if (std::abs(exact - std::round(exact)) > kWholeBins || std::round(exact) < 1.0)
    return fail(Code::usage, fmt::format("a window from {} to {} s is {:.6g} bins of {} s; need whole ones",
                                         from_s, to_s, exact, bin_s));
  if (!(level > 0.5 && level < 1.0))
    return fail(Code::usage, fmt::format("a level of {}; need a share above 0.5 and below 1", level));
  if (!(clock_sd_s >= 0.0) || !std::isfinite(clock_sd_s))
    return fail(Code::usage, fmt::format("a clock's deviation of {} s; need 0 or more", clock_sd_s));
  return {};
}

AroundCurve mean_around(const std::string& name, std::span<const double> events_s, const SampledCurve& curve,
                        const ObservedSpan& span, const AroundOptions& options) {
  AroundCurve out{
      .events = name, .subject = curve.subject, .id = curve.id, .quantity = curve.quantity, .bins = {}};
  const LineSums lines(curve);
  const auto add = [&](double event_s, std::vector<BinSums>& sums) {
    double from_s = event_s + options.edge_s(0);
    std::size_t first = lines.has_lines() ? lines.find_line(from_s) : 0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double to_s = event_s + options.edge_s(static_cast<std::int64_t>(k) + 1);
      double value = kNaN;
      if (lines.has_lines()) {
        const std::size_t last = lines.line_at(to_s, first);
        value = lines.mean(from_s, first, to_s, last);
        first = last;
      }
      if (std::isfinite(value))
        sums[k].add(value);
      else
        sums[k].add_missing();
      from_s = to_s;
    }
  };
  over_events(events_s, span, options, add, out);
  return out;
}

AroundCurve rate_around(const std::string& name, std::span<const double> events_s, const std::string& unit,
                        std::span<const double> spikes_s, const ObservedSpan& span,
                        const AroundOptions& options) {
  AroundCurve out{.events = name, .subject = unit, .id = "rate", .bins = {}};
  std::vector<double> counts(static_cast<std::size_t>(options.bins()));
  const auto add = [&](double event_s, std::vector<BinSums>& sums) {
    std::ranges::fill(counts, 0.0);
    auto spike = std::ranges::lower_bound(spikes_s, event_s + options.from_s);
    for (std::size_t k = 0; k < counts.size(); ++k)
      for (const double end_s = event_s + options.edge_s(static_cast<std::int64_t>(k) + 1);
           spike != spikes_s.end() && *spike < end_s; ++spike)
        counts[k] += 1.0;
    for (std::size_t k = 0; k < counts.size(); ++k) sums[k].add(counts[k] / options.bin_s);
  };
  over_events(events_s, span, options, add, out);
  return out;
}

}  // namespace kinemark::analysis
