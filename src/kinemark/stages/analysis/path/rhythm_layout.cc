// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/rhythm_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::analysis::internal {
namespace {

constexpr double kIrregular = 0.25;  // SD of cycles over their mean from which they are none
constexpr double kSameEvent = 0.25;  // of the time to the next event of its kind, within which a refit has it
constexpr double kSameEventAtMost_s = 0.3;

// Times of all instants of one path, s from its first sample, by kind.
struct InstantsFound {
  std::array<std::vector<double>, 3> of_kind;
};

InstantsFound instants_of(const PathSamples& path, const Eigen::Vector3d& axis) {
  InstantsFound out;
  for (const auto& movement : movements_of(path, speed_of(path))) {
    if (std::isfinite(movement.onset_s)) out.of_kind[0].push_back(movement.onset_s);
    if (std::isfinite(movement.end_s)) out.of_kind[1].push_back(movement.end_s);
  }
  out.of_kind[2] = cycle_starts(path.x, axis, path.rate_hz, CycleTrend::of_whole_cycles);
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

}  // namespace

Eigen::Vector3d upright(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double variation_of(const std::vector<double>& values) {
  if (values.size() < 2) return kNaN;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1)) / mean;
}

namespace {

std::vector<double> lengths_of(const Repeats& found) {
  std::vector<double> out;
  for (const auto& [from, to] : found.cycles) out.push_back(found.crossings[to] - found.crossings[from]);
  return out;
}

}  // namespace

Repeats find_repeats(const PathSamples& path, const Eigen::Vector3d& axis, PathRhythm& out) {
  Repeats found{.movements = movements_of(path, speed_of(path)),
                .crossings = cycle_starts(path.x, axis, path.rate_hz, CycleTrend::of_samples),
                .cycles = {}};
  const auto period = period_of(path.v, path.rate_hz);
  const bool alike = period.likeness >= kPeriodicLikeness;
  if (alike) found.cycles = cycles_among(found.crossings, period.s);
  auto lengths = lengths_of(found);
  const double variation = variation_of(lengths);
  if (alike && lengths.size() > 1 && variation < kIrregular) {
    // That these are cycles is known now, and so is their trend.
    found.crossings = cycle_starts(path.x, axis, path.rate_hz, CycleTrend::of_whole_cycles);
    found.cycles = cycles_among(found.crossings, period.s);
    lengths = lengths_of(found);
    out.periodic = lengths.size() > 1;
  }
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

}  // namespace kinemark::analysis::internal
