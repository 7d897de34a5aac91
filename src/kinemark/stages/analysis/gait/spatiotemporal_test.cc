// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/spatiotemporal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace kinemark::analysis {
namespace {

using data::Side;

double of_cycles(std::string_view id, const std::vector<GaitCycle>& cycles) {
  return find_gait_definition(id)->value(cycles);
}

// A stride along x: times after its strike; the other foot's print ahead and beside it.
GaitCycle stride(double start_s, double duration_s, double length_m, double step_m, double width_m,
                 Side side = Side::left) {
  return {.side = side,
          .start_s = start_s,
          .end_s = start_s + duration_s,
          .off_s = start_s + 0.62 * duration_s,
          .other_off_s = start_s + 0.11 * duration_s,
          .other_strike_s = start_s + 0.51 * duration_s,
          .print = {.x = {start_s, 0.0}},
          .other_print = {.x = {start_s + step_m, side == Side::left ? -width_m : width_m}},
          .next_print = {.x = {start_s + length_m, 0.0}}};
}

const std::vector<GaitCycle> kThree{stride(0.0, 1.0, 1.2, 0.61, 0.08), stride(1.0, 1.1, 1.3, 0.66, 0.10),
                                    stride(2.1, 1.2, 1.4, 0.68, 0.12)};

TEST(Spatiotemporal, AreTheirFormulas) {
  EXPECT_NEAR(of_cycles("gait_speed", kThree), 3.9 / 3.3, 1e-12);
  EXPECT_NEAR(of_cycles("cadence", kThree), 2.0 / 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("step_width", kThree), 0.10, 1e-12);
  EXPECT_NEAR(of_cycles("stride_time", kThree), 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("stride_length", kThree), 1.3, 1e-12);
  EXPECT_NEAR(of_cycles("step_time", kThree), 0.51 * 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("step_length", kThree), 0.65, 1e-12);
  EXPECT_NEAR(of_cycles("stance_time", kThree), 0.62 * 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("swing_time", kThree), 0.38 * 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("stance_share", kThree), 0.62, 1e-12);
  EXPECT_NEAR(of_cycles("double_support", kThree), 0.11 * 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("single_support", kThree), 0.40 * 1.1, 1e-12);
  EXPECT_NEAR(of_cycles("double_support_share", kThree), 0.22, 1e-12);
  EXPECT_NEAR(of_cycles("stride_time_sd", kThree), 0.1, 1e-12);
  EXPECT_NEAR(of_cycles("step_width_sd", kThree), 0.02, 1e-12);
}

TEST(Spatiotemporal, PartsOfAStrideAddUpToIt) {
  for (const auto& cycle : kThree) {
    const std::vector<GaitCycle> one{cycle};
    EXPECT_NEAR(of_cycles("stance_time", one) + of_cycles("swing_time", one), of_cycles("stride_time", one),
                1e-12);
    EXPECT_NEAR(of_cycles("double_support_share", one) * of_cycles("stride_time", one) +
                    of_cycles("single_support", one) + of_cycles("swing_time", one),
                of_cycles("stride_time", one), 1e-12);
    EXPECT_NEAR(of_cycles("gait_speed", one) * of_cycles("stride_time", one), of_cycles("stride_length", one),
                1e-12);
  }
}

TEST(Spatiotemporal, DoNotDependOnTheOrderOfStrides) {
  auto turned = kThree;
  std::ranges::reverse(turned);
  for (const auto& definition : gait_definitions())
    EXPECT_NEAR(definition.value(turned), definition.value(kThree), 1e-12) << definition.what.id;
}

TEST(Spatiotemporal, OtherSideSteppingInTheMirrorIsTheSame) {
  std::vector<GaitCycle> mirrored;
  for (const auto& c : kThree) {
    mirrored.push_back(c);
    auto& m = mirrored.back();
    m.side = Side::right;
    for (auto* print : {&m.print, &m.other_print, &m.next_print}) print->x.y() = -print->x.y();
  }
  for (const auto& definition : gait_definitions())
    EXPECT_NEAR(definition.value(mirrored), definition.value(kThree), 1e-12) << definition.what.id;
}

// Twice as far: lengths and speeds double, times stay. Twice as long: times double, speeds and rates halve.
TEST(Spatiotemporal, HaveTheUnitsThatTheyState) {
  auto farther = kThree, longer = kThree;
  for (auto& c : farther)
    for (auto* print : {&c.print, &c.other_print, &c.next_print}) print->x *= 2.0;
  for (auto& c : longer)
    for (auto* t : {&c.start_s, &c.end_s, &c.off_s, &c.other_off_s, &c.other_strike_s}) *t *= 2.0;
  for (const auto& definition : gait_definitions()) {
    const double value = definition.value(kThree);
    double with_length = 1.0, with_time = 1.0;
    switch (definition.what.quantity) {
      case data::Quantity::length:
        with_length = 2.0;
        break;
      case data::Quantity::time:
        with_time = 2.0;
        break;
      case data::Quantity::speed:
        with_length = 2.0, with_time = 0.5;
        break;
      case data::Quantity::rate:
        with_time = 0.5;
        break;
      case data::Quantity::share:
        break;
      default:
        FAIL() << definition.what.id << " has another quantity";
    }
    EXPECT_NEAR(definition.value(farther), with_length * value, 1e-12) << definition.what.id;
    EXPECT_NEAR(definition.value(longer), with_time * value, 1e-12) << definition.what.id;
  }
}

TEST(Spatiotemporal, SpeedIsThatOfTheWayAndNotTheMeanOfSpeeds) {
  const std::vector<GaitCycle> two{stride(0.0, 1.0, 1.0, 0.5, 0.1), stride(1.0, 3.0, 1.5, 0.7, 0.1)};
  EXPECT_NEAR(of_cycles("gait_speed", two), 2.5 / 4.0, 1e-12);
}

TEST(Spatiotemporal, WhatWasNotSeenIsLeftOutOfTheMean) {
  auto cycles = kThree;
  cycles[1].off_s = kNaN;
  cycles[1].next_print = {};
  EXPECT_NEAR(of_cycles("stance_time", cycles), 0.5 * 0.62 * 2.2, 1e-12);
  EXPECT_NEAR(of_cycles("stride_length", cycles), 1.3, 1e-12);
  EXPECT_NEAR(of_cycles("gait_speed", cycles), 2.6 / 2.2, 1e-12);  // neither its way nor its time
  EXPECT_NEAR(of_cycles("stride_time", cycles), 1.1, 1e-12);
  EXPECT_TRUE(std::isnan(of_cycles("step_width_sd", cycles)));  // of two
  EXPECT_NEAR(of_cycles("stride_time_sd", cycles), 0.1, 1e-12);
  for (auto& cycle : cycles) cycle.other_strike_s = kNaN;
  EXPECT_TRUE(std::isnan(of_cycles("step_time", cycles)));
  EXPECT_TRUE(std::isnan(of_cycles("single_support", cycles)));
}

TEST(Spatiotemporal, OfNoCycleTellNothing) {
  for (const auto& definition : gait_definitions())
    EXPECT_TRUE(std::isnan(definition.value({}))) << definition.what.id;
}

TEST(Spatiotemporal, OnlyDeviationsAreCorrectedAsSquaresAndOnlyStepsAreOfTheOtherFoot) {
  for (const auto& definition : gait_definitions()) {
    const std::string id(definition.what.id);
    EXPECT_EQ(definition.is_deviation(), id.ends_with("_sd")) << id;
    EXPECT_EQ(definition.of_other, id == "step_time" || id == "step_length") << id;
  }
}

}  // namespace
}  // namespace kinemark::analysis
