// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/locate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <vector>

#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
namespace ts = testing_support;

const std::array<double, 2> kStrength{ts::kLight, ts::kLight};

std::array<CountObservation, 2> observations(const data::Rig& rig, const Vector3d& x,
                                             Random* random = nullptr) {
  std::array<CountObservation, 2> out;
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
    const auto found = locate(rig, observations(rig, truth), middle_of_view(rig));
    ASSERT_TRUE(found);
    EXPECT_LT((found->x_in_world - truth).norm(), 1e-9);
    EXPECT_LT(found->chi2, 1e-9);
  }
}

TEST(Locate, LightOfAnyStrengthGivesTheSamePoint) {
  const auto rig = ts::real_rig(3);
  const Vector3d truth(0.1, 0.2, -0.1);
  auto seen = observations(rig, truth);
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
    const auto found = locate(rig, observations(rig, truth, &random), Vector3d::Zero());
    ASSERT_TRUE(found);
    scatter += (found->x_in_world - truth) * (found->x_in_world - truth).transpose() / kRuns;
    chi2 += found->chi2 / kRuns;
    EXPECT_LT((found->information.inverse() - bound).norm(), 0.1 * bound.norm());
  }
  EXPECT_NEAR(scatter.trace() / bound.trace(), 1.0, 0.1);
  EXPECT_NEAR(chi2, 3.0, 0.2);  // eight counts less three coordinates and two strengths
}

TEST(Locate, NeedsTwoObservationsAndAPointInFront) {
  const auto rig = ts::ideal_rig();
  const auto seen = observations(rig, Vector3d::Zero());
  EXPECT_FALSE(locate(rig, std::span(seen).first(1), Vector3d::Zero()));
  EXPECT_FALSE(locate(rig, seen, Vector3d(0, 0, 50)));
}

TEST(Locate, SightingsAddInformation) {
  const auto rig = ts::real_rig(3);
  const Vector3d truth(0.1, -0.2, 0.1);
  const auto two = observations(rig, truth);
  std::vector<CountObservation> four(two.begin(), two.end());
  four.insert(four.end(), two.begin(), two.end());
  const auto once = locate(rig, two, truth).value(), twice = locate(rig, four, truth).value();
  EXPECT_LT((twice.information - 2.0 * once.information).norm(), 1e-6 * once.information.norm());
  EXPECT_LT((twice.x_in_world - once.x_in_world).norm(), 1e-9);
  auto noisier = two;
  for (auto& observation : noisier) observation.variance *= 4.0;
  const auto worse = locate(rig, noisier, truth).value();
  EXPECT_LT((4.0 * worse.information - once.information).norm(), 1e-6 * once.information.norm());
}

TEST(Locate, EndsAtTheSamePointFromAnywhereInView) {
  const auto rig = ts::real_rig(5);
  const Vector3d truth(-0.15, 0.25, -0.05);
  Random random(2, 2);
  const auto seen = observations(rig, truth, &random);
  const Vector3d found = locate(rig, seen, middle_of_view(rig)).value().x_in_world;
  for (const double x : {-0.4, 0.4})
    for (const double y : {-0.4, 0.4})
      for (const double z : {-0.4, 0.4}) {
        const auto from = locate(rig, seen, Vector3d(x, y, z));
        ASSERT_TRUE(from) << x << ' ' << y << ' ' << z;
        EXPECT_LT((from->x_in_world - found).norm(), 1e-7) << x << ' ' << y << ' ' << z;
      }
}

TEST(Locate, TheFarthestSpotIsThatOfTheImages) {
  const auto rig = ts::ideal_rig();
  for (const Vector3d& truth : {Vector3d(0, 0, 0), Vector3d(0.0, 0.4, 0.0), Vector3d(0.3, -0.1, 0.2)}) {
    double farthest = 0.0;
    for (const auto& camera : rig.cameras)
      farthest = std::max(farthest, camera::respond(camera, truth).spot.cwiseAbs().maxCoeff());
    EXPECT_NEAR(locate(rig, observations(rig, truth), Vector3d::Zero())->farthest_spot, farthest, 1e-7);
  }
}

TEST(Locate, BoundNeedsTwoCameras) {
  const auto rig = ts::ideal_rig();
  EXPECT_TRUE(cramer_rao(rig, Vector3d::Zero(), std::array{ts::kLight, 0.0}).hasNaN());
}

TEST(Locate, MiddleOfViewIsWhereAxesMeet) { EXPECT_LT(middle_of_view(ts::ideal_rig()).norm(), 1e-8); }

TEST(Locate, DependenceOnParametersMeetsFiniteDifferences) {
  const auto rig = ts::real_rig(6);
  const Vector3d truth(0.1, 0.1, -0.2);
  const auto seen = observations(rig, truth);
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
