// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using data::Trial;
using internal::simulate_trial;
using testing::ElementsAre;
using testing::HasSubstr;
using testing_support::ScratchFolder;

Trial round_trip(const Trial& trial, const C3dWriteOptions& options = {}) {
  const ScratchFolder scratch;
  const auto written = write_c3d(scratch / "t.c3d", trial, options);
  EXPECT_TRUE(written) << written.error().message;
  EXPECT_EQ(std::filesystem::file_size(scratch / "t.c3d") % kC3dBlock, 0U);
  auto back = read_c3d(scratch / "t.c3d");
  EXPECT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->validate());
  return std::move(*back);
}

double largest_coordinate(const Trial& t) {
  double out = 0.0;
  for (const double v : t.markers.x_in_world)
    if (std::isfinite(v)) out = std::max(out, std::abs(v));
  return out;
}

TEST(C3dWriter, AllSixEncodingsGiveBackEverySample) {
  Trial trial = simulate_trial({.markers = 9, .frames = 60, .channels = 5});
  trial.markers.set_missing(3, 2, SampleState::rejected);
  trial.residual_m[trial.markers.index(3, 2)] = NAN;
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    for (const bool integers : {false, true}) {
      SCOPED_TRACE(std::string(to_string(processor)) + (integers ? " integer" : " float"));
      const Trial back = round_trip(trial, {.processor = processor, .integers = integers});
      EXPECT_THAT(back.warnings, ElementsAre());
      EXPECT_EQ(back.markers.names, trial.markers.names);
      EXPECT_EQ(back.markers.time, trial.markers.time);
      EXPECT_EQ(back.software, "kinemark");
      EXPECT_EQ(back.units_in_file, "mm");
      const double step_m = largest_coordinate(trial) / 32000.0;
      const double tolerance_m = integers ? 0.51 * step_m : 2e-7;
      for (std::size_t i = 0; i < trial.markers.state.size(); ++i) {
        ASSERT_EQ(back.markers.state[i], trial.markers.state[i]) << i;
        if (back.markers.state[i] == SampleState::missing || back.markers.state[i] == SampleState::rejected)
          continue;
        for (std::size_t a = 3 * i; a < 3 * i + 3; ++a)
          ASSERT_NEAR(back.markers.x_in_world[a], trial.markers.x_in_world[a], tolerance_m);
        ASSERT_EQ(std::isfinite(back.residual_m[i]), trial.markers.state[i] == SampleState::measured);
        if (trial.markers.state[i] != SampleState::measured) continue;
        ASSERT_NEAR(back.residual_m[i], trial.residual_m[i], 0.51 * step_m);
        ASSERT_EQ(back.camera_mask[i], trial.camera_mask[i]);
      }
      EXPECT_EQ(back.analog.names, trial.analog.names);
      EXPECT_EQ(back.analog.units, trial.analog.units);
      EXPECT_EQ(back.analog.rate_hz, trial.analog.rate_hz);
      ASSERT_EQ(back.analog.values.size(), trial.analog.values.size());
      for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
        ASSERT_NEAR(back.analog.values[i], trial.analog.values[i], integers ? 0.0126 : 4e-5);
    }
  }
}

TEST(C3dWriter, MeasuredWithoutResidualIsStillMeasured) {
  const Trial trial = simulate_trial({.residuals = false});
  const Trial back = round_trip(trial);
  EXPECT_EQ(back.markers.state, trial.markers.state);
  EXPECT_FALSE(back.residual_m.empty()) << "one step, the placeholder";
  EXPECT_TRUE(back.camera_mask.empty());
}

TEST(C3dWriter, ATrialThatWasNeverMeasuredStaysSo) {
  Trial trial = simulate_trial({.gaps = false, .residuals = false});
  std::ranges::fill(trial.markers.state, SampleState::model_filled);
  const Trial back = round_trip(trial);
  EXPECT_EQ(back.markers.state, trial.markers.state);
  EXPECT_TRUE(back.residual_m.empty());
}

TEST(C3dWriter, AMarkerAtTheOriginIsNotLost) {
  Trial trial = simulate_trial({.gaps = false});
  trial.markers.x(0, 0).setZero();
  trial.markers.x(1, 0).setConstant(1e-300);
  for (const bool integers : {false, true}) {
    const Trial back = round_trip(trial, {.integers = integers});
    EXPECT_EQ(back.markers.count_missing(), 0);
    EXPECT_LT(back.markers.x(0, 0).norm(), integers ? 1e-4 : 1e-8);
  }
}

TEST(C3dWriter, CoordinatesThatAreNextToNothingAreWritten) {
  Trial trial = simulate_trial({.markers = 2, .frames = 5, .channels = 0});
  for (double& v : trial.markers.x_in_world)
    if (std::isfinite(v)) v = 1e-50;
  const auto missing = trial.markers.count_missing();
  trial.residual_m.clear();
  trial.camera_mask.clear();
  for (const bool integers : {false, true}) {
    const Trial back = round_trip(trial, {.integers = integers});
    EXPECT_LT(largest_coordinate(back), 1e-8) << "not (0, 0, 0), which would be missing";
    EXPECT_EQ(back.markers.count_missing(), missing);
  }
}

TEST(C3dWriter, LargeResidualsAreKept) {
  Trial trial = simulate_trial({.gaps = false});
  trial.residual_m[0] = 0.08F;
  EXPECT_NEAR(round_trip(trial).residual_m[0], 0.08, 2e-4);
}

TEST(C3dWriter, MoreThan65535FramesInEveryWayOfCounting) {
  const ScratchFolder scratch;
  Trial trial = simulate_trial({.markers = 2, .frames = 70000});
  trial.first_frame = 65000;
  trial.markers.time.t0_s = 64999.0 / 240.0;
  ASSERT_TRUE(write_c3d(scratch / "long.c3d", trial));
  const auto reader = C3dReader::open(scratch / "long.c3d").value();
  EXPECT_EQ(reader.header().first_frame, 1);
  EXPECT_EQ(reader.header().last_frame, 65535);
  EXPECT_EQ(reader.parameters().number("POINT", "FRAMES"), -1.0) << "65535 in 16 bits";
  EXPECT_EQ(reader.parameters().number("POINT", "LONG_FRAMES"), 70000.0);
  const Trial back = read_trial(reader).value();
  EXPECT_THAT(back.warnings, ElementsAre());
  EXPECT_EQ(back.markers.frames(), 70000);
  EXPECT_EQ(back.first_frame, 65000);
  EXPECT_EQ(back.last_frame(), 134999);
  EXPECT_NEAR(back.markers.time.t0_s, trial.markers.time.t0_s, 1e-9);
  for (std::int64_t f = 69000; f < 70000; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      if (!trial.markers.present(f, m)) continue;
      ASSERT_NEAR((back.markers.x(f, m) - trial.markers.x(f, m)).norm(), 0.0, 4e-7);
    }
}

TEST(C3dWriter, MoreThan255LabelsOverflowIntoFurtherParameters) {
  const ScratchFolder scratch;
  const Trial trial = simulate_trial({.markers = 600, .frames = 3, .channels = 300, .samples_per_frame = 1});
  ASSERT_TRUE(write_c3d(scratch / "wide.c3d", trial));
  const auto reader = C3dReader::open(scratch / "wide.c3d").value();
  EXPECT_THAT(reader.parameters().find("POINT", "LABELS")->dims, ElementsAre(4, 255));
  EXPECT_THAT(reader.parameters().find("POINT", "LABELS3")->dims, ElementsAre(4, 90));
  EXPECT_THAT(reader.parameters().find("ANALOG", "SCALE2")->dims, ElementsAre(45));
  const Trial back = read_trial(reader).value();
  EXPECT_EQ(back.markers.names, trial.markers.names);
  EXPECT_EQ(back.analog.names, trial.analog.names);
  EXPECT_EQ(back.analog.units, trial.analog.units);
  EXPECT_THAT(back.warnings, ElementsAre());
}

TEST(C3dWriter, EventsKeepTheirClock) {
  Trial trial = simulate_trial({.frames = 20});
  trial.first_frame = 14400 * 60 + 1;  // an hour into the recording
  trial.markers.time.t0_s = 3600.0;
  for (int i = 0; i < 300; ++i)
    trial.events.push_back({.label = i % 2 == 0 ? "Foot Strike" : "Foot Off",
                            .context = i % 3 == 0 ? "Left" : "",
                            .time_s = 3600.0 + 0.01 * i + 0.001});
  const Trial back = round_trip(trial);
  ASSERT_EQ(back.events.size(), 300U);
  for (std::size_t i = 0; i < back.events.size(); ++i) {
    EXPECT_EQ(back.events[i].label, trial.events[i].label);
    EXPECT_EQ(back.events[i].context, trial.events[i].context);
    EXPECT_NEAR(back.events[i].time_s, trial.events[i].time_s, 5e-6);
  }
}

TEST(C3dWriter, ForcePlatesKeepGeometryChannelsAndCalibration) {
  Trial trial = simulate_trial({.channels = 14});
  data::ForcePlate plate{.type = 4,
                         .corners_in_world = {Eigen::Vector3d{0.6, 0.4, 0.0}, Eigen::Vector3d{0.0, 0.4, 0.0},
                                              Eigen::Vector3d{0.0, 0.0, 0.0}, Eigen::Vector3d{0.6, 0.0, 0.0}},
                         .origin_in_plate = {0.001, -0.002, -0.04},
                         .channel_idx = {0, 1, 2, 3, 4, 5},
                         .calibration_rows = 6};
  for (int i = 0; i < 36; ++i) plate.calibration.push_back(0.5 * i);
  trial.force_plates.push_back(plate);
  trial.force_plates.push_back({.type = 3, .channel_idx = {6, 7, 8, 9, 10, 11, 12, 13}});
  for (int i = 0; i < 12; ++i) trial.force_plates[1].pressure_correction.push_back(0.25 * i - 1.0);
  const Trial back = round_trip(trial, {.units = "m"});
  EXPECT_EQ(back.units_in_file, "m");
  ASSERT_EQ(back.force_plates.size(), 2U);
  EXPECT_THAT(back.force_plates[0].channel_idx, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(back.force_plates[1].channel_idx, ElementsAre(6, 7, 8, 9, 10, 11, 12, 13));
  EXPECT_EQ(back.force_plates[0].calibration, plate.calibration);
  EXPECT_THAT(back.force_plates[0].pressure_correction, ElementsAre());
  EXPECT_EQ(back.force_plates[1].pressure_correction, trial.force_plates[1].pressure_correction);
  // Of a copy whose first plate is left out, too.
  Trial second = back;
  second.force_plates.erase(second.force_plates.begin());
  const Trial again = round_trip(second);
  EXPECT_EQ(again.force_plates.at(0).pressure_correction, trial.force_plates[1].pressure_correction);
  for (std::size_t c = 0; c < 4; ++c)
    EXPECT_NEAR((back.force_plates[0].corners_in_world[c] - plate.corners_in_world[c]).norm(), 0.0, 1e-7);
  EXPECT_NEAR((back.force_plates[0].origin_in_plate - plate.origin_in_plate).norm(), 0.0, 1e-8);
}

TEST(C3dWriter, ATrialThatStartsLateIsNumberedSo) {
  Trial trial = simulate_trial({});
  trial.markers.time.t0_s = 0.4;  // as a TRC file gives it, with first_frame 1
  const Trial back = round_trip(trial);
  EXPECT_EQ(back.first_frame, 97);
  EXPECT_NEAR(back.markers.time.t0_s, 0.4, 1e-12);
  trial.markers.time.t0_s = 0.0;
  trial.first_frame = 0;
  EXPECT_EQ(round_trip(trial).first_frame, 0);
}

TEST(C3dWriter, NamesSurviveInUtf8) {
  Trial trial = simulate_trial({.markers = 2});
  trial.markers.names = {"Vänster tå", "左足先"};
  EXPECT_EQ(round_trip(trial).markers.names, trial.markers.names);
}

TEST(C3dWriter, SaysWhatItCannotWrite) {
  const ScratchFolder scratch;
  const auto message = [&](const Trial& t, const C3dWriteOptions& options = {}) {
    const auto status = write_c3d(scratch / "bad.c3d", t, options);
    EXPECT_FALSE(status);
    EXPECT_EQ(scratch.count_files(), 0) << "nothing half-written";
    return status ? std::string() : status.error().message;
  };
  Trial trial = simulate_trial({.frames = 10, .channels = 1});
  trial.analog.samples = 39;
  trial.analog.values.resize(39);
  EXPECT_THAT(message(trial), HasSubstr("bad.c3d: has 39 analog samples for 10 frames"));
  trial = simulate_trial({.frames = 10, .channels = 1});
  trial.analog.rate_hz = 100.0;
  EXPECT_THAT(message(trial), HasSubstr("100 Hz"));
  trial = simulate_trial({.frames = 10, .channels = 1});
  trial.analog.values[3] = NAN;
  EXPECT_THAT(message(trial, {.integers = true}), HasSubstr("channel 'F1' holds nan"));
  EXPECT_THAT(message(simulate_trial({.frames = 0})), HasSubstr("no frames"));
  EXPECT_THAT(message(simulate_trial({}), {.units = "furlong"}), HasSubstr("furlong"));
  trial = simulate_trial({.markers = 5000, .frames = 1});
  for (std::string& name : trial.markers.names) name += std::string(40, 'x');
  EXPECT_THAT(message(trial), HasSubstr("room for 255"));
  trial = simulate_trial({});
  trial.markers.names[1] = trial.markers.names[0];
  EXPECT_THAT(message(trial), HasSubstr("occurs twice"));
  trial = simulate_trial({.markers = 1, .frames = 1, .gaps = false});
  trial.markers.x(0, 0).setConstant(1e300);
  EXPECT_THAT(message(trial), HasSubstr("single precision"));
}

TEST(C3dWriter, ReplacesAFileOnlyWhenForced) {
  const ScratchFolder scratch;
  const Trial trial = simulate_trial({});
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  EXPECT_EQ(write_c3d(scratch / "a.c3d", trial).error().code, Code::io);
  EXPECT_TRUE(write_c3d(scratch / "a.c3d", trial, {.force = true}));
}

TEST(WriteC3d, AChannelOfOneNumberKeepsItAndTheOthersAreSaid) {
  const testing_support::ScratchFolder scratch;
  Trial trial = simulate_trial({.markers = 2, .frames = 3, .channels = 0});
  trial.channels = {
      .names = {"knee", "hip"},
      .kinds = {data::ChannelKind::angle, data::ChannelKind::angle},
      .units = {"deg", "deg"},
      .rate_hz = trial.markers.time.rate_hz,
      .frames = 3,
      .values = {17.0, NAN, NAN, 1, 2, 3, NAN, NAN, NAN, 1, 2, 3, 18.0, NAN, NAN, NAN, NAN, NAN}};
  std::vector<std::string> lost;
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial, {.lost = &lost}));
  EXPECT_THAT(lost,
              ElementsAre("1 channel that is no marker has fewer than three numbers: those that are not "
                          "there are kept as 0 in a .c3d file"));
  const auto back = read_c3d(scratch / "a.c3d");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(std::vector<double>(back->channels.values.begin(), back->channels.values.begin() + 6),
              ElementsAre(17.0, 0.0, 0.0, 1.0, 2.0, 3.0));
  EXPECT_TRUE(std::isnan(back->channels.values[6])) << "no number in this frame";
  EXPECT_EQ(back->channels.values[12], 18.0);
}

}  // namespace
}  // namespace kinemark::io
