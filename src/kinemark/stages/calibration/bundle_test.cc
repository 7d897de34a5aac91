// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kinemark/stages/calibration/internal/rays.h"
#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace ts = testing_support;

BundleOptions small() {
  BundleOptions options;
  options.warp_degree = 4;
  options.crosstalk = false;
  return options;
}

/// Root mean square error of distances among points that no calibration saw, found by rays, and their number.
double distance_error(const data::Rig& found, const data::Rig& truth) {
  std::vector<Eigen::Matrix3Xd> where;
  const auto fresh = tree_observations(truth, 40, 99, &where);
  double squares = 0.0;
  int count = 0;
  for (int pose = 0; pose < 40; ++pose) {
    std::vector<Eigen::Vector3d> at;
    for (int led = 0; led < 3; ++led) {
      std::vector<camera::Ray> rays;
      for (int c = 0; c < 2; ++c)
        rays.push_back(
            *internal::line_of_sight(found.cameras[static_cast<std::size_t>(c)],
                                     ts::mean_counts(truth.cameras[static_cast<std::size_t>(c)],
                                                     where[static_cast<std::size_t>(pose)].col(led))));
      at.push_back(*internal::meet(rays));
    }
    for (int a = 0; a < 3; ++a)
      for (int b = a + 1; b < 3; ++b) {
        const auto& p = where[static_cast<std::size_t>(pose)];
        const double error = (at[static_cast<std::size_t>(a)] - at[static_cast<std::size_t>(b)]).norm() -
                             (p.col(a) - p.col(b)).norm();
        squares += error * error;
        ++count;
      }
  }
  return std::sqrt(squares / count);
}

TEST(Bundle, FindsTheRigFromTreeAndGrid) {
  const auto truth = ts::real_rig(1);
  const auto result = calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 40, 1),
                                       grid_observations_of(truth, 1), small());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->rig.validate()) << result->rig.validate().error().message;
  EXPECT_NEAR(result->report.chi2_per_dof, 1.0, 0.15);
  EXPECT_GT(distance_error(ts::ideal_rig(), truth), 1.5e-3);
  EXPECT_LT(distance_error(result->rig, truth), 0.25e-3);
  EXPECT_EQ(result->rig.method, "bundle");
  EXPECT_EQ(result->report.poses, 40);
  EXPECT_EQ(result->report.outliers, 0);
}

TEST(Bundle, DoesWithoutAGrid) {
  const auto truth = ts::real_rig(2);
  const auto result = calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 60, 2), {}, small());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(distance_error(result->rig, truth), 0.35e-3);
}

TEST(Bundle, CovarianceIsProperAndShrinksWithPoses) {
  const auto truth = ts::real_rig(3);
  const auto few =
      calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 20, 3), {}, small()).value().rig.covariance;
  const auto many =
      calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 80, 3), {}, small()).value().rig.covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(many, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues()(0), -1e-9 * eigen.eigenvalues().tail<1>()(0));
  EXPECT_LT(many(data::ParameterLayout::focal, data::ParameterLayout::focal),
            few(data::ParameterLayout::focal, data::ParameterLayout::focal));
}

TEST(Bundle, HoldsOutliersDown) {
  const auto truth = ts::real_rig(4);
  auto tree = tree_observations(truth, 60, 4);
  for (const std::size_t i : {10U, 77U, 200U, 301U}) tree.observations[i].counts[2] += 60.0;
  const auto result = calibrate_bundle(ts::ideal_rig(), tree, {}, small());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GE(result->report.outliers, 4);  // a distorted pose may make another observation an outlier
  EXPECT_LE(result->report.outliers, 10);
  EXPECT_LT(result->report.chi2_per_dof, 1.3);
  EXPECT_LT(distance_error(result->rig, truth), 0.5e-3);
}

TEST(Bundle, RefusesAModelThatDoesNotFit) {
  auto truth = ts::real_rig(5);
  for (auto& camera : truth.cameras) {
    camera.detector.crosstalk(0, 2) = 0.03;
    camera.detector.crosstalk(3, 1) = 0.04;
  }
  const auto tree = tree_observations(truth, 50, 5);
  auto options = small();
  options.escalate = false;
  const auto plain = calibrate_bundle(ts::ideal_rig(), tree, {}, options);
  ASSERT_FALSE(plain);
  EXPECT_THAT(plain.error().message, HasSubstr("chi2 per degree of freedom"));
  options.crosstalk = true;
  const auto rich = calibrate_bundle(ts::ideal_rig(), tree, {}, options);
  ASSERT_TRUE(rich) << rich.error().message;
  EXPECT_LT(rich->report.chi2_per_dof, 1.2);
}

TEST(Bundle, EscalatesTheWarpUntilItFits) {
  auto truth = ts::real_rig(6);
  for (auto& camera : truth.cameras) {
    camera = camera::with_warp_degree(camera, 6);
    camera.detector.warp_x[18] = 0.05;  // x^6
  }
  auto options = small();
  options.warp_degree = 2;
  const auto result = calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 80, 6),
                                       grid_observations_of(truth, 6), options);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GE(result->report.warp_degree, 6);
}

TEST(Bundle, TellsTreesThatDoNotMatch) {
  const auto truth = ts::real_rig(7);
  auto tree = tree_observations(truth, 20, 7);
  tree.tree = tree_from_sides({0.310, 0.533, 0.310}).value();
  const std::string one = calibrate_bundle(ts::ideal_rig(), tree, {}, small()).error().message;
  EXPECT_THAT(one, HasSubstr("sides do not match the recording: LEDs "));
  EXPECT_THAT(one, HasSubstr(" mm apart on the tree and "));
  EXPECT_THAT(one, Not(HasSubstr("its distances are ")));
}

TEST(Bundle, TellsABlindCameraAndTooFewPoses) {
  const auto truth = ts::real_rig(8);
  auto tree = tree_observations(truth, 20, 8);
  auto blind = tree;
  for (std::size_t i = 1; i < blind.observations.size(); i += 2) blind.observations[i] = {};
  EXPECT_THAT(calibrate_bundle(ts::ideal_rig(), blind, {}, small()).error().message,
              HasSubstr("camera 'B' saw the tree in none of 20"));
  tree.observations.resize(3 * 3 * 2);
  EXPECT_THAT(calibrate_bundle(ts::ideal_rig(), tree, {}, small()).error().message,
              HasSubstr("3 of 3 poses"));
}

TEST(Bundle, StopsWhenAsked) {
  const auto truth = ts::real_rig(9);
  const auto result = calibrate_bundle(ts::ideal_rig(), tree_observations(truth, 10, 9), {}, small(),
                                       [](std::int64_t, std::int64_t) { return false; });
  EXPECT_EQ(result.error().code, Code::cancelled);
}

TEST(Bundle, OptionsCheckThemselves) {
  BundleOptions options;
  EXPECT_TRUE(options.check());
  options.warp_degree = 1;
  EXPECT_EQ(options.check().error().code, Code::usage);
}

TEST(Rays, SpotComesBackFromItsCounts) {
  const auto rig = ts::real_rig(10);
  for (const Eigen::Vector2d& spot :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.5, -0.7), Eigen::Vector2d(-0.93, 0.9)}) {
    const auto& detector = rig.cameras[0].detector;
    const auto found = internal::find_spot(detector, 700.0 * camera::respond_at(detector, spot).phi);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - spot).norm(), 1e-8);
  }
  EXPECT_FALSE(internal::find_spot(rig.cameras[0].detector, Eigen::Vector4d::Zero()));
}

}  // namespace
}  // namespace kinemark::calibration
