// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/emg_channels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "kinemark/workflow/measures/testing/muscles.h"

namespace kinemark::workflow {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::muscles;

TEST(EmgChannels, ChannelsAreFoundByName) {
  auto trial = muscles();
  EXPECT_THAT(emg_channels(trial).value(), ElementsAre(1, 2)) << "soleus";
  trial.analog.names[3] = "my EMG 1";
  EXPECT_THAT(emg_channels(trial).value(), ElementsAre(3))
      << "what is called EMG goes before what sounds like a muscle";
  trial.analog.units[3] = "N";
  EXPECT_THAT(emg_channels(trial).value(), ElementsAre(1, 2)) << "a force is no EMG";
  EXPECT_THAT(emg_channels(trial, {"RSOL", "*SOL"}).value(), ElementsAre(2, 1));
  EXPECT_THAT(emg_channels(trial, {"RSQL"}).error().message,
              HasSubstr("no analog channel 'RSQL' (nearest: RSOL"));
}

TEST(EmgChannels, VoltsAreWrittenInManyWays) {
  auto trial = muscles();
  const auto peak = [&](const std::string& unit) {
    trial.analog.units[1] = unit;
    const auto out = measure_channels(trial, {.channels = {trial.analog.names[1]}}, {},
                                      {.measures = {"emg_rms"}, .refits = 0});
    return out.value().measures.at(0).value;
  };
  const double volts = peak("V");
  for (const char* unit : {"volt", "Volts", "VOLTS"}) EXPECT_EQ(peak(unit), volts) << unit;
  for (const char* unit : {"mV", "millivolts", "Millivolt", "mVolts"})
    EXPECT_NEAR(peak(unit), 1e-3 * volts, 1e-12 * volts) << unit;
  for (const char* unit : {"uV", "\xc2\xb5V", "microvolts", "Microvolt"})
    EXPECT_NEAR(peak(unit), 1e-6 * volts, 1e-12 * volts) << unit;
}

TEST(EmgChannels, AForceInVoltsIsNoMuscle) {
  auto trial = muscles();
  for (const auto* const name : {"Electric Potential.Fx", "Electric Potential.Mz2", "EMG plate.Fz", "F1X",
                                 "Trigger", "Electric Potential"}) {
    trial.analog.names[1] = name;
    EXPECT_THAT(emg_channels(trial).value(), ElementsAre(2)) << name;
  }
  for (const auto* const name :
       {"RMGAS", "L_TibAnt", "right tib", "R.Med.Hams", "myTriceps", "LLATGAS", "VASTM"}) {
    trial.analog.names[1] = name;
    EXPECT_THAT(emg_channels(trial).value(), ElementsAre(1, 2)) << name;
  }
  trial.analog.names[1] = "Electric Potential.Fx";
  EXPECT_THAT(emg_channels(trial, {"*.Fx"}).value(), ElementsAre(1)) << "who names it has it";
}

TEST(EmgChannels, ValuesAreVoltsAndSpansThoseOfTheFrames) {
  const auto trial = muscles();
  const auto out =
      measure_channels(trial, {}, {{.name = "Foot Strike Left 2", .first_frame = 151, .last_frame = 200}},
                       {.measures = {"emg_rms"}, .refits = 0})
          .value();
  ASSERT_EQ(out.measures.size(), 2u);
  const auto& rms = out.measures[0];
  EXPECT_EQ(rms.subject, "LSOL");
  EXPECT_EQ(rms.context, "Left");
  EXPECT_EQ(rms.cycle, 1);
  EXPECT_NEAR(rms.start_s, 1.5, 1e-9);
  EXPECT_NEAR(rms.end_s, 1.999, 1e-9);
  EXPECT_GT(rms.uncorrected, 1e-4);
  EXPECT_LT(rms.uncorrected, 1.5e-3) << "millivolts";
}

TEST(EmgChannels, MaximaAreThoseOfTheRecordingItselfOrOfAnother) {
  const auto trial = muscles();
  const auto most = [&](const EmgChoice& choice) {
    return measure_channels(trial, choice, {}, {.refits = 0}).value().envelopes[0].maxCoeff();
  };
  EXPECT_NEAR(most({.to_maximum = true}), 1.0, 1e-12);
  auto strong = std::make_shared<data::Trial>(trial);
  for (auto& value : strong->analog.values) value *= 2.0;
  EXPECT_NEAR(most({.maximum = strong}), 0.5, 1e-9);
  strong->analog.names[1] = "other";
  EXPECT_THAT(measure_channels(trial, {.maximum = strong, .maximum_name = "max.c3d"}, {}, {.refits = 0})
                  .error()
                  .message,
              HasSubstr("max.c3d: has no analog channel 'LSOL' for its maximum"));
  strong->analog.names[1] = "LSOL";
  std::fill(strong->analog.values.begin(), strong->analog.values.end(), 0.0);
  EXPECT_FALSE(measure_channels(trial, {.maximum = strong}, {}, {.refits = 0}));
}

TEST(EmgChannels, WithoutANameThatIsOfAMuscleNothingIsMeasured) {
  auto trial = muscles();
  trial.analog.names = {"a", "b", "c", "d"};
  EXPECT_THAT(measure_channels(trial, {}, {}, {}).error().message, HasSubstr("name the channels"));
}

}  // namespace
}  // namespace kinemark::workflow
