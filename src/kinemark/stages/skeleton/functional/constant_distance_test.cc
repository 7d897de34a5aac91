// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/constant_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

Result<ConstantDistanceFit> fit(const testing::TestChain& chain, const ConstantDistanceOptions& options = {},
                                std::span<const std::uint8_t> mask = {}) {
  return fit_constant_distance({chain.markers, mask}, chain.layout.segments[0].markers,
                               chain.layout.segments[1].markers, options);
}

double median_error(const ConstantDistanceFit& fit, const testing::TestChain& chain) {
  std::vector<double> errors;
  for (std::size_t f = 0; f < fit.state.size(); ++f)
    if (fit.state[f] != data::CentreState::undetermined)
      errors.push_back((fit.centre_in_world[f] - chain.centres[0].col(static_cast<Eigen::Index>(f))).norm());
  std::ranges::sort(errors);
  return errors[errors.size() / 2];
}

TEST(ConstantDistance, KnowsTheDistancesOfExactData) {
  const auto chain = testing::make_chain({.stagger_m = 0.02});
  const auto f = fit(chain);
  ASSERT_TRUE(f) << f.error().message;
  EXPECT_EQ(f->chosen.size(), 30U);
  EXPECT_EQ(f->chosen.front(), 0);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const Eigen::Vector3d upper(0.0, 0.0, k < 3 ? 0.150 : 0.0);
    const double truth = (chain.x_in_segment[k < 3 ? 0 : 1].col(k % 3) - upper).norm();
    EXPECT_NEAR(f->distances_m(k), truth, 2e-3) << "the penalty shortens them a little";
  }
  EXPECT_LT(median_error(*f, chain), 1e-3);
}

TEST(ConstantDistance, NoiseAndGapsLeaveMostFramesNear) {
  const auto chain =
      testing::make_chain({.frames = 400, .stagger_m = 0.02, .noise_sd_m = 0.001, .missing = 0.2});
  const auto f = fit(chain);
  ASSERT_TRUE(f) << f.error().message;
  EXPECT_LT(median_error(*f, chain), 6e-3);
  EXPECT_GT(f->distance_sd_m, 1e-4);
}

TEST(ConstantDistance, NeedsTwoMarkersOnOneSegmentAndOneOnTheOther) {
  auto chain = testing::make_chain({.frames = 60});
  const auto lose = [&](std::int64_t frame, std::initializer_list<int> markers) {
    for (const int m : markers) chain.markers.set_missing(frame, m);
  };
  lose(50, {0, 1, 2});     // three on one, none on the other
  lose(51, {0, 1, 3, 4});  // one and one
  lose(52, {0, 1, 3});     // one and two
  lose(53, {0});           // two and three
  const auto f = fit(chain);
  ASSERT_TRUE(f);
  EXPECT_EQ(f->state[50], data::CentreState::undetermined);
  EXPECT_EQ(f->state[51], data::CentreState::undetermined);
  EXPECT_TRUE(f->centre_in_world[51].array().isNaN().all());
  EXPECT_EQ(f->state[52], data::CentreState::ambiguous) << "three distances always have a mirror image";
  EXPECT_TRUE(f->centre_in_world[52].allFinite() && f->covariance[52].allFinite());
  EXPECT_NE(f->state[53], data::CentreState::undetermined);
}

TEST(ConstantDistance, MaskedSamplesAreAsGoodAsMissing) {
  auto chain = testing::make_chain({.frames = 60});
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(60 * 6), 1);
  mask[chain.markers.index(0, 2)] = 0;
  const auto masked = fit(chain, {}, mask);
  chain.markers.set_missing(0, 2);
  const auto missing = fit(chain);
  ASSERT_TRUE(masked && missing);
  EXPECT_EQ(masked->chosen.front(), 1);
  EXPECT_EQ(masked->distances_m, missing->distances_m);
}

TEST(ConstantDistance, TakesTheLargestSetWhereNoFrameIsComplete) {
  auto chain = testing::make_chain({.frames = 400, .stagger_m = 0.02});
  for (std::int64_t f = 0; f < 400; ++f) chain.markers.set_missing(f, f % 10 == 0 ? 0 : 5);
  const auto f = fit(chain);
  ASSERT_TRUE(f) << f.error().message;
  EXPECT_EQ(f->complete, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(f->complete_frames, 360);
  ASSERT_EQ(f->chosen.size(), 30U);
  EXPECT_GT(f->chosen.back(), 360) << "spread over the frames that show them";
  EXPECT_LT(median_error(*f, chain), 2e-3);
  const double truth = (chain.x_in_segment[1].col(2)).norm();
  EXPECT_NEAR(f->distances_m(5), truth, 3e-3) << "seen in 40 frames, none of them complete";
  EXPECT_NE(f->state[10], data::CentreState::undetermined);
}

TEST(ConstantDistance, TakesAllMarkersWhereTwoFramesShowThem) {
  auto chain = testing::make_chain({.frames = 400, .stagger_m = 0.02});
  for (std::int64_t f = 2; f < 400; ++f) chain.markers.set_missing(f, 5);
  const auto f = fit(chain);
  ASSERT_TRUE(f);
  EXPECT_EQ(f->complete, f->markers);
  EXPECT_EQ(f->chosen, (std::vector<std::int64_t>{0, 1}));
}

TEST(ConstantDistance, SaysWhenNoTwoFramesShowTwoOfEach) {
  auto chain = testing::make_chain({.frames = 40});
  for (std::int64_t f = 0; f < 40; ++f)
    for (const int m : {3, 4}) chain.markers.set_missing(f, m);
  const auto none = fit(chain);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_NE(none.error().message.find("no frames show all 6 markers"), std::string::npos)
      << none.error().message;
  EXPECT_FALSE(none.error().message.contains("only one frame does"));
  auto once = testing::make_chain({.frames = 40});
  for (std::int64_t f = 1; f < 40; ++f)
    for (const int m : {3, 4}) once.markers.set_missing(f, m);
  const auto one = fit(once);
  ASSERT_FALSE(one);
  EXPECT_TRUE(one.error().message.contains("only one frame does show all 6 markers")) << one.error().message;
  EXPECT_FALSE(fit(chain, {.complete_frames = 1}));
  EXPECT_FALSE(fit(chain, {.penalty_m = -1.0}));
}

}  // namespace
}  // namespace kinemark::skeleton
