// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The shipped definition of the shoulder on an arm whose angles are known.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>

#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::pipeline {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kOneDegree = std::numbers::pi / 180.0;

// x forward, y up, z to the right: a thorax and a scapula in line with the laboratory, a humerus turned by
// `raised` and a forearm flexed by `flexed` about the humerus' z.
data::Trajectories arm(const Matrix3d& raised, double flexed) {
  const Vector3d gh(0.0, 1.4, 0.2), elbow = gh - raised * Vector3d(0, 0.3, 0);
  const Matrix3d forearm = raised * AngleAxisd(flexed, Vector3d::UnitZ()).toRotationMatrix();
  const std::map<std::string, Vector3d> at{{"IJ", {0.1, 1.4, 0}},
                                           {"PX", {0.1, 1.2, 0}},
                                           {"C7", {-0.1, 1.4, 0}},
                                           {"T8", {-0.1, 1.2, 0}},
                                           {"AA", {-0.05, 1.4, 0.2}},
                                           {"TS", {-0.05, 1.4, 0.05}},
                                           {"AI", {-0.05, 1.25, 0.08}},
                                           {"GH", gh},
                                           {"EM", elbow - raised * Vector3d(0, 0, 0.04)},
                                           {"EL", elbow + raised * Vector3d(0, 0, 0.04)},
                                           {"US", elbow - forearm * Vector3d(0, 0.25, 0.0)},
                                           {"RS", elbow - forearm * Vector3d(0, 0.25, -0.05)}};
  std::vector<std::string> names;
  for (const auto& [name, x] : at) names.push_back(name);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = 1});
  for (const auto& [name, x] : at) {
    out.x(0, out.find(name)) = x;
    out.state[static_cast<std::size_t>(out.find(name))] = data::SampleState::measured;
  }
  return out;
}

void expect_angles(const data::Trajectories& markers, const std::string& name, const Vector3d& degrees) {
  const auto motion = analysis::compute_segments(find_definition("isb-shoulder").value(),
                                                 {.markers = &markers}, {.up = Vector3d::UnitY()});
  ASSERT_TRUE(motion) << motion.error().message;
  for (const auto& series : motion->angles)
    if (series.name == name)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(series.value[k] / kOneDegree, degrees[static_cast<Eigen::Index>(k)], 1e-7) << name << k;
}

TEST(IsbShoulder, CallsAbductionPlaneZeroAndFlexionPlaneNinety) {
  const Matrix3d abducted = AngleAxisd(-60 * kOneDegree, Vector3d::UnitX()).toRotationMatrix();
  for (const auto* joint : {"thoracohumeral", "glenohumeral"}) {
    expect_angles(arm(abducted, 0.0), joint, {0.0, 60.0, 0.0});
    const Matrix3d forward = AngleAxisd(90 * kOneDegree, Vector3d::UnitY()) * abducted *
                             AngleAxisd(-90 * kOneDegree, Vector3d::UnitY());
    expect_angles(arm(forward, 0.0), joint, {90.0, 60.0, -90.0});
  }
}

TEST(IsbShoulder, HasThoraxScapulaAndElbow) {
  const Matrix3d raised = AngleAxisd(-40 * kOneDegree, Vector3d::UnitX()).toRotationMatrix();
  expect_angles(arm(raised, 0.0), "thorax", {0.0, 0.0, 0.0});
  expect_angles(arm(raised, 0.0), "scapula", {0.0, 0.0, 0.0});
  expect_angles(arm(raised, 70 * kOneDegree), "elbow", {70.0, 0.0, 0.0});
}

}  // namespace
}  // namespace kinemark::pipeline
