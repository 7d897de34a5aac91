// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/model_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::analysis {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A hip of three rotations.
data::ModelDescription hip(const Vector3d& first, const Vector3d& second, const Vector3d& third) {
  data::ModelDescription out;
  for (const auto* const name : {"flexion", "adduction", "rotation"})
    out.coordinates.push_back({.name = name});
  data::JointDescription joint;
  joint.name = "hip_r";
  for (const auto& axis : {first, second, third}) {
    data::AxisDescription rotation;
    rotation.axis = axis;
    rotation.coordinate_idx = static_cast<int>(joint.axes.size());
    joint.axes.push_back(rotation);
  }
  out.joints.push_back(joint);
  return out;
}

const Vector3d kX = Vector3d::UnitX(), kY = Vector3d::UnitY(), kZ = Vector3d::UnitZ();

TEST(ModelFacts, RotationsOneAfterTheOtherAboutOneAxisAreNamed) {
  for (const Vector3d& second : {Vector3d(kX), Vector3d(-2.0 * kX), Vector3d(1.0, 0.01, 0.0)})
    EXPECT_THAT(
        contradicted_joints(hip(kX, second, kZ)),
        ElementsAre("joint 'hip_r' turns about one axis by two coordinates, 'flexion' and 'adduction': no "
                    "marker can tell them apart"));
  EXPECT_THAT(contradicted_joints(hip(kX, kY, kZ)),
              Not(Contains(HasSubstr("turns about one axis by two coordinates"))));
}

TEST(ModelFacts, AxesApartAndOneCoordinateAreSound) {
  EXPECT_THAT(contradicted_joints(hip(kX, kY, kX)), IsEmpty()) << "Euler's angles";
  EXPECT_THAT(contradicted_joints(hip(kX, Vector3d(1.0, 0.1, 0.0), kZ)), IsEmpty());
  auto coupled = hip(kX, kX, kZ);
  coupled.joints[0].axes[1].coordinate_idx = 0;
  EXPECT_THAT(contradicted_joints(coupled), IsEmpty()) << "one coordinate moves both";
  auto moved = hip(kX, kX, kZ);
  moved.joints[0].axes[1].is_rotation = false;
  EXPECT_THAT(contradicted_joints(moved), IsEmpty());
}

TEST(ModelFacts, AConstantRotationBetweenThemIsPassedOver) {
  auto still = hip(kX, kY, kX);
  still.joints[0].axes[1].coordinate_idx = -1;
  EXPECT_EQ(contradicted_joints(still).size(), 1U);
}

}  // namespace
}  // namespace kinemark::analysis
