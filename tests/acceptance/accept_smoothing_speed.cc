// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// An hour of 16 markers at 240 Hz, smoothed with derivatives and covariance on one thread.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;

constexpr double kRateHz = 240.0, kSigma = 0.0005;

/// Most memory that this process ever held, MB.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kb = 0.0;
  while (status >> word)
    if (word == "VmHWM:") status >> kb;
  return kb / 1024.0;
}

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double truth(std::int64_t frame, std::int64_t marker, int axis, int derivative) {
  const double t = static_cast<double>(frame) / kRateHz,
               w = 2.0 * M_PI * (0.7 + 0.05 * static_cast<double>(marker % 16));
  const double phase = static_cast<double>(axis) + derivative * M_PI / 2.0;
  return 0.3 * std::pow(w, derivative) * std::sin(w * t + phase) +
         0.02 * std::pow(3.0 * w, derivative) * std::sin(3.0 * w * t + phase);
}

data::Trajectories recording(std::int64_t frames, std::int64_t markers) {
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers; ++m) names.push_back(fmt::format("M{}", m));
  auto t = data::Trajectories::all_missing(names, {kRateHz, 0.0, frames});
  for (std::int64_t m = 0; m < markers; ++m) {
    Random random(1, static_cast<std::uint64_t>(m));
    std::int64_t gap = 0;
    for (std::int64_t f = 0; f < frames; ++f) {
      if (gap > 0)
        --gap;
      else if (random.uniform() < 0.0005)
        gap = static_cast<std::int64_t>(random.uniform(1.0, 60.0));
      if (gap > 0) continue;
      for (int axis = 0; axis < 3; ++axis)
        t.x(f, m)[axis] = truth(f, m, axis, 0) + kSigma * random.gaussian();
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  }
  return t;
}

void hour() {
  constexpr std::int64_t kFrames = 864000, kMarkers = 16;
  const auto in = recording(kFrames, kMarkers);
  double sum = 0.0, count = 0.0;
  const double before = cpu_s();
  const auto status = trajectory::smooth_each(in, {}, [&](trajectory::MarkerResult&& one) -> Status {
    for (std::int64_t f = 0; f < kFrames; f += 97)
      for (int axis = 0; axis < 3; ++axis)
        if (const double a = one.acceleration[static_cast<std::size_t>(3 * f + axis)]; !std::isnan(a)) {
          sum += std::pow(a - truth(f, one.marker, axis, 2), 2);
          count += 1.0;
        }
    return {};
  });
  const double seconds = cpu_s() - before, memory = peak_mb();
  const double error = std::sqrt(sum / std::max(count, 1.0));
  testing_support::print_row(
      status.has_value() && seconds <= 60.0, "an hour of 16 markers at 240 Hz, one thread", "60 s",
      fmt::format("{:.1f} s; acceleration {:.3f} m/s^2 rms from the truth", seconds, error));
  testing_support::print_row(memory <= 1024.0, "... the whole process, recording included", "1 GB",
                             fmt::format("{:.0f} MB, {:.0f} of them the recording", memory,
                                         static_cast<double>(in.x_in_world.size()) * 8e-6 * 25.0 / 24.0));
  fmt::print("seconds {:.4f}\n", seconds);
}

int run_check(int /*argc*/, char** /*argv*/) {
  hour();
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("smoothing_speed", run_check);

}  // namespace
