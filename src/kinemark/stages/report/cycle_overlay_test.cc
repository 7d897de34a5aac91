// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/cycle_overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report {
namespace {

// Cycle c is c + p / 100 rad, of P points.
CycleOverlay overlay_of(std::int64_t cycles, std::int64_t points = 11) {
  CycleOverlay out;
  out.curves.id = "knee_angle_r";
  out.curves.context = "Right";
  out.curves.points = points;
  for (std::int64_t c = 0; c < cycles; ++c) {
    out.curves.cycles.push_back("Right");
    for (std::int64_t p = 0; p < points; ++p)
      out.curves.values.push_back(static_cast<double>(c) + 0.01 * static_cast<double>(p));
  }
  out.mean.assign(static_cast<std::size_t>(points), 0.5);
  out.sd.assign(static_cast<std::size_t>(points), cycles > 1 ? 0.1 : kNaN);
  out.cycles.assign(static_cast<std::size_t>(points), cycles);
  return out;
}

TEST(CycleOverlay, AnglesInDegreesCycleAfterCycle) {
  const CycleOverlay one = overlay_of(3);
  const auto json = cycles_json({&one, 1});
  EXPECT_EQ(json["points"], 11);
  const auto& curve = json["curves"][0];
  EXPECT_EQ(curve["coordinate"], "knee_angle_r");
  EXPECT_EQ(curve["side"], "Right");
  EXPECT_EQ(curve["count"], 3);
  EXPECT_EQ(curve["drawn"], 3);
  const auto each = internal::unpack_curve(curve["each"]);
  ASSERT_EQ(each.size(), 33U);
  for (std::size_t cycle = 0; cycle < 3; ++cycle)
    for (std::size_t i = 0; i < 11; ++i)
      EXPECT_NEAR(each[11 * cycle + i],
                  kDegPerRad * (static_cast<double>(cycle) + 0.01 * static_cast<double>(i)), 0.03);
  EXPECT_NEAR(internal::unpack_curve(curve["mean"])[5], 0.5 * kDegPerRad, 0.02);
  EXPECT_NEAR(internal::unpack_curve(curve["sd"])[5], 0.1 * kDegPerRad, 0.1);
}

TEST(CycleOverlay, LengthsStayInMetres) {
  CycleOverlay one = overlay_of(2);
  one.curves.quantity = data::Quantity::length;
  const auto json = cycles_json({&one, 1});
  EXPECT_NEAR(internal::unpack_curve(json["curves"][0]["mean"])[0], 0.5, 1e-4);
}

TEST(CycleOverlay, CyclesWithMissingValuesAreCountedApart) {
  CycleOverlay one = overlay_of(4);
  one.curves.values[12] = kNaN;
  one.cycles[1] = 3;
  const auto json = cycles_json({&one, 1});
  const auto& curve = json["curves"][0];
  EXPECT_EQ(curve["count"], 4);
  EXPECT_EQ(curve["whole"], 3);
  EXPECT_EQ(curve["fewest"], 3);
  EXPECT_EQ(curve["most"], 4);
  EXPECT_TRUE(std::isnan(internal::unpack_curve(curve["each"])[12]));
}

TEST(CycleOverlay, OneCycleHasNoSpread) {
  const CycleOverlay one = overlay_of(1);
  EXPECT_TRUE(cycles_json({&one, 1})["curves"][0]["sd"].is_null());
}

TEST(CycleOverlay, OfManyCyclesTheFirstTheLastAndSomeBetweenAreDrawn) {
  const CycleOverlay one = overlay_of(1000);
  const auto json = cycles_json({&one, 1});
  const auto& curve = json["curves"][0];
  EXPECT_EQ(curve["count"], 1000);
  EXPECT_EQ(curve["drawn"], kMostCyclesDrawn);
  const auto each = internal::unpack_curve(curve["each"]);
  ASSERT_EQ(each.size(), 11U * kMostCyclesDrawn);
  EXPECT_NEAR(each[0], 0.0, 30.0);
  EXPECT_NEAR(each[11U * (kMostCyclesDrawn - 1)], 999.0 * kDegPerRad, 30.0);
  for (std::int64_t i = 1; i < kMostCyclesDrawn; ++i)
    EXPECT_NEAR(each[static_cast<std::size_t>(11 * i)] - each[static_cast<std::size_t>(11 * (i - 1))],
                999.0 / (kMostCyclesDrawn - 1) * kDegPerRad, 120.0);
}

TEST(CycleOverlay, NothingWithoutCycles) { EXPECT_TRUE(cycles_json({}).is_null()); }

}  // namespace
}  // namespace kinemark::report
