// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/segments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/motion/foundations/testing/walking_body.h"
#include "kinemark/workflow/segments/testing/offset_leg.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kHeights = R"toml(
title = "Heights"
[[segment]]
name = "pelvis"
origin = "mean(LASI, RASI)"
first = ["y", "LASI - RASI"]
second = ["x", "mean(LASI, RASI) - mean(LPSI, RPSI)"]
[[landmark]]
name = "tip"
segment = "pelvis"
formula = "LKNE"
trial = "pointer"
[[value]]
name = "knee"
quantity = "length"
formula = "dot(LKNE - pelvis.o, up)"
[[value]]
name = "shown"
quantity = "length"
formula = "distance(tip, pelvis.o)"
)toml";

analysis::SegmentDefinition definition_of(std::string_view text) {
  return pipeline::parse_definition(text, "d.toml").value();
}

/// A left leg by the conventional gait model, from memory, with what is known of it.
class SegmentsVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    recording.trial = leg.trial(60, false);
    options.known = leg.values();
    options.noise_sd_m = 0.001;
    options.drop_doubtful = false;
  }
  static const analysis::SegmentSeries& series(const std::vector<analysis::SegmentSeries>& list,
                                               const std::string& name) {
    return *std::ranges::find(list, name, &analysis::SegmentSeries::name);
  }
  static const analysis::SegmentSeries& knee(const SegmentsFound& found) {
    return series(found.motion.angles, "LKneeAngles");
  }

  OffsetLeg leg;
  data::Recording recording;
  SegmentsOptions options;
  analysis::SegmentDefinition pig = pipeline::find_definition("pig").value();
};

TEST_F(SegmentsVerb, FindsTheKneeFromMemory) {
  const auto found = segments(pig, recording, options);
  ASSERT_TRUE(found) << found.error().message;
  const auto& angle = knee(*found);
  for (std::int64_t f = 0; f < 60; ++f) {
    const auto i = static_cast<std::size_t>(3 * f);
    EXPECT_NEAR(angle.value[i], OffsetLeg::flexion(f), 1e-9);
    EXPECT_GT(angle.sd[i], 0.0);
  }
  EXPECT_FALSE(found->static_trial);
  EXPECT_TRUE(found->remarks.gates.empty());
  EXPECT_TRUE(found->loads.series.empty()) << "there are no plates";
  EXPECT_TRUE(found->comparison.empty()) << "it holds no outputs";
}

TEST_F(SegmentsVerb, WhatIsGivenCountsBeforeWhatAFileKnows) {
  const auto used = [&](const std::string& name) {
    const auto found = segments(pig, recording, options);
    return *std::ranges::find(found.value().motion.parameters, name, &analysis::UsedParameter::name);
  };
  EXPECT_EQ(used("LKneeWidth").value, leg.knee_width);
  EXPECT_EQ(used("LKneeWidth").from, "leg.c3d");
  options.given = {{"LKneeWidth", 0.11, "me"}};
  EXPECT_EQ(used("LKneeWidth").value, 0.11);
  EXPECT_EQ(used("LKneeWidth").from, "me");
}

TEST_F(SegmentsVerb, ValuesOfAFileInOtherUnitsAreMended) {
  for (auto& value : options.known)
    if (value.name.ends_with("Rotation")) value.value *= 180.0 / std::numbers::pi;
  const auto found = segments(pig, recording, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->remarks.warnings, Contains(HasSubstr("leg.c3d: its angles are taken as degrees")));
}

TEST_F(SegmentsVerb, TheRecordingStaysAsItIsAndDoubtfulSamplesAreLeftOut) {
  const auto knee_marker = recording.trial.markers.find("LKNE");
  recording.trial.markers.x(30, knee_marker) += Eigen::Vector3d(0.2, 0.0, 0.0);
  const auto before = recording.trial.markers.state;
  const auto kept = segments(pig, recording, options);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_TRUE(std::isfinite(knee(*kept).value[90]));
  EXPECT_THAT(kept->screening.recording, Each(Not(HasSubstr("Left out: "))));
  options.drop_doubtful = true;
  const auto dropped = segments(pig, recording, options);
  ASSERT_TRUE(dropped) << dropped.error().message;
  EXPECT_TRUE(std::isnan(knee(*dropped).value[90]));
  EXPECT_THAT(dropped->screening.recording, Contains(HasSubstr("Left out: ")));
  EXPECT_FALSE(dropped->used.trial.markers.present(30, knee_marker));
  EXPECT_TRUE(std::ranges::equal(recording.trial.markers.state, before));
}

TEST_F(SegmentsVerb, AnExchangeInTheRecordingIsNamedThereAndExchangedBack) {
  recording.trial = {};
  recording.trial.markers =
      motion::testing::walking_body({"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK", "LHEE",
                                     "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"},
                                    60);
  recording.up = Eigen::Vector3d::UnitY();
  options.known.clear();
  for (const auto* side : {"L", "R"})
    for (const auto& [what, size_m] :
         {std::pair{"LegLength", 0.9}, std::pair{"KneeWidth", 0.1}, std::pair{"AnkleWidth", 0.07}})
      options.known.push_back({std::string(side) + what, size_m, "leg.c3d"});
  options.drop_doubtful = true;
  const data::Recording still = recording;
  options.static_trial = &still;
  const auto sound = segments(pig, recording, options);
  ASSERT_TRUE(sound) << sound.error().message;
  for (const auto* sentence :
       {"all is computed with them exchanged back", "what is computed from them is not so"})
    EXPECT_THAT(sound->remarks.warnings, Each(Not(HasSubstr(sentence))));
  EXPECT_TRUE(sound->remarks.passed());
  auto& names = recording.trial.markers.names;
  std::swap(*std::ranges::find(names, "LHEE"), *std::ranges::find(names, "LTOE"));
  const auto found = segments(pig, recording, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_FALSE(found->remarks.passed());
  EXPECT_THAT(found->remarks.warnings.front(),
              HasSubstr("are exchanged in the recording; all is computed with "
                        "them exchanged back: label them again."));
  const auto& ankle = series(found->motion.angles, "LAnkleAngles");
  const auto& right = series(sound->motion.angles, "LAnkleAngles");
  ASSERT_EQ(right.value.size(), 180U);
  for (std::size_t i = 0; i < ankle.value.size(); ++i) EXPECT_NEAR(ankle.value[i], right.value[i], 1e-12);
  EXPECT_THAT(found->remarks.warnings, Each(Not(HasSubstr("The static trial cannot be built on"))));
  options.drop_doubtful = false;
  const auto kept = segments(pig, recording, options);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_FALSE(kept->remarks.passed());
  EXPECT_THAT(kept->remarks.warnings, Contains(HasSubstr("what is computed from them is not so")));
  EXPECT_GT(std::abs(series(kept->motion.angles, "LAnkleAngles").value[0] - right.value[0]), 1.0);
}

TEST_F(SegmentsVerb, ARecordingMayBeItsOwnStaticTrial) {
  options.static_trial = &recording;
  const auto own = segments(pig, recording, options);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_TRUE(own->static_trial);
  EXPECT_TRUE(own->screening.static_trial.empty());
  EXPECT_THAT(own->remarks.warnings, Contains(HasSubstr("Knee rotation of a static trial contains")));
  const data::Recording same = recording;
  options.static_trial = &same;
  const auto other = segments(pig, recording, options);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_TRUE(other->static_trial);
  EXPECT_EQ(other->static_trial->movements, own->static_trial->movements + 1) << "the recording is one";
  EXPECT_THAT(other->remarks.warnings,
              Each(Not(HasSubstr("Knee rotation of a static trial contains the tibia's torsion"))));
}

TEST_F(SegmentsVerb, SentencesCallRecordingsByTheirNames) {
  auto& trial = recording.trial;
  const auto wand = trial.markers.find("LTHI");
  trial.channels.names = {"LTHI"};
  trial.channels.kinds = {data::ChannelKind::modeled_marker};
  trial.channels.units = {"mm"};
  trial.channels.rate_hz = 100.0;
  trial.channels.frames = 60;
  for (std::int64_t f = 0; f < 60; ++f)
    for (int k = 0; k < 3; ++k) trial.channels.values.push_back(1e3 * trial.markers.x(f, wand)[k]);
  for (std::int64_t f = 0; f < 60; ++f) trial.markers.set_missing(f, wand);
  const data::Recording still = recording;
  options.static_trial = &still;
  options.name = "walk";
  options.static_name = "cal";
  const auto found = segments(pig, recording, options);
  ASSERT_TRUE(found) << found.error().message;
  for (const char* name : {"walk", "cal"})
    EXPECT_THAT(found->remarks.warnings,
                Contains(std::string(name) + ": not measured, taken as a model of the file has them: LTHI"));
  EXPECT_NEAR(knee(*found).value[90], OffsetLeg::flexion(30), 1e-9);
}

TEST_F(SegmentsVerb, LandmarksAreShownInTrialsOfTheirName) {
  const auto heights = definition_of(kHeights);
  data::Recording near = recording, far = recording;
  auto& markers = far.trial.markers;
  for (std::int64_t f = 0; f < 60; ++f)
    markers.x(f, markers.find("LKNE")) =
        Eigen::Vector3d(0.5 * (markers.x(f, markers.find("LASI")) + markers.x(f, markers.find("RASI"))) +
                        Eigen::Vector3d(0.0, 0.0, 0.7));
  options.trials = {{"pointer", &near}, {"pointer", &far}};
  const auto found = segments(heights, recording, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->screening.trials.size(), 2U);
  EXPECT_NEAR(series(found->motion.values, "shown").value[0], 0.7, 1e-9) << "of one name the last";
  options.trials.clear();
  const auto none = segments(heights, recording, options);
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_THAT(none->remarks.warnings, Contains(HasSubstr("there is no landmark 'tip'")));
}

TEST_F(SegmentsVerb, UpIsAsItIsStatedElseZ) {
  const auto heights = definition_of(kHeights);
  const auto height = [&] {
    return series(segments(heights, recording, options).value().motion.values, "knee").value[0];
  };
  const auto& markers = recording.trial.markers;
  const Eigen::Vector3d knee_in_pelvis =
      markers.x(0, markers.find("LKNE")) -
      0.5 * (markers.x(0, markers.find("LASI")) + markers.x(0, markers.find("RASI")));
  EXPECT_NEAR(height(), knee_in_pelvis.z(), 1e-9);
  recording.up = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(height(), knee_in_pelvis.y(), 1e-9);
}

TEST_F(SegmentsVerb, OutputsOfAModelInTheRecordingAreCompared) {
  recording.trial = leg.trial(60, true);
  const auto same = segments(pig, recording, options);
  ASSERT_TRUE(same) << same.error().message;
  EXPECT_TRUE(same->comparison.agrees()) << same->comparison.summary();
  options.given = {{"LKneeWidth", 0.12, "me"}};
  const auto other = segments(pig, recording, options);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_THAT(other->remarks.warnings, Contains(HasSubstr("is explained by LKneeWidth")));
}

TEST_F(SegmentsVerb, AnyNumberOfThreadsGivesTheSameBits) {
  options.noise_sd_m = 0.0;
  const auto one = segments(pig, recording, options);
  options.threads = 2;
  const auto two = segments(pig, recording, options);
  ASSERT_TRUE(one && two);
  EXPECT_TRUE(std::ranges::equal(knee(*one).value, knee(*two).value));
  EXPECT_TRUE(std::ranges::equal(knee(*one).sd, knee(*two).sd));
}

TEST_F(SegmentsVerb, RefusesWhatMakesNoSense) {
  const auto refused = [&](const auto& change) {
    auto asked = options;
    auto with = recording;
    change(asked, with);
    const auto found = segments(pig, with, asked);
    return found ? Error{} : found.error();
  };
  const auto noise = refused([](auto& asked, auto&) { asked.noise_sd_m = -1.0; });
  EXPECT_EQ(noise.code, Code::usage);
  EXPECT_THAT(noise.message, HasSubstr("noise of -1 m: expected 0 or more"));
  const auto refits = refused([](auto& asked, auto& with) {
    asked.refits = 5;
    with.plates = data::Wrenches{.time = with.trial.markers.time, .items = {}};
  });
  EXPECT_EQ(refits.code, Code::usage);
  EXPECT_THAT(refits.message, HasSubstr("5 refits: expected 0 or at least 20"));
  const auto nothing = refused([](auto&, auto& with) {
    for (auto& name : with.trial.markers.names) name += "x";
  });
  EXPECT_EQ(nothing.code, Code::bad_input);
  EXPECT_THAT(nothing.message, HasSubstr("nothing can be computed"));
  EXPECT_ANY_THROW(refused([](auto& asked, auto&) { asked.trials = {{"pointer", nullptr}}; }));
}

}  // namespace
}  // namespace kinemark::workflow
