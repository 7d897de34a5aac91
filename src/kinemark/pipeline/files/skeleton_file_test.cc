// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/skeleton_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

json example() {
  const json unit{{1e-6, 0.0, 0.0}, {0.0, 4e-6, 0.0}, {0.0, 0.0, 9e-6}};
  const auto marker = [](const char* name, double x) {
    return json{{"name", name}, {"x_in_segment_m", {x, 0.5, -0.25}}};
  };
  return {{"schema", "kinemark.skeleton"},
          {"noise_sd_m", 0.001},
          {"input", {{"path", "star.c3d"}, {"xxh3_64", "00ff"}}},
          {"segments",
           {{{"name", "thigh"}, {"kind", "solid"}, {"markers", {marker("A", 0.1), marker("B", 0.2)}}},
            {{"name", "shank"}, {"kind", "line"}, {"markers", {marker("C", 0.3)}}}}},
          {"joints",
           {{{"name", "knee"},
             {"kind", "hinge"},
             {"parent", "thigh"},
             {"child", "shank"},
             {"centre_in_parent_m", {0.0, -0.4, 0.0}},
             {"centre_in_child_m", nullptr},
             {"covariance_in_parent_m2", unit},
             {"axis_in_parent", {0.0, 0.0, 1.0}},
             {"axis_sd_deg", 2.0},
             {"range_of_motion_deg", 90.0}}}}};
}

std::string wrong(const json& value) {
  const auto file = parse_skeleton(value.dump(), "s.json");
  return file ? "it was read" : file.error().message;
}

TEST(SkeletonFile, holds_what_joints_wrote) {
  const auto file = parse_skeleton(example().dump(), "s.json");
  ASSERT_TRUE(file) << file.error().message;
  const auto& s = file->skeleton;
  EXPECT_THAT(s.markers, ElementsAre("A", "B", "C"));
  EXPECT_EQ(s.segments[0].x_in_segment.col(1), Eigen::Vector3d(0.2, 0.5, -0.25));
  EXPECT_EQ(s.segments[1].kind, data::SegmentKind::line);
  ASSERT_EQ(s.joints.size(), 1U);
  const auto& knee = s.joints[0];
  EXPECT_EQ(knee.kind, data::JointKind::hinge);
  EXPECT_EQ(knee.child_segment, 1);
  EXPECT_EQ(knee.centre_in_parent, Eigen::Vector3d(0.0, -0.4, 0.0));
  EXPECT_EQ(knee.covariance_in_parent(1, 1), 4e-6);
  EXPECT_TRUE(knee.covariance_in_child.array().isNaN().all());
  EXPECT_NEAR(knee.axis_sd_rad, 2.0 * kRadPerDeg, 1e-15);
  EXPECT_EQ(s.frames(), 0);
  EXPECT_EQ(file->recording.path, "star.c3d");
  EXPECT_EQ(file->recording.hash, "00ff");
}

TEST(SkeletonFile, a_ball_has_no_axis_whose_doubt_could_be_unknown) {
  json ball = example();
  ball["joints"][0]["kind"] = "ball";
  const auto joint = parse_skeleton(ball.dump(), "s.json").value().skeleton.joints[0];
  EXPECT_EQ(joint.axis_covariance_in_parent.norm(), 0.0);
  EXPECT_EQ(joint.axis_sd_rad, 0.0);
}

TEST(SkeletonFile, is_found_in_its_folder) {
  const testing_support::ScratchFolder scratch;
  io::write_text(scratch / "skeleton.json", example().dump(), false).value();
  EXPECT_EQ(read_skeleton(scratch.path())->skeleton.joints.size(), 1U);
  EXPECT_EQ(read_skeleton(scratch / "skeleton.json")->skeleton.joints.size(), 1U);
  EXPECT_EQ(read_skeleton(scratch / "none").error().code, Code::io);
}

TEST(SkeletonFile, says_where_it_is_none) {
  EXPECT_EQ(parse_skeleton("{", "s.json").error().message, "s.json: not JSON; need a skeleton.json");
  EXPECT_THAT(wrong(json::array()), StartsWith("s.json: not a skeleton.json"));
  const auto with = [](const char* pointer, json value) {
    json all = example();
    all[json::json_pointer(pointer)] = std::move(value);
    return wrong(all);
  };
  EXPECT_THAT(with("/segments", 3), HasSubstr("segments: need a list of segments"));
  EXPECT_THAT(with("/segments/1", 3), HasSubstr("segments[1]: need an object"));
  EXPECT_THAT(with("/segments/1/name", ""), HasSubstr("segments[1].name: need a name"));
  EXPECT_THAT(with("/segments/0/kind", "disc"), HasSubstr("segments[0].kind: need \"line\""));
  EXPECT_THAT(with("/segments/0/markers/1/x_in_segment_m", {1, 2}),
              HasSubstr("markers[1].x_in_segment_m: need three"));
  EXPECT_THAT(with("/segments/1/markers/0/name", "A"), HasSubstr("marker 'A' is on a segment already"));
  EXPECT_THAT(with("/joints/0/parent", "foot"), HasSubstr("joints[0].parent: need the name of a segment"));
  EXPECT_THAT(with("/joints/0/parent", "shank"), HasSubstr("joint 'knee' joins segments 1 and 1"));
  EXPECT_THAT(with("/joints/0/kind", "slide"), HasSubstr("joints[0].kind: need \"ball\" or \"hinge\""));
  EXPECT_THAT(with("/joints/0/centre_in_parent_m", {"a", 1, 2}),
              HasSubstr("centre_in_parent_m: need three numbers"));
  EXPECT_THAT(with("/joints/0/covariance_in_parent_m2", {1, 2}),
              HasSubstr("covariance_in_parent_m2: need three rows"));
}

}  // namespace
}  // namespace kinemark::pipeline
