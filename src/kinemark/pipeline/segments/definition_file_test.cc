// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/definition_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::string_view kGood = R"toml(
title = "One leg"
sides = [["L", "Left", 1], ["R", "Right", -1]]
[progression]
point = "LASI"
facing = "foot.x"
[[parameter]]
name = "{S}Width"
also = ["{Side}Width"]
quantity = "length"
formula = "0.1"
[[point]]
name = "{S}JC"
written = true
formula = "{S}ANK {+} vector(0, {S}Width, 0)"
[[segment]]
name = "foot"
trial = "static"
origin = "LJC"
first = ["z", "LANK - LTOE"]
second = ["y", "LANK"]
turns = [["x", "0.1"], ["z", "-LWidth"]]
[[landmark]]
name = "heel"
segment = "foot"
formula = "LHEE"
[[angle]]
name = "{S}Ankle"
parent = "lab"
child = "foot"
sequence = "yxz"
components = [["flexion", "y", -90], ["inversion", "{-}x"], ["rotation", "3"]]
[[value]]
name = "height"
quantity = "length"
formula = "z(LANK)"
)toml";

std::string trouble(const std::string& text) {
  const auto read = parse_definition(text, "d.toml");
  return read ? "" : read.error().message;
}
std::string changed(std::string_view what, std::string_view by) {
  std::string text(kGood);
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(DefinitionFile, ReadsAnEntryForEachSide) {
  const auto read = parse_definition(kGood, "d.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->title, "One leg");
  ASSERT_THAT(read->parameters, SizeIs(2));
  EXPECT_EQ(read->parameters[1].name, "RWidth");
  EXPECT_EQ(read->parameters[1].also, std::vector<std::string>{"RightWidth"});
  ASSERT_THAT(read->points, SizeIs(2));
  EXPECT_EQ(read->points[0].formula.name, "+");
  EXPECT_EQ(read->points[1].formula.name, "-");
  EXPECT_TRUE(read->points[0].written);
  ASSERT_THAT(read->segments, SizeIs(1));
  EXPECT_EQ(read->segments[0].trial, analysis::InTrial::fixed);
  EXPECT_THAT(read->segments[0].turns, SizeIs(2));
  ASSERT_THAT(read->angles, SizeIs(2));
  const auto& right = read->angles[1];
  EXPECT_EQ(right.sequence, (analysis::AngleSequence{1, 0, 2}));
  EXPECT_EQ(right.components[0].index, 0);
  EXPECT_DOUBLE_EQ(right.components[0].offset_rad, -0.5 * std::numbers::pi);
  EXPECT_EQ(right.components[1].index, 1);
  EXPECT_EQ(right.components[1].sign, 1.0);
  EXPECT_EQ(read->angles[0].components[1].sign, -1.0);
  EXPECT_EQ(right.components[2].index, 2);
  EXPECT_EQ(read->landmarks[0].trial, "static");
  EXPECT_EQ(read->values[0].quantity, analysis::SubjectQuantity::length);
  EXPECT_TRUE(read->progression.has_value());
}

TEST(DefinitionFile, NamesThePlaceOfWhatIsWrong) {
  for (const auto& [what, by, words] : std::vector<std::array<std::string, 3>>{
           {"title =", "titel =", "d.toml: 'titel' is not read; there are title, sides"},
           {"1], [\"R\", \"Right\", -1]", "2]", "sides are lists of a letter, a word and 1 or -1"},
           {"formula = \"0.1\"", "formula = \"0.1 +\"", "parameter 'LWidth': formula: column"},
           {"formula = \"0.1\"", "formla = \"0.1\"", "formla"},
           {"quantity = \"length\"", "quantity = \"speed\"", "\"number\", \"length\", \"angle\" or \"mass\""},
           {"trial = \"static\"", "trial = \"still\"", "\"any\", \"static\" or \"moving\""},
           {"origin = \"LJC\"", "", "segment 'foot': origin is missing"},
           {"[\"z\", \"LANK - LTOE\"]", "[\"w\", \"LANK\"]", "segment 'foot': first: expected"},
           {"[[\"x\", \"0.1\"],", "[[\"x\"],", "segment 'foot': turns: expected"},
           {"sequence = \"yxz\"", "sequence = \"yyz\"", "angle 'LAnkle': sequence: 'yyz' is no sequence"},
           {"[\"rotation\", \"3\"]", "[\"rotation\", \"4\"]", "angle 'LAnkle': components: expected three"},
           {", [\"rotation\", \"3\"]", "", "angle 'LAnkle': needs three components"},
           {"child = \"foot\"", "child = \"shank\"", "no segment is called 'shank'"},
           {"point = \"LASI\"", "", "progression: point is missing"}}) {
    const auto said = trouble(changed(what, by));
    EXPECT_THAT(said, HasSubstr(words)) << what << " -> " << by;
    EXPECT_THAT(said, HasSubstr("d.toml"));
  }
  EXPECT_THAT(trouble("point = 3"), HasSubstr("'point' is not read"));
  EXPECT_THAT(trouble("point = [3]"), HasSubstr("expected [[point]] tables"));
  EXPECT_THAT(trouble("title = \"nothing\""), HasSubstr("nothing to compute"));
}

TEST(DefinitionFile, ReadsWhatIsAssumedAndHowOutputsShowIt) {
  const std::string parameter = R"toml(
angular_span = 2
[[parameter]]
name = "Turn"
quantity = "angle"
formula = "0"
entered_first = true
assumed_sd = "0.2"
zero_sd = "0.1"
shown = ["x(A)", "y(A)"]
shown_in = "any"
choices = [1.0, 0.0]
chosen_by = ["Other"]
[[point]]
name = "Place"
formula = "A"
also = ["APO"]
regression = true
written = true
)toml";
  const auto read = parse_definition(parameter, "d.toml");
  ASSERT_TRUE(read) << read.error().message;
  const auto& p = read->parameters.front();
  EXPECT_TRUE(p.entered_first && p.assumed_sd && p.zero_sd && p.shown_anywhere);
  EXPECT_EQ(p.shown.size(), 2U);
  EXPECT_EQ(p.choices.size(), 2U);
  EXPECT_EQ(p.chosen_by.front(), "Other");
  EXPECT_EQ(read->angular_span, 2);
  EXPECT_EQ(read->points.front().also.front(), "APO");
  EXPECT_TRUE(read->points.front().regression);
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string text = parameter;
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_THAT(trouble(with("angular_span = 2", "angular_span = 3")), HasSubstr("expected 0, 1 or 2 frames"));
  EXPECT_THAT(trouble(with("\"any\"", "\"static\"")), HasSubstr("\"moving\" or \"any\""));
  EXPECT_THAT(trouble(with("\"y(A)\"", "\"y(A\"")), HasSubstr("parameter 'Turn': shown: column"));
}

TEST(DefinitionFile, AxesThatASequenceHasTwiceAreNamedByTheirOrder) {
  EXPECT_THAT(trouble(changed("sequence = \"yxz\"", "sequence = \"yxy\"")), HasSubstr("1, 2, 3"));
  const auto euler =
      changed("sequence = \"yxz\"\ncomponents = [[\"flexion\", \"y\", -90]",
              "sequence = \"yxy\"\nsecond_negative = true\ncomponents = [[\"flexion\", \"1\"]");
  const auto read = parse_definition(euler, "d.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->angles[0].second_negative);
  const auto helical = changed(
      "sequence = \"yxz\"\ncomponents = [[\"flexion\", \"y\", -90], [\"inversion\", \"{-}x\"], "
      "[\"rotation\", \"3\"]]",
      "sequence = \"helical\"\ncomponents = [[\"a\", \"x\"], [\"b\", \"y\"], [\"c\", \"z\"]]");
  EXPECT_TRUE(parse_definition(helical, "d.toml").value().angles[0].helical);
}

TEST(DefinitionFile, ShippedOnesAreGood) {
  for (const auto& shipped : shipped_definitions()) {
    const auto read = find_definition(std::string(shipped.name));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->title.empty());
    EXPECT_GE(read->angles.size(), 5U);
  }
  EXPECT_THAT(find_definition("pigg").error().message,
              HasSubstr("'pigg' is no definition of segments; expected pig, isb-shoulder"));
  EXPECT_EQ(find_definition("pigg").error().code, Code::usage);
  EXPECT_EQ(find_definition("nothing.toml").error().code, Code::io);
  const testing_support::ScratchFolder scratch;
  std::ofstream(scratch / "d.toml") << kGood;
  EXPECT_TRUE(find_definition((scratch / "d.toml").string()));
}

}  // namespace
}  // namespace kinemark::pipeline
