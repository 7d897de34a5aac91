// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/report/figures/rig_timing.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

data::Counts recorded(const simulation::PhysicalRig& rig) {
  simulation::RigRecordingOptions how;
  how.frames = 2;
  return simulation::record(rig, simulation::signing_arm(), how).value().counts;
}

TEST(RigFigures, DrawTheScheduleInMilliseconds) {
  const auto figures = rig_figures(3);
  ASSERT_TRUE(figures) << figures.error().message;
  ASSERT_EQ(figures->size(), 3U);
  const auto rig = simulation::draw_rig({.seed = 3}).value();
  const auto slots = report::schedule_of(recorded(rig), rig.rig.timing);
  const auto& control = (*figures)[1];
  ASSERT_EQ(control.curves.size(), 6U) << "clock, four LEDs, conversions";
  for (std::size_t led = 0; led < 4; ++led) {
    const auto& points = control.curves[led + 1].points;  // low, rise (2), fall (2), ...
    EXPECT_NEAR(points(1, 0), 1e3 * slots[led].on_s, 1e-9);
    EXPECT_NEAR(points(3, 0), 1e3 * slots[led].off_s, 1e-9);
  }
  const auto& numbers = (*figures)[2].numbers;
  ASSERT_EQ(numbers.size(), 3U);
  for (const auto& number : numbers) EXPECT_NEAR(number.ours, *number.paper, 1e-6) << number.quantity;
}

TEST(RigFigures, ThePicturesNameTheirParts) {
  const auto figures = rig_figures(1).value();
  const auto components = report::figure_svg(figures[0].figure);
  for (const char* part :
       {"Camera A", "Camera B", "Amplifiers", "Multiplexer, A/D", "LED control", "4 hand", "1 shoulder"})
    EXPECT_THAT(components, HasSubstr(part));
  const auto control = report::figure_svg(figures[1].figure);
  for (const char* part : {"frame clock", "LED 4, hand", "A/D conversions", "slot 904"})
    EXPECT_THAT(control, HasSubstr(part));
  const auto slot = report::figure_svg(figures[2].figure);
  for (const char* part : {"settle 320", "8 conversions, 48", "off 200", "amplifier"})
    EXPECT_THAT(slot, HasSubstr(part));
}

}  // namespace
}  // namespace kinemark::studies
