// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/limb_figure.h"

#include <gmock/gmock.h>

#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/articulated/ends.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

class LimbFigure : public ::testing::Test {
 protected:
  void SetUp() override {
    limb = simulation::simulate_sleeve({.duration_s = 6.0, .tip = true, .seed = 2}).value();
    skeleton = skeleton::fit_articulated(limb.markers, limb.layout).value().skeleton;
  }
  simulation::LimbRecording limb;
  data::Skeleton skeleton;
};

TEST_F(LimbFigure, PosesAreFarFromEachOtherAndShowTheirMarkers) {
  skeleton::place_ends(limb.markers, limb.layout.ends, skeleton);
  const auto poses = choose_poses(limb.markers, skeleton, 4);
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_TRUE(std::ranges::is_sorted(poses));
  for (const auto f : poses)
    for (const auto& segment : limb.layout.segments)
      EXPECT_GE(std::ranges::count_if(segment.markers, [&](int m) { return limb.markers.present(f, m); }), 3);
  for (std::size_t a = 0; a < poses.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT((skeleton.centre(poses[a], 0) - skeleton.centre(poses[b], 0)).norm() +
                    (Eigen::Map<const Eigen::Vector3d>(limb.end_in_world.data() + 3 * poses[a]) -
                     Eigen::Map<const Eigen::Vector3d>(limb.end_in_world.data() + 3 * poses[b]))
                        .norm(),
                0.02);
}

TEST_F(LimbFigure, HoldsDotsLinesAndShadowsOfEveryPose) {
  skeleton::place_ends(limb.markers, limb.layout.ends, skeleton);
  const auto svg = limb_figure(limb.markers, skeleton, Eigen::Vector3d::UnitZ());
  std::size_t seen = 0;
  for (const auto f : choose_poses(limb.markers, skeleton, 4))
    for (std::int64_t m = 0; m < limb.markers.markers(); ++m) seen += limb.markers.present(f, m) ? 1 : 0;
  EXPECT_EQ(count(svg, "<circle"), seen);
  EXPECT_EQ(count(svg, "stroke=\"#000000\""), 8U) << "two segments in four poses";
  EXPECT_THAT(svg, HasSubstr("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr(">shoulder</text>"));
  EXPECT_THAT(svg, HasSubstr(">wrist</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST_F(LimbFigure, AnotherAxisUpIsTheSamePicture) {
  const auto svg = limb_figure(limb.markers, skeleton, Eigen::Vector3d::UnitZ(), 2);
  EXPECT_THAT(svg, Not(HasSubstr("shoulder"))) << "no ends were asked for";
  EXPECT_EQ(count(svg, "stroke=\"#000000\""), 4U) << "the forearm as far as its markers reach";
  // y up: x, y, z become x, -z, y and back.
  const auto turn = [](double* x) {
    const double y = x[1];
    x[1] = x[2];
    x[2] = -y;
  };
  for (std::size_t i = 0; i < limb.markers.x_in_world.size(); i += 3)
    turn(limb.markers.x_in_world.data() + i);
  for (std::size_t i = 0; i < skeleton.centre_in_world.size(); i += 3)
    turn(skeleton.centre_in_world.data() + i);
  EXPECT_EQ(limb_figure(limb.markers, skeleton, Eigen::Vector3d::UnitY(), 2), svg);
}

}  // namespace
}  // namespace kinemark::pipeline
