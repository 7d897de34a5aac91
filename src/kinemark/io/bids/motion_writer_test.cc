// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "kinemark/core/missing.h"
#include "kinemark/io/bids/motion_bids.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

data::Trial walk() {
  data::Trial t;
  t.software = "maker";
  t.first_frame = 101;
  t.markers =
      data::Trajectories::all_missing({"LASI", "RASI"}, {.rate_hz = 119.88, .t0_s = 0.8342, .frames = 3});
  for (std::size_t i = 0; i < 6; ++i) {
    if (i == 3) continue;
    t.markers.state[i] = data::SampleState::measured;
    for (std::size_t k = 0; k < 3; ++k)
      t.markers.x_in_world[3 * i + k] = 0.1 * static_cast<double>(3 * i + k) + 1.0 / 3.0;
  }
  t.channels = {.names = {"LKneeAngles", "LKneePower"},
                .kinds = {data::ChannelKind::angle, data::ChannelKind::power},
                .units = {"deg", ""},
                .rate_hz = 119.88,
                .frames = 3};
  for (int i = 0; i < 18; ++i) t.channels.values.push_back(i == 7 ? kNaN : 0.7 * i);
  return t;
}

/// Written into a folder and read again.
Result<data::Trial> there_and_back(const data::Trial& trial, const testing_support::ScratchFolder& scratch) {
  const auto name =
      parse_motion_name(scratch.path() / "sub-01" / "motion" / "sub-01_task-walk_tracksys-omc_motion.tsv");
  if (!name) return std::unexpected(name.error());
  std::filesystem::create_directories(name->folder);
  const auto files = motion_files(*name, trial);
  if (!files) return std::unexpected(files.error());
  for (const MotionFile& file : *files)
    if (auto s = file.write(file.path); !s) return std::unexpected(s.error());
  return read_motion_bids(files->front().path);
}

TEST(MotionWriter, PositionsAndChannelsComeBackToTheLastBit) {
  const testing_support::ScratchFolder scratch;
  const data::Trial trial = walk();
  const auto back = there_and_back(trial, scratch);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->warnings.empty());
  EXPECT_EQ(back->markers.names, trial.markers.names);
  EXPECT_EQ(back->markers.time, trial.markers.time);
  EXPECT_EQ(back->first_frame, 101);
  EXPECT_EQ(back->software, "maker");
  EXPECT_EQ(back->markers.state, trial.markers.state);
  EXPECT_EQ(back->channels.names, trial.channels.names);
  EXPECT_EQ(back->channels.kinds, trial.channels.kinds);
  EXPECT_EQ(back->channels.units, trial.channels.units);
  const auto same = [](const Array<double>& a, const Array<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
  };
  EXPECT_TRUE(same(back->markers.x_in_world, trial.markers.x_in_world));
  EXPECT_TRUE(same(back->channels.values, trial.channels.values));
}

TEST(MotionWriter, FilesAreAsBidsHasThem) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(there_and_back(walk(), scratch));
  const auto text = [&](const char* name) {
    return read_text(scratch.path() / "sub-01" / "motion" / name).value();
  };
  const std::string motion = text("sub-01_task-walk_tracksys-omc_motion.tsv");
  EXPECT_EQ(std::ranges::count(motion, '\n'), 3) << "no header";
  EXPECT_THAT(motion, HasSubstr("\tn/a\tn/a\tn/a\t"));
  const std::string channels = text("sub-01_task-walk_tracksys-omc_channels.tsv");
  EXPECT_TRUE(channels.starts_with("name\tcomponent\ttype\ttracked_point\tunits\t"));
  EXPECT_THAT(channels, HasSubstr("\nRASI_y\ty\tPOS\tRASI\tm\t"));
  EXPECT_THAT(channels, HasSubstr("\nLKneeAngles_x\tx\tJNTANG\tLKneeAngles\tdeg\t"));
  EXPECT_THAT(channels, HasSubstr("\nLKneePower_z\tz\tMISC\tLKneePower\tn/a\t"));
  const std::string json = text("sub-01_task-walk_tracksys-omc_motion.json");
  for (const char* part :
       {"\"TaskName\": \"walk\"", "\"SamplingFrequency\": 119.88", "\"MissingValues\": \"n/a\"",
        "\"POSChannelCount\": 6", "\"MotionChannelCount\": 13", "\"TrackedPointsCount\": 2",
        "\"TrackingSystemName\": \"omc\""})
    EXPECT_THAT(json, HasSubstr(part));
  EXPECT_THAT(text("sub-01_task-walk_tracksys-omc_channels.json"), HasSubstr("\"SpatialAxes\""));
  EXPECT_THAT(read_text(scratch / "dataset_description.json").value(), HasSubstr("\"BIDSVersion\""));
}

TEST(MotionWriter, ColumnsOfMarkersThatCollideGetNamesOfTheirOwn) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A", "A_x"}, {.rate_hz = 100.0, .frames = 1});
  trial.channels = {.names = {"A"},
                    .kinds = {data::ChannelKind::force},
                    .units = {"N"},
                    .rate_hz = 100.0,
                    .frames = 1,
                    .values = {1.0, 2.0, 3.0}};
  const auto back = there_and_back(trial, scratch);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->markers.names, ElementsAre("A", "A_x"));
  EXPECT_THAT(back->channels.names, ElementsAre("A"));
  EXPECT_EQ(back->channels.kinds.front(), data::ChannelKind::force);
}

TEST(MotionWriter, NamesThatATableCannotHoldAreRefused) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = walk();
  trial.markers.names[1] = "R\tASI";
  const auto refused = there_and_back(trial, scratch);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("holds a tab"));
}

}  // namespace
}  // namespace kinemark::io
