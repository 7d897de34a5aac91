// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/pipeline/segments/definition_file.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::string_view kShank = R"toml(
sides = [["L", "Left", 1], ["R", "Right", -1]]
[[segment]]
name = "{S}Shank"
origin = "{S}ANK"
first = ["z", "{S}KNE - {S}ANK"]
second = ["y", "{S}MED - {S}ANK"]
[[value]]
name = "height"
formula = "z(LANK)"
[[body]]
name = "{S}Shank"
segment = "{S}Shank"
mass = "3"
centre = "mean({S}ANK, {S}KNE)"
gyration = ["0.1", "0.1", "0"]
floor = ["{S}ANK"]
ground_reaction = "{S}Ground"
[[joint]]
name = "{S}Knee"
centre = "{S}KNE"
parent = "lab"
child = "{S}Shank"
bodies = ["{S}Shank"]
per = "70"
moment = [["extension", "-y"], ["valgus", "{+}x"], ["rotation", "z"]]
force = [["anterior", "x"], ["left", "y"], ["tension", "z"]]
)toml";

std::string with(std::string_view what, std::string_view by) {
  std::string text(kShank);
  const auto found = text.find(what);
  EXPECT_NE(found, std::string::npos) << what;
  return text.replace(found, what.size(), by);
}

std::string complaint(const std::string& text) {
  const auto read = parse_definition(text, "d.toml");
  return read ? "" : read.error().message;
}

TEST(DefinitionKinetics, ReadsBodiesAndJointsOfBothSides) {
  const auto read = parse_definition(kShank, "d.toml");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_THAT(read->bodies, SizeIs(2));
  EXPECT_EQ(read->bodies[1].name, "RShank");
  EXPECT_THAT(read->bodies[1].floor, SizeIs(1));
  EXPECT_EQ(read->bodies[0].ground_reaction, "LGround");
  ASSERT_THAT(read->joints, SizeIs(2));
  EXPECT_EQ(read->joints[0].moment[0].label, "extension");
  EXPECT_EQ(read->joints[0].moment[0].sign, -1.0);
  EXPECT_EQ(read->joints[0].moment[1].sign, 1.0);
  EXPECT_EQ(read->joints[1].moment[1].sign, -1.0);
  EXPECT_EQ(read->joints[1].force[2].axis, 2);
}

TEST(DefinitionKinetics, ConventionalGaitModelHasThreeJointsALeg) {
  const auto pig = find_definition("pig");
  ASSERT_TRUE(pig);
  EXPECT_THAT(pig->joints, SizeIs(6));
  EXPECT_THAT(pig->bodies, SizeIs(6));
}

TEST(DefinitionKinetics, SaysWhatIsWrong) {
  EXPECT_THAT(complaint(with(R"(["0.1", "0.1", "0"])", R"(["0.1", "0.1"])")),
              HasSubstr("body 'LShank': gyration: expected radii about x, y and z, three formulas"));
  EXPECT_THAT(complaint(with(R"(["tension", "z"])", R"(["tension", "y"])")),
              HasSubstr("joint 'LKnee': force: expected three of [\"LABEL\", \"-y\"], an axis each"));
  EXPECT_THAT(complaint(with(R"(["extension", "-y"], )", "")),
              HasSubstr("joint 'LKnee': moment: expected three"));
  EXPECT_THAT(complaint(with(R"(bodies = ["{S}Shank"])", R"(bodies = ["{S}Foot"])")),
              HasSubstr("joint 'LKnee': no body is called 'LFoot'"));
  EXPECT_THAT(complaint(with(R"(bodies = ["{S}Shank"])", R"(bodies = ["LShank", "LShank"])")),
              HasSubstr("joint 'LKnee': body 'LShank' stands there twice"));
  EXPECT_THAT(complaint(with(R"(bodies = ["{S}Shank"])", "bodies = []")),
              HasSubstr("joint 'LKnee': no body is beyond it"));
  EXPECT_THAT(complaint(with(R"(child = "{S}Shank")", R"(child = "{S}Calf")")),
              HasSubstr("joint 'LKnee': no segment is called 'LCalf'"));
  EXPECT_THAT(complaint(with(R"(segment = "{S}Shank")", R"(segment = "{S}Calf")")),
              HasSubstr("body 'LShank': no segment is called 'LCalf'"));
  EXPECT_THAT(complaint(with(R"(mass = "3")", "")), HasSubstr("mass"));
  EXPECT_THAT(complaint(with(R"(mass = "3")", R"(mass = "3 +")")), HasSubstr("body 'LShank': mass: "));
  EXPECT_THAT(complaint(with(R"(floor = ["{S}ANK"])", "")),
              HasSubstr("body 'LShank': ground_reaction needs points of the 'floor'"));
}

TEST(DefinitionKinetics, NamesOfResultsStandOnce) {
  EXPECT_THAT(complaint(with(R"(name = "height")", R"(name = "LKneeMoment")")),
              HasSubstr("'LKneeMoment': every angle and value needs a name of its own"));
}

}  // namespace
}  // namespace kinemark::pipeline
