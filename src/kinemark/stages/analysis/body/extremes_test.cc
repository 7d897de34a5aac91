// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/extremes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/body/measure_errors.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

VectorXd draw(Eigen::Index size, std::uint64_t seed) {
  Random random(seed, 1);
  VectorXd out(size);
  for (double& x : out) x = random.gaussian();
  return out;
}

TEST(Extremes, PicksOfACurve) {
  VectorXd curve(5);
  curve << kNaN, 1.0, -4.0, 3.0, 3.0;
  EXPECT_EQ(picked(Pick::largest, curve), 3.0);
  EXPECT_EQ(picked(Pick::smallest, curve), -4.0);
  EXPECT_EQ(picked(Pick::range, curve), 7.0);
  EXPECT_EQ(picked(Pick::size, curve), 4.0);
  EXPECT_EQ(picked(Pick::time_of_largest, curve), 3.0) << "the first of equal ones";
  EXPECT_EQ(picked(Pick::time_of_smallest, curve), 2.0);
  for (const auto pick : {Pick::largest, Pick::range, Pick::size, Pick::time_of_largest}) {
    EXPECT_TRUE(std::isnan(picked(pick, VectorXd())));
    EXPECT_TRUE(std::isnan(picked(pick, VectorXd::Constant(3, kNaN))));
  }
}

TEST(Extremes, ThinnedTheLargestOfNoiseIsNotTheLuckiest) {
  double plain = 0.0, thin = 0.0;
  constexpr int kTrials = 400;
  for (int k = 0; k < kTrials; ++k) {
    const VectorXd curve = draw(60, 2 * k);
    plain += picked(Pick::range, curve) / kTrials;
    thin += thinned(Pick::range, curve, draw(60, 2 * k + 1)) / kTrials;
  }
  EXPECT_GT(plain, 4.0);
  EXPECT_NEAR(thin, 0.0, 0.3);
  const VectorXd line = VectorXd::LinSpaced(10, -20.0, 30.0);
  EXPECT_NEAR(thinned(Pick::largest, line, 0.1 * draw(10, 5)), 30.0, 1e-12) << "noise of both signs cancels";
  EXPECT_NEAR(thinned(Pick::size, -line, VectorXd::Zero(10)), 30.0, 1e-12);
  EXPECT_TRUE(std::isnan(thinned(Pick::largest, line, VectorXd())));
}

TEST(Extremes, InstantsThatNoiseMakesAsExtreme) {
  VectorXd curve(101);
  for (int i = 0; i < 101; ++i) curve[i] = -std::pow(0.1 * (i - 40), 2);
  InstantSet sharp(Pick::time_of_largest, curve), low(Pick::time_of_smallest, -curve),
      flat(Pick::time_of_largest, curve.cwiseMin(-4.0));
  for (int k = 0; k < 200; ++k) {
    const VectorXd noise = 0.1 * draw(101, 900 + k);
    sharp.add(noise), low.add(noise), flat.add(noise);
  }
  // 2 SD of a difference of 0.1 each: 0.28, at 5 samples.
  EXPECT_NEAR(static_cast<double>(sharp.within(2.0).first), 35.0, 1.0);
  EXPECT_NEAR(static_cast<double>(sharp.within(2.0).last), 45.0, 1.0);
  EXPECT_EQ(low.within(2.0).first, sharp.within(2.0).first);
  EXPECT_LE(flat.within(2.0).first, 20);
  EXPECT_GE(flat.within(2.0).last, 60);
  EXPECT_EQ(sharp.within(-1.0).first, 40);
}

/// One coordinate.
BodySeries series_of(const VectorXd& q) {
  BodySeries out;
  out.q = q;
  return out;
}

TEST(MeasureErrors, AnExtremeAndItsInstantFromRefits) {
  constexpr int kFrames = 80, kRefits = 12;
  BodyRecord record;
  record.time = {.rate_hz = 20.0, .frames = kFrames};
  const Eigen::MatrixX<bool> contact;
  const auto view = [&](const BodySeries& s) {
    return BodyView{.series = s, .record = record, .contact = contact, .count = kFrames};
  };
  const auto pilot = series_of(VectorXd::Zero(kFrames)), estimate = series_of(draw(kFrames, 3));
  MeasureErrors most(*find_body_definition("joint_maximum"), view(estimate), view(pilot), view(pilot),
                     kRefits),
      when(*find_body_definition("joint_maximum_time"), view(estimate), view(pilot), view(pilot), kRefits),
      mean(*find_body_definition("joint_mean"), view(estimate), view(pilot), view(pilot), kRefits);
  for (int first = 0; first < 10; first += 5) {
    std::vector<BodySeries> some;
    for (int k = 0; k < 5; ++k) some.push_back(series_of(draw(kFrames, 50 + first + k)));
    std::vector<NumberedView> views;
    for (int k = 0; k < 5; ++k) views.push_back({first + k, view(some[k])});
    for (auto* errors : {&most, &when, &mean}) errors->add(views);
  }
  EXPECT_GT(estimate.q.maxCoeff(), 2.0);
  EXPECT_LT(std::abs(most.value()), 0.7) << "nothing but noise";
  EXPECT_NEAR(mean.value(), estimate.q.mean(), 1e-12);
  for (int k = 0; k < 10; ++k) EXPECT_LT(std::abs(most.deviations()[k]), 1.5);
  for (const auto* errors : {&most, &when, &mean})
    EXPECT_TRUE(std::isnan(errors->deviations()[11])) << "never given";
  EXPECT_GT(when.reach().after - when.reach().before, 2.0) << "any of 4 s";
  EXPECT_EQ(most.reach().after, 0.0);
}

TEST(Extremes, LengthsOfVectorsThatAreNoiseAloneAreThinnedToNothing) {
  Random random(3, 1);
  Eigen::VectorXd curve(3000), noise(3000);
  for (Eigen::Index i = 0; i < curve.size(); ++i) curve[i] = random.gaussian(), noise[i] = random.gaussian();
  EXPECT_NEAR(picked(Pick::mean_size, curve), 1.596, 0.06);  // sqrt(8 / pi), Maxwell's mean
  EXPECT_NEAR(thinned(Pick::mean_size, curve, noise), 0.0, 0.06);
}

TEST(Extremes, LengthsOfVectorsFarAboveNoiseStay) {
  Random random(3, 2);
  Eigen::VectorXd curve(3000), noise(3000);
  for (Eigen::Index i = 0; i < curve.size(); ++i)
    curve[i] = i % 3 == 1 ? -20.0 : 0.0, noise[i] = random.gaussian();
  EXPECT_DOUBLE_EQ(picked(Pick::mean_size, curve), 20.0);
  EXPECT_NEAR(thinned(Pick::mean_size, curve, noise), 19.85, 0.05) << "1.5 of what noise turns them by";
  EXPECT_TRUE(std::isnan(picked(Pick::mean_size, {})));
}

TEST(Extremes, TheMeanSizeIsThatInTime) {
  // Sizes of 0, 0 and 10: the last stands for half a step of two.
  Eigen::VectorXd curve = Eigen::VectorXd::Zero(9);
  curve[7] = -10.0;
  EXPECT_DOUBLE_EQ(picked(Pick::mean_size, curve), 2.5);
  EXPECT_DOUBLE_EQ(picked(Pick::mean_size, Eigen::Vector3d(3.0, 4.0, 0.0)), 5.0) << "one alone";
}

}  // namespace
}  // namespace kinemark::analysis
