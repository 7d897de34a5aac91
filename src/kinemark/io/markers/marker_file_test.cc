// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/marker_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

data::Trial small() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f) {
    trial.markers.x(f, 0) = Eigen::Vector3d(0.5, 0.25, 1.0 + 0.125 * static_cast<double>(f));
    trial.markers.state[trial.markers.index(f, 0)] = data::SampleState::measured;
  }
  return trial;
}

TEST(MarkerFile, WhatIsWrittenReadsBackByTheSameDoor) {
  const testing_support::ScratchFolder scratch;
  for (const char* name : {"a.c3d", "a.trc", "a.nwb", "a.mat", "a.csv", "B.C3D", "B.Trc", "B.NWB"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(write_markers(scratch / name, small(), false));
    const auto back = read_markers(scratch / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->markers.names, small().markers.names);
    EXPECT_EQ(back->markers.time, small().markers.time);
    EXPECT_EQ(back->markers.state, small().markers.state);
    for (std::int64_t f = 0; f < 3; ++f)
      EXPECT_LT((back->markers.x(f, 0) - small().markers.x(f, 0)).norm(), 1e-6);
    EXPECT_EQ(write_markers(scratch / name, small(), false).error().code, Code::io);
    EXPECT_TRUE(write_markers(scratch / name, small(), true));
  }
}

TEST(MarkerFile, AFormatCanBeCheckedBeforeThereIsAnythingToWrite) {
  for (const char* name : {"a.c3d", "no/such/folder/a.TRC", "a.nwb", "a.Csv"})
    EXPECT_TRUE(check_marker_format(name)) << name;
  for (const char* name : {"a.mot", "a.v3d", "a", "c3d", "a.c3d.gz", ".csv"}) {
    const auto status = check_marker_format(name);
    ASSERT_FALSE(status) << name;
    EXPECT_EQ(status.error().code, Code::usage);
    EXPECT_THAT(status.error().message, testing::StartsWith(std::string(name) + ": "));
    EXPECT_THAT(status.error().message, HasSubstr("supported are .c3d, .trc, .nwb, "));
    EXPECT_EQ(write_markers(name, small(), false).error().message, status.error().message);
  }
}

TEST(MarkerFile, TheContentDecidesBeforeTheExtension) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_markers(scratch / "a.c3d", small(), false));
  ASSERT_TRUE(write_markers(scratch / "a.trc", small(), false));
  fs::rename(scratch / "a.c3d", scratch / "really_c3d.trc");
  fs::rename(scratch / "a.trc", scratch / "really_trc");
  EXPECT_EQ(read_markers(scratch / "really_c3d.trc").value().format, "C3D");
  EXPECT_EQ(read_markers(scratch / "really_trc").value().format, "TRC");
}

TEST(MarkerFile, BrokenFilesGetTheirFormatsSentence) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "empty.trc", "", false));
  EXPECT_THAT(read_markers(scratch / "empty.trc").error().message, HasSubstr("expected a TRC file"));
  ASSERT_TRUE(write_text(scratch / "empty.c3d", "", false));
  const auto c3d = read_markers(scratch / "empty.c3d");
  EXPECT_EQ(c3d.error().code, Code::bad_input);
  EXPECT_THAT(c3d.error().message, HasSubstr("C3D"));
}

TEST(MarkerFile, OtherFilesAreAnsweredWithWhatIsSupported) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "q.mot", "Coordinates\nendheader\n", false));
  ASSERT_TRUE(write_text(scratch / "README", "aPlain text with a P in second place", false));
  const auto motion = read_markers(scratch / "q.mot");
  EXPECT_EQ(motion.error().code, Code::not_supported);
  EXPECT_THAT(
      motion.error().message,
      ::testing::AllOf(
          HasSubstr("a .mot file is not read as a marker file: its first line has one cell, and a table of "),
          HasSubstr("labels there such as time, LASI_X, LASI_Y, LASI_Z; supported are "
                    "C3D (.c3d), TRC (.trc), NWB")));
  ASSERT_TRUE(write_text(scratch / "ball.txt", "#Kinovea Trajectory data export\n#T X Y\n0 1 2\n", true));
  EXPECT_THAT(
      read_markers(scratch / "ball.txt").error().message,
      HasSubstr(
          "it holds paths that Kinovea followed in the image of one camera, and no positions in space"));
  ASSERT_TRUE(write_text(scratch / "tabs.txt", "Time\tFP1.ForX\n0\t1\n", true));
  EXPECT_THAT(read_markers(scratch / "tabs.txt").error().message,
              HasSubstr("its first line has 2 cells between tabs, and"));
  ASSERT_TRUE(write_text(scratch / "commas.txt", "when,where,who\n0,1,2\n", true));
  EXPECT_THAT(
      read_markers(scratch / "commas.txt").error().message,
      ::testing::AllOf(HasSubstr("its first line has 3 cells between commas, and"), Not(HasSubstr("where"))));
  ASSERT_TRUE(write_text(scratch / "bytes.dat", std::string("a\0b", 3), true));
  EXPECT_THAT(read_markers(scratch / "bytes.dat").error().message,
              HasSubstr("a .dat file is not read as a marker file; supported are"));
  EXPECT_THAT(read_markers(scratch / "README").error().message, HasSubstr("a file without an extension"));
  EXPECT_EQ(read_markers(scratch / "absent.trc").error().code, Code::io);
  EXPECT_EQ(read_markers(scratch.path()).error().code, Code::bad_input);
  const auto status = write_markers(scratch / "q.xlsx", small(), false);
  EXPECT_EQ(status.error().code, Code::usage);
  EXPECT_THAT(status.error().message, HasSubstr("supported are .c3d, .trc, .nwb, "));
}

TEST(MarkerFile, PointsInPixelsAreNoMarkers) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "left.csv", "scorer,n,n\nbodyparts,A,A\ncoords,x,y\n0,1,2\n", false));
  ASSERT_TRUE(write_text(scratch / "left.json", R"({"images": [{"id": 1}]})", false));
  ASSERT_TRUE(write_text(scratch / "v_0_keypoints.json", R"({"version":1.3,"people":[]})", false));
  for (const char* name : {"left.csv", "left.json", "v_0_keypoints.json"}) {
    const auto read = read_markers(scratch / name);
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().code, Code::not_supported);
    EXPECT_THAT(read.error().message,
                HasSubstr(std::string(name) + ": holds points in the images of a camera"));
  }
  ASSERT_TRUE(write_text(scratch / "other.json", R"({"a": 1})", false));
  EXPECT_THAT(read_markers(scratch / "other.json").error().message, HasSubstr("a .json file is not read"));
}

TEST(MarkerFile, Visual3dTextNeedsARateAndOthersRefuseOne) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a.V3D",
                         "\ts\ts\ts\n\tA\tA\tA\n\tTARGET\tTARGET\tTARGET\n\tp\tp\tp\n"
                         "ITEM\tX\tY\tZ\n5\t1\t2\t3\n",
                         false));
  EXPECT_TRUE(needs_rate(scratch / "a.V3D"));
  EXPECT_FALSE(needs_rate(scratch / "a.c3d"));
  const auto without = read_markers(scratch / "a.V3D");
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().code, Code::usage);
  const auto with = read_markers(scratch / "a.V3D", {.rate_hz = 179.0});
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_EQ(with->markers.time, (TimeBase{179.0, 0.0, 1}));
  EXPECT_EQ(with->first_frame, 5);
  ASSERT_TRUE(write_markers(scratch / "a.trc", small(), false));
  const auto twice = read_markers(scratch / "a.trc", {.rate_hz = 100.0});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, Code::usage);
  EXPECT_THAT(twice.error().message, HasSubstr("the file stores its own rate"));
}

TEST(MarkerFile, ATableWithoutTimesNeedsARateAndOneWithTimesRefusesIt) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a.csv", "frame,A_x,A_y,A_z\n1,0,0,1\n2,0,0,1.5\n", false));
  ASSERT_TRUE(write_text(scratch / "b.csv", "time,A_x,A_y,A_z\n0,0,0,1\n0.5,0,0,1.5\n", false));
  EXPECT_TRUE(needs_rate(scratch / "a.csv"));
  EXPECT_FALSE(needs_rate(scratch / "b.csv"));
  EXPECT_FALSE(needs_rate(scratch / "absent.csv"));
  EXPECT_THAT(read_markers(scratch / "a.csv", {.unit = "m"}).error().message, HasSubstr("with --rate HZ"));
  EXPECT_EQ(read_markers(scratch / "a.csv", {.rate_hz = 200.0, .unit = "m"}).value().markers.time,
            (TimeBase{200.0, 0.0, 2}));
  EXPECT_EQ(read_markers(scratch / "b.csv", {.unit = "m"}).value().markers.time.rate_hz, 2.0);
  EXPECT_THAT(read_markers(scratch / "b.csv", {.rate_hz = 2.0, .unit = "m"}).error().message,
              HasSubstr("stores its own rate"));
}

TEST(MarkerFile, TextsOfOtherKindsAreRefusedWithWhatTheyHold) {
  const testing_support::ScratchFolder scratch;
  for (const char* name : {"k.csv", "k.txt"}) {
    ASSERT_TRUE(write_text(scratch / name, "Time (ms);Trajectory 1/0/X;Trajectory 1/0/Y\n0;1;2\n", false));
    const auto refused = read_markers(scratch / name);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::not_supported);
    EXPECT_THAT(refused.error().message, HasSubstr("paths that Kinovea followed in the image of one camera"));
  }
}

TEST(MarkerFile, AnglesOfAVisual3dTextGoAlongAsChannels) {
  const testing_support::ScratchFolder scratch;
  const std::string head =
      "\ta.c3d\ta.c3d\ta.c3d\ta.c3d\ta.c3d\ta.c3d\n\tHip\tHip\tHip\tHip\tHip\tHip\n"
      "\tLANDMARK\tLANDMARK\tLANDMARK\tLINK_MODEL_BASED\tLINK_MODEL_BASED\tLINK_MODEL_BASED\n"
      "\tPROCESSED\tPROCESSED\tPROCESSED\tPROCESSED\tPROCESSED\tPROCESSED\nITEM\tX\tY\tZ\tX\tY\tZ\n";
  ASSERT_TRUE(
      write_text(scratch / "a.v3d", head + "1\t1\t2\t3\t90.1\t0.2\t-45.3\n2\t4\t5\t6\t7\t\t9\n", false));
  ASSERT_TRUE(write_text(scratch / "a.txt", head + "1\t1\t2\t3\t90.1\t0.2\t-45.3\n", false));
  EXPECT_EQ(read_markers(scratch / "a.txt", {.rate_hz = 100.0}).value().format,
            read_markers(scratch / "a.v3d", {.rate_hz = 100.0}).value().format)
      << "known by its content";
  const auto trial = read_markers(scratch / "a.v3d", {.rate_hz = 100.0});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->channels.names, testing::ElementsAre("Hip_angles_XYZ"));
  EXPECT_THAT(trial->channels.units, testing::ElementsAre("deg"));
  EXPECT_EQ(trial->channels.kinds, std::vector{data::ChannelKind::angle});
  EXPECT_EQ(trial->channels.values.at(0), 90.1) << "the file's own number";
  EXPECT_TRUE(std::isnan(trial->channels.values.at(4)));
  ASSERT_TRUE(write_markers(scratch / "a.c3d", *trial, false));
  EXPECT_EQ(read_markers(scratch / "a.c3d").value().channels.names, trial->channels.names);
}

TEST(MarkerFile, ANwbKeepsWhoRecordedAndSaysWhatNoTrialHolds) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.software = "Vicon Nexus";
  trial.first_frame = 165;
  ASSERT_TRUE(write_markers(scratch / "a.nwb", trial, false));
  const auto back = read_markers(scratch / "a.nwb").value();
  EXPECT_EQ(back.software, "Vicon Nexus");
  EXPECT_EQ(back.first_frame, 165);
  EXPECT_THAT(back.unread, testing::IsEmpty());
  data::Derivatives rates;
  rates.velocity.assign(trial.markers.x_in_world.size(), 0.5);
  rates.filters.resize(2);
  ASSERT_TRUE(write_nwb(scratch / "b.nwb", trial, &rates, {.subject_id = "M1"}));
  const auto named = read_markers(scratch / "b.nwb").value();
  EXPECT_THAT(named.unread, testing::ElementsAre("derivatives of markers"));
  EXPECT_THAT(named.beside.objects,
              testing::ElementsAre(testing::Field(&data::BesideObject::path, "/general/subject")));
  EXPECT_THAT(back.beside.objects, testing::IsEmpty()) << "nobody is named";
}

TEST(MarkerFile, ProvenanceSurvivesEveryFormatThatCanHoldIt) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  for (std::int64_t f = 0; f < 3; ++f) trial.markers.x(f, 1) = Eigen::Vector3d(1.0, 2.0, 3.0);
  trial.markers.state[trial.markers.index(0, 1)] = data::SampleState::interpolated;
  trial.markers.state[trial.markers.index(1, 1)] = data::SampleState::model_filled;
  trial.markers.state[trial.markers.index(2, 1)] = data::SampleState::upsampled;
  trial.markers.set_missing(1, 0, data::SampleState::rejected);
  trial.markers.set_method(0, 1, "cubic");
  trial.markers.set_method(1, 1, "rigid body");
  for (const char* name : {"a.c3d", "a.nwb", "a.mat", "a.csv"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(write_markers(scratch / name, trial, false));
    const auto back = read_markers(scratch / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->markers.state, trial.markers.state);
    for (std::int64_t f = 0; f < 3; ++f) EXPECT_EQ(back->markers.made_by(f, 1), trial.markers.made_by(f, 1));
    EXPECT_THAT(back->warnings, testing::IsEmpty());
  }
}

TEST(MarkerFile, TheSameRecordingAgreesInBothFormats) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto c3d = read_markers(data / "biobuddy/static.c3d");
  const auto trc = read_markers(data / "biobuddy/static.trc");
  ASSERT_TRUE(c3d) << c3d.error().message;
  ASSERT_TRUE(trc) << trc.error().message;
  ASSERT_EQ(c3d->markers.names, trc->markers.names);
  ASSERT_EQ(c3d->markers.frames(), trc->markers.frames());
  EXPECT_EQ(c3d->markers.time.rate_hz, trc->markers.time.rate_hz);
  for (std::int64_t f = 0; f < trc->markers.frames(); ++f)
    for (std::int64_t m = 0; m < trc->markers.markers(); ++m)
      ASSERT_LT((trc->markers.x(f, m) - c3d->markers.x(f, m)).norm(), 8.7e-6)
          << "the TRC is rounded to 0.01 mm per axis; frame " << f << " marker " << m;
}

TEST(MarkerFile, ARecordingOfSeveralFilesIsForConvertAlone) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 1});
  for (const auto& status :
       {check_marker_format("a_motion.tsv"), write_markers(scratch / "a_motion.tsv", trial, false)}) {
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Code::usage);
    EXPECT_THAT(status.error().message,
                HasSubstr("a recording of Motion-BIDS is several files, which kinemark convert writes"));
  }
  EXPECT_EQ(scratch.count_files(), 0);
}

}  // namespace
}  // namespace kinemark::io
