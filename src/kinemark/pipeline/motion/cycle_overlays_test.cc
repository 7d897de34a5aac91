// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/missing.h"

#include "kinemark/pipeline/motion/internal/cycle_overlays.h"

namespace kinemark::pipeline::internal {
namespace {

constexpr double kPeriod_s = 1.25;

// Four seconds at 200 Hz; the coordinates swing with the cycle, the last stands still.
data::JointMotion swinging() {
  data::JointMotion motion;
  motion.time = {.rate_hz = 200.0, .t0_s = 2.0, .frames = 800};
  motion.coordinates = {"knee_angle_r", "knee_angle_l", "pelvis_ty", "wrist"};
  motion.is_rotation = {true, true, false, true};
  motion.q.resize(800 * 4);
  for (std::int64_t f = 0; f < 800; ++f) {
    const double phase = 2.0 * std::numbers::pi * (motion.time.time_s(f) - 2.0) / kPeriod_s;
    motion.q[motion.index(f, 0)] = std::sin(phase);
    motion.q[motion.index(f, 1)] = std::cos(phase);
    motion.q[motion.index(f, 2)] = 0.9 + 0.01 * std::sin(2.0 * phase);
    motion.q[motion.index(f, 3)] = 0.3;
  }
  return motion;
}

const std::vector<data::Event> kEvents{{"Foot Strike", "Right", 2.0},
                                       {"Foot Strike", "Right", 3.25},
                                       {"Foot Strike", "Right", 4.5},
                                       {"Foot Strike", "Right", 5.75},
                                       {"Foot Strike", "Left", 2.625},
                                       {"Foot Strike", "Left", 3.875},
                                       {"General", "", 3.0}};

const report::CycleOverlay* find(const std::vector<report::CycleOverlay>& all, const std::string& name,
                                 const std::string& side) {
  for (const auto& one : all)
    if (one.curves.id == name && one.curves.context == side) return &one;
  return nullptr;
}

TEST(CycleSpans, AreTheTimesFromStrikeToStrike) {
  const auto spans = cycle_spans(kEvents, swinging().time);
  ASSERT_EQ(spans.size(), 4U);
  EXPECT_EQ(spans[0].side, data::Side::left);
  EXPECT_DOUBLE_EQ(spans[0].start_s, 2.625);
  EXPECT_DOUBLE_EQ(spans[0].end_s, 3.875);
  EXPECT_EQ(spans[3].side, data::Side::right);
  EXPECT_DOUBLE_EQ(spans[3].end_s, 5.75);
  EXPECT_TRUE(cycle_spans(std::vector<data::Event>{{"General", "", 3.0}}, swinging().time).empty());
}

TEST(CycleOverlays, AreTheSwingFromStrikeToStrike) {
  const auto motion = swinging();
  const auto all = cycle_overlays(kEvents, motion.time, motion);
  const auto* right = find(all, "knee_angle_r", "Right");
  ASSERT_NE(right, nullptr);
  EXPECT_EQ(right->curves.count(), 3);
  for (std::int64_t p = 0; p < right->curves.points; ++p) {
    const double expected = std::sin(2.0 * std::numbers::pi * static_cast<double>(p) / 100.0);
    for (std::int64_t c = 0; c < 3; ++c) EXPECT_NEAR(right->curves(c, p), expected, 2e-4);
    EXPECT_NEAR(right->mean[static_cast<std::size_t>(p)], expected, 2e-4);
    EXPECT_NEAR(right->sd[static_cast<std::size_t>(p)], 0.0, 1e-6);
    EXPECT_EQ(right->cycles[static_cast<std::size_t>(p)], 3);
  }
}

TEST(CycleOverlays, ASideGoesWithItsFootAndTheMiddleWithBoth) {
  const auto motion = swinging();
  const auto all = cycle_overlays(kEvents, motion.time, motion);
  EXPECT_EQ(all.size(), 4U) << "what stands still is left out";
  EXPECT_EQ(find(all, "knee_angle_r", "Left"), nullptr);
  EXPECT_EQ(find(all, "knee_angle_l", "Right"), nullptr);
  ASSERT_NE(find(all, "knee_angle_l", "Left"), nullptr);
  EXPECT_EQ(find(all, "knee_angle_l", "Left")->curves.count(), 1);
  EXPECT_EQ(find(all, "pelvis_ty", "Left")->curves.quantity, data::Quantity::length);
  EXPECT_EQ(find(all, "pelvis_ty", "Right")->curves.count(), 3);
}

TEST(CycleOverlays, WhatIsNotDeterminedIsLeftOut) {
  auto motion = swinging();
  motion.determined.assign(motion.q.size(), 1);
  // The second right cycle from 3.25 to 4.5 s lacks a stretch.
  for (std::int64_t f = 300; f < 340; ++f) motion.determined[motion.index(f, 0)] = 0;
  const auto all = cycle_overlays(kEvents, motion.time, motion);
  const auto* right = find(all, "knee_angle_r", "Right");
  ASSERT_NE(right, nullptr);
  const auto p = static_cast<std::int64_t>(std::lround((1.6 - kPeriod_s) / kPeriod_s * 100.0));
  EXPECT_TRUE(std::isnan(right->curves(1, p)));
  EXPECT_EQ(right->cycles[static_cast<std::size_t>(p)], 2);
  EXPECT_EQ(right->cycles[0], 3);
}

TEST(CycleOverlays, NothingWithoutTwoStrikesOfAFoot) {
  const auto motion = swinging();
  EXPECT_TRUE(cycle_overlays({}, motion.time, motion).empty());
  EXPECT_TRUE(cycle_overlays(std::span(kEvents).first(1), motion.time, motion).empty());
}

}  // namespace
}  // namespace kinemark::pipeline::internal
