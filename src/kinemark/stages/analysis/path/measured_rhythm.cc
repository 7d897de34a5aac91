// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/internal/rhythm_layout.h"
#include "kinemark/stages/analysis/path/measured_path.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"
#include "kinemark/stages/analysis/path/pivot.h"
#include "kinemark/stages/analysis/path/rhythm.h"
#include "kinemark/stages/analysis/path/stated_measure.h"

namespace kinemark::analysis {
namespace {

using data::Quantity;
using internal::find_repeats;
using internal::kCurves;
using internal::kPoints;
using internal::lay_out_cycles;
using internal::lay_out_movements;
using internal::Layout;
using internal::mean_of;
using internal::Sort;
using internal::Span;
using internal::upright;
using internal::variation_of;
using internal::Version;
using internal::version_of;

constexpr std::int64_t kFewestSamples = 8;  // of a stretch

constexpr std::array kRhythmDefinitions{
    data::MeasureDefinition{"cycle_duration", "cycles", Quantity::time, "Duration of one cycle",
                            "from an upward crossing of the mean along the main axis to the next",
                            "definition"},
    data::MeasureDefinition{"cycle_variation", "cycles", Quantity::share,
                            "Variation of the cycles' durations", "SD between cycles, N - 1, over their mean",
                            "definition"},
    data::MeasureDefinition{"repetition_duration", "cycles", Quantity::time, "Duration of one movement",
                            "from start to end, 5 % of the peak speed, held for 100 ms", "definition"},
    data::MeasureDefinition{"repetition_variation", "cycles", Quantity::share,
                            "Variation of the movements' durations",
                            "SD between movements of a kind, N - 1, over their mean", "definition"}};

// Sums over refits of what noise does to the curves of a span.
struct CurveSums {
  std::vector<double> sum = std::vector<double>(at(kCurves * kPoints), 0.0), squares = sum;
  std::int64_t count = 0;

  void add(const std::vector<double>& values, const std::vector<double>& base) {
    if (!std::isfinite(values.front()) || !std::isfinite(base.front())) return;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double off = values[i] - base[i];
      sum[i] += off;
      squares[i] += off * off;
    }
    ++count;
  }
  [[nodiscard]] double sd(std::size_t i) const {
    if (count < 2) return kNaN;
    const auto n = static_cast<double>(count);
    return std::sqrt(std::max(0.0, (squares[i] - sum[i] * sum[i] / n) / (n - 1.0)));
  }
};

bool asks_for(const PathMeasureOptions& options, std::string_view id) {
  return options.measures.empty() || std::ranges::find(options.measures, id) != options.measures.end();
}

// What was found of a layout in the recording, and what noise does to it.
struct Numbers {
  Version recorded, settled;
  std::vector<std::vector<double>> deviations;  // of the refits, one list for each instant
  std::vector<CurveSums> sums;                  // one for each span

  [[nodiscard]] double length(const Span& span) const {
    return recorded.times[span.end] - recorded.times[span.begin];
  }
  [[nodiscard]] double settled_length(const Span& span) const {
    return settled.times[span.end] - settled.times[span.begin];
  }
  // What a refit's noise does to the length.
  [[nodiscard]] double length_off(const Span& span, std::size_t refit) const {
    return deviations[span.end][refit] - deviations[span.begin][refit];
  }
  void add(const Version& refit) {
    for (std::size_t i = 0; i < deviations.size(); ++i)
      deviations[i].push_back(refit.times[i] - settled.times[i]);
    for (std::size_t s = 0; s < sums.size(); ++s) sums[s].add(refit.curves[s], settled.curves[s]);
  }
};

// Which samples of a stretch were measured.
struct Seen {
  const std::vector<bool>& samples;  // of the recording
  std::int64_t first;                // of the stretch
  double rate_hz;

  // Longest stretch without a sample, and share of the samples, between two times of the stretch.
  struct Missing {
    double longest_s = 0.0, share = 0.0;
  };
  [[nodiscard]] Missing between(double from_s, double to_s) const {
    const auto begin = std::max<std::int64_t>(0, first + std::llround(std::floor(from_s * rate_hz)));
    const auto last =
        std::min<std::int64_t>(std::ssize(samples) - 1, first + std::llround(std::ceil(to_s * rate_hz)));
    std::int64_t run = 0, longest = 0, missing = 0;
    for (auto i = begin; i <= last; ++i) {
      run = samples[at(i)] ? 0 : run + 1;
      missing += run > 0;
      longest = std::max(longest, run);
    }
    return {.longest_s = static_cast<double>(longest) / rate_hz,
            .share = static_cast<double>(missing) /
                     static_cast<double>(std::max<std::int64_t>(1, last - begin + 1))};
  }
  // Nobody knows what happened in a long gap.
  [[nodiscard]] bool knows(double time_s) const {
    const auto n = std::ssize(samples);
    std::int64_t begin = first + std::llround(std::floor(time_s * rate_hz)), end = begin + 1;
    if (begin < 0 || end >= n || (samples[at(begin)] && samples[at(end)])) return begin >= 0 && end < n;
    while (begin > 0 && !samples[at(begin - 1)]) --begin;
    while (end + 1 < n && !samples[at(end + 1)]) ++end;
    return static_cast<double>(end - begin + 1) / rate_hz <= kLongestGap_s;
  }
};

void give_interval(const Pivoted& pivoted, data::Measure& measure) {
  if (!std::isfinite(pivoted.value)) {
    measure.remark = "no interval: more than a tenth of the refits do not determine it";
    return;
  }
  measure.uncorrected = measure.value;
  measure.value = pivoted.value;
  measure.sd = pivoted.sd;
  measure.interval.kind = data::IntervalKind::two_sided;
  measure.interval.low = pivoted.low;
  measure.interval.high = pivoted.high;
}

// States measures and curves of repetitions.
class Statement {
 public:
  Statement(const Layout& layout, const Numbers& numbers, const Seen& seen, const PathMeasureOptions& options,
            double start_s, double cut_off_hz, PathRhythm& out)
      : layout_(layout),
        numbers_(numbers),
        seen_(seen),
        options_(options),
        start_s_(start_s),
        cut_off_hz_(cut_off_hz),
        out_(out) {}

  void state() {
    state_events();
    for (const auto& sort : layout_.sorts) {
      std::vector<std::size_t> known;
      for (const auto s : sort.spans) {
        const auto& [begin, end] = layout_.spans[s];
        if (std::isfinite(shown_[begin]) && std::isfinite(shown_[end]) &&
            seen_.between(numbers_.recorded.times[begin], numbers_.recorded.times[end]).longest_s <=
                kLongestGap_s)
          known.push_back(s);
      }
      if (known.empty()) continue;
      if (asks_for(options_, sort.duration)) state_durations(sort, known);
      if (known.size() > 1 && asks_for(options_, sort.variation)) state_variation(sort, known);
      state_curves(sort, known);
    }
  }

 private:
  [[nodiscard]] bool intervals() const { return options_.refits > 0; }

  void state_events() {
    shown_.assign(layout_.instants.size(), kNaN);
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      const double time = numbers_.recorded.times[i];
      if (std::isnan(time) || !seen_.knows(time)) continue;
      PathEvent event{.kind = layout_.instants[i].kind, .time_s = start_s_ + time};
      const auto pivoted = intervals() ? pivot(time, numbers_.deviations[i], options_.level) : Pivoted{};
      if (std::isfinite(pivoted.value)) event.time_s = start_s_ + pivoted.value, event.sd_s = pivoted.sd;
      shown_[i] = event.time_s;
      out_.events.push_back(event);
    }
    std::ranges::stable_sort(out_.events, {}, &PathEvent::time_s);
  }

  [[nodiscard]] data::Measure blank(std::string_view id, const Sort& sort, std::size_t first,
                                    std::size_t last, Quantity quantity) const {
    const std::size_t begin = layout_.spans[first].begin, end = layout_.spans[last].end;
    const bool cycle = sort.context == "cycle";
    data::Measure out{.id = std::string(id),
                      .subject = out_.subject,
                      .context = sort.context == "movement" || cycle ? "" : sort.context,
                      .region = out_.region,
                      .start_s = shown_[begin],
                      .end_s = shown_[end],
                      .quantity = quantity};
    out.interval.level = options_.level;
    out.share_not_measured =
        seen_.between(numbers_.recorded.times[begin], numbers_.recorded.times[end]).share;
    out.method =
        fmt::format("{}, {} refits, smoothed to {:.3g} Hz",
                    cycle ? "crossings of the mean" : "5 % of the peak speed", options_.refits, cut_off_hz_);
    return out;
  }

  void state_durations(const Sort& sort, const std::vector<std::size_t>& known) {
    for (std::size_t i = 0; i < known.size(); ++i) {
      const auto& span = layout_.spans[known[i]];
      auto measure = blank(sort.duration, sort, known[i], known[i], Quantity::time);
      measure.cycle = static_cast<std::int64_t>(i);
      measure.value = numbers_.length(span);
      if (intervals()) {
        std::vector<double> off;
        for (std::size_t k = 0; k < at(options_.refits); ++k) off.push_back(numbers_.length_off(span, k));
        give_interval(wide_pivot(measure.value, off, options_.level), measure);
      }
      out_.measures.push_back(std::move(measure));
    }
  }

  // SD over mean, freed of what noise adds to its square.
  void state_variation(const Sort& sort, const std::vector<std::size_t>& known) {
    auto measure = blank(sort.variation, sort, known.front(), known.back(), Quantity::share);
    std::vector<double> lengths, settled;
    for (const auto s : known) {
      lengths.push_back(numbers_.length(layout_.spans[s]));
      settled.push_back(numbers_.settled_length(layout_.spans[s]));
    }
    measure.value = variation_of(lengths);
    if (intervals()) {
      std::vector<double> off;
      const double base = variation_of(settled);
      for (std::size_t k = 0; k < at(options_.refits); ++k) {
        std::vector<double> again;
        for (std::size_t i = 0; i < known.size(); ++i)
          again.push_back(settled[i] + numbers_.length_off(layout_.spans[known[i]], k));
        const double value = variation_of(again);
        off.push_back(value * value - base * base);
      }
      const auto pivoted = wide_pivot_of_square(measure.value, off, options_.level);
      give_interval(pivoted, measure);
      if (pivoted.low <= 0.0) {
        measure.interval.kind = data::IntervalKind::at_most;
        measure.interval.low = kNaN;
        measure.remark = "not distinguishable from 0";
      }
    }
    out_.measures.push_back(std::move(measure));
  }

  void state_curves(const Sort& sort, const std::vector<std::size_t>& known) {
    constexpr std::array kNames{"x", "y", "z", "speed"};
    for (std::int64_t c = 0; c < kCurves; ++c) {
      data::CycleCurves curves{.id = kNames[at(c)],
                               .subject = out_.subject,
                               .context = sort.context,
                               .quantity = c < 3 ? Quantity::length : Quantity::speed,
                               .points = kPoints};
      for (std::size_t i = 0; i < known.size(); ++i) {
        curves.cycles.push_back(fmt::format("{} {}", sort.context, i + 1));
        for (auto k = at(c * kPoints); k < at((c + 1) * kPoints); ++k) {
          curves.values.push_back(numbers_.recorded.curves[known[i]][k]);
          if (intervals()) curves.sd.push_back(numbers_.sums[known[i]].sd(k));
        }
      }
      out_.curves.push_back(std::move(curves));
    }
  }

  const Layout& layout_;
  const Numbers& numbers_;
  const Seen& seen_;
  const PathMeasureOptions& options_;
  double start_s_, cut_off_hz_;
  std::vector<double> shown_;  // times of instants, freed of bias, on the recording's clock; NaN: not known
  PathRhythm& out_;
};

}  // namespace

std::string_view to_string(PathEventKind kind) {
  switch (kind) {
    case PathEventKind::movement_start:
      return "Movement Start";
    case PathEventKind::movement_end:
      return "Movement End";
    case PathEventKind::cycle_start:
      return "Cycle Start";
  }
  return "";
}

std::span<const data::MeasureDefinition> rhythm_definitions() { return kRhythmDefinitions; }

const data::MeasureDefinition* find_rhythm_definition(std::string_view id) {
  const auto* found = std::ranges::find(kRhythmDefinitions, id, &data::MeasureDefinition::id);
  return found == kRhythmDefinitions.end() ? nullptr : &*found;
}

std::expected<PathRhythm, std::string> MeasuredPath::rhythm(const data::Region& region) const {
  const Stretch stretch = stretch_of(region);
  const double rate = recording_.rate_hz;
  const auto least = std::max<std::int64_t>(kFewestSamples, std::llround(2.0 * kMovingHold_s * rate));
  if (stretch.count < least)
    return std::unexpected(
        fmt::format("{} frames are too few for a movement; need {}", stretch.count, least));
  const double start_s = first_s_ + static_cast<double>(stretch.first) / rate;
  PathRhythm out{.subject = name_,
                 .region = region.name,
                 .start_s = start_s,
                 .end_s = start_s + static_cast<double>(stretch.count - 1) / rate};
  if (const double times = below_noise(stretch); times > 0.0) {
    out.verdict = fmt::format("moves by less than {} the noise: no events",
                              times < 1.0 ? "half" : fmt::format("{:g} times", times));
    return out;
  }
  // The same noise as behind the measures of the stretch.
  const auto stream = mix64(static_cast<std::uint64_t>(marker_) + 1);
  const bool intervals = options_.refits > 0;
  const auto near = intervals ? around(stretch) : Neighbourhood{};
  const auto part = [&](const SeriesMatrix& x) {
    return differentiate(x, stretch.first - near.first, stretch.count, rate);
  };
  const PathSamples less = differentiate(less_, stretch.first, stretch.count, rate);
  const SeriesMatrix pilot =
      intervals ? pilot_path(near.recording, stretch.first - near.first, stretch.count, options_.seed, stream)
                : SeriesMatrix{};
  // What there is, by the path without noise at rest.
  const PathSamples settled = intervals ? part(pilot) : less;
  const Eigen::Vector3d axis = upright(detrended_axis(settled.x));
  const auto found = find_repeats(settled, axis, out);
  Layout layout;
  lay_out_movements(settled, found.movements, layout);
  lay_out_cycles(found, layout);
  if (layout.instants.empty()) return out;

  const PathFrame frame = recognise(settled);
  const bool travels = out.periodic && !frame.closed && !frame.discrete;
  Numbers numbers{.recorded = version_of(less, layout, axis, travels),
                  .settled = version_of(settled, layout, axis, travels),
                  .deviations = std::vector<std::vector<double>>(layout.instants.size()),
                  .sums = std::vector<CurveSums>(layout.spans.size())};
  if (intervals)
    for_each_refit(near.recording, pilot, options_.refits, options_.seed, stream,
                   [&](std::int64_t, const SeriesMatrix& refit, const SeriesMatrix&) {
                     numbers.add(version_of(part(refit), layout, axis, travels));
                   });
  const Seen seen{.samples = recording_.seen, .first = stretch.first, .rate_hz = rate};
  Statement(layout, numbers, seen, options_, start_s, kLessSmooth * recording_.choice.half_power * rate, out)
      .state();
  return out;
}

}  // namespace kinemark::analysis
