// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/check_up.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::pipeline {
namespace {

constexpr double kMostPpm = 1000.0;     // a resonator without calibration is within half of it
constexpr double kSd = 4.0;             // of a rate, within which it is the granted one
constexpr double kLeastDark = 1.0;      // counts: below, the noise is cut off at code 0
constexpr double kMostDarkShare = 0.1;  // of the codes, that steady light may take
constexpr double kNoiseFactor = 3.0, kNoiseCounts = 0.5;
// Of a slot's counts, in the next: it moves a spot by so much of the distance of the two LEDs' spots.
constexpr double kMostCrosstalk = 1e-3;
constexpr double kKnownCrosstalk_sd = 5e-4;  // beyond, it is not known
constexpr double kFollows_counts = 1.0;      // by which a channel differs between LEDs at least

constexpr std::array<std::string_view, 4> kElectrodes = {"+x", "-x", "+y", "-y"};

/// Levels by LED and camera, and their names.
struct Levels {
  const Recorded& recorded;
  const data::Counts& layout;
  [[nodiscard]] std::size_t cameras() const { return layout.cameras.size(); }
  [[nodiscard]] std::size_t leds() const { return layout.leds.size(); }
  [[nodiscard]] const stream::CountLevels& lit(std::size_t led, std::size_t camera) const {
    return recorded.lit[led * cameras() + camera];
  }
  /// Counts of a channel without light: of the dark slot, else 0.
  [[nodiscard]] double dark(std::size_t camera, int channel) const {
    return recorded.dark.empty() ? 0.0 : recorded.dark[camera].mean(channel);
  }
  /// Noise of a channel where it is least.
  [[nodiscard]] double noise(std::size_t camera, int channel) const {
    double least = recorded.dark.empty() ? kNaN : recorded.dark[camera].noise(channel);
    for (std::size_t l = 0; l < leds(); ++l) least = std::fmin(least, lit(l, camera).noise(channel));
    return least;
  }
};

void add_rate(const Levels& levels, std::vector<TrialNote>& out) {
  const auto& clock = levels.recorded.clock;
  if (!clock) {
    out.push_back({"the rate was not measured: two seconds of a device with a clock of its own are needed"});
    return;
  }
  const bool good = std::abs(clock->ppm_fast) <= std::max(kMostPpm, kSd * clock->sd_ppm);
  const std::string rates =
      fmt::format("{:.4f} +- {:.4f} frames per second, {:.4f} granted, arrivals scatter by {:.2f} ms",
                  clock->rate_hz, clock->sd_hz, levels.layout.time.rate_hz, 1e3 * clock->delay_sd_s);
  out.push_back(
      good ? TrialNote{rates}
           : TrialNote{
                 rates + ": the device does not keep its rate; ask for a lower one, or look at its clock",
                 false});
}

void add_losses(const RecorderProgress& progress, std::vector<TrialNote>& out) {
  if (progress.dropped_by_device + progress.dropped_here == 0) {
    out.push_back({fmt::format("none of {} frames is missing", progress.frames)});
    return;
  }
  out.push_back({fmt::format("{} of {} frames are missing: end other programs of this machine, use a shorter "
                             "cable, or ask for a lower rate",
                             progress.dropped_by_device + progress.dropped_here, progress.frames),
                 false});
}

void add_dark(const Levels& levels, std::vector<TrialNote>& out) {
  if (levels.recorded.dark.empty()) {
    out.push_back({"the dark level is not known: there is no dark slot"});
    return;
  }
  for (std::size_t c = 0; c < levels.cameras(); ++c) {
    const auto& mean = levels.recorded.dark[c].mean;
    const std::string level = fmt::format("camera {} in the dark: {:.1f} to {:.1f} counts",
                                          levels.layout.cameras[c], mean.minCoeff(), mean.maxCoeff());
    if (mean.minCoeff() < kLeastDark)
      out.push_back({level + ": a channel is cut off at code 0; raise its offset", false});
    else if (mean.maxCoeff() > kMostDarkShare * levels.layout.highest_code)
      out.push_back({level + ": the room is too bright; dim it, or put a filter before the lens", false});
    else
      out.push_back({level});
  }
}

/// Whether a channel is the same whichever LED is lit; not known of one LED without a dark slot.
bool is_dead(const Levels& levels, std::size_t camera, int channel) {
  double low = levels.lit(0, camera).mean(channel), high = low;
  const auto take = [&](double level) {
    low = std::min(low, level);
    high = std::max(high, level);
  };
  for (std::size_t l = 0; l < levels.leds(); ++l) take(levels.lit(l, camera).mean(channel));
  if (!levels.recorded.dark.empty()) take(levels.dark(camera, channel));
  return levels.leds() + levels.recorded.dark.size() > 1 && high - low < kFollows_counts;
}

void add_channels(const Levels& levels, std::vector<TrialNote>& out) {
  std::vector<double> all;
  for (std::size_t c = 0; c < levels.cameras(); ++c)
    for (int k = 0; k < 4; ++k)
      if (const double noise = levels.noise(c, k); !std::isnan(noise)) all.push_back(noise);
  if (all.empty()) return;
  const double usual = math::median(all);
  const std::size_t before = out.size();
  for (std::size_t c = 0; c < levels.cameras(); ++c)
    for (int k = 0; k < 4; ++k) {
      const std::string channel = fmt::format(
          "channel {} of camera {}", kElectrodes[static_cast<std::size_t>(k)], levels.layout.cameras[c]);
      const double noise = levels.noise(c, k);
      if (is_dead(levels, c, k))
        out.push_back({channel + " follows no light: look at its wire and its amplifier", false});
      else if (noise > kNoiseFactor * usual + kNoiseCounts)
        out.push_back({fmt::format("{} has a noise of {:.2f} counts where {:.2f} are usual: look at its "
                                   "cable, its shield and its ground",
                                   channel, noise, usual),
                       false});
    }
  if (out.size() == before)
    out.push_back({fmt::format("noise of {} channels: {:.2f} to {:.2f} counts", all.size(),
                               *std::ranges::min_element(all), *std::ranges::max_element(all))});
}

/// What is left of the light of the LED before the dark slot, at one camera.
TrialNote crosstalk_of(const stream::SlotShare& found, const std::string& led, const std::string& camera) {
  const bool none_known = found.sd.hasNaN();
  Eigen::Index worst = 0;
  const double surely = none_known ? 0.0 : (found.share - kSd * found.sd).maxCoeff(&worst);
  if (none_known || (surely <= 0.0 && found.sd.maxCoeff() > kKnownCrosstalk_sd))
    return {fmt::format(
        "crosstalk into the slot after LED '{}' is not known at camera {}: move that LED across its "
        "view",
        led, camera)};
  const double share = found.share(worst), sd = found.sd(worst);
  if (surely > 0.0 && share > kMostCrosstalk)
    return {fmt::format(
                "{:.2f} +- {:.2f} % of the light of LED '{}' is still there in the slot after it, channel "
                "{} of camera {}: an amplifier has not settled, or the LED goes out slowly",
                100.0 * share, 100.0 * sd, led, kElectrodes[static_cast<std::size_t>(worst)], camera),
            false};
  return {fmt::format("crosstalk into the slot after LED '{}': {:.2f} % or less at camera {}", led,
                      100.0 * (found.share.cwiseAbs() + 2.0 * found.sd).maxCoeff(), camera)};
}

void add_crosstalk(const Levels& levels, std::vector<TrialNote>& out) {
  const auto& recorded = levels.recorded;
  if (recorded.crosstalk_led < 0 || recorded.crosstalk.empty()) {
    out.push_back({"crosstalk from slot to slot is not known: there is no dark slot"});
    return;
  }
  for (std::size_t c = 0; c < levels.cameras(); ++c)
    out.push_back(crosstalk_of(recorded.crosstalk[c],
                               levels.layout.leds[static_cast<std::size_t>(recorded.crosstalk_led)],
                               levels.layout.cameras[c]));
}

/// What one camera says of an LED; empty: all is well.
std::string trouble_of(const Levels& levels, std::size_t led, std::size_t camera) {
  const std::string& name = levels.layout.cameras[camera];
  const auto& lit = levels.lit(led, camera);
  if (lit.frames == 0) return fmt::format("no frame came from camera {}", name);
  if (lit.saturated > 0)
    return fmt::format("saturates camera {}: give it less light, or more distance", name);
  if (is_dark(levels.recorded, levels.layout, led * levels.cameras() + camera))
    return fmt::format("dark in camera {}: look at its wire, and whether the camera sees it", name);
  return "";
}

std::string brightness(const Levels& levels, std::size_t led, std::size_t camera) {
  return fmt::format("brightest channel at {:.0f} % of the codes in camera {}",
                     100.0 * levels.lit(led, camera).mean.maxCoeff() / levels.layout.highest_code,
                     levels.layout.cameras[camera]);
}

void add_leds(const Levels& levels, std::vector<TrialNote>& out) {
  for (std::size_t l = 0; l < levels.leds(); ++l) {
    std::string line;
    bool good = true;
    for (std::size_t c = 0; c < levels.cameras(); ++c) {
      const std::string trouble = trouble_of(levels, l, c);
      good = good && trouble.empty();
      line += line.empty() ? "" : "; ";
      line += trouble.empty() ? brightness(levels, l, c) : trouble;
    }
    out.push_back({fmt::format("LED '{}': {}", levels.layout.leds[l], line), good});
  }
}

}  // namespace

std::vector<TrialNote> check_up(const Recorded& recorded, const stream::GrantedPlan& granted) {
  if (recorded.error) return {{recorded.error->message, false}};
  if (recorded.progress.frames == 0)
    return {{"no frame came: is it running, and does it wait for a trigger?", false}};
  const Levels levels{recorded, granted.layout};
  std::vector<TrialNote> out;
  add_rate(levels, out);
  add_losses(recorded.progress, out);
  add_dark(levels, out);
  add_channels(levels, out);
  add_crosstalk(levels, out);
  add_leds(levels, out);
  return out;
}

data::Gate check_up_gate(const std::vector<TrialNote>& lines) {
  const auto wrong = std::ranges::count(lines, false, &TrialNote::good);
  return {.name = "check_up",
          .passed = wrong == 0,
          .value = static_cast<double>(wrong),
          .bound = 0.0,
          .unit = "lines",
          .sentence = fmt::format("{} of {} lines name something wrong; need 0", wrong, lines.size())};
}

}  // namespace kinemark::pipeline
