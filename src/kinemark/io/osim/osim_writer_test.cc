// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/osim_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/osim/internal/joint_types.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/testing/place_bodies.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using data::ModelDescription;
using testing::HasSubstr;

std::vector<double> random_pose(const ModelDescription& model, Random& random) {
  std::vector<double> q;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) q.push_back(random.uniform(-1.0, 1.0));
  return q;
}

void expect_same_pose(const math::SE3& a, const math::SE3& b, double tolerance, const std::string& what) {
  EXPECT_LT((a.rotation - b.rotation).cwiseAbs().maxCoeff(), tolerance) << what;
  EXPECT_LT((a.translation - b.translation).cwiseAbs().maxCoeff(), tolerance) << what;
}

void expect_same_content(const ModelDescription& a, const ModelDescription& b) {
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.credits, b.credits);
  for (const auto& body : a.bodies) {
    const int idx = b.find_body(body.name);
    ASSERT_GE(idx, 0) << body.name;
    const auto& other = b.bodies[static_cast<std::size_t>(idx)];
    EXPECT_EQ(body.mass, other.mass);
    EXPECT_EQ(body.com_in_body, other.com_in_body);
    EXPECT_EQ(body.inertia_about_com, other.inertia_about_com);
  }
  ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i) {
    const auto &c = a.coordinates[i], &d = b.coordinates[i];
    EXPECT_EQ(c.name, d.name);
    EXPECT_EQ(c.is_rotation, d.is_rotation) << c.name;
    EXPECT_EQ(c.default_value, d.default_value) << c.name;
    EXPECT_EQ(c.range_min, d.range_min) << c.name;
    EXPECT_EQ(c.range_max, d.range_max) << c.name;
    EXPECT_EQ(c.clamped, d.clamped) << c.name;
    EXPECT_EQ(c.locked, d.locked) << c.name;
  }
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    const auto &c = a.joints[j], &d = b.joints[j];
    EXPECT_EQ(c.name, d.name);
    EXPECT_EQ(c.parent_body_idx < 0, d.parent_body_idx < 0);
    EXPECT_EQ(c.parameters, d.parameters) << c.name;
    expect_same_pose(c.parent_from_joint, d.parent_from_joint, 1e-15, c.name);
    expect_same_pose(c.child_from_joint, d.child_from_joint, 1e-15, c.name);
    ASSERT_EQ(c.axes.size(), d.axes.size()) << c.name;
    for (std::size_t k = 0; k < c.axes.size(); ++k) {
      EXPECT_EQ(c.axes[k].axis, d.axes[k].axis) << c.name;
      EXPECT_EQ(c.axes[k].coordinate_idx, d.axes[k].coordinate_idx) << c.name;
      EXPECT_EQ(c.axes[k].second_coordinate_idx, d.axes[k].second_coordinate_idx) << c.name;
      for (const double x : {-1.3, -0.2, 0.0, 0.4, 2.0})
        EXPECT_EQ(c.axes[k].function(x).f, d.axes[k].function(x).f) << c.name;
    }
  }
  ASSERT_EQ(a.couplings.size(), b.couplings.size());
  for (std::size_t i = 0; i < a.couplings.size(); ++i) {
    EXPECT_EQ(a.couplings[i].dependent_idx, b.couplings[i].dependent_idx);
    EXPECT_EQ(a.couplings[i].independent_idx, b.couplings[i].independent_idx);
    for (const double x : {-1.3, 0.0, 0.4})
      EXPECT_EQ(a.couplings[i].function(x).f, b.couplings[i].function(x).f);
  }
  ASSERT_EQ(a.point_constraints.size(), b.point_constraints.size());
  for (std::size_t i = 0; i < a.point_constraints.size(); ++i) {
    EXPECT_EQ(a.point_constraints[i].point_in_a, b.point_constraints[i].point_in_a);
    EXPECT_EQ(a.point_constraints[i].point_in_b, b.point_constraints[i].point_in_b);
  }
  ASSERT_EQ(a.markers.size(), b.markers.size());
  for (std::size_t i = 0; i < a.markers.size(); ++i) {
    EXPECT_EQ(a.markers[i].name, b.markers[i].name);
    EXPECT_EQ(a.markers[i].x_in_body, b.markers[i].x_in_body);
  }
}

void expect_same_motion(const ModelDescription& a, const ModelDescription& b, double tolerance) {
  Random random(11, 0);
  for (int i = 0; i < 3; ++i) {
    const auto q = random_pose(a, random);
    const auto placed = osim::place_bodies(a, q), again = osim::place_bodies(b, q);
    for (const auto& body : a.bodies) {
      const int other = b.find_body(body.name);
      if (other >= 0)
        expect_same_pose(placed[static_cast<std::size_t>(a.find_body(body.name))],
                         again[static_cast<std::size_t>(other)], tolerance, body.name);
    }
  }
}

TEST(OsimWriter, EveryRealModelSurvives) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  int models = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    if (entry.path().extension() != ".osim") continue;
    SCOPED_TRACE(entry.path().string());
    ++models;
    const ModelDescription model = read_osim(entry.path()).value();
    const auto text = format_osim(model);
    ASSERT_TRUE(text) << text.error().message;
    const auto again = parse_osim(*text, "again.osim");
    ASSERT_TRUE(again) << again.error().message;
    expect_same_content(model, *again);
    expect_same_motion(model, *again, 1e-14);  // rounding adds up along the chain
  }
  EXPECT_EQ(models, 15);
}

/// Ground -> base by a weld, base -> tip by the given joint.
ModelDescription one_joint(data::JointDescription joint, int coordinates) {
  ModelDescription m{.name = "m"};
  m.bodies = {{.name = "base", .mass = 1.0}, {.name = "tip", .mass = 1.0}};
  for (int i = 0; i < coordinates; ++i) m.coordinates.push_back({.name = "q" + std::to_string(i)});
  joint.name = "j";
  joint.parent_body_idx = 0;
  joint.child_body_idx = 1;
  m.joints = {{.name = "w", .type = "WeldJoint", .child_body_idx = 0}, std::move(joint)};
  m.markers = {{.name = "M", .body_idx = 1, .x_in_body = {0.1, 0.2, 0.3}}};
  return m;
}

ModelDescription rewritten(const ModelDescription& model) {
  const auto text = format_osim(model);
  EXPECT_TRUE(text) << text.error().message;
  auto again = parse_osim(text.value_or(""), "again.osim");
  EXPECT_TRUE(again) << again.error().message;
  return again.value_or(ModelDescription{});
}

TEST(OsimWriter, APrescribedCoordinateKeepsItsFunction) {
  auto model =
      one_joint({.type = "PinJoint", .axes = {{.axis = Eigen::Vector3d::UnitZ(), .coordinate_idx = 0}}}, 1);
  EXPECT_FALSE(rewritten(model).coordinates[0].prescribed);
  model.coordinates[0].prescribed = math::ScalarFunction::sine(0.4, 6.0, 0.5, 0.1).scaled(2.0);
  const auto again = rewritten(model);
  ASSERT_TRUE(again.coordinates[0].prescribed);
  for (const double t : {-1.0, 0.0, 0.7})
    EXPECT_EQ((*again.coordinates[0].prescribed)(t).f, (*model.coordinates[0].prescribed)(t).f);
}

TEST(OsimWriter, TypesKeepTheirNames) {
  for (const char* type : {"PinJoint", "SliderJoint", "UniversalJoint", "PlanarJoint", "BallJoint",
                           "GimbalJoint", "FreeJoint"}) {
    const auto freedoms = osim::freedoms_of(type).value();
    std::vector<int> coordinates;
    for (std::size_t i = 0; i < freedoms.size(); ++i) coordinates.push_back(static_cast<int>(i));
    auto model = one_joint({.type = type, .axes = osim::axes_of(freedoms, coordinates)},
                           static_cast<int>(freedoms.size()));
    for (std::size_t i = 0; i < freedoms.size(); ++i)
      model.coordinates[i].is_rotation = freedoms[i].is_rotation;
    EXPECT_THAT(format_osim(model).value(), HasSubstr("<" + std::string(type) + " name=\"j\">"));
    const auto again = rewritten(model);
    for (std::size_t i = 0; i < freedoms.size(); ++i)
      EXPECT_EQ(again.coordinates[i].is_rotation, freedoms[i].is_rotation) << type << i;
    expect_same_motion(model, again, 1e-15);
  }
}

TEST(OsimWriter, AnEllipsoidStaysOneUntilItsAxesChange) {
  data::JointDescription joint{.type = "EllipsoidJoint", .parameters = {0.1, 0.2, 0.3}};
  joint.axes = osim::axes_of(*osim::freedoms_of("EllipsoidJoint"), std::vector<int>{0, 1, 2});
  for (auto& axis : osim::ellipsoid_axes({0.1, 0.2, 0.3}, 0, 1)) joint.axes.push_back(axis);
  ModelDescription model = one_joint(joint, 3);
  const auto again = rewritten(model);
  EXPECT_EQ(again.joints[1].type, "EllipsoidJoint");
  expect_same_motion(model, again, 1e-15);
  model.joints[1].parameters[0] = 0.5;
  EXPECT_THAT(format_osim(model).error().message,
              HasSubstr("joint 'j' has an axis that depends on two coordinates"));
}

TEST(OsimWriter, OtherChainsBecomeCustomJointsOrWelds) {
  data::JointDescription joint{
      .type = "PinJoint",
      .parent_from_joint = {.translation = {1, 2, 3}},
      .axes = {{.axis = {1, 1, 0}, .coordinate_idx = 0},
               {.is_rotation = false,
                .axis = {0, 0, 2},
                .coordinate_idx = 0,
                .function = math::ScalarFunction::polynomial({1, 2, 3})},
               {.is_rotation = false,
                .axis = {0, 1, 0},
                .function = math::ScalarFunction::piecewise_linear({0, 1}, {0.5, 2}).value()}}};
  const ModelDescription model = one_joint(joint, 1);
  const auto again = rewritten(model);
  EXPECT_EQ(again.joints[1].type, "CustomJoint");
  EXPECT_TRUE(again.coordinates[0].is_rotation);
  expect_same_motion(model, again, 1e-15);

  joint.axes = {{.axis = {0, 0, 1}, .function = math::ScalarFunction::constant(0.4)},
                {.is_rotation = false, .axis = {1, 0, 0}, .function = math::ScalarFunction::constant(0.3)}};
  const ModelDescription fixed = one_joint(joint, 0);
  EXPECT_EQ(rewritten(fixed).joints[1].type, "WeldJoint");
  expect_same_motion(fixed, rewritten(fixed), 1e-15);
}

TEST(OsimWriter, AJointTurnedRoundSurvivesUnlessACoordinateBothTurnsAndMovesIt) {
  const auto reversed = [](const std::string& joint) {
    return parse_osim(R"(<OpenSimDocument Version="40000"><Model name="m">
      <BodySet><objects><Body name="a"/><Body name="b"/></objects></BodySet><JointSet><objects>
      <WeldJoint name="w"><socket_parent_frame>/ground</socket_parent_frame>
        <socket_child_frame>/bodyset/a</socket_child_frame></WeldJoint>)" +
                          joint + "</objects></JointSet></Model></OpenSimDocument>",
                      "m.osim")
        .value();
  };
  const std::string sockets =
      "<socket_parent_frame>/bodyset/b</socket_parent_frame><socket_child_frame>/bodyset/a</"
      "socket_child_frame>";
  const auto free = reversed("<FreeJoint name=\"j\">" + sockets + "</FreeJoint>");
  EXPECT_GE(free.find_body("j_intermediate"), 0);
  expect_same_content(free, rewritten(free));
  expect_same_motion(free, rewritten(free), 1e-15);

  const auto axis = [](const char* name) {
    return std::string("<TransformAxis name=\"") + name +
           "\"><coordinates>q</coordinates><axis>0 0 1</axis><LinearFunction "
           "name=\"function\"/></TransformAxis>";
  };
  const auto screw = reversed("<CustomJoint name=\"j\">" + sockets + "<SpatialTransform>" +
                              axis("rotation1") + axis("translation1") + "</SpatialTransform></CustomJoint>");
  EXPECT_THAT(format_osim(screw).error().message, HasSubstr("drives the joints 'j_rotation' and 'j'"));
}

TEST(OsimWriter, NamesThatOpenSimRefusesAreMended) {
  ModelDescription model = one_joint({.type = "WeldJoint"}, 0);
  model.name = "Monkey Arm";
  model.markers[0].name = "L/wrist +1";
  model.credits = "a < b & \"c\" \xC3\xA9";
  const auto again = rewritten(model);
  EXPECT_EQ(again.name, "Monkey_Arm");
  EXPECT_EQ(again.markers[0].name, "L_wrist__1");
  EXPECT_EQ(again.credits, model.credits);
  model.markers.push_back({.name = "L wrist  1", .body_idx = 0});
  EXPECT_THAT(format_osim(model).error().message, HasSubstr("'L_wrist__1' occurs twice"));
}

TEST(OsimWriter, RefusesWhatOpenSimHasNoFormFor) {
  const auto refusal = [](const ModelDescription& model) {
    const auto text = format_osim(model);
    return text ? "" : text.error().message;
  };
  const data::AxisDescription x{.coordinate_idx = 0}, y{.axis = {0, 1, 0}, .coordinate_idx = 0},
      z{.axis = {0, 0, 1}, .coordinate_idx = 0};
  EXPECT_THAT(refusal(one_joint({.axes = {x, y, z, x}}, 1)), HasSubstr("more than three rotations"));
  EXPECT_THAT(refusal(one_joint({.axes = {x, y, x}}, 1)), HasSubstr("parallel axes"));
  EXPECT_THAT(refusal(one_joint({.axes = {x}}, 2)), HasSubstr("'q1' drives no joint"));
  data::AxisDescription natural = x;
  natural.function = math::ScalarFunction::natural_spline({0, 1, 2}, {0, 1, 0}).value();
  EXPECT_THAT(refusal(one_joint({.axes = {natural}}, 1)), HasSubstr("natural spline"));
  ModelDescription shared = one_joint({.axes = {x}}, 1);
  shared.joints[0].axes = {x};
  EXPECT_THAT(refusal(shared), HasSubstr("drives the joints 'w' and 'j'"));
  ModelDescription coupled = one_joint({.axes = {x, {.axis = {0, 1, 0}, .coordinate_idx = 1}}}, 2);
  coupled.couplings = {{.name = "c", .dependent_idx = 1, .independent_idx = 0, .function = natural.function}};
  EXPECT_THAT(refusal(coupled), HasSubstr("coupling 'c' is a natural spline"));
  ModelDescription invalid = one_joint({.axes = {x}}, 1);
  invalid.markers[0].body_idx = 7;
  EXPECT_THAT(refusal(invalid), HasSubstr("marker 'M'"));
}

TEST(OsimWriter, WritesTheFileWholeAndOnlyOverAnOldOneWhenForced) {
  const testing_support::ScratchFolder scratch;
  const ModelDescription model = one_joint({.type = "WeldJoint"}, 0);
  ASSERT_TRUE(write_osim(scratch / "m.osim", model));
  EXPECT_EQ(write_osim(scratch / "m.osim", model).error().code, Code::io);
  EXPECT_TRUE(write_osim(scratch / "m.osim", model, {.force = true}));
  EXPECT_EQ(read_text(scratch / "m.osim").value(), format_osim(model).value());
  ModelDescription invalid = model;
  invalid.bodies[0].mass = -1;
  EXPECT_THAT(write_osim(scratch / "n.osim", invalid).error().message, HasSubstr("n.osim: body 'base'"));
  EXPECT_EQ(scratch.count_files(), 1);
}

}  // namespace
}  // namespace kinemark::io
