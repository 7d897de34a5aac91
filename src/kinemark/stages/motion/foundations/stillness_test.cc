// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/stillness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

/// A leg of three markers that sways by 100 mm, whose ankle goes back by `flexed_m` in every frame from
/// `first` on.
data::Trajectories leg(double flexed_m, std::int64_t first, std::int64_t frames = 200) {
  auto out = data::Trajectories::all_missing({"LASI", "LKNE", "LANK"}, {.rate_hz = 100.0, .frames = frames});
  Random random(3, 0);
  for (std::int64_t f = 0; f < frames; ++f) {
    const Vector3d sway(0.05 * std::sin(0.03 * static_cast<double>(f)), 0.0, 0.0);
    for (std::int64_t m = 0; m < 3; ++m) {
      const Vector3d noise(random.gaussian(), random.gaussian(), random.gaussian());
      out.x(f, m) = Vector3d(0.0, 0.9 - 0.4 * static_cast<double>(m), 0.0) + sway + 0.001 * noise;
      if (m == 2 && f >= first) out.x(f, m) += Vector3d(-flexed_m, flexed_m, 0.0);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

std::optional<Unrest> unrest_of(const data::Trajectories& trial) { return find_unrest(trial, trial.names); }

TEST(Stillness, ABodyThatSwaysIsStill) {
  EXPECT_EQ(unrest_of(leg(0.0, 0)), std::nullopt);
  EXPECT_EQ(unrest_of(leg(0.3, 0)), std::nullopt) << "a flexed posture, held";
}

TEST(Stillness, AKneeThatIsFlexedIsNamedWithBothDistances) {
  const auto unrest = unrest_of(leg(0.3, 120));
  ASSERT_TRUE(unrest);
  EXPECT_EQ(unrest->marker, "LASI");
  EXPECT_EQ(unrest->partner, "LANK");
  EXPECT_NEAR(unrest->least_m, std::hypot(0.3, 0.5), 0.004);
  EXPECT_NEAR(unrest->most_m, 0.8, 0.004);
  EXPECT_THAT(describe(*unrest, "cal.c3d"), HasSubstr("cal.c3d is not still: LASI and LANK are 58"));
  EXPECT_THAT(describe(*unrest, "cal.c3d"), HasSubstr(" mm apart in some of its frames, 80"));
}

TEST(Stillness, OnlyMarkersOfTheBodyAreAsked) {
  const std::vector<std::string> trunk{"LASI", "LKNE", "CLAV"};
  EXPECT_EQ(find_unrest(leg(0.3, 120), trunk), std::nullopt) << "the ankle is not among them";
}

TEST(Stillness, AFewFramesAndFewSamplesDecideNothing) {
  EXPECT_EQ(unrest_of(leg(0.3, 195)), std::nullopt) << "2 % of the frames";
  EXPECT_EQ(unrest_of(leg(0.3, 4, 9)), std::nullopt) << "nine frames";
}

}  // namespace
}  // namespace kinemark::motion
