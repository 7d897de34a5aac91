// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/vsk/vsk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

const std::string kLeg =
    R"(<?xml version="1.0"?><KinematicModel MODEL="Leg" VERSION="2.5"><Parameters>
<StaticParameter NAME="Mass" QUANTITY="mass" VALUE="75"/>
<StaticParameter NAME="KneeWidth" QUANTITY="length" VALUE="105"/>
<StaticParameter NAME="Torsion" QUANTITY="angle" VALUE="0.25"/>
<StaticParameter NAME="KNEy" QUANTITY="length" EXPRESSION="KneeWidth / 2"/>
<Parameter NAME="THIz" PRIOR="-200" VALUE="-226.5"/></Parameters>
<Skeleton><Segment NAME="Pelvis"><JointFree NAME="World_Pelvis"/>
<Segment NAME="Femur"><JointBall NAME="Hip"><JointTemplate/></JointBall>
<Segment NAME="Tibia"><JointHinge NAME="Knee"/>
<Segment NAME="Torsioned"><JointDummy NAME="Turn"/></Segment></Segment></Segment>
<Segment NAME="Trunk"><JointFree/></Segment></Segment></Skeleton>
<MarkerSet><Markers>
<Marker NAME="ASI" POSITION="43.5 -107.25 1e2" SEGMENT="Pelvis" STATUS="required"/>
<Marker NAME="THI" POSITION="0 KNEy THIz" SEGMENT="Femur" STATUS="optional"/>
<Marker NAME="ANK" POSITION=" 0 35 0 " SEGMENT="Torsioned"/></Markers>
<Sticks><Stick MARKER1="ASI" MARKER2="THI"/><Stick MARKER1="ASI" MARKER2="HEE"/></Sticks></MarkerSet></KinematicModel>)";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

std::string bad(const std::string& xml) {
  const auto vsk = parse_vsk(xml, "s.vsk");
  EXPECT_FALSE(vsk) << xml;
  if (vsk) return "";
  EXPECT_EQ(vsk.error().code, Code::bad_input);
  EXPECT_EQ(vsk.error().message.find('\n'), std::string::npos) << "one sentence";
  EXPECT_TRUE(vsk.error().message.starts_with("s.vsk: "));
  return vsk.error().message;
}

TEST(Vsk, SegmentsHangOnTheirParents) {
  const auto vsk = parse_vsk(kLeg, "s");
  ASSERT_TRUE(vsk) << vsk.error().message;
  EXPECT_EQ(vsk->model, "Leg");
  std::vector<std::string> names;
  std::vector<int> parents;
  std::vector<std::string_view> kinds;
  for (const auto& segment : vsk->segments) {
    names.push_back(segment.name);
    parents.push_back(segment.parent);
    kinds.push_back(to_string(segment.kind));
  }
  EXPECT_THAT(names, ElementsAre("Pelvis", "Femur", "Tibia", "Torsioned", "Trunk"));
  EXPECT_THAT(parents, ElementsAre(-1, 0, 1, 2, 0));
  EXPECT_THAT(kinds, ElementsAre("free", "ball", "hinge", "fixed", "free"));
  EXPECT_EQ(vsk->segments[2].joint, "Knee");
  EXPECT_EQ(vsk->segments[4].joint, "");
}

TEST(Vsk, MarkersLieInTheirSegments) {
  const auto vsk = parse_vsk(kLeg, "s");
  ASSERT_TRUE(vsk) << vsk.error().message;
  ASSERT_THAT(vsk->markers, SizeIs(3));
  EXPECT_EQ(vsk->markers[0].x_in_segment, Eigen::Vector3d(0.0435, -0.10725, 0.1));
  EXPECT_FALSE(vsk->markers[1].x_in_segment) << "an expression";
  EXPECT_EQ(vsk->markers[2].segment, 3);
  EXPECT_TRUE(vsk->markers[0].required);
  EXPECT_FALSE(vsk->markers[1].required);
  EXPECT_THAT(vsk->sticks, ElementsAre(Pair(0, 1)));
  EXPECT_THAT(vsk->warnings, ElementsAre("1 stick left out, as they join markers that are not there"));
}

TEST(Vsk, MeasuresAreInUnits) {
  const auto vsk = parse_vsk(kLeg, "s");
  ASSERT_TRUE(vsk) << vsk.error().message;
  ASSERT_THAT(vsk->parameters, SizeIs(5));
  EXPECT_EQ(vsk->parameters[0].unit, "kg");
  EXPECT_EQ(vsk->parameters[0].value, 75.0);
  EXPECT_EQ(vsk->parameters[1].unit, "m");
  EXPECT_EQ(vsk->parameters[1].value, 0.105);
  EXPECT_EQ(vsk->parameters[2].unit, "rad");
  EXPECT_EQ(vsk->parameters[2].value, 0.25);
  EXPECT_FALSE(vsk->parameters[3].value);
  EXPECT_EQ(vsk->parameters[3].expression, "KneeWidth / 2");
  EXPECT_EQ(vsk->parameters[4].unit, "") << "of no stated quantity: as it is";
  EXPECT_EQ(vsk->parameters[4].value, -226.5);
}

TEST(Vsk, ATargetTellsWhereAMarkerIsThatDoesNotSaySo) {
  const auto vsk = parse_vsk(R"(<KinematicModel MODEL="New">
  <Skeleton><Segment NAME="Pelvis"><JointFree/><Segment NAME="Femur"><JointBall NAME="Hip"/></Segment></Segment></Skeleton>
  <MarkerSet><Markers>
    <Marker NAME="ASI" STATUS="required"/><Marker NAME="THI" STATUS="optional"/>
    <Marker NAME="SAC" SEGMENT="Pelvis" POSITION="1 2 3"/></Markers></MarkerSet>
  <TargetSet><Targets>
    <TargetLocalPointToWorldPoint MARKER="THI" SEGMENT="Femur" POSITION="10 20 30"/>
    <TargetLocalPointToWorldPoint MARKER="THI" SEGMENT="Pelvis" POSITION="0 0 0"/>
    <TargetLocalPointToWorldPoint MARKER="SAC" SEGMENT="Femur" POSITION="0 0 0"/>
    <TargetLocalPointToWorldPoint MARKER="ASI" SEGMENT="Pelvis" POSITION="ASI_X 0 0"/></Targets></TargetSet>
</KinematicModel>)",
                             "new.vst");
  ASSERT_TRUE(vsk) << vsk.error().message;
  ASSERT_EQ(vsk->markers.size(), 3U);
  EXPECT_EQ(vsk->markers[0].segment, 0);
  EXPECT_FALSE(vsk->markers[0].x_in_segment) << "an expression";
  EXPECT_TRUE(vsk->markers[0].required);
  EXPECT_EQ(vsk->markers[1].segment, 1);
  EXPECT_EQ(vsk->markers[1].x_in_segment.value(), Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_FALSE(vsk->markers[1].required);
  EXPECT_EQ(vsk->markers[2].segment, 0) << "its own word goes before a target's";
  EXPECT_EQ(vsk->markers[2].x_in_segment.value(), Eigen::Vector3d(0.001, 0.002, 0.003));
}

TEST(Vsk, SaysWhatIsWrong) {
  EXPECT_THAT(bad("<KinematicModel"), HasSubstr("is not XML that can be read"));
  EXPECT_THAT(bad(""), HasSubstr("is not XML that can be read"));
  EXPECT_THAT(bad("<OpenSimDocument/>"), HasSubstr("has no element <KinematicModel>"));
  EXPECT_THAT(bad("<KinematicModel/>"), HasSubstr("has no <Segment> in a <Skeleton>"));
  EXPECT_THAT(bad(with(kLeg, "\"Femur\"", "\"Pelvis\"")),
              HasSubstr("two elements <Segment> are called 'Pelvis'"));
  EXPECT_THAT(bad(with(kLeg, "<Segment NAME=\"Femur\">", "<Segment>")), HasSubstr("a <Segment> has no NAME"));
  EXPECT_THAT(bad(with(kLeg, "<JointHinge NAME=\"Knee\"/>", "")), HasSubstr("segment 'Tibia' has no joint"));
  EXPECT_THAT(bad(with(kLeg, "JointHinge", "JointGlue")),
              HasSubstr("segment 'Tibia' has a <JointGlue>, which is none of Vicon's joints"));
  EXPECT_THAT(bad(with(kLeg, "SEGMENT=\"Femur\"", "SEGMENT=\"Thigh\"")),
              HasSubstr("marker 'THI' is on segment 'Thigh', which is not there"));
  EXPECT_THAT(bad(with(kLeg, " SEGMENT=\"Femur\"", "")),
              HasSubstr("marker 'THI' is on no segment, neither by"));
  EXPECT_THAT(bad(with(kLeg, "\"THI\" POS", "\"ASI\" POS")),
              HasSubstr("two elements <Marker> are called 'ASI'"));
  EXPECT_THAT(bad(with(kLeg, "VALUE=\"75\"", "VALUE=\"heavy\"")),
              HasSubstr("parameter 'Mass' is 'heavy'; expected a number"));
  EXPECT_THAT(bad(with(kLeg, "VALUE=\"75\"", "VALUE=\"inf\"")), HasSubstr("parameter 'Mass' is 'inf'"));
}

TEST(Vsk, WhatIsDeepOrLongIsRefused) {
  std::string deep = "<KinematicModel><Skeleton>";
  for (int i = 0; i < 200; ++i) deep += "<Segment NAME=\"s" + std::to_string(i) + "\"><JointFree/>";
  for (int i = 0; i < 200; ++i) deep += "</Segment>";
  EXPECT_THAT(bad(deep + "</Skeleton></KinematicModel>"), HasSubstr("segments are nested deeper than 100"));
  EXPECT_THAT(bad(std::string((4UL << 20) + 1, ' ')), HasSubstr("are read of a skeleton"));
}

TEST(Vsk, AFileThatIsNotThere) {
  const auto vsk = read_vsk("no/such.vsk");
  ASSERT_FALSE(vsk);
  EXPECT_EQ(vsk.error().code, Code::io);
  EXPECT_TRUE(is_vsk_ending(".vst"));
  EXPECT_FALSE(is_vsk_ending(".xml"));
}

TEST(VskData, ASubjectOfPlugInGait) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto vsk = read_vsk(data / "pycgm-rom/Sample_SM.vsk");
  ASSERT_TRUE(vsk) << vsk.error().message;
  EXPECT_EQ(vsk->model, "PlugInGait");
  EXPECT_THAT(vsk->segments, SizeIs(19));
  EXPECT_THAT(vsk->markers, SizeIs(35));
  EXPECT_THAT(vsk->sticks, SizeIs(54));
  EXPECT_THAT(vsk->parameters, SizeIs(112));
  EXPECT_THAT(vsk->warnings, IsEmpty());
  EXPECT_TRUE(std::ranges::all_of(vsk->markers, [](const auto& m) { return m.x_in_segment.has_value(); }));
  const auto height = std::ranges::find(vsk->parameters, "Height", &VskParameter::name);
  ASSERT_NE(height, vsk->parameters.end());
  EXPECT_EQ(height->value, 1.76);
}

}  // namespace
}  // namespace kinemark::io
