// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a recording holds besides positions: residuals, channels, analog channels, events and force plates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "kinemark/core/check.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::sample_trial;

void expect_same(const data::ForcePlate& got, const data::ForcePlate& wanted) {
  EXPECT_EQ(got.number, wanted.number);
  EXPECT_EQ(got.type, wanted.type);
  for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(got.corners_in_world[c], wanted.corners_in_world[c]);
  EXPECT_EQ(got.origin_in_plate, wanted.origin_in_plate);
  EXPECT_EQ(got.channel_idx, wanted.channel_idx);
  EXPECT_THAT(got.calibration, ::testing::Pointwise(::testing::NanSensitiveDoubleEq(), wanted.calibration));
  EXPECT_EQ(got.calibration_rows, wanted.calibration_rows);
  EXPECT_EQ(got.pressure_correction, wanted.pressure_correction);
  EXPECT_EQ(got.metres_per_unit, wanted.metres_per_unit);
}

void expect_same(const data::AnalogChannels& got, const data::AnalogChannels& wanted) {
  EXPECT_EQ(got.names, wanted.names);
  EXPECT_EQ(got.units, wanted.units);
  EXPECT_EQ(got.rate_hz, wanted.rate_hz);
  EXPECT_EQ(got.samples, wanted.samples);
  EXPECT_TRUE(testing::same_bits(got.values, wanted.values));
}

/// All that is not a position.
void expect_same(const data::Trial& got, const data::Trial& wanted) {
  EXPECT_EQ(got.first_frame, wanted.first_frame);
  ASSERT_EQ(got.residual_m.size(), wanted.residual_m.size());
  if (!wanted.residual_m.empty()) {
    EXPECT_EQ(std::memcmp(got.residual_m.data(), wanted.residual_m.data(), 4 * wanted.residual_m.size()), 0);
  }
  EXPECT_EQ(got.camera_mask, wanted.camera_mask);
  EXPECT_EQ(got.channels.names, wanted.channels.names);
  EXPECT_EQ(got.channels.kinds, wanted.channels.kinds);
  EXPECT_EQ(got.channels.units, wanted.channels.units);
  EXPECT_EQ(got.channels.rate_hz, wanted.channels.rate_hz);
  EXPECT_EQ(got.channels.frames, wanted.channels.frames);
  EXPECT_TRUE(testing::same_bits(got.channels.values, wanted.channels.values));
  expect_same(got.analog, wanted.analog);
  ASSERT_EQ(got.events.size(), wanted.events.size());
  for (std::size_t i = 0; i < wanted.events.size(); ++i) {
    EXPECT_EQ(got.events[i].label, wanted.events[i].label);
    EXPECT_EQ(got.events[i].context, wanted.events[i].context);
    EXPECT_EQ(got.events[i].time_s, wanted.events[i].time_s);
  }
  ASSERT_EQ(got.force_plates.size(), wanted.force_plates.size());
  for (std::size_t i = 0; i < wanted.force_plates.size(); ++i)
    expect_same(got.force_plates[i], wanted.force_plates[i]);
  EXPECT_EQ(got.unloaded_s, wanted.unloaded_s);
  EXPECT_EQ(got.calibration_error.fields, wanted.calibration_error.fields);
}

class NwbSignals : public ::testing::Test {
 protected:
  data::Trial round_trip(const data::Trial& trial, const NwbWriteOptions& options = {.force = true}) {
    const auto written = write_nwb(scratch_ / "a.nwb", trial, nullptr, {}, options);
    EXPECT_TRUE(written) << written.error().message;
    const auto back = read_nwb(scratch_ / "a.nwb");
    EXPECT_TRUE(back) << back.error().message;
    if (!back) return {};
    EXPECT_THAT(back->warnings, IsEmpty());
    return back->trial;
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(NwbSignals, EverythingComesBackBitByBit) {
  for (const std::int64_t frames : {2, 50, 5000}) {
    const data::Trial trial = sample_trial(frames);
    ASSERT_TRUE(trial.validate());
    const data::Trial back = round_trip(trial);
    expect_same(back, trial);
    EXPECT_TRUE(testing::same_bits(back.markers.x_in_world, trial.markers.x_in_world));
  }
}

TEST_F(NwbSignals, SamplesInBlocksOfRows) {
  data::Trial trial = sample_trial(2);
  trial.analog.samples = 200'001;
  Random random(3, 0);
  testing::fill(trial.analog.values, 5 * 200'001, -1.0, 1.0, random);
  expect_same(round_trip(trial), trial);
}

TEST_F(NwbSignals, WhatIsNotThereStaysAbsent) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.5, .frames = 2});
  trial.first_frame = 51;
  expect_same(round_trip(trial), trial);
  const internal::Quiet quiet;
  auto in = internal::Input::open(scratch_ / "a.nwb");
  ASSERT_TRUE(in);
  for (const char* path : {"/intervals", "/processing/behavior/events", "/processing/behavior/force_plates",
                           "/processing/behavior/analog_channels", "/processing/behavior/Residual"})
    EXPECT_FALSE(in->object(in->file(), path)) << path;
  EXPECT_THAT(*in->children(in->object(in->file(), "/acquisition").id()), IsEmpty());
}

TEST_F(NwbSignals, OddOnesComeBack) {
  data::Trial trial = sample_trial(3);
  trial.analog.units.clear();  // no unit of any channel
  trial.first_frame = -3;
  trial.unloaded_s = {0.0, -1.0};
  for (auto& plate : trial.force_plates) {
    plate.channel_idx.clear();
    plate.calibration.clear();
  }
  expect_same(round_trip(trial), trial);
  trial.analog.samples = 0;
  trial.analog.values.clear();
  trial.markers.sample_offset_s.assign(trial.markers.names.size(), 0.001);
  expect_same(round_trip(trial), trial);
}

TEST_F(NwbSignals, OneSeriesForEachUnitInWordsOfTheSI) {
  round_trip(sample_trial(4));
  const internal::Quiet quiet;
  auto in = internal::Input::open(scratch_ / "a.nwb");
  ASSERT_TRUE(in);
  EXPECT_THAT(*in->children(in->object(in->file(), "/acquisition").id()),
              ::testing::ElementsAre("analog", "analog_N", "analog_Nmm_V", "analog_mV"));
  const Handle force = in->object(in->file(), "/acquisition/analog_N");
  EXPECT_EQ(in->text_attribute(force.id(), "neurodata_type"), "TimeSeries");
  EXPECT_EQ(in->text_attribute(force.id(), "description"), "analog channels, a column each: Fx1 Fz1");
  const Handle data = in->object(force.id(), "data");
  EXPECT_EQ(in->number_shape(data.id()), (std::vector<std::int64_t>{17, 2}));
  EXPECT_EQ(in->text_attribute(data.id(), "unit"), "newtons");
  const Handle start = in->object(force.id(), "starting_time");
  EXPECT_EQ(in->number_attribute(start.id(), "rate"), 1000.0 / 3.0);
  const Handle emg = in->object(in->file(), "/acquisition/analog_mV/data");
  EXPECT_EQ(in->text_attribute(emg.id(), "unit"), "volts");
  EXPECT_EQ(in->number_attribute(emg.id(), "conversion"), 1e-3);
  const Handle none = in->object(in->file(), "/acquisition/analog/data");
  EXPECT_EQ(in->text_attribute(none.id(), "unit"), "n.a.");
}

TEST_F(NwbSignals, TablesArePlainForAnyProgram) {
  round_trip(sample_trial(4));
  const internal::Quiet quiet;
  auto in = internal::Input::open(scratch_ / "a.nwb");
  ASSERT_TRUE(in);
  const auto numbers = [&](const char* path) {
    const Handle column = in->object(in->file(), std::string(internal::kModule) + path);
    return in->numbers<double>(column.id()).value_or(Array<double>{});
  };
  const Handle corners = in->object(in->file(), "/processing/behavior/force_plates/corners");
  EXPECT_EQ(in->number_shape(corners.id()), (std::vector<std::int64_t>{3, 4, 3}));
  EXPECT_EQ(numbers("/force_plates/channels"), (Array<double>{0, 2, -1, 4, 3, 1, -1, -1, -1}));
  EXPECT_EQ(numbers("/force_plates/id"), (Array<double>{0, 1, 2}));
  EXPECT_EQ(numbers("/analog_channels/column"), (Array<double>{0, 0, 1, 0, 0}));
  const Handle unloaded = in->object(in->file(), "/intervals/plates_unloaded");
  EXPECT_EQ(in->text_attribute(unloaded.id(), "neurodata_type"), "TimeIntervals");
}

TEST_F(NwbSignals, TheWriterTakesThemOnceAndOfItsMarkers) {
  const data::Trial trial = sample_trial(4);
  auto writer = NwbWriter::create(scratch_ / "b.nwb", NwbOutline::of(trial.markers, nullptr)).value();
  data::Trial other = trial;
  other.markers.names[0] = "other";
  EXPECT_THROW(static_cast<void>(writer.write_signals(other)), ContractError);
  ASSERT_TRUE(writer.write(trial.markers));
  ASSERT_TRUE(writer.write_signals(trial));
  EXPECT_THROW(static_cast<void>(writer.write_signals(trial)), ContractError);
  ASSERT_TRUE(writer.commit());
  expect_same(read_nwb(scratch_ / "b.nwb").value().trial, trial);
}

TEST_F(NwbSignals, TheSameTrialGivesTheSameBytesAndAnInvalidOneNone) {
  data::Trial trial = sample_trial(4);
  for (const char* name : {"a.nwb", "b.nwb"}) ASSERT_TRUE(write_nwb(scratch_ / name, trial));
  EXPECT_EQ(read_text(scratch_ / "a.nwb").value(), read_text(scratch_ / "b.nwb").value());
  trial.force_plates[0].channel_idx = {5};
  const auto refused = write_nwb(scratch_ / "c.nwb", trial);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("a force plate uses analog channel 6; the file has 5"));
}

/// A file of signals that somebody spoils.
class HostileSignals : public ::testing::Test {
 protected:
  /// The sentence about a file after `spoil` changed it; "was read".
  template <class Spoil>
  std::string after(const Spoil& spoil) {
    EXPECT_TRUE(write_nwb(scratch_ / "small.nwb", sample_trial(12), nullptr, {}, {.force = true}));
    const internal::Quiet quiet;
    {
      const Handle file(H5Fopen((scratch_ / "small.nwb").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      // As files of older versions, so that it is not the digest that sees what was done.
      H5Adelete(file.id(), internal::kDigestAttribute);
      const Handle module(H5Gopen2(file.id(), internal::kModule, H5P_DEFAULT), H5Gclose);
      spoil(module.id());
    }
    const auto read = internal::read_nwb_here(scratch_ / "small.nwb");
    if (read) {
      EXPECT_TRUE(read->trial.validate());
    }
    if (read) return "was read";
    EXPECT_EQ(read.error().code, Code::bad_input);
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    return read.error().message;
  }
  /// The same with a dataset of `dims` in place of what was at `path`, `value` in each place of it.
  std::string replaced(const char* path, std::vector<hsize_t> dims, double value = 0.0,
                       hid_t type = H5T_IEEE_F64LE) {
    return after([&](hid_t module) {
      H5Ldelete(module, path, H5P_DEFAULT);
      const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
      const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      const std::vector<hsize_t> chunk(dims.size(), 1);
      H5Pset_chunk(create.id(), static_cast<int>(chunk.size()), chunk.data());
      if (type != H5T_C_S1) H5Pset_fill_value(create.id(), H5T_NATIVE_DOUBLE, &value);
      const Handle made(H5Dcreate2(module, path, type, space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT),
                        H5Dclose);
      EXPECT_TRUE(made) << path;
    });
  }
  std::string without(const char* path) {
    return after([&](hid_t module) { H5Ldelete(module, path, H5P_DEFAULT); });
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(HostileSignals, AFileOfOlderVersionsHoldsThemToo) {
  EXPECT_EQ(after([](hid_t) {}), "was read");
  for (const char* table : {"analog_channels", "events", "force_plates", "channels"})
    EXPECT_THAT(without(table), ::testing::AnyOf("was read", HasSubstr("force_plates/channels: holds")));
}

TEST_F(HostileSignals, AnalogChannelsThatDoNotFit) {
  EXPECT_THAT(
      without("analog_channels/series"),
      HasSubstr("small.nwb: /processing/behavior/analog_channels/series: does not hold a text for each row"));
  EXPECT_THAT(without("analog_channels/rate_hz"),
              HasSubstr("analog_channels/rate_hz: does not hold a number for each of 5 rows"));
  EXPECT_THAT(replaced("analog_channels/rate_hz", {5}, -3.0), HasSubstr("analog_channels/rate_hz"));
  EXPECT_THAT(replaced("analog_channels/rate_hz", {5}, NAN), HasSubstr("the same rate in each row"));
  EXPECT_THAT(replaced("analog_channels/column", {5}, 2.0),
              HasSubstr("analog_channels/column: holds 2; expected whole numbers from 0 to 0"));
  EXPECT_THAT(replaced("analog_channels/column", {5}, 0.5), HasSubstr("column: holds 0.5"));
  EXPECT_THAT(replaced("analog_channels/unit", {5}), HasSubstr("unit: does not hold a text for each row"));
  EXPECT_THAT(without("/acquisition/analog_N"),
              HasSubstr("/acquisition/analog_N: its data are not numbers of shape samples x channels"));
  EXPECT_THAT(replaced("/acquisition/analog_N/data", {49, 2, 1}), HasSubstr("shape samples x channels"));
  EXPECT_THAT(replaced("/acquisition/analog_N/data", {49, 2}, 0.0, H5T_C_S1),
              HasSubstr("shape samples x channels"));
  EXPECT_THAT(replaced("/acquisition/analog_N/data", {48, 2}),
              HasSubstr("/acquisition/analog_N: has 48 samples, /acquisition/analog has 49"));
}

TEST_F(HostileSignals, ChannelsAndResidualsThatDoNotFit) {
  EXPECT_THAT(replaced("Residual/a_b/data", {11}), HasSubstr("Residual/a_b: does not hold 12 samples"));
  EXPECT_THAT(without("Cameras/_."), HasSubstr("Cameras/_.: does not hold 12 samples"));
  EXPECT_THAT(replaced("Channels/a_b/data", {12, 2}),
              HasSubstr("Channels/a_b: does not hold 12 samples of 3 numbers"));
  EXPECT_THAT(without("channels/kind"), HasSubstr("channels/kind: does not hold a text for each row"));
  EXPECT_THAT(after([](hid_t m) {
                H5Ldelete(m, "channels/kind", H5P_DEFAULT);
                H5Lcreate_hard(m, "channels/channel", m, "channels/kind", H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("holds a word that is no kind of channel"));
}

TEST_F(HostileSignals, EventsAndPlatesThatDoNotFit) {
  EXPECT_THAT(replaced("events/timestamp", {2}),
              HasSubstr("events/timestamp: does not hold a number for each of 3 rows"));
  EXPECT_THAT(without("events/context"), HasSubstr("events/context: does not hold a text for each row"));
  EXPECT_THAT(replaced("force_plates/corners", {3, 3, 3}),
              HasSubstr("force_plates/corners: does not hold 12 numbers for each of 3 rows"));
  EXPECT_THAT(replaced("force_plates/number", {3}, 0.0), HasSubstr("expected whole numbers from 1 to 255"));
  EXPECT_THAT(replaced("force_plates/number", {256}, 1.0), HasSubstr("numbers of 1 to 255 plates"));
  EXPECT_THAT(replaced("force_plates/type", {3}, NAN), HasSubstr("force_plates/type: holds nan"));
  EXPECT_THAT(replaced("force_plates/metres_per_unit", {3}), HasSubstr("need a length in metres"));
  EXPECT_THAT(replaced("force_plates/channels", {3, 2}, 5.0),
              HasSubstr("force_plates/channels: holds 5; expected whole numbers from -1 to 4"));
  EXPECT_THAT(replaced("force_plates/channels", {3}), HasSubstr("as many numbers for each of 3 rows"));
  EXPECT_THAT(replaced("force_plates/channels", {2, 3}), HasSubstr("as many numbers for each of 3 rows"));
  EXPECT_THAT(replaced("force_plates/calibration_values", {3}, 5.0),
              HasSubstr("expected whole numbers from 0 to 4"));
  EXPECT_THAT(replaced("force_plates/calibration_rows", {3}, 1e9), HasSubstr("calibration_rows: holds"));
  EXPECT_THAT(replaced("force_plates/pressure_correction", {3, 11}),
              HasSubstr("force_plates/pressure_correction: does not hold 12 numbers for each of 3 rows"));
  EXPECT_EQ(replaced("force_plates/pressure_correction", {3, 12}, NAN), "was read");
  EXPECT_EQ(without("force_plates/pressure_correction"), "was read");
  EXPECT_THAT(after([](hid_t m) {
                std::vector<double> numbers(36, NAN);
                numbers[12] = 0.5;
                const Handle column(H5Dopen2(m, "force_plates/pressure_correction", H5P_DEFAULT), H5Dclose);
                H5Dwrite(column.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
              }),
              HasSubstr("force_plates/pressure_correction: has 1 of 12 numbers in row 2"));
  EXPECT_THAT(replaced("/intervals/plates_unloaded/stop_time", {1}, NAN), HasSubstr("unloaded from"));
  EXPECT_THAT(replaced("markers/first_frame", {5}, 1e300),
              HasSubstr("first_frame: holds no number of a frame"));
}

TEST_F(HostileSignals, ClaimsThatTheSizeOfTheFileDoesNotExplain) {
  for (const hsize_t many : {hsize_t{1} << 33, hsize_t{1} << 50}) {
    EXPECT_NE(replaced("/acquisition/analog_N/data", {many, 2}), "was read");
    EXPECT_NE(replaced("/acquisition/analog/data", {1, many}), "was read");
    EXPECT_NE(replaced("Channels/a_b/data", {many, 3}), "was read");
    EXPECT_NE(replaced("force_plates/number", {many}), "was read");
    EXPECT_NE(replaced("force_plates/channels", {3, many}), "was read");
    EXPECT_NE(replaced("force_plates/calibration", {3, many}), "was read");
    EXPECT_NE(replaced("events/label", {many}, 0.0, H5T_C_S1), "was read");
    EXPECT_NE(replaced("analog_channels/channel", {many}, 0.0, H5T_C_S1), "was read");
  }
}

}  // namespace
}  // namespace kinemark::io
