// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/trial_notes.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/math/statistics.h"

namespace kinemark::pipeline {
namespace {

using Lines = std::vector<TrialNote>;

void add_stillness(const Recorded& recorded, const data::Counts& layout, Lines& out) {
  std::vector<double> sd;
  std::size_t still = 0, seen = 0;
  for (std::size_t at = 0; at < recorded.lit.size(); ++at) {
    const auto& levels = recorded.lit[at];
    if (is_dark(recorded, layout, at) || !levels.sd.allFinite()) continue;
    ++seen;
    if (!levels.still) continue;
    ++still;
    for (const double one : levels.sd) sd.push_back(one);
  }
  if (seen == 0) return;
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

void add_darkness(const Recorded& recorded, const data::Counts& layout, Lines& out) {
  const auto cameras = layout.cameras.size();
  for (std::size_t at = 0; at < recorded.lit.size(); ++at)
    if (is_dark(recorded, layout, at))
      out.push_back(
          {fmt::format("LED '{}' is dark at camera {}: look at its wire, and whether the camera sees it",
                       layout.leds[at / cameras], layout.cameras[at % cameras]),
           false});
}

void add_missing(const RecorderProgress& p, Lines& out) {
  if (p.acknowledged == p.frames) out.push_back({fmt::format("all {} frames came and are kept", p.frames)});
  if (p.dropped_by_device > 0)
    out.push_back({fmt::format("the device lost {} of {} frames: nobody read it in time, or it was away",
                               p.dropped_by_device, p.frames),
                   false});
  if (p.dropped_here > 0)
    out.push_back(
        {fmt::format("{} of {} frames came and were dropped here: the disk was full or too slow for them; "
                     "record to another one",
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
      out.push_back({fmt::format("LED '{}' saturates camera {} in {} of {} frames: give it less light, "
                                 "or more distance",
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

bool is_dark(const Recorded& recorded, const data::Counts& layout, std::size_t at) {
  const auto& levels = recorded.lit[at];
  if (levels.frames == 0) return false;
  const double dark = recorded.dark.empty() ? 0.0 : recorded.dark[at % layout.cameras.size()].mean.sum();
  return levels.mean.sum() - dark < stream::kLeastLightShare * layout.highest_code;
}

Lines describe_trial(const Recorded& recorded, const data::Counts& layout) {
  Lines out;
  if (!recorded.progress.begun)
    return {{"the trial did not begin: no frame came in which the LED of the trigger was as bright", false}};
  if (recorded.progress.frames == 0) return {{"no frame came", false}};
  add_missing(recorded.progress, out);
  add_stillness(recorded, layout, out);
  add_darkness(recorded, layout, out);
  add_saturation(recorded, layout, out);
  add_clock(recorded, out);
  return out;
}

data::Gate missing_gate(const RecorderProgress& progress) {
  const auto missing = progress.frames - progress.acknowledged;
  return {.name = "frames_missing",
          .passed = missing == 0,
          .value = static_cast<double>(missing),
          .bound = 0.0,
          .unit = "frames",
          .sentence = fmt::format("{} of {} frames are missing; need 0", missing, progress.frames)};
}

}  // namespace kinemark::pipeline
