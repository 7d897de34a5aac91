// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/offset_frames.h"

#include <gmock/gmock.h>

#include "kinemark/io/osim/osim_model.h"

namespace kinemark::io {
namespace {

const std::string kModel = R"(<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><Model name="m"><BodySet name="bodyset"><objects>
<Body name="tibia_r"><components>
<PhysicalOffsetFrame name="tibia_r_imu"><socket_parent>..</socket_parent><translation>0 -0.1 0</translation>
<orientation>0 0 1.5707963267948966</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="twice"><socket_parent>..</socket_parent></PhysicalOffsetFrame></components>
<mass>3</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body>
</objects></BodySet><JointSet name="jointset"><objects>
<PinJoint name="knee"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/tibia_r</socket_child_frame>
<coordinates><Coordinate name="knee_angle_r"/></coordinates></PinJoint></objects></JointSet>
<components><PhysicalOffsetFrame name="twice"><socket_parent>/ground</socket_parent></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="floor"><socket_parent>/ground</socket_parent></PhysicalOffsetFrame></components>
</Model></OpenSimDocument>)";

TEST(OffsetFrames, AreThoseOfTheirBodies) {
  const auto model = parse_osim(kModel, "m.osim").value();
  const auto found =
      parse_offset_frames(kModel, "m.osim", model, {"floor", "tibia_r_imu", "absent", "twice"}).value();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "tibia_r_imu");
  EXPECT_EQ(found[0].body_idx, 0);
  EXPECT_TRUE((found[0].body_from_frame.rotation * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(found[0].body_from_frame.translation.isApprox(Eigen::Vector3d(0, -0.1, 0)));
}

TEST(OffsetFrames, AFileThatIsNoXmlIsRefused) {
  const auto model = parse_osim(kModel, "m.osim").value();
  EXPECT_FALSE(parse_offset_frames("<Model", "m.osim", model, {"a"}));
}

}  // namespace
}  // namespace kinemark::io
