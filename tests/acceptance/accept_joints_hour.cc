// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// An hour of 16 markers at 60 Hz: time of one thread, memory, and cost per frame from a minute to an hour.
#include <fmt/core.h>
#include <sys/resource.h>

#include <ctime>

#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

struct Cost {
  double seconds = 0.0;  ///< of the processor, which a busy machine does not lengthen
  std::int64_t frames = 0, answered = 0;
};

Cost run(double minutes) {
  data::SegmentLayout layout;
  data::Trajectories markers;
  {
    auto limb = simulation::simulate_sleeve({.duration_s = 60.0 * minutes, .seed = 1}).value();
    layout = std::move(limb.layout);
    markers = std::move(limb.markers);
  }
  const std::clock_t begin = std::clock();
  const auto fit = skeleton::fit_articulated(markers, layout, {.threads = 1}).value();
  Cost cost{.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC,
            .frames = markers.frames()};
  cost.answered = fit.joints[0].determined + fit.joints[0].bridged;
  return cost;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

int run_check(int /*argc*/, char** /*argv*/) {
  const Cost minute = run(1.0), ten = run(10.0), hour = run(60.0);
  print_row(hour.seconds <= 20.0, "an hour of 16 markers, one thread", "<= 20 s",
            fmt::format("{:.1f} s, {:.1f} us a frame, {} of {} frames answered", hour.seconds,
                        1e6 * hour.seconds / static_cast<double>(hour.frames), hour.answered, hour.frames));
  // The geometry is found from a fixed number of frames: what grows with the recording is the rest.
  const double early = (ten.seconds - minute.seconds) / static_cast<double>(ten.frames - minute.frames);
  const double late = (hour.seconds - ten.seconds) / static_cast<double>(hour.frames - ten.frames);
  print_row(late <= 1.3 * early, "cost per frame", "constant from a minute to an hour (<= 1.3 x)",
            fmt::format("{:.1f} us up to ten minutes, {:.1f} us from then on; a minute takes {:.2f} s",
                        1e6 * early, 1e6 * late, minute.seconds));
  const double memory = peak_megabytes();
  print_row(memory <= 500.0, "memory, with the recording itself", "<= 500 MB",
            fmt::format("{:.0f} MB", memory));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("joints_hour", run_check);

}  // namespace
