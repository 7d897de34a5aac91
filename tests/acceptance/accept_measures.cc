// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of simulated movements: bias against the raw value's, and coverage of the intervals.
// Arguments: movements of each family (default 200), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acceptance/path_families.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

// One measure of one movement beside its truth.
struct Judged {
  std::string family;
  bool periodic = false, discrete = false;
  double truth = kNaN, raw = kNaN, sd = kNaN;
  data::Measure measure;
};

data::Trajectories recording_of(const analysis::PathSamples& path, double noise_mm, Random& random) {
  const auto n = path.count();
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = path.rate_hz, .frames = n});
  std::vector<bool> seen(static_cast<std::size_t>(n), true);
  if (random.uniform() < 0.5) {
    const int gaps = 1 + std::min(2, static_cast<int>(random.uniform(0.0, 3.0)));
    for (int g = 0; g < gaps; ++g) {
      const auto length = static_cast<std::int64_t>(random.uniform(0.03, 0.1) * path.rate_hz) + 1;
      const auto first = static_cast<std::int64_t>(random.uniform(
          0.12 * path.rate_hz, static_cast<double>(n) - 0.12 * path.rate_hz - static_cast<double>(length)));
      for (std::int64_t i = first; i < first + length; ++i) seen[static_cast<std::size_t>(i)] = false;
    }
  }
  for (std::int64_t i = 0; i < n; ++i) {
    const Eigen::Vector3d noise =
        1e-3 * noise_mm * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    if (!seen[static_cast<std::size_t>(i)]) continue;
    out.x(i, 0) = path.x.row(i).transpose() + noise;
    out.state[out.index(i, 0)] = data::SampleState::measured;
  }
  return out;
}

// The samples as recorded, straight across gaps, and central differences: what people compute.
analysis::PathSamples raw_of(const data::Trajectories& markers) {
  analysis::SeriesMatrix x(markers.frames(), 3);
  std::int64_t before = -1;
  for (std::int64_t i = 0; i < markers.frames(); ++i) {
    if (!markers.present(i, 0)) continue;
    x.row(i) = markers.x(i, 0).transpose();
    for (std::int64_t k = before + 1; k < i; ++k)
      x.row(k) = x.row(before) + (x.row(i) - x.row(before)) * static_cast<double>(k - before) /
                                     static_cast<double>(i - before);
    before = i;
  }
  const auto slope = [&](const analysis::SeriesMatrix& of) {
    analysis::SeriesMatrix out = analysis::SeriesMatrix::Zero(of.rows(), 3);
    for (std::int64_t i = 1; i + 1 < of.rows(); ++i)
      out.row(i) = 0.5 * markers.time.rate_hz * (of.row(i + 1) - of.row(i - 1));
    return out;
  };
  analysis::PathSamples out{.rate_hz = markers.time.rate_hz, .x = x};
  out.v = slope(out.x), out.a = slope(out.v), out.j = slope(out.a);
  return out;
}

analysis::PathSamples stretch_of(const analysis::PathSamples& path, std::int64_t first, std::int64_t count) {
  return {.rate_hz = path.rate_hz,
          .x = path.x.middleRows(first, count),
          .v = path.v.middleRows(first, count),
          .a = path.a.middleRows(first, count),
          .j = path.j.middleRows(first, count)};
}

std::vector<Judged> measure_one(const std::string& family, std::uint64_t seed) {
  Random random(seed, 7);
  const auto movement = acceptance::draw_movement(family, random);
  constexpr std::array kRates{60.0, 100.0, 120.0, 240.0};
  const double rate = kRates[std::min<std::size_t>(3, static_cast<std::size_t>(random.uniform(0.0, 4.0)))];
  const double noise_mm = std::exp(random.uniform(std::log(0.1), std::log(3.0)));
  const auto path = acceptance::sample_movement(movement, rate);
  const auto markers = recording_of(path, noise_mm, random);
  const auto measured = analysis::measure_paths(markers, {.noise_sd_m = 1e-3 * noise_mm, .seed = seed});
  std::vector<Judged> out;
  if (!measured || measured->measures.empty()) return out;
  const auto& one = measured->measures.front();
  const auto first = std::llround(one.start_s * rate), last = std::llround(one.end_s * rate);
  const auto whole = stretch_of(path, first, last - first + 1);
  const auto raw = stretch_of(raw_of(markers), first, last - first + 1);
  auto frame = analysis::recognise(whole);
  frame.start_s = one.start_s;
  const analysis::PathFacts truth(whole, frame), as_recorded(raw, frame);
  for (const auto& measure : measured->measures)
    for (const auto& definition : analysis::path_definitions())
      if (definition.what.id == measure.id)
        out.push_back({.family = family,
                       .periodic = frame.periodic,
                       .discrete = frame.discrete,
                       .truth = definition.value(truth),
                       .raw = definition.value(as_recorded),
                       .measure = measure});
  return out;
}

// One row of the table: a measure over some families.
struct Row {
  const char* id;
  const char* families;  // of kFamilies, with blanks around each
  const char* name;
  double least, most;  // coverage in per cent
  bool upper_alone;    // of the upper end
};
constexpr const char* kCyclic = " ellipse eight sign walk ";
constexpr const char* kClosed = " ellipse eight sign ";
constexpr const char* kDiscrete = " reach submovements ";
constexpr const char* kWheel = " wheel ";
constexpr const char* kTremor = " tremor ";

const std::vector<Row> kRows{
    {"path_length", kCyclic, "cyclic", 91, 98, false},
    {"mean_speed", kCyclic, "cyclic", 91, 98, false},
    {"peak_speed", kCyclic, "cyclic", 91, 98, false},
    {"peak_acceleration", kCyclic, "cyclic", 91, 98, false},
    {"rms_jerk", kCyclic, "cyclic", 91, 98, false},
    {"ldlj", kCyclic, "cyclic", 91, 98, false},
    {"sparc", kCyclic, "cyclic", 91, 98, false},
    {"plane_sd", kClosed, "closed", 93, 100, false},
    {"plane_axes_ratio", kClosed, "closed", 91, 98, false},
    {"farthest_sample", kClosed, "closed", 91, 98, false},
    {"curvature", kClosed, "closed", 91, 98, false},
    {"power_law_exponent", kClosed, "closed", 91, 98, false},
    {"cycle_time", kCyclic, "cyclic", 91, 98, false},
    {"cycle_time_sd", kCyclic, "cyclic", 91, 98, false},
    {"circle_diameter", kWheel, "wheel", 91, 98, false},
    {"ellipse_major", " ellipse sign ", "ellipses", 91, 98, false},
    {"ellipse_minor", " ellipse sign ", "ellipses", 91, 98, false},
    {"plane_sd", kWheel, "wheel", 97, 100, false},
    {"peak_speed", kDiscrete, "discrete", 91, 98, false},
    {"peak_acceleration", kDiscrete, "discrete", 91, 98, false},
    {"onset", kDiscrete, "discrete", 91, 98, false},
    {"movement_end", kDiscrete, "discrete", 91, 98, false},
    {"movement_time", kDiscrete, "discrete", 91, 98, false},
    {"plane_sd", kDiscrete, "discrete", 93, 100, false},
    {"submovements", kDiscrete, "discrete", 97, 100, false},
    {"extent_long", kCyclic, "cyclic", 85, 100, false},
    {"extent_thick", kCyclic, "cyclic", 95, 100, true},
    {"box_length", kCyclic, "cyclic", 85, 100, false},
    {"box_height", kCyclic, "cyclic", 95, 100, true},
    {"movement_path", kDiscrete, "discrete", 80, 100, false},
    {"movement_mean_speed", kDiscrete, "discrete", 80, 100, false},
    {"ldlj", kDiscrete, "discrete", 95, 100, true},
    {"path_length", kDiscrete, "discrete, across rests", 95, 100, true},
    {"mean_speed", kDiscrete, "discrete, across rests", 95, 100, true},
    {"peak_speed", kWheel, "wheel", 95, 100, true},
    {"peak_acceleration", kWheel, "wheel", 95, 100, true},
    {"tremor", kTremor, "tremor", 88, 100, false},
};

// Means and deviations without the two per cent at each end, so that one wild movement does not decide.
struct Trimmed {
  double mean = 0.0, sd = 0.0;
};
Trimmed trimmed(std::vector<double> values) {
  std::ranges::sort(values);
  const auto cut = static_cast<std::size_t>(0.02 * static_cast<double>(values.size()));
  Trimmed out;
  const double count = static_cast<double>(values.size() - 2 * cut);
  for (std::size_t i = cut; i + cut < values.size(); ++i) out.mean += values[i] / count;
  for (std::size_t i = cut; i + cut < values.size(); ++i)
    out.sd += (values[i] - out.mean) * (values[i] - out.mean) / count;
  out.sd = std::sqrt(out.sd);
  return out;
}

void judge_row(const Row& row, const std::vector<std::vector<Judged>>& judged) {
  int movements = 0, with_interval = 0, covered = 0;
  std::vector<double> error, raw_error;  // over the truth, which differs from movement to movement
  for (const auto& movement : judged)
    for (const auto& one : movement) {
      if (one.measure.id != row.id || !std::string_view(row.families).contains(" " + one.family + " "))
        continue;
      ++movements;
      if (!std::isfinite(one.measure.value) || !std::isfinite(one.truth)) continue;
      const double size = std::max(std::abs(one.truth), 1e-6);
      error.push_back((one.measure.value - one.truth) / size);
      if (std::isfinite(one.raw)) raw_error.push_back((one.raw - one.truth) / size);
      const auto& interval = one.measure.interval;
      if (interval.kind == data::IntervalKind::none) continue;
      ++with_interval;
      covered += one.truth <= interval.high && (row.upper_alone || !(one.truth < interval.low));
    }
  const double share = 100.0 * covered / std::max(1, with_interval);
  const auto name = fmt::format("measures, {}: {}", row.name, row.id);
  print_row(with_interval > 0 && share >= row.least && share <= row.most, name + ", coverage",
            row.most < 100.0 ? fmt::format("{:g} to {:g} %", row.least, row.most)
                             : fmt::format("{:g} %", row.least),
            fmt::format("{:.1f} % of {} with an interval, of {} movements", share, with_interval, movements));
  if (row.upper_alone || raw_error.empty()) return;
  const auto own = trimmed(error), raw = trimmed(raw_error);
  print_row(std::abs(own.mean) <= std::max(0.1 * std::abs(raw.mean), 0.3 * own.sd), name + ", bias",
            "a tenth of the raw value's, or 0.3 of its SD",
            fmt::format("{:.2g} % of the truth, SD {:.2g} %; raw {:.2g} %", 100.0 * own.mean, 100.0 * own.sd,
                        100.0 * raw.mean));
}

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<std::vector<Judged>> judged(acceptance::kFamilies.size() * static_cast<std::size_t>(count));
  parallel_for(static_cast<std::int64_t>(judged.size()), 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const auto family = static_cast<std::size_t>(i) % acceptance::kFamilies.size();
      judged[static_cast<std::size_t>(i)] =
          measure_one(acceptance::kFamilies[family], first_seed + static_cast<std::uint64_t>(i));
    }
  });
  for (const auto& row : kRows) judge_row(row, judged);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("measures", run);

}  // namespace
