// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/rig_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/rig_schedule.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

data::Counts recorded(const simulation::PhysicalRig& rig) {
  simulation::RigRecordingOptions how;
  how.frames = 2;
  return simulation::record(rig, simulation::signing_arm(), how).value().counts;
}

TEST(RigSchedule, IsThatOfTheRecorder) {
  const auto rig = simulation::draw_rig({.seed = 3}).value();
  const auto& timing = rig.rig.timing;
  const auto slots = schedule_of(recorded(rig), timing);
  ASSERT_EQ(slots.size(), 4U);
  for (int led = 0; led < 4; ++led) {
    const auto& slot = slots[static_cast<std::size_t>(led)];
    EXPECT_NEAR(slot.on_s, led * timing.slot_s(2), 1e-12);
    EXPECT_NEAR(slot.off_s, (led + 1) * timing.slot_s(2) - timing.off_s, 1e-12);
    ASSERT_EQ(slot.conversion_s.size(), 8U);
    for (int k = 0; k < 8; ++k)
      EXPECT_NEAR(slot.conversion_s[static_cast<std::size_t>(k)],
                  timing.conversion_offset_s(led, k / 4, k % 4, 2), 1e-12);
  }
  EXPECT_EQ(slots.back().led, "hand");
}

TEST(PulseTrain, RisesAndFallsWhereThePulsesDo) {
  const auto train = pulse_train({{0.1, 0.3}, {0.5, 0.9}, {1.2, 1.4}}, 0.0, 0.8);
  const Eigen::VectorXd time = (Eigen::VectorXd(8) << 0.0, 0.1, 0.1, 0.3, 0.3, 0.5, 0.5, 0.8).finished(),
                        level = (Eigen::VectorXd(8) << 0, 0, 1, 1, 0, 0, 1, 1).finished();
  EXPECT_EQ(train.time, time);
  EXPECT_EQ(train.level, level);
}

TEST(RigFigures, DrawTheScheduleInMilliseconds) {
  const auto figures = rig_figures(3);
  ASSERT_TRUE(figures) << figures.error().message;
  ASSERT_EQ(figures->size(), 3U);
  const auto rig = simulation::draw_rig({.seed = 3}).value();
  const auto slots = schedule_of(recorded(rig), rig.rig.timing);
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
