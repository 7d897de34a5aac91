// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/output_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/workflow/segments/testing/offset_leg.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// The leg's own outputs beside those that are computed where a file says something else.
OutputComparison compared(const data::Trial& trial, std::vector<analysis::SubjectValue> known,
                          std::vector<analysis::SubjectValue> given = {}) {
  const auto definition = pipeline::find_definition("pig");
  EXPECT_TRUE(definition) << definition.error().message;
  const analysis::SegmentInput input{
      .markers = &trial.markers, .given = std::move(given), .known = std::move(known)};
  const auto motion = analysis::compute_segments(*definition, input);
  EXPECT_TRUE(motion) << motion.error().message;
  auto out = compare_outputs(*definition, input, {}, *motion, trial);
  EXPECT_TRUE(out) << out.error().message;
  return std::move(*out);
}

OutputComparison compared_but(const OffsetLeg& leg, const std::string& name, double value) {
  auto known = leg.values();
  for (auto& one : known)
    if (one.name == name) one.value = value;
  return compared(leg.trial(60, true), known);
}

std::vector<std::string> explained(const OutputComparison& c) {
  std::vector<std::string> out;
  for (const auto& p : c.explanation.parameters) out.push_back(p.name);
  for (const auto& p : c.explanation.points) out.push_back(p);
  return out;
}

TEST(OutputComparison, SaysThatTheyAgree) {
  const OffsetLeg leg;
  const auto c = compared(leg.trial(60, true), leg.values());
  EXPECT_EQ(c.outputs.size(), 4U) << "an angle and three centres";
  EXPECT_TRUE(c.agrees());
  EXPECT_THAT(c.findings(), IsEmpty());
  EXPECT_THAT(c.summary(), HasSubstr("agrees with the file's own 1 angle to"));
  EXPECT_THAT(c.summary(), HasSubstr("3 centres to"));
  EXPECT_THAT(c.summary(), Not(HasSubstr("95 % of frames below")));
}

TEST(OutputComparison, IsEmptyWithoutOutputs) {
  const OffsetLeg leg;
  EXPECT_TRUE(compared(leg.trial(60, false), leg.values()).empty());
}

TEST(OutputComparison, NamesTheParameterThatExplainsADifference) {
  double side = -1.0;
  for (const auto& [name, value] : {std::pair{"ThighRotation", -0.2},
                                    {"ThighRotation", -0.2},
                                    {"ShankRotation", 0.1},
                                    {"TibialTorsion", -0.1},
                                    {"AnkleAbAdd", 0.05},
                                    {"KneeWidth", 0.12}}) {
    side = -side;  // both legs, the first parameter on each
    const OffsetLeg leg{.side = side};
    const std::string parameter = leg.letter() + name;
    const auto c = compared_but(leg, parameter, value);
    EXPECT_FALSE(c.agrees()) << parameter;
    EXPECT_THAT(explained(c), ::testing::ElementsAre(parameter));
    ASSERT_EQ(c.findings().size(), 1U) << parameter;
    EXPECT_THAT(c.findings().front(),
                HasSubstr("The difference from the file's own outputs is explained by " + parameter));
    EXPECT_THAT(c.findings().front(), Not(HasSubstr("No parameter of the model that can be read")));
    EXPECT_THAT(c.findings().front(), Not(HasSubstr("are those of a static trial, and it was computed")));
    EXPECT_THAT(c.summary(), HasSubstr("95 % of frames below"));
    EXPECT_THAT(c.summary(), HasSubstr("differs from the file's own"));
    EXPECT_LT(c.explanation.angle_rad, 1e-6);
  }
}

TEST(OutputComparison, NamesTheDiameterThatSomebodyGave) {
  const OffsetLeg leg{.diameter = 0.009};
  const auto c = compared(leg.trial(60, true), leg.values(), {{"MarkerDiameter", 0.014, "--subject"}});
  EXPECT_THAT(explained(c), ::testing::ElementsAre("MarkerDiameter"));
  EXPECT_THAT(c.findings().front(),
              HasSubstr("(the file's outputs were made with 9 mm, here 14 mm from --subject"));
  EXPECT_THAT(c.findings().front(), Not(HasSubstr("by another regression (")));
}

TEST(OutputComparison, NamesHipsOfAnotherRegression) {
  const OffsetLeg leg{.hip_forward = 0.012};
  const auto c = compared(leg.trial(60, true), leg.values());
  EXPECT_THAT(explained(c), ::testing::ElementsAre("LHJC"));
  EXPECT_THAT(c.findings().front(), HasSubstr("LHJC by another regression (12 mm away)"));
  EXPECT_THAT(c.findings().front(), Not(HasSubstr("(the file's outputs were made with")));
}

TEST(OutputComparison, SaysThatMarkersWereChangedOnlyWhereAConstantVaries) {
  const OffsetLeg leg{.wobble = 0.05};
  const auto c = compared(leg.trial(60, true), leg.values());
  EXPECT_THAT(c.findings(), Contains(HasSubstr("Markers were changed after the file's model ran on them")));
  EXPECT_THAT(c.findings(), Contains(HasSubstr("LThighRotation by +-")));
  const auto other = compared_but(OffsetLeg{}, "LThighRotation", -0.2);
  EXPECT_THAT(other.findings(), Each(Not(HasSubstr("Markers were changed"))));
}

TEST(OutputComparison, SaysThatNothingExplainsIt) {
  const OffsetLeg leg;
  auto trial = leg.trial(60, true);
  for (std::size_t i = 0; i < trial.channels.values.size(); i += 3) trial.channels.values[i] += 2.0;
  const auto c = compared(trial, leg.values());
  EXPECT_THAT(explained(c), IsEmpty());
  EXPECT_THAT(c.findings(), ::testing::ElementsAre(HasSubstr("No parameter of the model that can be read")));
  for (const auto& finding : c.findings())
    EXPECT_THAT(finding, Not(HasSubstr("file's own outputs is explained by")));
}

TEST(OutputComparison, SaysThatAnglesAreThoseOfAStaticTrial) {
  const OffsetLeg leg;
  auto trial = leg.trial(60, true);
  const auto definition = pipeline::find_definition("pig");
  ASSERT_TRUE(definition);
  const auto still = analysis::compute_segments(
      *definition, {.markers = &trial.markers, .static_trial = &trial.markers, .known = leg.values()});
  ASSERT_TRUE(still) << still.error().message;
  const auto knee = std::ranges::find(still->angles, "LKneeAngles", &analysis::SegmentSeries::name);
  ASSERT_NE(knee, still->angles.end());
  for (std::size_t i = 0; i < trial.channels.values.size(); ++i)
    trial.channels.values[i] = knee->value[i] * 180.0 / 3.14159265358979323846;
  const auto c = compared(trial, leg.values());
  EXPECT_TRUE(c.static_outputs);
  EXPECT_THAT(c.findings(), ::testing::ElementsAre(HasSubstr(
                                "those of a static trial, and it was computed as a moving one: name it")));
  EXPECT_THAT(explained(c), IsEmpty());
}

TEST(OutputComparison, FindsOutputsWithASuffixAndPassesOverMissingOnes) {
  const OffsetLeg leg;
  auto trial = leg.trial(60, true);
  trial.channels.names = {"Ann:LKneeAngles_M"};
  for (std::size_t k = 0; k < 30; ++k) trial.channels.values[k] = 0.0;
  const auto c = compared(trial, leg.values());
  ASSERT_FALSE(c.empty());
  EXPECT_EQ(c.outputs.front().theirs, "Ann:LKneeAngles_M");
  EXPECT_EQ(c.outputs.front().frames, 50);
  EXPECT_TRUE(c.agrees());
}

}  // namespace
}  // namespace kinemark::workflow
