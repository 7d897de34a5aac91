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
#include "kinemark/stages/analysis/path/measured_path.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"
#include "kinemark/stages/analysis/path/pivot.h"
#include "kinemark/stages/analysis/path/rhythm.h"
#include "kinemark/stages/analysis/path/stated_measure.h"

namespace kinemark::analysis {
namespace {

using data::Quantity;

constexpr std::int64_t kPoints = 101;
constexpr std::int64_t kCurves = 4;  // x, y, z, speed
constexpr double kIrregular = 0.25;  // SD of cycles over their mean from which they are none
constexpr double kSameEvent = 0.25;  // of the time to the next event of its kind, within which a refit has it
constexpr double kSameEventAtMost_s = 0.3;
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

// An instant of the path that refits are compared with.
struct Instant {
  PathEventKind kind;
  double time_s;       // s from the first sample
  double tolerance_s;  // within which a refit's is the same
};

// From one instant to another, by their indices.
struct Span {
  std::size_t begin, end;
};

// Times of all instants of one path, s from its first sample, by kind.
struct InstantsFound {
  std::array<std::vector<double>, 3> of_kind;
};

Eigen::Vector3d upright(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

InstantsFound instants_of(const PathSamples& path, const Eigen::Vector3d& axis) {
  InstantsFound out;
  for (const auto& movement : movements_of(speed_of(path), path.rate_hz)) {
    if (std::isfinite(movement.onset_s)) out.of_kind[0].push_back(movement.onset_s);
    if (std::isfinite(movement.end_s)) out.of_kind[1].push_back(movement.end_s);
  }
  out.of_kind[2] = cycle_starts(path.x, axis, path.rate_hz);
  return out;
}

// The time of the instant in another version of the path; NaN where it has none there.
double same_in(const InstantsFound& found, const Instant& instant) {
  const auto& times = found.of_kind[at(static_cast<std::int64_t>(instant.kind))];
  double best = kNaN;
  for (auto it = std::ranges::lower_bound(times, instant.time_s - instant.tolerance_s);
       it != times.end() && *it <= instant.time_s + instant.tolerance_s; ++it)
    if (std::isnan(best) || std::abs(*it - instant.time_s) < std::abs(best - instant.time_s)) best = *it;
  return best;
}

// Instants of one kind, each the same within a quarter of the way to its neighbours.
void add_instants(PathEventKind kind, const std::vector<double>& times, std::vector<Instant>& out) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    double room = std::numeric_limits<double>::infinity();
    if (i > 0) room = times[i] - times[i - 1];
    if (i + 1 < times.size()) room = std::min(room, times[i + 1] - times[i]);
    out.push_back({kind, times[i], std::min(kSameEventAtMost_s, kSameEvent * room)});
  }
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// SD over mean; NaN of fewer than two.
double variation_of(const std::vector<double>& values) {
  if (values.size() < 2) return kNaN;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1)) / mean;
}

// x, y, z and speed at kPoints even times from begin to end, curve by curve; linear between samples.
std::vector<double> curves_over(const PathSamples& path, const SeriesMatrix& positions,
                                const Eigen::VectorXd& speed, double begin_s, double end_s) {
  std::vector<double> out(at(kCurves * kPoints), kNaN);
  if (!std::isfinite(begin_s) || !std::isfinite(end_s)) return out;
  for (std::int64_t p = 0; p < kPoints; ++p) {
    const double share = static_cast<double>(p) / static_cast<double>(kPoints - 1);
    const double sample = std::clamp((begin_s + share * (end_s - begin_s)) * path.rate_hz, 0.0,
                                     static_cast<double>(path.count() - 1));
    const auto before = std::min<std::int64_t>(path.count() - 2, static_cast<std::int64_t>(sample));
    const double later = sample - static_cast<double>(before);
    for (int axis = 0; axis < 3; ++axis)
      out[at(axis * kPoints + p)] =
          (1.0 - later) * positions(before, axis) + later * positions(before + 1, axis);
    out[at(3 * kPoints + p)] = (1.0 - later) * speed[before] + later * speed[before + 1];
  }
  return out;
}

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

// What repetitions of one sort are called and which measures tell of them.
struct Sort {
  std::string context;
  std::string_view duration, variation;
  std::vector<std::size_t> spans;  // indices of spans
};

// Instants and spans of a path, and which spans belong together.
struct Layout {
  std::vector<Instant> instants;
  std::vector<Span> spans;
  std::vector<Sort> sorts;
};

// What repeats in a path without noise at rest.
struct Repeats {
  std::vector<MovementWindow> movements;
  std::vector<double> crossings;  // of the mean, upward, s
  std::vector<CycleEnds> cycles;  // of a periodic movement
};

// Cycles of a path, if it is periodic; a sentence on it.
Repeats find_repeats(const PathSamples& path, const Eigen::Vector3d& axis, PathRhythm& out) {
  Repeats found{.movements = movements_of(speed_of(path), path.rate_hz),
                .crossings = cycle_starts(path.x, axis, path.rate_hz),
                .cycles = {}};
  const auto period = period_of(path.v, path.rate_hz);
  const bool alike = period.likeness >= kPeriodicLikeness;
  if (alike) found.cycles = cycles_among(found.crossings, period.s);
  std::vector<double> lengths;
  for (const auto& [from, to] : found.cycles) lengths.push_back(found.crossings[to] - found.crossings[from]);
  const double variation = variation_of(lengths);
  out.periodic = alike && lengths.size() > 1 && variation < kIrregular;
  if (out.periodic) {
    out.period_s = period.s;
    out.verdict = fmt::format("{} cycles of {:.3f} s (likeness {:.2f})", lengths.size(), mean_of(lengths),
                              period.likeness);
  } else if (std::isnan(period.s)) {
    out.verdict = "not periodic: it does not come back to what it did";
  } else if (!alike) {
    out.verdict = fmt::format(
        "not periodic: after {:.2f} s, where it is most like itself, its velocities correlate by {:.2f}; "
        "need {:g}",
        period.s, period.likeness, kPeriodicLikeness);
  } else if (lengths.size() < 2) {
    out.verdict = fmt::format("not periodic: {} whole cycle{} of {:.2f} s; need two", lengths.size(),
                              lengths.size() == 1 ? "" : "s", period.s);
  } else {
    out.verdict = fmt::format("not periodic: its cycles differ by {:.0f} % (SD); need less than {:.0f} %",
                              100.0 * variation, 100.0 * kIrregular);
  }
  if (!out.periodic) found.cycles.clear();
  const auto& all = found.movements;
  if (!all.empty() && (std::isfinite(all.front().onset_s) || std::isfinite(all.back().end_s)))
    out.verdict += fmt::format("; {} movement{} between rests", all.size(), all.size() == 1 ? "" : "s");
  return found;
}

// Starts and ends of movements; those that have both are spans, by the kind of their way.
void lay_out_movements(const PathSamples& path, const std::vector<MovementWindow>& movements, Layout& out) {
  std::vector<double> starts, ends;
  std::vector<Eigen::Vector3d> ways;
  const auto place = [&](double s) -> Eigen::Vector3d {
    return path.x.row(std::min<std::int64_t>(path.count() - 1, std::llround(s * path.rate_hz))).transpose();
  };
  for (const auto& [onset_s, end_s] : movements) {
    if (std::isfinite(onset_s)) starts.push_back(onset_s);
    if (std::isfinite(end_s)) ends.push_back(end_s);
    if (!std::isfinite(onset_s) || !std::isfinite(end_s)) continue;
    out.spans.push_back({starts.size() - 1, ends.size() - 1});
    ways.push_back(place(end_s) - place(onset_s));
  }
  for (auto& span : out.spans) span.end += starts.size();
  add_instants(PathEventKind::movement_start, starts, out.instants);
  add_instants(PathEventKind::movement_end, ends, out.instants);
  const auto kinds = kinds_of(ways);
  const std::size_t count = kinds.empty() ? 0 : 1 + std::ranges::max(kinds);
  out.sorts.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    out.sorts[k].context = count > 1 ? fmt::format("movement {}", k + 1) : "movement";
    out.sorts[k].duration = "repetition_duration";
    out.sorts[k].variation = "repetition_variation";
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) out.sorts[kinds[i]].spans.push_back(i);
}

// Crossings between which there are cycles, and those, before the movements.
void lay_out_cycles(const Repeats& found, Layout& out) {
  if (found.cycles.empty()) return;
  Sort sort{.context = "cycle", .duration = "cycle_duration", .variation = "cycle_variation", .spans = {}};
  std::vector<std::size_t> used;
  for (const auto& [from, to] : found.cycles)
    for (const auto c : {from, to})
      if (used.empty() || used.back() != c) used.push_back(c);
  std::vector<double> times;
  for (const auto c : used) times.push_back(found.crossings[c]);
  const auto place = [&, before = out.instants.size()](std::size_t c) {
    return before + at(std::ranges::lower_bound(used, c) - used.begin());
  };
  for (const auto& [from, to] : found.cycles) {
    sort.spans.push_back(out.spans.size());
    out.spans.push_back({place(from), place(to)});
  }
  add_instants(PathEventKind::cycle_start, times, out.instants);
  out.sorts.insert(out.sorts.begin(), std::move(sort));
}

// The times and curves of a layout in one version of the path.
struct Version {
  std::vector<double> times;                // one for each instant, s from the first sample
  std::vector<std::vector<double>> curves;  // one for each span
};

// How far a path goes on from cycle to cycle, m/s: from the mean place of its first cycle to that of its
// last, which do not depend on where in the cycle it begins.
Eigen::RowVector3d travel_of(const PathSamples& path, const Layout& layout,
                             const std::vector<double>& times) {
  if (layout.sorts.empty() || layout.sorts.front().context != "cycle") return Eigen::RowVector3d::Zero();
  std::vector<std::pair<double, Eigen::RowVector3d>> means;  // middle of the cycle, s, and its mean place
  const Eigen::VectorXd unused = Eigen::VectorXd::Zero(path.count());
  for (const auto s : layout.sorts.front().spans) {
    const double begin = times[layout.spans[s].begin], end = times[layout.spans[s].end];
    const auto over = curves_over(path, path.x, unused, begin, end);
    if (!std::isfinite(over.front())) continue;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      for (std::int64_t p = 0; p + 1 < kPoints; ++p) sum[axis] += over[at(axis * kPoints + p)];
    means.emplace_back(0.5 * (begin + end), sum / static_cast<double>(kPoints - 1));
  }
  if (means.size() < 2) return Eigen::RowVector3d::Zero();
  return (means.back().second - means.front().second) / (means.back().first - means.front().first);
}

Version version_of(const PathSamples& path, const Layout& layout, const Eigen::Vector3d& axis, bool travels) {
  Version out;
  const auto found = instants_of(path, axis);
  for (const auto& instant : layout.instants) out.times.push_back(same_in(found, instant));
  SeriesMatrix positions = path.x;
  if (travels) {
    const Eigen::RowVector3d step = travel_of(path, layout, out.times) / path.rate_hz;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) positions.row(i) -= static_cast<double>(i) * step;
  }
  const Eigen::VectorXd speed = speed_of(path);
  for (const auto& span : layout.spans)
    out.curves.push_back(curves_over(path, positions, speed, out.times[span.begin], out.times[span.end]));
  return out;
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
        give_interval(pivot(measure.value, off, options_.level), measure);
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
      const auto pivoted = pivot_of_square(measure.value, off, options_.level);
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
  if (below_noise(stretch)) {
    out.verdict = "moves by less than half the noise: no events";
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
