// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/mat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "kinemark/io/file.h"
#include "kinemark/io/matlab/internal/mat_parse.h"
#include "kinemark/io/matlab/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::Trial;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class T>
void expect_same_bits(const Array<T>& a, const Array<T>& b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

/// All that a MAT file keeps.
void expect_same(const Trial& a, const Trial& b) {
  EXPECT_EQ(a.first_frame, b.first_frame);
  EXPECT_EQ(a.software, b.software);
  EXPECT_EQ(a.markers.names, b.markers.names);
  EXPECT_EQ(a.markers.time, b.markers.time);
  EXPECT_EQ(a.markers.methods, b.markers.methods);
  expect_same_bits(a.markers.x_in_world, b.markers.x_in_world, "positions");
  expect_same_bits(a.markers.state, b.markers.state, "states");
  expect_same_bits(a.markers.method, b.markers.method, "methods");
  expect_same_bits(a.markers.covariance, b.markers.covariance, "covariances");
  expect_same_bits(a.markers.sample_offset_s, b.markers.sample_offset_s, "offsets");
  expect_same_bits(a.markers.unfiltered_in_world, b.markers.unfiltered_in_world, "samples before the filter");
  ASSERT_EQ(a.markers.filters.size(), b.markers.filters.size());
  for (std::size_t m = 0; m < a.markers.filters.size(); ++m) {
    EXPECT_EQ(a.markers.filters[m].method, b.markers.filters[m].method);
    EXPECT_EQ(a.markers.filters[m].order, b.markers.filters[m].order);
    EXPECT_THAT(b.markers.filters[m].cutoff_hz,
                ::testing::NanSensitiveDoubleEq(a.markers.filters[m].cutoff_hz));
    EXPECT_THAT(b.markers.filters[m].noise_sd_m,
                ::testing::NanSensitiveDoubleEq(a.markers.filters[m].noise_sd_m));
  }
  expect_same_bits(a.residual_m, b.residual_m, "residuals");
  expect_same_bits(a.camera_mask, b.camera_mask, "cameras");
  EXPECT_EQ(a.channels.names, b.channels.names);
  EXPECT_EQ(a.channels.kinds, b.channels.kinds);
  EXPECT_EQ(a.channels.units, b.channels.units);
  EXPECT_EQ(a.channels.rate_hz, b.channels.rate_hz);
  expect_same_bits(a.channels.values, b.channels.values, "channels");
  EXPECT_EQ(a.analog.names, b.analog.names);
  EXPECT_EQ(a.analog.units, b.analog.units);
  EXPECT_EQ(a.analog.rate_hz, b.analog.rate_hz);
  EXPECT_EQ(a.analog.samples, b.analog.samples);
  expect_same_bits(a.analog.values, b.analog.values, "analog");
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].label, b.events[i].label);
    EXPECT_EQ(a.events[i].context, b.events[i].context);
    EXPECT_EQ(a.events[i].time_s, b.events[i].time_s);
  }
  EXPECT_EQ(a.unloaded_s, b.unloaded_s);
  EXPECT_EQ(a.calibration_error.fields, b.calibration_error.fields);
  ASSERT_EQ(a.force_plates.size(), b.force_plates.size());
  for (std::size_t i = 0; i < a.force_plates.size(); ++i) {
    EXPECT_EQ(a.force_plates[i].number, b.force_plates[i].number);
    EXPECT_EQ(a.force_plates[i].calibration_rows, b.force_plates[i].calibration_rows);
    EXPECT_EQ(a.force_plates[i].metres_per_unit, b.force_plates[i].metres_per_unit);
    EXPECT_EQ(a.force_plates[i].type, b.force_plates[i].type);
    EXPECT_EQ(a.force_plates[i].corners_in_world, b.force_plates[i].corners_in_world);
    EXPECT_EQ(a.force_plates[i].origin_in_plate, b.force_plates[i].origin_in_plate);
    EXPECT_EQ(a.force_plates[i].channel_idx, b.force_plates[i].channel_idx);
    EXPECT_EQ(a.force_plates[i].calibration, b.force_plates[i].calibration);
    EXPECT_EQ(a.force_plates[i].pressure_correction, b.force_plates[i].pressure_correction);
  }
}

/// Written and read again.
Result<Trial> there_and_back(const Trial& trial, const MatWriteOptions& options = {}) {
  const testing_support::ScratchFolder scratch;
  if (auto s = write_mat(scratch / "t.mat", trial, options); !s) return std::unexpected(s.error());
  return read_mat(scratch / "t.mat");
}

TEST(Mat, EverythingOfATrialComesBackToTheLastBit) {
  const Trial trial = testing::full_trial();
  ASSERT_TRUE(trial.validate()) << trial.validate().error().message;
  const auto back = there_and_back(trial);
  ASSERT_TRUE(back) << back.error().message;
  expect_same(trial, *back);
  EXPECT_EQ(back->format, "MAT");
  EXPECT_EQ(back->units_in_file, "m");
}

TEST(Mat, TrialsOfAnySizeComeBack) {
  for (const auto& [markers, frames, channels] :
       {std::array{1, 1, 0}, std::array{1, 9, 2}, std::array{9, 1, 3}, std::array{31, 200, 5},
        std::array{0, 5, 2}}) {
    const Trial trial = testing::sized_trial(markers, frames, channels);
    ASSERT_TRUE(trial.validate()) << trial.validate().error().message;
    const auto back = there_and_back(trial);
    ASSERT_TRUE(back) << back.error().message;
    expect_same(trial, *back);
  }
}

TEST(Mat, OffsetsOfEverySampleComeBack) {
  Trial trial = testing::full_trial();
  trial.markers.sample_offset_s = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  const auto back = there_and_back(trial);
  ASSERT_TRUE(back) << back.error().message;
  expect_same(trial, *back);
}

TEST(Mat, TheSameTrialGivesTheSameBytesAndNamesItsSet) {
  const testing_support::ScratchFolder scratch;
  const Trial trial = testing::full_trial();
  ASSERT_TRUE(write_mat(scratch / "a.mat", trial, {.set = "0123456789abcdef"}));
  ASSERT_TRUE(write_mat(scratch / "b.mat", trial, {.set = "0123456789abcdef"}));
  const std::string bytes = read_text(scratch / "a.mat").value();
  EXPECT_EQ(bytes, read_text(scratch / "b.mat").value());
  EXPECT_THAT(bytes.substr(0, 116), HasSubstr("kinemark_set=0123456789abcdef"));
  EXPECT_TRUE(is_mat(bytes.substr(0, 128)));
}

TEST(Mat, AnExistingFileStaysWithoutForce) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "t.mat", "mine", false));
  const auto refused = write_mat(scratch / "t.mat", testing::full_trial());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_EQ(read_text(scratch / "t.mat").value(), "mine");
  EXPECT_TRUE(write_mat(scratch / "t.mat", testing::full_trial(), {.force = true}));
}

TEST(Mat, WhatDoesNotFitTwoGigabytesIsRefusedBeforeAFileIsBegun) {
  const testing_support::ScratchFolder scratch;
  Trial trial;
  trial.markers.time = {.rate_hz = 100.0, .frames = std::int64_t{1} << 28};  // a column of times alone
  const auto refused = write_mat(scratch / "t.mat", trial);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::not_supported);
  EXPECT_THAT(refused.error().message, HasSubstr("2 GB"));
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(Mat, FieldsLieAsMatlabUsersExpect) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_mat(scratch / "t.mat", testing::full_trial()));
  const std::string bytes = read_text(scratch / "t.mat").value();
  const auto file = internal::parse_mat_variables(std::as_bytes(std::span(bytes)));
  ASSERT_TRUE(file);
  ASSERT_EQ(file->variables.size(), 1);
  const auto& trial = file->variables[0];
  EXPECT_EQ(trial.name, "trial");
  EXPECT_THAT(trial.field("data")->dims, ElementsAre(3, 2, 3));
  EXPECT_THAT(trial.field("time")->numbers(), ElementsAre(0.1001, 0.1001 + 1 / 119.88, 0.1001 + 2 / 119.88));
  EXPECT_EQ(trial.field("labels")->elements[1].text(), "Übung 2");
  EXPECT_EQ(trial.field("status_names")->elements[2].text(), "interpolated");
  // The second marker's y in the last frame: frames, then markers, then coordinates.
  EXPECT_EQ(trial.field("data")->numbers()[2 + 3 * (1 + 2 * 1)], 0.1 * 16 + 1.0 / 3.0);
  EXPECT_EQ(trial.field("sd")->numbers()[0], std::sqrt(1e-6));
  EXPECT_EQ(trial.field("sd")->numbers()[3 * 2 * 2], std::sqrt(6e-6));
  EXPECT_THAT(trial.field("force_plates")->field("channels")->numbers(), ElementsAre(1.0, 2.0));
  EXPECT_THAT(trial.field("force_plates")->field("calibration")->dims, ElementsAre(6, 6));
  EXPECT_THAT(trial.field("force_plates")->field("corners")->dims, ElementsAre(4, 3));
}

TEST(Mat, Version73IsRefusedWithTheWayToSaveAgain) {
  std::string text = "MATLAB 7.3 MAT-file, Platform: GLNXA64";
  text.resize(520, ' ');
  EXPECT_TRUE(is_mat(text.substr(0, 128)));
  const auto refused = parse_mat(std::as_bytes(std::span(text)), "x.mat");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::not_supported);
  EXPECT_THAT(refused.error().message, HasSubstr("'-v7'"));
}

TEST(Mat, AFileWithoutATrialIsRefusedWithItsVariables) {
  const std::string text = testing::mat_file({});
  const auto refused = parse_mat(std::as_bytes(std::span(text)), "x.mat");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::not_supported);
  EXPECT_THAT(refused.error().message, HasSubstr("x.mat: holds no variable; expected a struct"));
  EXPECT_FALSE(is_mat("PathFileType\t4"));
}

}  // namespace
}  // namespace kinemark::io
