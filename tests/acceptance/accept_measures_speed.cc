// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How long measures of an hour of 16 markers at 240 Hz take, with and without refits, and what of the truth
// they find. Arguments: minutes that are measured without refits (default 60), with refits (default 60); what
// is shorter than an hour is multiplied, and says so.
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr double kRate_hz = 240.0;
constexpr std::int64_t kMarkers = 16;
constexpr double kNoise_m = 5e-4;
constexpr double kCores = 2.0;

// Slow wandering, a gesture whose rhythm changes, and its overtone: different for each marker.
Eigen::Vector3d position(std::int64_t marker, double t) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double own = 0.37 * static_cast<double>(marker);
  const double phase = kTurn * (0.8 + 0.02 * static_cast<double>(marker)) * t + 2.0 * std::sin(0.05 * t);
  return {0.30 * std::sin(kTurn * 0.021 * t + own) + 0.12 * std::cos(phase),
          0.20 * std::cos(kTurn * 0.017 * t) + 0.08 * std::sin(phase + own), 0.05 * std::sin(2.0 * phase)};
}

// Gaps of 50 ms, one every ten seconds.
bool is_seen(std::int64_t marker, std::int64_t frame) { return (frame + 131 * marker) % 2400 >= 12; }

data::Trajectories recording_of(double minutes) {
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < kMarkers; ++m) names.push_back(fmt::format("M{}", m));
  const auto frames = std::llround(60.0 * minutes * kRate_hz);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = kRate_hz, .frames = frames});
  parallel_for(kMarkers, 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t m = begin; m < end; ++m) {
      Random random(16, static_cast<std::uint64_t>(m));
      for (std::int64_t f = 0; f < frames; ++f) {
        if (!is_seen(m, f)) continue;
        out.x(f, m) = position(m, static_cast<double>(f) / kRate_hz) +
                      kNoise_m * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
        out.state[out.index(f, m)] = data::SampleState::measured;
      }
    }
  });
  return out;
}

// Every measure by its name, so that none is left out because it does not apply.
std::vector<std::string> all_measures() {
  std::vector<std::string> out;
  for (const auto& definition : analysis::path_definitions()) out.emplace_back(definition.what.id);
  return out;
}

// Root mean square over markers of the path length's error, per cent.
double path_error(const analysis::PathMeasures& measured) {
  double squares = 0.0;
  int count = 0;
  for (const auto& measure : measured.measures) {
    if (measure.id != "path_length") continue;
    const auto marker = std::atoll(measure.subject.c_str() + 1);
    const auto first = std::llround(measure.start_s * kRate_hz),
               last = std::llround(measure.end_s * kRate_hz);
    double truth = 0.0;
    for (std::int64_t f = first; f < last; ++f)
      truth += (position(marker, static_cast<double>(f + 1) / kRate_hz) -
                position(marker, static_cast<double>(f) / kRate_hz))
                   .norm();
    squares += std::pow(measure.value / truth - 1.0, 2);
    ++count;
  }
  return 100.0 * std::sqrt(squares / count);
}

void judge(const std::string& what, double minutes, std::int64_t refits, double bound_s) {
  const auto markers = recording_of(minutes);
  const auto begin = std::clock();
  const auto measured = analysis::measure_paths(
      markers, {.measures = all_measures(), .refits = refits, .noise_sd_m = kNoise_m, .threads = 0});
  // Of the processor, so that what else the machine does does not count: each core its part of the markers.
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kCores * 60.0 / minutes;
  const auto name = fmt::format("measures_speed, an hour of 16 markers at 240 Hz, {}", what);
  if (!measured) {
    print_row(false, name, fmt::format("{:g} s", bound_s), measured.error().message);
    return;
  }
  print_row(
      seconds <= bound_s, name, fmt::format("{:g} s", bound_s),
      fmt::format("{:.1f} s on {:g} cores by the processor's time{}; {} values, path length within {:.3f} %",
                  seconds, kCores, minutes < 60.0 ? fmt::format(", of {:g} min multiplied", minutes) : "",
                  measured->measures.size(), path_error(*measured)));
}

int run(int argc, char** argv) {
  judge("all measures without intervals", argc > 1 ? std::atof(argv[1]) : 60.0, 0, 5.0);
  const double minutes = argc > 2 ? std::atof(argv[2]) : 60.0;
  if (minutes > 0.0) judge("all measures with 200 refits, pilot included", minutes, 200, 300.0);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("measures_speed", run);

}  // namespace
