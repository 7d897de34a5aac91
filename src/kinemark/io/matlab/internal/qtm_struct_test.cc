// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Structs with the fields that Qualisys' manual lists ("Export to MAT format").
#include "kinemark/io/matlab/internal/qtm_struct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/mat.h"
#include "kinemark/io/matlab/testing/sample.h"

namespace kinemark::io::internal {
namespace {

using data::SampleState;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kFrames = 4;

/// M x 4 x F: 100 m + 10 k + f, residual 0.5; NaN in the last frame of the first.
std::string coordinates(int markers) {
  std::vector<double> out;
  for (int f = 0; f < kFrames; ++f)
    for (int k = 0; k < 4; ++k)
      for (int m = 0; m < markers; ++m)
        out.push_back(m == 0 && f == kFrames - 1 ? kNaN : k == 3 ? 0.5 : 100.0 * m + 10.0 * k + f);
  return mat_numbers(out, {markers, 4, kFrames});
}

std::string group(const std::vector<std::string>& labels, const MatFields& more = {}) {
  const auto count = static_cast<int>(labels.size());
  MatFields fields = {
      {"Count", mat_number(count)}, {"Labels", mat_texts(labels)}, {"Data", coordinates(count)}};
  fields.insert(fields.end(), more.begin(), more.end());
  return mat_struct(fields);
}

std::string types(const std::vector<std::uint8_t>& values, int markers) {
  return mat_numbers(values, {markers, kFrames});
}

/// An export with these trajectories and more fields.
Result<data::Trial> read(const MatFields& trajectories, const MatFields& more = {}) {
  MatFields fields = {{"File", mat_text("C:\\walk.qtm")},
                      {"StartFrame", mat_number(11)},
                      {"Frames", mat_number(kFrames)},
                      {"FrameRate", mat_number(100)},
                      {"Trajectories", mat_struct(trajectories)}};
  fields.insert(fields.end(), more.begin(), more.end());
  const std::string file = io::testing::mat_file({mat_struct(fields, "walk")});
  return parse_mat(std::as_bytes(std::span(file)), "walk.mat");
}

TEST(QtmStruct, TrajectoriesComeInMetresWithTheirResiduals) {
  const auto trial = read({{"Labeled", group({"heel", "toe"})}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->warnings, IsEmpty());
  EXPECT_THAT(trial->markers.names, ElementsAre("heel", "toe"));
  EXPECT_EQ(trial->markers.frames(), kFrames);
  EXPECT_EQ(trial->first_frame, 11);
  EXPECT_DOUBLE_EQ(trial->markers.time.t0_s, 0.1);
  EXPECT_EQ(trial->units_in_file, "mm");
  for (int f = 0; f < kFrames; ++f)
    for (int m = 0; m < 2; ++m) {
      const std::size_t i = trial->markers.index(f, m);
      const bool gone = m == 0 && f == kFrames - 1;
      EXPECT_EQ(trial->markers.state[i], gone ? SampleState::missing : SampleState::measured);
      if (gone) continue;
      EXPECT_EQ(trial->markers.x(f, m), Eigen::Vector3d(1e-3 * (100.0 * m + f), 1e-3 * (100.0 * m + 10.0 + f),
                                                        1e-3 * (100.0 * m + 20.0 + f)));
      EXPECT_FLOAT_EQ(trial->residual_m[i], 0.0005F);
    }
}

TEST(QtmStruct, TypesTellWhatWasFilled) {
  const auto trial = read({{"Labeled", group({"a", "b"}, {{"Type", types({1, 1, 2, 3, 4, 0, 0, 1}, 2)}})}});
  ASSERT_TRUE(trial) << trial.error().message;
  const auto state = [&](int f, int m) { return trial->markers.state[trial->markers.index(f, m)]; };
  EXPECT_EQ(state(0, 0), SampleState::measured);
  EXPECT_EQ(state(1, 0), SampleState::interpolated);
  EXPECT_EQ(state(1, 1), SampleState::model_filled);
  EXPECT_EQ(state(2, 0), SampleState::interpolated);
  EXPECT_EQ(state(2, 1), SampleState::missing);
  EXPECT_TRUE(std::isnan(trial->residual_m[trial->markers.index(1, 0)]));
}

TEST(QtmStruct, WithoutTypesAResidualOfZeroIsNotMeasured) {
  std::vector<double> values = {1, 2, 3, 0.0, 1, 2, 3, 0.7};  // one marker, two frames
  const auto trial = read({{"Labeled", mat_struct({{"Labels", mat_texts(std::vector<std::string>{"a"})},
                                                   {"Data", mat_numbers(values, {1, 4, 2})}})}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.state, ElementsAre(SampleState::interpolated, SampleState::measured));
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("Frames says 4, and the trajectories have 2")));
}

TEST(QtmStruct, UnidentifiedTrajectoriesGetNamesThatSaySo) {
  const auto trial = read({{"Labeled", group({"a"})}, {"Unidentified", group({"", ""})}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("a", "uname*1", "uname*2"));
  EXPECT_TRUE(data::is_unlabelled(trial->markers.names[1]));
  EXPECT_EQ(trial->markers.x(1, 2)[0], 1e-3 * 101.0);
}

TEST(QtmStruct, NamesThatComeTwiceGetANumber) {
  const auto trial = read({{"Labeled", group({"a", "a"})}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("a", "a_2"));
  EXPECT_THAT(trial->warnings, Contains(HasSubstr("a name that stood before ('a')")));
}

std::string analog(double rate) {
  const std::vector<double> values = {1, 10, 2, 20, 3, 30, 4, 40, 5, 50, 6, 60, 7, 70, 8, 80};
  return mat_structs({"BoardName", "Labels", "Frequency", "Data"},
                     {{mat_text("board"), mat_texts(std::vector<std::string>{"emg 1", "emg 2"}),
                       mat_number(rate), mat_numbers(values, {2, 8})}});
}

std::string force(double rate) {
  std::vector<double> values(24);
  for (int i = 0; i < 24; ++i) values[i] = i;
  return mat_structs(
      {"ForcePlateName", "Frequency", "Force", "Moment"},
      {{mat_text("left"), mat_number(rate), mat_numbers(values, {3, 8}), mat_numbers(values, {3, 8})}});
}

TEST(QtmStruct, AnalogChannelsAndForcesAreReadAsChannels) {
  const auto trial = read({{"Labeled", group({"a"})}}, {{"Analog", analog(200)}, {"Force", force(200)}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->analog.names, ElementsAre("emg 1", "emg 2", "left Fx", "left Fy", "left Fz", "left Mx",
                                               "left My", "left Mz"));
  EXPECT_EQ(trial->analog.units[2], "N");
  EXPECT_EQ(trial->analog.units[5], "Nm");
  EXPECT_EQ(trial->analog.samples, 8);
  EXPECT_EQ(trial->analog.rate_hz, 200.0);
  EXPECT_EQ(trial->analog.values[3 * 8 + 1], 40.0);
  EXPECT_EQ(trial->analog.values[3 * 8 + 4], 11.0);
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("where the plates lie is left out")));
}

TEST(QtmStruct, ChannelsOfAnotherRateAreLeftOutAndSaid) {
  const auto trial = read({{"Labeled", group({"a"})}}, {{"Analog", analog(200)}, {"Force", force(400)}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->analog.names.size(), 2U);
  EXPECT_THAT(trial->warnings,
              Contains(HasSubstr("walk.Force.Force: 8 samples at 400 Hz do not go with 8 at 200 Hz")));
}

TEST(QtmStruct, EventsHaveTheirTimes) {
  const std::string events = mat_structs(
      {"Label", "Frame", "Time"},
      {{mat_text("RHS"), mat_number(12), mat_number(0.11)}, {mat_text("bad"), mat_number(1), mat_text("x")}});
  const auto trial = read({{"Labeled", group({"a"})}}, {{"Events", events}, {"Skeletons", mat_number(1)}});
  ASSERT_TRUE(trial) << trial.error().message;
  ASSERT_EQ(trial->events.size(), 1U);
  EXPECT_EQ(trial->events[0].label, "RHS");
  EXPECT_EQ(trial->events[0].time_s, 0.11);
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("event 2 has no time"), "Skeletons is not read"));
}

TEST(QtmStruct, ContradictionsAreRefusedByTheirField) {
  const auto message = [](const Result<data::Trial>& trial) {
    return trial ? "read" : trial.error().message;
  };
  EXPECT_THAT(message(read({})), HasSubstr("walk.mat: walk.Trajectories: holds no trajectory"));
  EXPECT_THAT(message(read({{"Labeled", mat_struct({{"Labels", mat_texts(std::vector<std::string>{"a"})},
                                                    {"Data", coordinates(2)}})}})),
              HasSubstr("walk.Trajectories.Labeled.Labels: names 1 of 2 trajectories"));
  const std::vector<std::uint8_t> two = {1, 1};
  EXPECT_THAT(message(read({{"Labeled", group({"a"}, {{"Type", mat_numbers(two, {1, 2})}})}})),
              HasSubstr("walk.Trajectories.Labeled.Type: is 1 x 2; expected 1 x 4 numbers"));
  EXPECT_THAT(
      message(read({{"Labeled", mat_struct({{"Data", mat_numbers(std::vector<double>(10), {1, 5, 2})}})}})),
      HasSubstr("walk.Trajectories.Labeled.Data: has 5 rows for each trajectory"));
}

}  // namespace
}  // namespace kinemark::io::internal
