// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/trial_notes.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/math/statistics.h"

namespace kinemark::pipeline {
namespace {

using Lines = std::vector<TrialNote>;

void add_stillness(const Recorded& recorded, Lines& out) {
  std::vector<double> sd;
  std::size_t still = 0;
  for (const auto& levels : recorded.lit) {
    if (!levels.still) continue;
    ++still;
    for (const double one : levels.sd) sd.push_back(one);
  }
  if (still == 0) {
    out.push_back({"every LED moved: hold one still for a second to see its noise"});
    return;
  }
  const auto [low, high] = std::ranges::minmax(sd);
  out.push_back(
      {fmt::format("LEDs that stood still have an SD of {:.2f} counts, {:.2f} to {:.2f} ({} of {} LEDs "
                   "at their cameras)",
                   math::median(sd), low, high, still, recorded.lit.size())});
}

void add_missing(const RecorderProgress& p, Lines& out) {
  if (p.dropped_by_device + p.dropped_here == 0)
    out.push_back({fmt::format("all {} frames came and are kept", p.frames)});
  if (p.dropped_by_device > 0)
    out.push_back({fmt::format("the device lost {} of {} frames: nobody read it in time, or it was away",
                               p.dropped_by_device, p.frames),
                   false});
  if (p.dropped_here > 0)
    out.push_back({fmt::format("{} of {} frames came and were dropped here: the disk was too slow for them; "
                               "record to another one, or with --sync never",
                               p.dropped_here, p.frames),
                   false});
  if (p.reopened > 0)
    out.push_back({fmt::format("the device was away and came back {} time{}; frames in between are missing",
                               p.reopened, p.reopened == 1 ? "" : "s"),
                   false});
}

void add_saturation(const Recorded& recorded, const data::Counts& layout, Lines& out) {
  const auto cameras = layout.cameras.size();
  for (std::size_t at = 0; at < recorded.lit.size(); ++at) {
    const auto& levels = recorded.lit[at];
    if (levels.saturated > 0)
      out.push_back({fmt::format("LED '{}' saturates camera {} in {} of {} frames: give it less light with "
                                 "--intensity, or more distance",
                                 layout.leds[at / cameras], layout.cameras[at % cameras], levels.saturated,
                                 levels.frames),
                     false});
  }
}

void add_clock(const Recorded& recorded, Lines& out) {
  if (!recorded.clock) return;
  const auto& clock = *recorded.clock;
  out.push_back(
      {fmt::format("by this machine's clock the device gives {:.6f} +- {:.6f} frames per second: its "
                   "clock is {:.2f} +- {:.2f} ppm {}",
                   clock.rate_hz, clock.sd_hz, std::abs(clock.ppm_fast), clock.sd_ppm,
                   clock.ppm_fast < 0.0 ? "slow" : "fast")});
}

}  // namespace

Lines describe_trial(const Recorded& recorded, const data::Counts& layout) {
  Lines out;
  if (recorded.progress.frames == 0) return {{"no frame came", false}};
  add_missing(recorded.progress, out);
  add_stillness(recorded, out);
  add_saturation(recorded, layout, out);
  add_clock(recorded, out);
  return out;
}

data::Gate missing_gate(const RecorderProgress& progress) {
  const auto missing = progress.dropped_by_device + progress.dropped_here;
  return {.name = "frames_missing",
          .passed = missing == 0,
          .value = static_cast<double>(missing),
          .bound = 0.0,
          .unit = "frames",
          .sentence = fmt::format("{} of {} frames are missing; need 0", missing, progress.frames)};
}

}  // namespace kinemark::pipeline
