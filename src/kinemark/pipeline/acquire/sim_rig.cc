// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/sim_rig.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/pipeline/simulate/rig_scenes.h"
#include "kinemark/stages/simulation/rig_device.h"

namespace kinemark::pipeline {
namespace {

constexpr double kYear_s = 3.2e7;
constexpr double kLargestSeed = 9e15;  ///< whole numbers up to here have no neighbour in a double

/// 0 for "fast".
double speed_of(AddressSettings& settings) {
  const bool fast = settings.flag("fast"), says_fast = settings.text("speed") == "fast";
  if (says_fast) return 0.0;
  const double speed = settings.number("speed", 1.0, 1e-3, 1e4);
  return fast ? 0.0 : speed;
}

Result<StagedScene> stage(AddressSettings& settings) {
  const auto scene = settings.text("scene").value_or("wheel");
  const int leds = settings.whole("leds", 0, 1, simulation::kMostLeds);
  auto out = scene == "wheel"  ? stage_wheel({.leds = leds == 0 ? simulation::kMostLeds : leds})
             : scene == "sign" ? Result<StagedScene>(stage_sign())
             : scene == "tree" ? stage_tree(0)
                               : fail(Code::usage, fmt::format("{}: there is no scene '{}'; there are "
                                                               "wheel, sign, tree",
                                                               settings.uri(), scene));
  if (!out) return out;
  auto& names = out->scene.leds;
  if (leds > static_cast<int>(names.size()))
    return fail(Code::usage,
                fmt::format("{}: the scene '{}' has {} LEDs", settings.uri(), scene, names.size()));
  if (leds > 0) names.resize(static_cast<std::size_t>(leds));
  return out;
}

}  // namespace

Result<std::unique_ptr<stream::Device>> open_sim_rig(AddressSettings settings, std::uint64_t seed,
                                                     std::shared_ptr<stream::HostClock> clock) {
  auto staged = stage(settings);
  if (!staged) return std::unexpected(staged.error());
  const int cameras = settings.whole("cameras", 2, 1, 2);
  seed = static_cast<std::uint64_t>(settings.number("seed", static_cast<double>(seed), 0.0, kLargestSeed));
  const bool dark_slot = settings.flag("dark");
  const simulation::RigDeviceOptions options{
      .rate_hz = settings.number("rate", 0.0, 0.01, 1e5),
      .duration_s = settings.number("seconds", 0.0, 1e-3, kYear_s),
      .seed = seed,
      .stream = staged->stream,
      .speed = speed_of(settings),
      .clock_ppm = settings.number("clock_ppm", 0.0, -9e4, 9e4),
      .buffer_s = settings.number("buffer", 1.0, 1e-3, 3600.0),
      .unplug_at_s = settings.number("unplug_at", 0.0, 1e-3, kYear_s),
      .unplug_for_s = settings.number("unplug_for", 1.0, 0.0, kYear_s),
      .dark_led = settings.whole("dark_led", 0, 1, simulation::kMostLeds),
      .bright_led = settings.whole("bright_led", 0, 1, simulation::kMostLeds),
      .noisy_channel = settings.whole("noisy_channel", 0, 1, 4 * cameras),
      .afterglow = settings.number("afterglow", 0.0, 0.0, 0.5)};
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  auto rig = simulation::draw_rig({.seed = seed, .dark_slot = dark_slot});
  if (!rig) return std::unexpected(rig.error());
  rig->rig.cameras.resize(static_cast<std::size_t>(cameras));
  rig->room.resize(static_cast<std::size_t>(cameras));
  return simulation::RigDevice::create(std::move(*rig), std::move(staged->scene), options, std::move(clock));
}

}  // namespace kinemark::pipeline
