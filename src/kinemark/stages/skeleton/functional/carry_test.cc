// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/carry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::Rotations;

testing::ChainSetup trial(std::uint64_t seed, double noise_sd_m) {
  return {.per_segment = 5,
          .stagger_m = 0.04,
          .rotations = Rotations::cone,
          .range_rad = 1.2,
          .noise_sd_m = noise_sd_m,
          .seed = seed};
}

TEST(Carry, AFunctionalTrialGivesTheJointOfAnother) {
  const auto functional = testing::make_chain(trial(1, 0.0));
  auto walk = testing::make_chain(trial(2, 0.0));
  const auto found = find_joints(functional.markers, functional.layout);
  ASSERT_TRUE(found);
  const auto carried = carry_joints(*found, walk.markers);
  ASSERT_TRUE(carried) << carried.error().message;
  EXPECT_TRUE(carried->validate());
  EXPECT_LT(testing::centre_error(*carried, walk, 0).rms_m, 1e-6);
  EXPECT_EQ(testing::centre_error(*carried, walk, 0).share, 1.0);
}

TEST(Carry, MarkersInAnotherOrderAndMissingOnesDoNotMatter) {
  const auto functional = testing::make_chain(trial(1, 0.0));
  const auto walk = testing::make_chain(trial(2, 0.0));
  const auto found = find_joints(functional.markers, functional.layout).value();
  std::vector<std::string> names = walk.markers.names;
  std::ranges::reverse(names);
  names.pop_back();  // s0m0 is not in this recording
  auto other = data::Trajectories::all_missing(names, walk.markers.time);
  for (std::int64_t f = 0; f < other.frames(); ++f)
    for (std::int64_t m = 0; m < other.markers(); ++m) {
      other.x(f, m) = walk.markers.x(f, walk.markers.find(names[static_cast<std::size_t>(m)]));
      other.state[other.index(f, m)] = data::SampleState::measured;
    }
  const auto carried = carry_joints(found, other);
  ASSERT_TRUE(carried) << carried.error().message;
  EXPECT_LT(testing::centre_error(*carried, walk, 0).rms_m, 1e-6);
}

TEST(Carry, CovarianceCoversTheTruth) {
  int inside = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto functional = testing::make_chain(trial(seed, 0.001)),
               walk = testing::make_chain(trial(seed + 100, 0.001));
    const auto carried =
        carry_joints(find_joints(functional.markers, functional.layout).value(), walk.markers);
    ASSERT_TRUE(carried);
    for (std::int64_t f = 0; f < 300; f += 10) {
      const Eigen::Vector3d d = carried->centre(f, 0) - walk.centres[0].col(f);
      inside += d.x() * d.x() < 3.841 * carried->centre_covariance(f, 0)(0, 0);
      ++count;
    }
  }
  EXPECT_GE(static_cast<double>(inside) / count, 0.91);
}

TEST(Carry, SaysWhenTheMarkersAreNotThere) {
  const auto chain = testing::make_chain(trial(1, 0.0));
  const auto found = find_joints(chain.markers, chain.layout).value();
  auto other = chain.markers;
  for (auto& name : other.names) name += "'";
  const auto carried = carry_joints(found, other);
  ASSERT_FALSE(carried);
  EXPECT_EQ(carried.error().code, Code::bad_input);
  EXPECT_NE(carried.error().message.find("neither 's0' nor 's1'"), std::string::npos)
      << carried.error().message;
}

}  // namespace
}  // namespace kinemark::skeleton
