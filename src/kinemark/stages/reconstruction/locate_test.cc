// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/locate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>

#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
namespace ts = testing_support;

const std::array<double, 2> kStrength{ts::kLight, ts::kLight};

std::array<CountSighting, 2> sightings(const data::Rig& rig, const Vector3d& x, Random* random = nullptr) {
  std::array<CountSighting, 2> out;
  const double sd = ts::count_sd(rig);
  for (int c = 0; c < 2; ++c) {
    auto& s = out[static_cast<std::size_t>(c)];
    s = {.camera = c,
         .counts = ts::mean_counts(rig.cameras[static_cast<std::size_t>(c)], x),
         .variance = sd * sd};
    for (int k = 0; random != nullptr && k < 4; ++k) s.counts[k] += sd * random->gaussian();
  }
  return out;
}

TEST(Locate, FindsPointsFromPerfectCounts) {
  const auto rig = ts::real_rig(3);
  for (const Vector3d& truth : {Vector3d(0, 0, 0), Vector3d(0.2, -0.35, 0.3), Vector3d(-0.25, 0.3, -0.3)}) {
    const auto found = locate(rig, sightings(rig, truth), middle_of_view(rig));
    ASSERT_TRUE(found);
    EXPECT_LT((found->x_in_world - truth).norm(), 1e-9);
    EXPECT_LT(found->chi2, 1e-9);
  }
}

TEST(Locate, LightOfAnyStrengthGivesTheSamePoint) {
  const auto rig = ts::real_rig(3);
  const Vector3d truth(0.1, 0.2, -0.1);
  auto seen = sightings(rig, truth);
  seen[1].counts = ts::mean_counts(rig.cameras[1], truth, 0.3 * ts::kLight);
  EXPECT_LT((locate(rig, seen, Vector3d::Zero())->x_in_world - truth).norm(), 1e-9);
}

TEST(Locate, ScattersAsItsCovarianceAndTheBoundSay) {
  const auto rig = ts::real_rig(4);
  const Vector3d truth(0.15, -0.2, 0.1);
  const Matrix3d bound = cramer_rao(rig, truth, kStrength);
  Random random(5, 1);
  Matrix3d scatter = Matrix3d::Zero();
  double chi2 = 0.0;
  constexpr int kRuns = 2000;
  for (int i = 0; i < kRuns; ++i) {
    const auto found = locate(rig, sightings(rig, truth, &random), Vector3d::Zero());
    ASSERT_TRUE(found);
    scatter += (found->x_in_world - truth) * (found->x_in_world - truth).transpose() / kRuns;
    chi2 += found->chi2 / kRuns;
    EXPECT_LT((found->information.inverse() - bound).norm(), 0.1 * bound.norm());
  }
  EXPECT_NEAR(scatter.trace() / bound.trace(), 1.0, 0.1);
  EXPECT_NEAR(chi2, 3.0, 0.2);  // eight counts less three coordinates and two strengths
}

TEST(Locate, NeedsTwoSightingsAndAPointInFront) {
  const auto rig = ts::ideal_rig();
  const auto seen = sightings(rig, Vector3d::Zero());
  EXPECT_FALSE(locate(rig, std::span(seen).first(1), Vector3d::Zero()));
  EXPECT_FALSE(locate(rig, seen, Vector3d(0, 0, 50)));
}

TEST(Locate, BoundNeedsTwoCameras) {
  const auto rig = ts::ideal_rig();
  EXPECT_TRUE(cramer_rao(rig, Vector3d::Zero(), std::array{ts::kLight, 0.0}).hasNaN());
}

TEST(Locate, MiddleOfViewIsWhereAxesMeet) { EXPECT_LT(middle_of_view(ts::ideal_rig()).norm(), 1e-8); }

TEST(Locate, DependenceOnParametersMeetsFiniteDifferences) {
  const auto rig = ts::real_rig(6);
  const Vector3d truth(0.1, 0.1, -0.2);
  const auto seen = sightings(rig, truth);
  const auto by = by_parameters(rig, truth, kStrength, kStrength);
  for (int c = 0; c < 2; ++c) {
    const auto at = static_cast<std::size_t>(c);
    const data::ParameterLayout layout(rig.cameras[at]);
    for (const int index : {0, 4, data::ParameterLayout::focal, data::ParameterLayout::principal,
                            layout.warp_x + 3, layout.warp_y + 1, layout.gain + 2, layout.offset + 1}) {
      const double step = index >= layout.offset ? 0.1 : 1e-5;
      Eigen::VectorXd more = Eigen::VectorXd::Zero(layout.count);
      more[index] = step;
      data::Rig high = rig, low = rig;
      high.cameras[at] = camera::moved(rig.cameras[at], more);
      low.cameras[at] = camera::moved(rig.cameras[at], -more);
      const Vector3d slope =
          (locate(high, seen, truth)->x_in_world - locate(low, seen, truth)->x_in_world) / (2.0 * step);
      EXPECT_LT((by.col(rig.first_parameter(c) + index) - slope).norm(), 2e-3 * slope.norm() + 1e-9)
          << c << ' ' << index;
    }
  }
}

}  // namespace
}  // namespace kinemark::reconstruction
