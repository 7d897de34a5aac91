// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/time_base.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/array.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark {
namespace {

TEST(TimeBase, TheNearestFrameOfAFramesTimeIsThatFrame) {
  for (const double rate_hz : {1e-3, 0.5, 30.0, 59.94, 100.0, 179.0, 1000.0 / 3.0, 25000.0})
    for (const double t0_s : {0.0, -2.5, 1234.567, 1.7e9}) {
      const TimeBase time{.rate_hz = rate_hz, .t0_s = t0_s, .frames = 1000};
      for (const std::int64_t frame : {-3, 0, 1, 2, 499, 999, 5000})
        EXPECT_EQ(time.nearest_frame(time.time_s(frame)), frame) << rate_hz << " Hz from " << t0_s << " s";
    }
}

TEST(TimeBase, AFrameReachesHalfwayToItsNeighbours) {
  const TimeBase time{.rate_hz = 100.0, .t0_s = 1.0, .frames = 10};
  EXPECT_EQ(time.nearest_frame(1.0349), 3);
  EXPECT_EQ(time.nearest_frame(1.0251), 3);
  EXPECT_EQ(time.nearest_frame(1.0249), 2);
  EXPECT_EQ(time.nearest_frame(0.9), -10) << "before the first frame";
  EXPECT_EQ(time.nearest_frame(2.0), 100) << "beyond the last one";
}

TEST(TimeBase, LateFramesDoNotDrift) {
  const TimeBase time{.rate_hz = 59.94, .t0_s = 0.0, .frames = 59'940'000};
  EXPECT_DOUBLE_EQ(time.time_s(59'940'000), 1e6) << "no sum of steps";
}

TEST(TimeBase, EqualIsEqualToTheBit) {
  const TimeBase time{.rate_hz = 0.1 + 0.2, .t0_s = 0.0, .frames = 3};
  EXPECT_EQ(time, (TimeBase{.rate_hz = 0.1 + 0.2, .t0_s = -0.0, .frames = 3}));
  EXPECT_NE(time, (TimeBase{.rate_hz = 0.3, .t0_s = 0.0, .frames = 3}));
  EXPECT_NE(time, (TimeBase{.rate_hz = 0.1 + 0.2, .t0_s = 0.0, .frames = 4}));
  EXPECT_NE(time, (TimeBase{.rate_hz = 0.1 + 0.2, .t0_s = 1e-300, .frames = 3}));
}

TEST(Missing, IsANumberThatEqualsNothing) {
  EXPECT_TRUE(std::isnan(kNaN));
  EXPECT_FALSE(kNaN == kNaN);
}

TEST(Units, DegreesAndBackAreWhereTheyWere) {
  EXPECT_DOUBLE_EQ(180.0 * kRadPerDeg, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(kDegPerRad * kRadPerDeg, 1.0);
}

TEST(TimeBase, NumbersFramesAsTheFileDoesAndComparesInstantsOnly) {
  const TimeBase plain{.rate_hz = 100.0, .frames = 10};
  const TimeBase numbered{.rate_hz = 100.0, .frames = 10, .first_number = 363};
  EXPECT_EQ(plain.number(4), 4);
  EXPECT_EQ(numbered.number(4), 367);
  EXPECT_EQ(plain, numbered);
  EXPECT_EQ(numbered.time_s(4), plain.time_s(4));
}

TEST(Index, IsTheSameNumberWithoutASign) {
  static_assert(at(std::int64_t{7}) == 7U);
  static_assert(at(std::numeric_limits<std::int64_t>::max()) == 9223372036854775807U);
  const std::vector<double> values{1.0, 2.0, 3.0};
  EXPECT_EQ(values[at(2)], 3.0);
}

TEST(Array, KeepsWhatIsThereWhenItGrowsAndFillsOnRequest) {
  Array<double> values(3, 0.25);
  values.resize(100'000);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(values[at(i)], 0.25);
  values.assign(5, -1.0);
  EXPECT_EQ(values, (Array<double>{-1.0, -1.0, -1.0, -1.0, -1.0}));
  values.resize(7, 2.0);
  EXPECT_EQ(values[6], 2.0);
  const Array<double> copy = values;
  values[0] = 9.0;
  EXPECT_EQ(copy[0], -1.0);
  EXPECT_TRUE(Array<double>(0).empty());
}

}  // namespace
}  // namespace kinemark
