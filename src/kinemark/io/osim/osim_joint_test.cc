// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Small documents: every joint type, frame path, function and old spelling against its definition.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/osim/internal/joint_types.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/testing/place_bodies.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();

Matrix3d rotation(const Vector3d& axis, double angle) {
  return AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A 4.x model: bodies "a" and "b", the joints given, a marker on b.
std::string model_4(const std::string& joints, const std::string& more = "") {
  return fmt::format(R"(<OpenSimDocument Version="40000"><Model name="m">
    <BodySet name="bodyset"><objects><Body name="a"><mass>1</mass></Body><Body name="b"/></objects></BodySet>
    <JointSet name="jointset"><objects>{}</objects></JointSet>
    <MarkerSet><objects><Marker name="M"><socket_parent_frame>/bodyset/b</socket_parent_frame>
      <location>0.1 0.2 0.3</location></Marker></objects></MarkerSet>{}</Model></OpenSimDocument>)",
                     joints, more);
}

std::string weld(const char* parent, const char* child, const char* name = "w") {
  return fmt::format(R"(<WeldJoint name="{}"><socket_parent_frame>{}</socket_parent_frame>
    <socket_child_frame>{}</socket_child_frame></WeldJoint>)",
                     name, parent, child);
}

std::string joint_ab(const char* type, const std::string& inside) {
  return weld("/ground", "/bodyset/a") +
         fmt::format(R"(<{0} name="j"><socket_parent_frame>/bodyset/a</socket_parent_frame>
           <socket_child_frame>/bodyset/b</socket_child_frame>{1}</{0}>)",
                     type, inside);
}

data::ModelDescription parse(const std::string& xml) {
  auto model = parse_osim(xml, "m.osim");
  EXPECT_TRUE(model) << model.error().message;
  return model.value_or(data::ModelDescription{});
}

math::SE3 motion_of_b(const data::ModelDescription& model, const std::vector<double>& q) {
  return osim::place_bodies(model, q)[static_cast<std::size_t>(model.find_body("b"))];
}

void expect_motion(const data::ModelDescription& model, const std::vector<double>& q,
                   const Matrix3d& rotation, const Vector3d& translation) {
  const math::SE3 b = motion_of_b(model, q);
  EXPECT_LT((b.rotation - rotation).norm(), 1e-14);
  EXPECT_LT((b.translation - translation).norm(), 1e-14);
}

TEST(OsimJoint, TypesWithAFixedMotion) {
  const Matrix3d I = Matrix3d::Identity();
  expect_motion(parse(model_4(joint_ab("PinJoint", ""))), {0.4}, rotation(Z, 0.4), Vector3d::Zero());
  expect_motion(parse(model_4(joint_ab("SliderJoint", ""))), {0.4}, I, 0.4 * X);
  expect_motion(parse(model_4(joint_ab("UniversalJoint", ""))), {0.4, 0.5},
                rotation(X, 0.4) * rotation(Y, 0.5), Vector3d::Zero());
  expect_motion(parse(model_4(joint_ab("PlanarJoint", ""))), {0.4, 0.5, 0.6}, rotation(Z, 0.4),
                {0.5, 0.6, 0.0});
  for (const char* type : {"BallJoint", "GimbalJoint"})
    expect_motion(parse(model_4(joint_ab(type, ""))), {0.4, 0.5, 0.6},
                  rotation(X, 0.4) * rotation(Y, 0.5) * rotation(Z, 0.6), Vector3d::Zero());
  expect_motion(parse(model_4(joint_ab("FreeJoint", ""))), {0.4, 0.5, 0.6, 1, 2, 3},
                rotation(X, 0.4) * rotation(Y, 0.5) * rotation(Z, 0.6), {1, 2, 3});
}

TEST(OsimJoint, CoordinatesThatTheFileOmitsAreNamedAfterTheirJoint) {
  const auto model = parse(model_4(joint_ab("PlanarJoint", "")));
  EXPECT_EQ(model.coordinates[2].name, "j_coord_2");
  EXPECT_TRUE(model.coordinates[0].is_rotation);
  EXPECT_FALSE(model.coordinates[1].is_rotation);
}

TEST(OsimJoint, EllipsoidKeepsTheOriginOnTheSurfaceAndZNormalToTheUnitSphere) {
  const auto model = parse(model_4(joint_ab("EllipsoidJoint", "<radii_x_y_z>0.1 0.2 0.3</radii_x_y_z>")));
  const Vector3d radii(0.1, 0.2, 0.3);
  for (const double a : {-1.1, 0.0, 0.7})
    for (const double b : {-0.4, 0.0, 1.3}) {
      const Matrix3d R = rotation(X, a) * rotation(Y, b) * rotation(Z, 0.6);
      expect_motion(model, {a, b, 0.6}, R, radii.cwiseProduct(R * Z));
    }
}

// Independent construction from its parts: ellipsoid mobilizer between frames turned by 90 deg about Z, then
// a pin whose axis passes through the winging origin.
TEST(OsimJoint, ScapulothoracicFromItsParts) {
  const auto model =
      parse(model_4(joint_ab("ScapulothoracicJoint",
                             "<thoracic_ellipsoid_radii_x_y_z>0.1 0.2 0.3</thoracic_ellipsoid_radii_x_y_z>"
                             "<scapula_winging_axis_origin>0.05 -0.02</scapula_winging_axis_origin>"
                             "<scapula_winging_axis_direction>0.3</scapula_winging_axis_direction>")));
  EXPECT_EQ(model.bodies.size(), 3U);
  EXPECT_EQ(model.bodies[2].name, "j_intermediate");
  const std::vector<double> q = {0.2, -0.3, 0.4, 0.5};
  const Matrix3d R = rotation(X, 0.2) * rotation(Y, -0.3) * rotation(Z, 0.4), quarter = rotation(Z, M_PI / 2);
  const Vector3d p = Vector3d(0.2, 0.1, 0.3).cwiseProduct(R * Z), origin(0.05, -0.02, 0.0);
  const Matrix3d between = quarter * R * quarter.transpose();
  const Matrix3d wing = rotation(Vector3d(-std::sin(0.3), std::cos(0.3), 0.0), 0.5);
  expect_motion(model, q, between * wing, quarter * p + between * (origin - wing * origin));
}

TEST(OsimJoint, CustomTranslatesInTheParentThenRotatesBodyFixed) {
  const auto model = parse(model_4(joint_ab("CustomJoint", R"(
    <coordinates><Coordinate name="u"/><Coordinate name="v"/></coordinates><SpatialTransform>
      <TransformAxis name="rotation1"><coordinates>u</coordinates><axis>0 0 2</axis>
        <LinearFunction name="function"><coefficients>2 0.1</coefficients></LinearFunction></TransformAxis>
      <TransformAxis name="rotation2"><coordinates>v</coordinates><axis>1 1 0</axis>
        <function><MultiplierFunction><function><MultiplierFunction><function><PolynomialFunction>
          <coefficients>3 0 1</coefficients></PolynomialFunction></function><scale>2</scale></MultiplierFunction></function>
          <scale>0.5</scale></MultiplierFunction></function></TransformAxis>
      <TransformAxis name="rotation3"><coordinates/><axis>0 1 0</axis><Constant name="function"><value>0</value></Constant>
      </TransformAxis>
      <TransformAxis name="translation1"><coordinates>u</coordinates><axis>1 0 0</axis><function><Sine>
        <amplitude>2</amplitude><omega>3</omega><phase>0.1</phase><offset>0.2</offset></Sine></function></TransformAxis>
      <TransformAxis name="translation2"><coordinates></coordinates><axis>0 1 0</axis>
        <function><Constant><value>0.25</value></Constant></function></TransformAxis>
    </SpatialTransform>)")));
  EXPECT_EQ(model.joints[1].axes.size(), 4U) << "the third rotation never moves";
  const double u = 0.3, v = 0.4;
  expect_motion(model, {u, v}, rotation(Z, 2 * u + 0.1) * rotation(X + Y, 3 * v * v + 1),
                {2 * std::sin(3 * u + 0.1) + 0.2, 0.25, 0.0});
  EXPECT_TRUE(model.coordinates[0].is_rotation);
}

TEST(OsimJoint, TheSplineIsSimmsUnderAllItsNames) {
  for (const char* tag : {"SimmSpline", "NaturalCubicSpline", "natCubicSpline"}) {
    const auto model = parse(model_4(joint_ab("CustomJoint", fmt::format(R"(
      <coordinates><Coordinate name="u"/></coordinates><SpatialTransform><TransformAxis name="translation1">
      <coordinates>u</coordinates><axis>1 0 0</axis><{0} name="function"><x>0 1 2 4</x><y>0 1 8 64</y></{0}></TransformAxis>
      </SpatialTransform>)",
                                                                         tag))));
    EXPECT_EQ(model.joints[1].axes[0].function.kind(), math::ScalarFunction::Kind::simm_spline);
    EXPECT_NEAR(motion_of_b(model, {3.0}).translation.x(), 27.0, 1e-12) << "exact for a cubic";
    EXPECT_FALSE(model.coordinates[0].is_rotation);
  }
}

TEST(OsimJoint, OffsetFramesMayHangOnEachOtherAndBeNamedInEveryWay) {
  const std::string component = R"(<components>
      <PhysicalOffsetFrame name="on_a"><socket_parent>/bodyset/a</socket_parent><translation>1 0 0</translation>
        <orientation>0.1 0.2 0.3</orientation></PhysicalOffsetFrame>
      <PhysicalOffsetFrame name="further"><socket_parent>../on_a</socket_parent><translation>0 1 0</translation>
        <orientation>0.4 0 0</orientation></PhysicalOffsetFrame></components>)";
  const Matrix3d first = rotation(X, 0.1) * rotation(Y, 0.2) * rotation(Z, 0.3);
  for (const char* path : {"/further", "../../further", "further"}) {
    const auto model =
        parse(model_4(weld("/ground", "/bodyset/a") + weld(path, "../../bodyset/b", "j"), component));
    expect_motion(model, {}, first * rotation(X, 0.4), X + first * Y);
  }
}

TEST(OsimJoint, FramesOfTheJointItselfAndMarkersOnFrames) {
  const auto model = parse(model_4(weld("/ground", "/bodyset/a") + R"(
    <PinJoint name="j"><socket_parent_frame>p</socket_parent_frame><socket_child_frame>c</socket_child_frame>
      <coordinates><Coordinate name="q"><default_value>0.5</default_value></Coordinate></coordinates>
      <frames><PhysicalOffsetFrame name="p"><socket_parent>/bodyset/a</socket_parent><translation>1 2 3</translation>
        <orientation>0 0 0</orientation></PhysicalOffsetFrame>
      <PhysicalOffsetFrame name="c"><socket_parent>/bodyset/b</socket_parent><translation>0 0.5 0</translation>
        <orientation>0 0 0</orientation></PhysicalOffsetFrame></frames></PinJoint>)",
                                   R"(<ConstraintSet><objects><PointConstraint name="loop">
      <socket_body_1>/jointset/j/p</socket_body_1><socket_body_2>/bodyset/b</socket_body_2>
      <location_body_1>0 0 1</location_body_1></PointConstraint></objects></ConstraintSet>)"));
  expect_motion(model, {0.5}, rotation(Z, 0.5), Vector3d(1, 2, 3) - rotation(Z, 0.5) * Vector3d(0, 0.5, 0));
  EXPECT_EQ(model.point_constraints[0].point_in_a, Vector3d(1, 2, 4));
  EXPECT_EQ(model.point_constraints[0].body_a_idx, 0);
}

TEST(OsimJoint, InterimVersionsWithConnectors) {
  const auto model = parse(R"(<OpenSimDocument Version="30515"><Model name="m">
    <BodySet><objects><Body name="b"/></objects></BodySet><JointSet><objects><SliderJoint name="j"><connectors>
      <Connector_PhysicalFrame_ name="parent_frame"><connectee_name>../ground</connectee_name></Connector_PhysicalFrame_>
      <Connector_PhysicalFrame_ name="child_frame"><connectee_name>b</connectee_name></Connector_PhysicalFrame_>
    </connectors></SliderJoint></objects></JointSet></Model></OpenSimDocument>)");
  expect_motion(model, {0.7}, Matrix3d::Identity(), 0.7 * X);
}

std::string old_joint(const char* reverse) {
  return fmt::format(R"(<OpenSimDocument Version="20302"><Model name="m"><BodySet><objects>
    <Body name="ground"><Joint/></Body>
    <Body name="b"><mass>2</mass><mass_center>0 0.1 0</mass_center><inertia_xx>1</inertia_xx><inertia_yy>2</inertia_yy>
      <inertia_zz>3</inertia_zz><inertia_xy>0.1</inertia_xy><inertia_xz>0.2</inertia_xz><inertia_yz>0.3</inertia_yz>
      <Joint><CustomJoint name="j"><parent_body> ground </parent_body>
        <location_in_parent>1 0 0</location_in_parent><orientation_in_parent>0 0 0.5</orientation_in_parent>
        <location>0 0.25 0</location><orientation>0.1 0 0</orientation><reverse>{}</reverse>
        <CoordinateSet><objects><Coordinate name="r"><motion_type> rotational </motion_type></Coordinate>
          <Coordinate name="s"/><Coordinate name="t"><motion_type>translational</motion_type></Coordinate>
        </objects></CoordinateSet>
        <SpatialTransform><TransformAxis name="rotation1"><coordinates>r</coordinates><axis>0 0 1</axis><function>
            <LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis>
          <TransformAxis name="rotation2"><coordinates>s</coordinates><axis>0 1 0</axis><function>
            <LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis>
          <TransformAxis name="translation3"><coordinates>t</coordinates><axis>0 0 1</axis><function>
            <LinearFunction><coefficients>1 0</coefficients></LinearFunction></function></TransformAxis>
        </SpatialTransform></CustomJoint></Joint></Body></objects></BodySet>
    <MarkerSet><objects><Marker name="M"><body> b </body><location> 0 0 1 </location></Marker></objects></MarkerSet>
    </Model></OpenSimDocument>)",
                     reverse);
}

TEST(OsimJoint, OldFormatWithTheJointInItsBody) {
  const auto model = parse(old_joint("false"));
  ASSERT_EQ(model.bodies.size(), 1U) << "the ground is no body";
  Matrix3d inertia;
  inertia << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 3;
  EXPECT_EQ(model.bodies[0].inertia_about_com, inertia);
  const Matrix3d R = rotation(Z, 0.5) * rotation(Z, 0.3) * rotation(Y, 0.4) * rotation(X, 0.1).transpose();
  expect_motion(model, {0.3, 0.4, 0.6}, R, Vector3d(1, 0, 0.6) - R * Vector3d(0, 0.25, 0));
}

// Turned round, the joint's motion carries the ground from the body: the inverse of the whole.
TEST(OsimJoint, AReversedJointMovesByTheInverse) {
  const auto model = parse(old_joint("true"));
  EXPECT_EQ(model.bodies.size(), 2U);
  EXPECT_EQ(model.bodies[1].name, "j_intermediate");
  const std::vector<double> q = {0.3, 0.4, 0.6};
  const math::SE3 motion{.rotation = rotation(Z, 0.3) * rotation(Y, 0.4), .translation = 0.6 * Z};
  const math::SE3 ground_frame{.rotation = rotation(Z, 0.5), .translation = X};
  const math::SE3 body_frame{.rotation = rotation(X, 0.1), .translation = 0.25 * Y};
  const math::SE3 expected = ground_frame * motion.inverse() * body_frame.inverse();
  expect_motion(model, q, expected.rotation, expected.translation);
}

TEST(OsimJoint, AJointWhoseChildIsNearerToTheGroundIsTurnedRound) {
  const auto model = parse(model_4(weld("/ground", "/bodyset/a") + R"(<UniversalJoint name="j">
    <socket_parent_frame>/bodyset/b</socket_parent_frame><socket_child_frame>/bodyset/a</socket_child_frame>
    </UniversalJoint>)"));
  EXPECT_EQ(model.bodies.size(), 2U) << "rotations alone need no body between";
  expect_motion(model, {0.4, 0.5}, (rotation(X, 0.4) * rotation(Y, 0.5)).transpose(), Vector3d::Zero());
}

TEST(OsimJoint, CouplersWithScaleAndSplineAndDisabledOnes) {
  const auto coupler = [](const char* name, const char* inside) {
    return fmt::format(
        R"(<CoordinateCouplerConstraint name="{}">{}<coupled_coordinates_function><SimmSpline><x>0 1</x>
      <y>0 2</y></SimmSpline></coupled_coordinates_function><independent_coordinate_names>j_coord_0
      </independent_coordinate_names><dependent_coordinate_name>j_coord_1</dependent_coordinate_name>
      </CoordinateCouplerConstraint>)",
        name, inside);
  };
  const auto model = parse(model_4(
      joint_ab("UniversalJoint", ""),
      "<ConstraintSet><objects>" + coupler("one", "<scale_factor>0.5</scale_factor>") +
          coupler("two", "<isDisabled>true</isDisabled>") +
          coupler("three", "<isEnforced> False </isEnforced>") +
          R"(<ConstantDistanceConstraint name="rod"/><PointOnLineConstraint name="rail"/></objects></ConstraintSet>)"));
  ASSERT_EQ(model.couplings.size(), 1U);
  EXPECT_DOUBLE_EQ(model.couplings[0].function(0.3).f, 0.3);
  EXPECT_EQ(model.couplings[0].independent_idx, 0);
  EXPECT_EQ(model.couplings[0].dependent_idx, 1);
  EXPECT_THAT(model.warnings, ElementsAre("ConstantDistanceConstraint 'rod' is not enforced",
                                          "PointOnLineConstraint 'rail' is not enforced"));
}

TEST(OsimJoint, AWeldIsThreePointsThatLieOnEachOther) {
  const auto loop = [](const std::string& inside) {
    return R"(<ConstraintSet><objects><WeldConstraint name="glue">)" + inside +
           "</WeldConstraint></objects></ConstraintSet>";
  };
  const auto check = [](const data::ModelDescription& model, const Matrix3d& turned) {
    ASSERT_EQ(model.point_constraints.size(), 3U);
    EXPECT_THAT(model.warnings, IsEmpty());
    for (int k = 0; k < 3; ++k) {
      const auto& point = model.point_constraints[static_cast<std::size_t>(k)];
      EXPECT_EQ(point.body_a_idx, 0);
      EXPECT_EQ(point.body_b_idx, 1);
      const Vector3d of_frame = k == 0 ? Vector3d(0, 0, 0) : 0.1 * (k == 1 ? X : Y);
      EXPECT_TRUE(point.point_in_a.isApprox(Vector3d(1, 2, 3) + turned * of_frame, 1e-12)) << k;
      EXPECT_TRUE((point.point_in_b - Vector3d(0, 0, 4) - of_frame).norm() < 1e-12) << k;
    }
  };
  const std::string joints = joint_ab("UniversalJoint", "");
  check(parse(model_4(joints, loop(R"(<frames>
      <PhysicalOffsetFrame name="p"><socket_parent>/bodyset/a</socket_parent><translation>1 2 3</translation>
        <orientation>0.5 0 0</orientation></PhysicalOffsetFrame>
      <PhysicalOffsetFrame name="c"><socket_parent>/bodyset/b</socket_parent><translation>0 0 4</translation>
        <orientation>0 0 0</orientation></PhysicalOffsetFrame></frames>
      <socket_frame1>p</socket_frame1><socket_frame2>c</socket_frame2>)"))),
        rotation(X, 0.5));
  check(parse(model_4(joints,
                      loop(R"(<body_1>a</body_1><body_2>b</body_2><location_body_1>1 2 3</location_body_1>
      <orientation_body_1>0.5 0 0</orientation_body_1><location_body_2>0 0 4</location_body_2>)"))),
        rotation(X, 0.5));
}

TEST(OsimJoint, APrescribedCoordinateHasItsFunctionOfTime) {
  const auto coordinate = [](std::string_view name, std::string_view inside) {
    return fmt::format(R"(<Coordinate name="{}">{}</Coordinate>)", name, inside);
  };
  const std::string one = "<prescribed_function><Constant><value>1</value></Constant></prescribed_function>";
  const std::string wave =
      "<prescribed_function><Sine><amplitude>0.4</amplitude><omega>6</omega><phase>0.5</phase>"
      "<offset>0.1</offset></Sine></prescribed_function>";
  const auto model = parse(model_4(
      joint_ab("BallJoint", "<coordinates>" + coordinate("u", "<prescribed>true</prescribed>" + wave) +
                                coordinate("v", "<prescribed>true</prescribed><prescribed_function/>") +
                                coordinate("w", "<locked>true</locked><prescribed>true</prescribed>" + one) +
                                "</coordinates>")));
  ASSERT_TRUE(model.coordinates[0].prescribed);
  EXPECT_DOUBLE_EQ((*model.coordinates[0].prescribed)(0.3).f, 0.1 + 0.4 * std::sin(6 * 0.3 + 0.5));
  EXPECT_TRUE(model.coordinates[0].held());
  EXPECT_FALSE(model.coordinates[0].locked);
  EXPECT_FALSE(model.coordinates[1].held()) << "OpenSim ignores the flag without a function";
  EXPECT_FALSE(model.coordinates[2].prescribed) << "a lock takes precedence";
  EXPECT_THAT(model.warnings, IsEmpty());
  const auto idle = parse(model_4(joint_ab(
      "UniversalJoint", "<coordinates>" + coordinate("u", one) + coordinate("v", "") + "</coordinates>")));
  EXPECT_FALSE(idle.coordinates[0].held()) << "a function without the flag";
}

TEST(OsimJoint, TheFirstVersions) {
  const auto model = parse(R"(<?xml version="1.0"?><Model name="block"><DynamicsEngine><SimbodyEngine>
    <gravity>0 0 -9.8</gravity>
    <BodySet><objects><SimbodyBody name="ground"/><SimbodyBody name="b"><mass>20</mass>
      <inertia>0.1 0.01 0.02 0.01 0.2 0.03 0.02 0.03 0.3</inertia></SimbodyBody></objects></BodySet>
    <CoordinateSet><objects><SimbodyCoordinate name="ty"><range>-1 2</range><default_value>1</default_value>
      <clamped>true</clamped></SimbodyCoordinate><SimbodyCoordinate name="rz"/></objects></CoordinateSet>
    <JointSet><objects><SimbodyJoint name="ground_block"><bodies>ground b</bodies><DofSet><objects>
      <SimbodyTranslationDof name="ty"><coordinate>ty</coordinate><Value><natCubicSpline><x>-360 360</x><y>-360 360</y>
        </natCubicSpline></Value></SimbodyTranslationDof>
      <SimbodyRotationDof name="r1"><axis>0 0 1</axis><coordinate>rz</coordinate><Value><natCubicSpline>
        <x>-6.28 6.28</x><y>-12.56 12.56</y></natCubicSpline></Value></SimbodyRotationDof>
    </objects></DofSet></SimbodyJoint></objects></JointSet></SimbodyEngine></DynamicsEngine></Model>)");
  EXPECT_EQ(model.gravity.z(), -9.8);
  EXPECT_DOUBLE_EQ(model.bodies[0].inertia_about_com(1, 2), 0.03);
  const int ty = model.find_coordinate("ty"), rz = model.find_coordinate("rz");
  ASSERT_GE(ty, 0);
  EXPECT_FALSE(model.coordinates[static_cast<std::size_t>(ty)].is_rotation);
  EXPECT_TRUE(model.coordinates[static_cast<std::size_t>(ty)].clamped);
  std::vector<double> q(2);
  q[static_cast<std::size_t>(ty)] = 0.7;
  q[static_cast<std::size_t>(rz)] = 0.2;
  const math::SE3 b = motion_of_b(model, q);
  EXPECT_LT((b.rotation - rotation(Z, 0.4)).norm(), 1e-12);
  EXPECT_LT((b.translation - 0.7 * Y).norm(), 1e-12);
}

TEST(OsimJoint, TransformAxisSetOfVersion10500) {
  const auto model =
      parse(R"(<OpenSimDocument Version="10500"><Model name="m"><BodySet><objects><Body name="ground"/>
    <Body name="b"><Joint><CustomJoint name="j"><parent_body>ground</parent_body><CoordinateSet><objects>
      <Coordinate name="u"/></objects></CoordinateSet><TransformAxisSet><objects>
      <TransformAxis name="tx"><is_rotation>false</is_rotation><coordinate>u</coordinate><axis>1 0 0</axis><function>
        <Constant><value>0.5</value></Constant></function></TransformAxis>
      <TransformAxis name="r1"><is_rotation>true</is_rotation><coordinate>u</coordinate><axis>0 1 0</axis><function>
        <LinearFunction/></function></TransformAxis></objects></TransformAxisSet></CustomJoint></Joint></Body>
    </objects></BodySet></Model></OpenSimDocument>)");
  expect_motion(model, {0.3}, rotation(Y, 0.3), 0.5 * X);
}

}  // namespace
}  // namespace kinemark::io
