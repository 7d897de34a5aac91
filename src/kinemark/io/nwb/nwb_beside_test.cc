// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a file holds besides movement: listed, carried into results byte for byte, never doubled.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/io/nwb/testing/others.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "kinemark/io/nwb/testing/sample_session.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::array kOfOthers = {"/units/spike_times", "/units/id", "/acquisition/lfp/data",
                                  "/acquisition/lfp/starting_time", "/intervals/trials/timeseries"};

data::Trial small_trial() {
  data::Trial trial = testing::sample_trial(40);
  trial.markers.covariance.clear();
  return trial;
}

/// A file of ours that another program has added to.
std::filesystem::path make_source(const testing_support::ScratchFolder& scratch) {
  EXPECT_TRUE(write_nwb(scratch / "in.nwb", small_trial()));
  testing::add_others(scratch / "in.nwb");
  return scratch / "in.nwb";
}

void expect_carried(const std::filesystem::path& from, const std::filesystem::path& to) {
  for (const char* dataset : kOfOthers)
    EXPECT_TRUE(testing::content(to, dataset) == testing::content(from, dataset)) << dataset;
  EXPECT_EQ(testing::content(to, "/intervals/trials/timeseries"),
            "0 100 /acquisition/lfp\n100 50 /acquisition/lfp\n")
      << "references lead where they led";
}

const data::BesideObject& object_at(const data::Beside& beside, const std::string& path) {
  const auto found = std::ranges::find(beside.objects, path, &data::BesideObject::path);
  EXPECT_NE(found, beside.objects.end()) << path;
  return found == beside.objects.end() ? beside.objects.front() : *found;
}

TEST(NwbBeside, OfAFileOfOursAloneIsNothing) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", small_trial()));
  const auto file = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->trial.beside.objects, IsEmpty());
  EXPECT_EQ(file->trial.beside.file, "");
}

TEST(NwbBeside, AnotherPersonThanNobodyIsSomething) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", small_trial(), nullptr, testing::sample_metadata()));
  const auto file = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->trial.beside.objects.size(), 2U);
  EXPECT_EQ(file->trial.beside.objects[0].path, "/general/subject");
  EXPECT_EQ(file->trial.beside.objects[1].type, "date 2026-11-21T09:30:00.250+01:00");
}

TEST(NwbBeside, IsListedWithShapesRatesAndUnits) {
  const testing_support::ScratchFolder scratch;
  const auto file = read_nwb(make_source(scratch));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_THAT(file->warnings, IsEmpty()) << "what others add does not touch the digest of what is ours";
  std::vector<std::string> paths;
  for (const auto& object : file->trial.beside.objects) paths.push_back(object.path);
  EXPECT_THAT(paths, ElementsAre("/acquisition/lfp", "/acquisition/raw", "/acquisition/same",
                                 "/general/devices/probe", "/general/lab", "/intervals/trials", "/odd/again",
                                 "/units"));
  const auto& beside = file->trial.beside;
  EXPECT_EQ(beside.room, "/processing/behavior");
  const auto& lfp = object_at(beside, "/acquisition/lfp");
  EXPECT_EQ(lfp.type, "ElectricalSeries");
  EXPECT_THAT(lfp.shape, ElementsAre(6000, 4));
  EXPECT_EQ(lfp.rate_hz, 1000.0);
  EXPECT_EQ(lfp.unit, "volts");
  EXPECT_EQ(lfp.lost, "");
  EXPECT_THAT(object_at(beside, "/units").shape, ElementsAre(40));
  EXPECT_EQ(object_at(beside, "/acquisition/same").type, "link to /acquisition/lfp");
  EXPECT_EQ(object_at(beside, "/acquisition/raw").type, "link to another file, elsewhere.h5");
  EXPECT_NE(object_at(beside, "/acquisition/raw").lost, "");
  EXPECT_EQ(object_at(beside, "/odd/again").type, "another name of an object");
}

TEST(NwbBeside, GoesAlongByteForByte) {
  const testing_support::ScratchFolder scratch;
  const auto source = make_source(scratch);
  const auto before = read_text(source).value();
  auto trial = read_nwb(source).value().trial;
  trial.markers.x(3, 0) += Eigen::Vector3d(0.25, 0.0, 0.0);
  ASSERT_TRUE(write_nwb(scratch / "out.nwb", trial, nullptr, {}, {.beside = &trial.beside}));
  EXPECT_TRUE(read_text(source).value() == before) << "the input is not touched";
  expect_carried(source, scratch / "out.nwb");
  const auto back = read_nwb(scratch / "out.nwb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(testing::same_bits(back->trial.markers.x_in_world, trial.markers.x_in_world));
  EXPECT_EQ(back->trial.analog.names, trial.analog.names);
  EXPECT_EQ(back->trial.events.size(), trial.events.size());
  EXPECT_THAT(back->warnings, IsEmpty());
  EXPECT_EQ(back->trial.beside.objects.size(), trial.beside.objects.size());
}

TEST(NwbBeside, TwiceDoublesNothingAndGivesTheSameBytes) {
  const testing_support::ScratchFolder scratch;
  const auto source = make_source(scratch);
  const auto pass = [&](const char* from, const char* to) {
    const auto trial = read_nwb(scratch / from).value().trial;
    const auto status = write_nwb(scratch / to, trial, nullptr, {}, {.beside = &trial.beside});
    EXPECT_TRUE(status) << status.error().message;
  };
  pass("in.nwb", "one.nwb");
  pass("in.nwb", "same.nwb");
  EXPECT_TRUE(read_text(scratch / "one.nwb").value() == read_text(scratch / "same.nwb").value());
  pass("one.nwb", "two.nwb");
  pass("two.nwb", "three.nwb");
  const internal::Quiet quiet;
  const auto list = [&](const char* name) {
    auto in = internal::Input::open(scratch / name).value();
    return std::pair(internal::listed_content(in), internal::all_content(in));
  };
  EXPECT_EQ(list("three.nwb"), list("one.nwb"));
  expect_carried(source, scratch / "three.nwb");
  EXPECT_LT(std::filesystem::file_size(scratch / "three.nwb"), 3 * std::filesystem::file_size(source));
}

TEST(NwbBeside, NeuronsOfOurOwnSessionsGoAlong) {
  const testing_support::ScratchFolder scratch;
  const auto neural = testing::sample_neural();
  ASSERT_TRUE(testing::write_session(scratch / "session.nwb", neural, {testing::sample_field()}));
  const auto trial = read_nwb(scratch / "session.nwb").value().trial;
  ASSERT_TRUE(write_nwb(scratch / "made.nwb", trial, nullptr, {}, {.beside = &trial.beside}));
  const auto back = read_neural(scratch / "made.nwb");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->units.size(), neural.units.size());
  EXPECT_TRUE(std::ranges::equal(back->units[0].times_s, neural.units[0].times_s));
  EXPECT_EQ(back->intervals.size(), 1U) << "trials";
  EXPECT_EQ(read_neural_lanes(scratch / "made.nwb").value().fields.size(), 1U);
  const auto at = [](const std::filesystem::path& path, const char* object) {
    return testing::content(path, object);
  };
  for (const char* object : {"/units/spike_times", "/intervals/trials/start_time"})
    EXPECT_EQ(at(scratch / "made.nwb", object), at(scratch / "session.nwb", object)) << object;
  EXPECT_THAT(read_nwb(scratch / "made.nwb").value().warnings, IsEmpty());
}

TEST(NwbBeside, PositionsOfOthersKeepTheirNames) {
  const testing_support::ScratchFolder scratch;
  {
    const internal::Quiet quiet;
    internal::Output out((scratch / "in.nwb").string(), "others");
    out.declare(out.file(), "NWBFile");
    out.text(out.file(), "identifier", "monkey");
    out.attribute(out.file(), "kinemark_set", "a");  // no mark of ours: these bytes stay wherever they are
    out.group(out.file(), "processing");
    const Handle module = out.group(out.file(), "/processing/behavior", "ProcessingModule");
    const Handle position = out.group(module.id(), "Position", "Position");
    const Handle hand = out.group(position.id(), "hand", "SpatialSeries");
    const Handle data = out.samples(hand.id(), "data", H5T_IEEE_F64LE, 2, 3, 0.0, 0);
    const std::array x{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
    out.write(data, H5T_NATIVE_DOUBLE, 0, 2, 3, x.data());
    out.attribute(data.id(), "unit", "meters");
    const Handle start = out.number(hand.id(), "starting_time", 1.5);
    out.attribute(start.id(), "rate", 100.0, H5T_IEEE_F64LE);
    ASSERT_TRUE(out.close());
  }
  testing::add_others(scratch / "in.nwb");
  auto trial = read_nwb(scratch / "in.nwb").value().trial;
  EXPECT_EQ(trial.beside.room, "/processing/kinemark");
  trial.markers.x(0, 0).x() = 9.0;
  ASSERT_TRUE(
      write_nwb(scratch / "out.nwb", trial, nullptr, {}, {.ndx_pose = true, .beside = &trial.beside}));
  const auto back = read_nwb(scratch / "out.nwb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->trial.markers.x(0, 0).x(), 9.0);
  EXPECT_EQ(back->trial.markers.time.t0_s, 1.5);
  EXPECT_EQ(back->metadata.identifier, "monkey");
  constexpr auto kHand = "/processing/behavior/Position/hand/data";
  EXPECT_EQ(testing::content(scratch / "out.nwb", kHand), testing::content(scratch / "in.nwb", kHand));
  EXPECT_EQ(testing::content(scratch / "out.nwb", "/processing/kinemark/PoseEstimation/hand/data"),
            testing::content(scratch / "out.nwb", "/processing/kinemark/Position/hand/data"));
  expect_carried(scratch / "in.nwb", scratch / "out.nwb");
  ASSERT_TRUE(write_nwb(scratch / "two.nwb", back->trial, nullptr, {}, {.beside = &back->trial.beside}));
  EXPECT_EQ(testing::content(scratch / "two.nwb", "/processing/kinemark_2/Position/hand/data"), "absent");
}

TEST(NwbBeside, AnotherSetLeavesNoMarkOfTheOlder) {
  const testing_support::ScratchFolder scratch;
  NwbMetadata metadata{.set = "0123456789abcdef"};
  ASSERT_TRUE(write_nwb(scratch / "in.nwb", small_trial(), nullptr, metadata));
  testing::add_others(scratch / "in.nwb");
  const auto trial = read_nwb(scratch / "in.nwb").value().trial;
  ASSERT_TRUE(write_nwb(scratch / "none.nwb", trial, nullptr, {}, {.beside = &trial.beside}));
  EXPECT_EQ(read_text(scratch / "none.nwb")->find("kinemark_set="), std::string::npos);
  metadata.set = "fedcba9876543210";
  ASSERT_TRUE(write_nwb(scratch / "other.nwb", trial, nullptr, metadata, {.beside = &trial.beside}));
  EXPECT_EQ(read_nwb(scratch / "other.nwb")->metadata.set, "fedcba9876543210");
  EXPECT_EQ(read_text(scratch / "other.nwb")->find("0123456789abcdef"), std::string::npos);
}

std::vector<NwbTable> one_table(double value) {
  return {{.name = "measures",
           .description = "of movement",
           .columns = {{.name = "speed", .description = "m/s", .texts = {}, .numbers = {value}}}}};
}

TEST(NwbBeside, TablesGoIntoAModuleOfACopy) {
  const testing_support::ScratchFolder scratch;
  const auto source = make_source(scratch);
  const auto first = read_nwb(source).value().trial;
  const auto write = [&](const char* name, double value, const data::Beside& beside) {
    const auto status = write_nwb_tables(scratch / name, one_table(value), {}, false, &beside);
    EXPECT_TRUE(status) << status.error().message;
  };
  write("one.nwb", 1.0, first.beside);
  expect_carried(source, scratch / "one.nwb");
  const auto back = read_nwb(scratch / "one.nwb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(testing::same_bits(back->trial.markers.x_in_world, first.markers.x_in_world));
  write("two.nwb", 2.0, back->trial.beside);
  const double two = 2.0;
  EXPECT_EQ(testing::content(scratch / "two.nwb", "/processing/measures/measures/speed"),
            std::string(reinterpret_cast<const char*>(&two), sizeof two));
  EXPECT_EQ(testing::content(scratch / "two.nwb", "/processing/measures_2/measures/speed"), "absent");
  // A recording that is written again keeps its measures.
  const auto measured = read_nwb(scratch / "two.nwb").value().trial;
  ASSERT_TRUE(write_nwb(scratch / "three.nwb", measured, nullptr, {}, {.beside = &measured.beside}));
  EXPECT_NE(testing::content(scratch / "three.nwb", "/processing/measures/measures/speed"), "absent");
  EXPECT_TRUE(read_nwb(scratch / "three.nwb"));
}

TEST(NwbBeside, ANameThatOthersHaveIsRefusedAndNothingIsWritten) {
  const testing_support::ScratchFolder scratch;
  auto bare = small_trial();
  bare.analog = {};
  bare.force_plates.clear();
  ASSERT_TRUE(write_nwb(scratch / "in.nwb", bare));
  {
    internal::Output out(testing::open_for_writing(scratch / "in.nwb"), "others");
    out.group(out.file(), "/acquisition/analog_N", "TimeSeries");
    ASSERT_TRUE(out.close());
  }
  auto trial = small_trial();
  trial.beside = read_nwb(scratch / "in.nwb").value().trial.beside;
  const auto status = write_nwb(scratch / "out.nwb", trial, nullptr, {}, {.beside = &trial.beside});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::bad_input);
  EXPECT_THAT(status.error().message,
              HasSubstr("/acquisition/analog_N is there already and is not of kinemark"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "out.nwb"));
  EXPECT_EQ(scratch.count_files(), 1) << "nothing half-written";
}

TEST(NwbBeside, ACopyThatHdf5CannotOpenIsOneSentence) {
  const testing_support::ScratchFolder scratch;
  const internal::Quiet quiet;
  ASSERT_TRUE(write_nwb(scratch / "fresh.nwb", small_trial()));
  auto bytes = read_text(scratch / "fresh.nwb").value();
  ASSERT_TRUE(write_text(scratch / "cut.nwb", bytes.substr(0, 600), false));
  const auto carried = internal::carry_here(scratch / "cut.nwb", scratch / "fresh.nwb");
  ASSERT_FALSE(carried);
  EXPECT_THAT(carried.error().message, HasSubstr("cannot be opened for writing"));
}

TEST(NwbBeside, WhateverIsBrokenInACopyItIsWrittenOrRefusedInOneSentence) {
  const testing_support::ScratchFolder scratch;
  const auto source = make_source(scratch);
  const auto trial = read_nwb(source).value().trial;
  const auto whole = read_text(source).value();
  Random random(48, 0);
  int refused = 0;
  for (int round = 0; round < 24; ++round) {
    auto broken = whole;
    for (int k = 0; k < 40; ++k)
      broken[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(broken.size())))] ^=
          static_cast<char>(1 << (k % 8));
    ASSERT_TRUE(write_text(source, broken, true));
    const auto status =
        write_nwb(scratch / "out.nwb", trial, nullptr, {}, {.force = true, .beside = &trial.beside});
    EXPECT_EQ(scratch.count_files(), 1 + static_cast<int>(std::filesystem::exists(scratch / "out.nwb")));
    if (status) continue;
    ++refused;
    EXPECT_TRUE(status.error().code == Code::bad_input || status.error().code == Code::io);
    EXPECT_THAT(status.error().message, HasSubstr("out.nwb: "));
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
  EXPECT_GT(refused, 0);
}

TEST(NwbBeside, SamplesThatAreDamagedGoAlongAsTheyAre) {
  const testing_support::ScratchFolder scratch;
  const auto source = make_source(scratch);
  {
    const internal::Quiet quiet;
    const Handle file = testing::open_for_writing(source);
    const Handle data(H5Dopen2(file.id(), "/acquisition/lfp/data", H5P_DEFAULT), H5Dclose);
    haddr_t address = 0;
    hsize_t size = 0;
    unsigned mask = 0;
    std::array<hsize_t, 2> offset{};
    const Handle space(H5Dget_space(data.id()), H5Sclose);
    ASSERT_GE(H5Dget_chunk_info(data.id(), space.id(), 0, offset.data(), &mask, &address, &size), 0);
    std::fstream bytes(source, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(address) + 100);
    bytes.write("damage!", 7);
  }
  EXPECT_EQ(testing::content(source, "/acquisition/lfp/data"), "unreadable");
  const auto trial = read_nwb(source).value().trial;
  ASSERT_TRUE(write_nwb(scratch / "out.nwb", trial, nullptr, {}, {.beside = &trial.beside}));
  EXPECT_NE(read_text(scratch / "out.nwb")->find("damage!"), std::string::npos);
  EXPECT_EQ(testing::content(scratch / "out.nwb", "/units/spike_times"),
            testing::content(source, "/units/spike_times"));
}

}  // namespace
}  // namespace kinemark::io
