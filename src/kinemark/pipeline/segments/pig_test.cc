// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The shipped conventional gait model on a leg whose axes are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"
#include "kinemark/workflow/segments/testing/offset_leg.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;
using workflow::OffsetLeg;

constexpr double kLeg = 0.92, kKnee = 0.102, kAnkle = 0.07, kMarker = 0.014, kAsis = 0.24, kWand = 0.25;

// The left hip by Davis' regression, written out, in a pelvis whose axes are the laboratory's.
Vector3d left_hip(const Vector3d& pelvis) {
  const double depth = 0.115 * kLeg - 0.0153, trochanter = 0.1288 * kLeg - 0.04856 + 0.5 * kMarker;
  return pelvis + Vector3d(depth * std::cos(0.5) * std::sin(0.314) - trochanter * std::cos(0.314),
                           0.5 * kAsis - depth * std::sin(0.5),
                           -depth * std::cos(0.5) * std::cos(0.314) - trochanter * std::sin(0.314));
}

// Left leg with a knee that flexes about its axis by `flexion` in each frame; the thigh's wand is turned off
// that axis by kWand. With a knee alignment device, or with the marker at the knee.
data::Trajectories leg(const std::vector<double>& flexion, bool device) {
  auto out = data::Trajectories::all_missing({"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK",
                                              "LHEE", "LTOE", "LKAX", "LKD1", "LKD2"},
                                             {.rate_hz = 100.0, .frames = std::ssize(flexion)});
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const Vector3d pelvis(0.1, 0.2, 1.0), x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
    const Vector3d hip = left_hip(pelvis), knee = hip - 0.4 * z;
    const Matrix3d shank = Eigen::AngleAxisd(flexion[static_cast<std::size_t>(f)], y).toRotationMatrix();
    const Vector3d ankle = knee - 0.4 * shank.col(2), marker = knee + 0.5 * (kKnee + kMarker) * y;
    const Vector3d wand = Eigen::AngleAxisd(kWand, z) * y;
    std::map<std::string, Vector3d> at{{"LASI", pelvis + 0.5 * kAsis * y},
                                       {"RASI", pelvis - 0.5 * kAsis * y},
                                       {"LPSI", pelvis + 0.05 * y - 0.15 * x},
                                       {"RPSI", pelvis - 0.05 * y - 0.15 * x},
                                       {"LTHI", knee + 0.2 * z + 0.12 * wand},
                                       {"LTIB", knee - 0.2 * shank.col(2) + 0.09 * y},
                                       {"LANK", ankle + 0.5 * (kAnkle + kMarker) * y},
                                       {"LHEE", ankle + shank * Vector3d(-0.06, 0.0, -0.05)},
                                       {"LTOE", ankle + shank * Vector3d(0.15, 0.02, -0.05)}};
    if (device)
      at.insert({{"LKAX", marker + 0.1 * y},
                 {"LKD1", marker + 0.1 * (x + z).normalized()},
                 {"LKD2", marker + 0.1 * (x - z).normalized()}});
    else
      at["LKNE"] = marker;
    for (const auto& [name, position] : at) {
      const auto m = out.find(name);
      out.x(f, m) = position;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

analysis::SegmentMotion computed(const data::Trajectories& markers, const data::Trajectories* still) {
  const auto definition = find_definition("pig");
  EXPECT_TRUE(definition);
  auto motion = analysis::compute_segments(*definition, {.markers = &markers,
                                                         .static_trial = still,
                                                         .given = {{"LLegLength", kLeg, "test"},
                                                                   {"RLegLength", kLeg, "test"},
                                                                   {"LKneeWidth", kKnee, "test"},
                                                                   {"LAnkleWidth", kAnkle, "test"}}});
  EXPECT_TRUE(motion) << motion.error().message;
  return std::move(*motion);
}

const analysis::SegmentSeries& angle(const analysis::SegmentMotion& motion, const std::string& name) {
  for (const auto& series : motion.angles)
    if (series.name == name) return series;
  ADD_FAILURE() << name;
  return motion.angles.front();
}

double parameter(const analysis::SegmentMotion& motion, const std::string& name) {
  for (const auto& used : motion.parameters)
    if (used.name == name) return used.value;
  return std::nan("");
}

const std::vector<double> kFlexion{0.0, 0.3, 0.6, 0.9};

TEST(ConventionalGaitModel, HasItsHipByTheRegression) {
  const auto walk = leg(kFlexion, false);
  const auto motion = computed(walk, nullptr);
  EXPECT_LT((motion.points.x(0, motion.points.find("LHJC")) - left_hip({0.1, 0.2, 1.0})).norm(), 1e-9);
  EXPECT_EQ(motion.points.find("RKJC"), -1) << "the right leg has no markers";
}

TEST(ConventionalGaitModel, FindsTheKneesAxisWithAnAlignmentDevice) {
  const auto still = leg({0.0, 0.0}, true), walk = leg(kFlexion, false);
  const auto motion = computed(walk, &still);
  EXPECT_NEAR(parameter(motion, "LThighRotation"), kWand, 1e-9) << "the wand is behind the axis";
  const auto& knee = angle(motion, "LKneeAngles");
  for (std::size_t f = 0; f < kFlexion.size(); ++f) {
    EXPECT_NEAR(knee.value[3 * f], kFlexion[f], 1e-9);
    EXPECT_NEAR(knee.value[3 * f + 1], 0.0, 1e-9);
  }
  EXPECT_LT(
      (motion.points.x(0, motion.points.find("LKJC")) - (left_hip({0.1, 0.2, 1.0}) - Vector3d(0, 0, 0.4)))
          .norm(),
      1e-9);
}

TEST(ConventionalGaitModel, SeesAWrongAxisWithoutIt) {
  const auto still = leg({0.0, 0.0}, false), walk = leg(kFlexion, false);
  const auto motion = computed(walk, &still);
  EXPECT_EQ(parameter(motion, "LThighRotation"), 0.0);
  EXPECT_GT(std::abs(angle(motion, "LKneeAngles").value[3 * 3 + 1]), 0.1);
}

TEST(ConventionalGaitModel, HasAFlatFootInTheStaticTrial) {
  const auto still = leg({0.0, 0.0}, true), walk = leg(kFlexion, false);
  const auto standing = computed(still, &still), moving = computed(walk, &still);
  EXPECT_NEAR(angle(standing, "LAnkleAngles").value[0], 0.0, 1e-9) << "foot and shank are perpendicular";
  EXPECT_TRUE(std::isnan(parameter(computed(walk, nullptr), "LStaticPlantFlex")));
  EXPECT_TRUE(std::isfinite(parameter(moving, "LStaticPlantFlex")));
}

// What was used for a parameter.
const analysis::UsedParameter& used(const analysis::SegmentMotion& motion, const std::string& name) {
  for (const auto& one : motion.parameters)
    if (one.name == name) return one;
  ADD_FAILURE() << name;
  return motion.parameters.front();
}

analysis::SegmentMotion computed_of(const OffsetLeg& leg, const data::Trajectories& markers,
                                    const std::vector<std::string>& withheld) {
  analysis::SegmentInput input{.markers = &markers};
  for (const auto& value : leg.values())
    if (std::ranges::find(withheld, value.name) == withheld.end()) input.known.push_back(value);
  auto motion = analysis::compute_segments(*find_definition("pig"), input, {.noise_sd_m = 1e-6});
  EXPECT_TRUE(motion) << motion.error().message;
  return std::move(*motion);
}

class OffsetLegs : public ::testing::TestWithParam<double> {};

TEST_P(OffsetLegs, HaveTheAnglesAndCentresThatTheyWereBuiltWith) {
  const OffsetLeg leg{.side = GetParam()};
  const auto trial = leg.trial(20, false);
  const auto motion = computed_of(leg, trial.markers, {});
  const auto& knee = angle(motion, leg.letter() + "KneeAngles");
  for (std::int64_t f = 0; f < 20; ++f) {
    const auto i = static_cast<std::size_t>(3 * f);
    EXPECT_NEAR(knee.value[i], OffsetLeg::flexion(f), 1e-9);
    EXPECT_NEAR(knee.value[i + 1], 0.0, 1e-9);
    EXPECT_NEAR(knee.value[i + 2], 0.0, 1e-9);
    const auto points = leg.points(f);
    for (const auto& [ours, theirs] : {std::pair{"KJC", "FEO"}, {"AJC", "TIO"}, {"HJC", "FEP"}})
      EXPECT_LT(
          (motion.points.x(f, motion.points.find(leg.letter() + ours)) - points.at(leg.letter() + theirs))
              .norm(),
          1e-9)
          << ours;
  }
  EXPECT_TRUE(used(motion, "MarkerDiameter").assumed);
  EXPECT_NEAR(used(motion, "MarkerDiameter").sd, 0.002, 1e-12);
}

TEST_P(OffsetLegs, HoldTheTruthInTheirDeviationsWhereMeasuresAreWithheld) {
  for (const double diameter : {0.0105, 0.0175}) {
    const OffsetLeg leg{.side = GetParam(), .diameter = diameter};
    const auto trial = leg.trial(20, false);
    const std::string s = leg.letter();
    const auto motion =
        computed_of(leg, trial.markers,
                    {s + "ThighRotation", s + "ShankRotation", s + "TibialTorsion", s + "AnkleAbAdd"});
    const auto& knee = angle(motion, s + "KneeAngles");
    for (std::size_t i = 0; i < knee.value.size(); ++i) {
      const double truth = i % 3 == 0 ? OffsetLeg::flexion(static_cast<std::int64_t>(i / 3)) : 0.0;
      EXPECT_LT(std::abs(knee.value[i] - truth), 1.96 * knee.sd[i]) << i;
      EXPECT_NEAR(knee.constant_sd[i], knee.sd[i], 1e-3 * knee.sd[i]) << "it is the same in all frames";
    }
    EXPECT_TRUE(used(motion, s + "ThighRotation").assumed);
  }
}

INSTANTIATE_TEST_SUITE_P(BothSides, OffsetLegs, ::testing::Values(1.0, -1.0));

TEST(ConventionalGaitModel, TakesWhatTheFilesOwnOutputsWereMadeWith) {
  const OffsetLeg leg{.diameter = 0.0182};
  const auto trial = leg.trial(20, true);
  const auto motion = computed_of(leg, trial.markers, {"LThighRotation", "LAnkleAbAdd"});
  EXPECT_NEAR(used(motion, "MarkerDiameter").value, 0.0182, 1e-9);
  EXPECT_EQ(used(motion, "MarkerDiameter").from, "the file's own model outputs");
  EXPECT_NEAR(used(motion, "MarkerDiameter").sd, 0.002, 1e-12) << "nobody measured it";
  EXPECT_NEAR(used(motion, "LThighRotation").value, leg.thigh, 1e-9);
  EXPECT_NEAR(used(motion, "LAnkleAbAdd").value, leg.abduction, 1e-9);
  EXPECT_FALSE(used(motion, "LShankRotation").assumed) << "a file has it";
  EXPECT_THAT(used(motion, "LShankRotation").from, Not(HasSubstr("the file's own model outputs")));
}

TEST(ConventionalGaitModel, DoubtsAnOffsetOfZero) {
  OffsetLeg leg{.thigh = 0.0};
  const auto trial = leg.trial(20, false);
  const auto doubted = used(computed_of(leg, trial.markers, {}), "LThighRotation");
  EXPECT_TRUE(doubted.assumed);
  EXPECT_NEAR(doubted.sd, 5.0 * 3.14159265358979 / 180.0, 1e-9);
  EXPECT_THAT(doubted.from, HasSubstr("where 0 may stand for 'not measured'"));
  leg.thigh = 0.01;
  const auto entered = used(computed_of(leg, trial.markers, {}), "LThighRotation");
  EXPECT_FALSE(entered.assumed);
  EXPECT_THAT(entered.from, Not(HasSubstr("where 0 may stand for 'not measured'")));
}

TEST(ConventionalGaitModel, DoubtsAZeroMoreWhereOffsetsAreUsuallyMeasured) {
  const OffsetLeg leg{.thigh = 0.0};
  const auto trial = leg.trial(20, false);
  analysis::SegmentInput input{.markers = &trial.markers, .known = leg.values(), .zeros_doubtful = true};
  const auto motion = analysis::compute_segments(*find_definition("pig"), input, {.noise_sd_m = 1e-6});
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_NEAR(used(*motion, "LThighRotation").sd, 15.0 * 3.14159265358979 / 180.0, 1e-9);
  EXPECT_TRUE(used(*motion, "LThighRotation").assumed);
}

TEST(ConventionalGaitModel, AMeasureThatIsGivenIsExactOrHasItsDeviation) {
  const OffsetLeg leg;
  const auto trial = leg.trial(20, false);
  const auto with = [&](std::vector<analysis::SubjectValue> given) {
    const double trochanter = 0.1288 * leg.leg - 0.04856;
    given.push_back({"LAsisTrocanterDistance", trochanter, "--subject"});
    given.push_back({"RAsisTrocanterDistance", trochanter, "--subject"});
    analysis::SegmentInput input{.markers = &trial.markers, .given = std::move(given), .known = leg.values()};
    auto motion = analysis::compute_segments(*find_definition("pig"), input, {.noise_sd_m = 1e-9});
    EXPECT_TRUE(motion) << motion.error().message;
    return std::move(*motion);
  };
  const auto exact = with({{"MarkerDiameter", 0.014, "--subject"}});
  EXPECT_FALSE(used(exact, "MarkerDiameter").assumed);
  EXPECT_EQ(used(exact, "MarkerDiameter").sd, 0.0);
  for (const double sd : angle(exact, "LKneeAngles").sd) EXPECT_LT(sd, 1e-5);
  analysis::SubjectValue turn{"LThighRotation", leg.thigh, "--subject"};
  turn.sd = 0.04;
  const auto loose = with({{"MarkerDiameter", 0.014, "--subject"}, turn});
  EXPECT_EQ(used(loose, "LThighRotation").sd, 0.04);
  // A turn of the thigh's axis turns the knee's rotation by about as much.
  const auto& knee = angle(loose, "LKneeAngles");
  for (std::size_t i = 2; i < knee.sd.size(); i += 3) {
    EXPECT_GT(knee.sd[i], 0.02);
    EXPECT_LT(knee.sd[i], 0.12);
  }
}

TEST(ConventionalGaitModel, TakesEnteredAnthropometryBeforeTheStaticTrials) {
  const OffsetLeg leg;
  const auto trial = leg.trial(20, false);
  analysis::SegmentInput input{
      .markers = &trial.markers, .static_trial = &trial.markers, .known = leg.values()};
  for (auto& value : input.known)
    if (value.name == "InterAsisDistance") value.value = 0.25;
  const auto entered = analysis::compute_segments(*find_definition("pig"), input);
  ASSERT_TRUE(entered);
  EXPECT_EQ(used(*entered, "InterAsisDistance").value, 0.25);
  for (auto& value : input.known)
    if (value.name == "InterAsisDistance") value.value = 0.0;
  const auto measured = analysis::compute_segments(*find_definition("pig"), input);
  ASSERT_TRUE(measured);
  EXPECT_NEAR(used(*measured, "InterAsisDistance").value, leg.asis, 1e-9) << "0 is not measured";
}

}  // namespace
}  // namespace kinemark::pipeline
