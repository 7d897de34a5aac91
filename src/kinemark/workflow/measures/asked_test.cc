// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/asked.h"

#include <gmock/gmock.h>

namespace kinemark::workflow {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::StartsWith;

AskedMeasures asked_for(MeasuresOf of, std::vector<std::string> measures = {}, MeasureNeeds needs = {}) {
  MeasureOptions options;
  options.of = of;
  options.measures = std::move(measures);
  options.needs = needs;
  return asked_measures(options).value();
}

TEST(AskedMeasures, GoToTheStageThatTakesThem) {
  const auto asked = asked_for(MeasuresOf::everything, {"cadence", "path_length", "grf_peak", "emg_rms"});
  EXPECT_THAT(asked.gait.measures, ElementsAre("cadence"));
  EXPECT_THAT(asked.path.measures, ElementsAre("path_length"));
  EXPECT_THAT(asked.plates.measures, ElementsAre("grf_peak"));
  EXPECT_THAT(asked.emg.measures, ElementsAre("emg_rms"));
  EXPECT_TRUE(asked.paths && asked.by_name && asked.forces_by_name && asked.muscles_by_name);
  EXPECT_THAT(asked_for(MeasuresOf::everything, {"gait", "cadence"}).gait.measures, IsEmpty()) << "all of it";
}

TEST(AskedMeasures, WithoutNamesAreThoseOfTheVerb) {
  const auto paths = asked_for(MeasuresOf::paths);
  EXPECT_TRUE(paths.paths);
  EXPECT_FALSE(paths.walking || paths.muscles || paths.uses_forces());
  const auto walking = asked_for(MeasuresOf::walking);
  EXPECT_TRUE(walking.walking && walking.uses_forces());
  EXPECT_FALSE(walking.paths || walking.by_name);
  const auto all = asked_for(MeasuresOf::everything);
  EXPECT_TRUE(all.paths && all.walking && all.muscles && all.forces);
  EXPECT_FALSE(all.by_name || all.muscles_by_name);
}

TEST(AskedMeasures, WhatIsNeededIsLookedFor) {
  EXPECT_FALSE(asked_for(MeasuresOf::everything, {"path_length"}).walking);
  EXPECT_TRUE(asked_for(MeasuresOf::everything, {"path_length"}, {.events = true}).walking);
  EXPECT_FALSE(asked_for(MeasuresOf::everything, {}, {.events = true, .own_movements = true}).walking);
  EXPECT_TRUE(asked_for(MeasuresOf::muscles, {}, {.strides = true}).by_name);
  EXPECT_FALSE(asked_for(MeasuresOf::paths, {}, {.events = true}).walking) << "paths have their own";
}

TEST(AskedMeasures, RefuseWhatIsNoneOrOfAnotherVerb) {
  MeasureOptions options;
  options.of = MeasuresOf::paths;
  for (const char* id : {"nothing", "cadence", "joint_range"}) {
    options.measures = {id};
    EXPECT_EQ(asked_measures(options).error().code, Code::usage) << id;
  }
  EXPECT_EQ(
      asked_measures(options).error().message,
      "joint_range is measured of a motion, not of markers; 'kinemark dynamics' measures it, of a .mot or "
      ".sto with --model");
  options.measures = {"cadence"};
  EXPECT_EQ(asked_measures(options).error().message,
            "cadence is no measure of 'kinemark measure'; 'kinemark gait' measures it");
  options.measures = {"cadense"};
  EXPECT_THAT(asked_measures(options).error().message,
              AllOf(StartsWith("there is no measure 'cadense' (nearest: cadence"),
                    EndsWith("; --list shows them all")));
  options.measures = {"path_length"};
  EXPECT_TRUE(asked_measures(options));
  options.emg.envelope.low_pass_hz = 5.0;
  EXPECT_EQ(asked_measures(options).error().code, Code::usage);
  options.emg.envelope = {};
  options.refits = 12;
  EXPECT_EQ(asked_measures(options).error().code, Code::usage);
}

TEST(KnownMeasures, AreEachTakenFromOneThing) {
  EXPECT_EQ(kind_of_measure("path_length"), MeasureKind::path);
  EXPECT_EQ(kind_of_measure("cycle_duration"), MeasureKind::path);
  EXPECT_EQ(kind_of_measure("cadence"), MeasureKind::gait);
  EXPECT_EQ(kind_of_measure("grf_peak"), MeasureKind::plates);
  EXPECT_EQ(kind_of_measure("emg_rms"), MeasureKind::emg);
  EXPECT_EQ(kind_of_measure("joint_range"), MeasureKind::motion);
  EXPECT_EQ(kind_of_measure("plates"), MeasureKind::plates) << "all of them";
  EXPECT_EQ(kind_of_measure("nothing"), std::nullopt);
  EXPECT_EQ(find_measure("plates"), nullptr) << "the word for all is no measure";
  for (const auto& known : known_measures()) {
    EXPECT_EQ(find_measure(known.what.id), &known) << known.what.id << " stands once";
    EXPECT_TRUE(known.is_of(MeasuresOf::everything));
    EXPECT_EQ(known.is_of(MeasuresOf::walking),
              known.kind == MeasureKind::gait || known.kind == MeasureKind::plates);
  }
}

}  // namespace
}  // namespace kinemark::workflow
