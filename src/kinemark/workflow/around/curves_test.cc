// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/around/curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::workflow {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsNan;

data::Trajectories two_markers() {
  auto out = data::Trajectories::all_missing({"a", "b"}, {.rate_hz = 10.0, .t0_s = 1.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f) {
    if (f == 1) continue;
    out.x(f, 0) = Eigen::Vector3d(0.1 * static_cast<double>(f), 0.2, 0.3);
    out.state[out.index(f, 0)] = data::SampleState::measured;
  }
  return out;
}

TEST(AroundCurves, AreCoordinatesAtTheTrueTimesOfSamples) {
  auto markers = two_markers();
  markers.sample_offset_s = {0.004, 0.0};
  const auto curves = curves_of(markers);
  ASSERT_EQ(curves.size(), 3U) << "x, y, z of a; b was never seen";
  EXPECT_EQ(curves[0].subject, "a");
  EXPECT_EQ(curves[2].id, "z");
  EXPECT_THAT(curves[0].time_s,
              ElementsAre(DoubleNear(1.004, 1e-12), DoubleNear(1.104, 1e-12), DoubleNear(1.204, 1e-12)));
  EXPECT_THAT(curves[0].value, ElementsAre(0.0, IsNan(), 0.2));
}

TEST(AroundCurves, SpeedIsTheLengthOfTheVelocity) {
  const auto markers = two_markers();
  data::Derivatives rates;
  rates.velocity.assign(18, kNaN);
  for (std::size_t f : {0U, 2U}) {
    rates.velocity[6 * f] = 0.3;
    rates.velocity[6 * f + 1] = 0.4;
    rates.velocity[6 * f + 2] = 0.0;
  }
  const auto curves = curves_of(markers, &rates);
  ASSERT_EQ(curves.size(), 4U);
  EXPECT_EQ(curves[3].id, "speed");
  EXPECT_EQ(curves[3].quantity, data::Quantity::speed);
  EXPECT_THAT(curves[3].value, ElementsAre(DoubleNear(0.5, 1e-12), IsNan(), DoubleNear(0.5, 1e-12)));
}

TEST(AroundCurves, ColumnsOfAMotionAreAnglesOrLengths) {
  data::Table table{
      .columns = {"elbow_flexion", "pelvis_tx"}, .time_s = {0.0, 0.1}, .values = {90.0, 0.5, 45.0, 0.6}};
  const auto degrees = curves_of(table, true);
  ASSERT_EQ(degrees.size(), 2U);
  EXPECT_NEAR(degrees[0].value[0], std::numbers::pi / 2.0, 1e-12);
  EXPECT_EQ(degrees[0].quantity, data::Quantity::angle);
  EXPECT_EQ(degrees[1].value[1], 0.6);
  EXPECT_EQ(degrees[1].quantity, data::Quantity::length);
  EXPECT_EQ(curves_of(table, false)[0].value[0], 90.0) << "in rad as it stands";
}

TEST(AroundCurves, ForcesAndMomentsOfAFileInDegreesAreNoAngles) {
  data::Table table{.columns = {"knee_angle_r_moment", "ground_force_vy", "ground_force_px"},
                    .time_s = {0.0},
                    .values = {2.0, 700.0, 0.3}};
  const auto curves = curves_of(table, true);
  EXPECT_EQ(curves[0].quantity, data::Quantity::moment);
  EXPECT_EQ(curves[0].id, "moment");
  EXPECT_EQ(curves[1].quantity, data::Quantity::force);
  EXPECT_EQ(curves[2].quantity, data::Quantity::length);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(curves[c].value[0], table.values[c]);
}

TEST(AroundCurves, TheSpanIsThatOfAllSamples) {
  EXPECT_TRUE(std::isnan(span_of({}).start_s));
  const auto span = span_of(curves_of(two_markers()));
  EXPECT_EQ(span.start_s, 1.0);
  EXPECT_NEAR(span.end_s, 1.2, 1e-12);
}

}  // namespace
}  // namespace kinemark::workflow
