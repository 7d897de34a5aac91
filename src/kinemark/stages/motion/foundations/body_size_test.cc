// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/body_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/motion/foundations/testing/walking_body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kNames = {"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK",
                                         "LHEE", "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"};

data::Trajectories walk(double factor) {
  auto markers = testing::walking_body(kNames, 60);
  for (double& x : markers.x_in_world) x *= factor;
  return markers;
}

TEST(BodySize, OfPeopleIsBelieved) {
  for (const double factor : {0.3, 0.6, 1.0, 1.5}) {
    const auto size = size_of_body(body_of_names(kNames), walk(factor));
    ASSERT_TRUE(size);
    EXPECT_NEAR(size->factor, factor, 0.1 * factor);
    EXPECT_FALSE(size->is_nobodys()) << factor;
  }
}

TEST(BodySize, OfAnotherUnitIsNobodys) {
  for (const double factor : {1e-3, 0.0254, 0.1, 10.0, 25.4}) {
    const auto size = size_of_body(body_of_names(kNames), walk(factor));
    ASSERT_TRUE(size);
    EXPECT_TRUE(size->is_nobodys()) << factor;
  }
  const auto point = size_of_body(body_of_names(kNames), walk(0.0));
  ASSERT_TRUE(point);
  EXPECT_TRUE(point->is_nobodys()) << "all markers at one point";
  EXPECT_THAT(size_of_body(body_of_names(kNames), walk(10.0))->sentence(),
              HasSubstr("the unit of length is another one, or this is no human body"));
}

TEST(BodySize, TwoPeopleAreNoGiant) {
  auto names = kNames;
  for (auto& name : names) name = "Ann:" + name;
  for (const auto& name : kNames) names.push_back("Bob:" + name);
  const auto one = walk(1.0);
  auto both = data::Trajectories::all_missing(names, one.time);
  const auto M = one.markers();
  for (std::int64_t f = 0; f < both.frames(); ++f)
    for (std::int64_t m = 0; m < 2 * M; ++m) {
      both.x(f, m) = one.x(f, m % M) + Eigen::Vector3d(m < M ? 0.0 : 3.0, 0.0, 0.0);
      both.state[both.index(f, m)] = data::SampleState::measured;
    }
  const auto size = size_of_body(body_of_names(names), both);
  ASSERT_TRUE(size);
  EXPECT_FALSE(size->is_nobodys()) << size->sentence();
}

TEST(BodySize, OfFewMarkersIsNotKnown) {
  const std::vector<std::string> few = {"LASI", "RASI", "LPSI"};
  EXPECT_FALSE(size_of_body(body_of_names(few), testing::walking_body(few, 10)));
  EXPECT_FALSE(size_of_body(body_of_names(kNames), data::Trajectories::all_missing(kNames, {.frames = 5})));
  const std::vector<std::string> unknown = {"*1", "*2", "*3", "*4", "*5"};
  EXPECT_FALSE(size_of_body(body_of_names(unknown), data::Trajectories::all_missing(unknown, {.frames = 5})));
}

}  // namespace
}  // namespace kinemark::motion
