// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/recording_input.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/marker_file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class ReadMarkerInput : public ::testing::Test {
 protected:
  void SetUp() override {
    data::Trial trial;
    trial.markers =
        data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 6});
    for (std::int64_t f = 0; f < 6; ++f)
      for (std::int64_t m = 0; m < 3; ++m) {
        if (f == 2 && m == 1) continue;
        trial.markers.x(f, m) = Eigen::Vector3d(static_cast<double>(f), static_cast<double>(m), 0.25);
        trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
      }
    ASSERT_TRUE(write_markers(trc_, trial, false));
    ASSERT_TRUE(write_text(v3d_,
                           "\ts\ts\ts\n\tA\tA\tA\n\tTARGET\tTARGET\tTARGET\n\tp\tp\tp\n"
                           "ITEM\tX\tY\tZ\n1\t1\t2\t3\n2\t1\t2\t3\n",
                           false));
  }
  testing_support::ScratchFolder scratch_;
  fs::path trc_ = scratch_ / "a.trc", v3d_ = scratch_ / "a.v3d";
};

TEST_F(ReadMarkerInput, AFileThatTellsItsRateNeedsNone) {
  const auto input = read_marker_input({.path = trc_}).value();
  EXPECT_EQ(input.trial.markers.time.rate_hz, 50.0);
  EXPECT_TRUE(input.rate_known);
  EXPECT_EQ(input.file.role, "markers");
  EXPECT_EQ(input.file.path, trc_.string());
  EXPECT_EQ(input.file.hash, "") << "not asked for";
}

TEST_F(ReadMarkerInput, RateOfAFileThatTellsNone) {
  EXPECT_EQ(read_marker_input({.path = v3d_}).error().code, Code::usage);
  for (const auto rule : {RateRule::given, RateRule::where_needed, RateRule::or_unknown}) {
    const auto input = read_marker_input({.path = v3d_, .rate_hz = 179.0, .rate = rule}).value();
    EXPECT_EQ(input.trial.markers.time.rate_hz, 179.0);
    EXPECT_TRUE(input.rate_known);
  }
  const auto unknown = read_marker_input({.path = v3d_, .rate = RateRule::or_unknown}).value();
  EXPECT_FALSE(unknown.rate_known);
  EXPECT_EQ(unknown.trial.markers.frames(), 2);
}

TEST_F(ReadMarkerInput, ARateForAFileThatTellsItsOwn) {
  EXPECT_EQ(read_marker_input({.path = trc_, .rate_hz = 100.0}).error().code, Code::usage);
  EXPECT_EQ(read_marker_input({.path = trc_, .rate_hz = 100.0, .rate = RateRule::or_unknown}).error().code,
            Code::usage);
  const auto passed_over =
      read_marker_input({.path = trc_, .rate_hz = 100.0, .rate = RateRule::where_needed}).value();
  EXPECT_EQ(passed_over.trial.markers.time.rate_hz, 50.0);
}

TEST_F(ReadMarkerInput, AUnitOrARateForAFileThatIsNotReadIsNotWhatIsWrong) {
  const auto odd = scratch_ / "odd.csv";
  ASSERT_TRUE(write_text(odd, "t,alpha,beta\n0,1,2\n0.01,1,2\n", false));
  for (const auto& refused :
       {read_marker_input({.path = odd, .unit = "mm"}), read_marker_input({.path = odd, .rate_hz = 50.0})}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::bad_input);
    EXPECT_THAT(refused.error().message, HasSubstr("none of its 3 columns is a position of a marker"));
  }
  EXPECT_THAT(read_marker_input({.path = trc_, .unit = "mm"}).error().message, HasSubstr("states the unit"));
}

TEST_F(ReadMarkerInput, TheRecordHoldsSizeAndChecksum) {
  const auto input = read_marker_input({.path = trc_, .record = true}).value();
  const auto hash = hash_file(trc_).value();
  EXPECT_EQ(input.file.role, "markers");
  EXPECT_EQ(input.file.bytes, hash.bytes);
  EXPECT_EQ(input.file.hash, hash.hex);
  EXPECT_EQ(input.file.hash_kind, "XXH3-64");
}

TEST_F(ReadMarkerInput, ARecordingOfAnalogChannelsAloneIsRefusedWhereSamplesAreNeeded) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 3});
  trial.analog = {.names = {"EMG"}, .units = {"V"}, .rate_hz = 100.0, .samples = 3};
  trial.analog.values.assign(3, 0.5);
  ASSERT_TRUE(write_markers(scratch_ / "emg.c3d", trial, false));
  ASSERT_TRUE(read_marker_input({.path = scratch_ / "emg.c3d"})) << "info and convert can use it";
  const auto refused = read_marker_input({.path = scratch_ / "emg.c3d", .needs_samples = true});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message,
              HasSubstr("emg.c3d: holds 0 markers and 3 frames; need at least one of each"));
}

TEST_F(ReadMarkerInput, WhatCannotBeReadIsTheReadersSentence) {
  EXPECT_EQ(read_marker_input({.path = scratch_ / "none.c3d"}).error().code, Code::io);
  ASSERT_TRUE(write_text(scratch_ / "notes.docx", "hello", false));
  EXPECT_EQ(read_marker_input({.path = scratch_ / "notes.docx"}).error().code, Code::not_supported);
}

/// A heel marker, and one plate that bears 700 N from the third frame on.
std::string d_flow(const char* force = "FP1.ForX\tFP1.ForY\tFP1.ForZ") {
  std::string out =
      std::string("TimeStamp\tFrameNumber\tLHEE.PosX\tLHEE.PosY\tLHEE.PosZ\tFP1.CopX\tFP1.CopY\tFP1.CopZ\t") +
      force + "\n";
  for (int f = 0; f < 6; ++f)
    out += "0.0" + std::to_string(f) + "\t" + std::to_string(f + 1) + "\t0.1\t0.05\t0.2\t0.15\t0\t0.3\t10\t" +
           (f < 2 ? "0.2" : "700") + "\t-20\n";
  return out;
}

TEST_F(ReadMarkerInput, ForcesBesideTheMarkersOfDFlowAreThoseOfTheRecording) {
  const auto txt = scratch_ / "walk.txt";
  ASSERT_TRUE(write_text(txt, d_flow(), false));
  const auto input = read_recording({.path = txt}, {.wanted = true}, {}, false).value();
  ASSERT_TRUE(input.plates);
  ASSERT_EQ(input.plates->items.size(), 1U);
  const auto& plate = input.plates->items[0];
  EXPECT_EQ(plate.name, "plate 1");
  EXPECT_TRUE(plate.corners_in_world.empty());
  EXPECT_EQ(plate.force[3 * 4 + 1], 700.0);
  EXPECT_EQ(plate.point[3 * 4 + 2], 0.3);
  EXPECT_EQ(plate.force[1], 0.0) << "0.2 N are nobody's";
  EXPECT_THAT(input.notes, ::testing::Contains(HasSubstr("where the plates lie is not known")));
  EXPECT_THAT(input.trial.warnings, ::testing::Not(::testing::Contains(HasSubstr("are not read"))));
  EXPECT_FALSE(read_recording({.path = txt}, {.wanted = false}, {}, false).value().plates) << "nobody asks";
  ASSERT_TRUE(write_text(txt, d_flow("FP1.MomX\tFP1.MomY\tFP1.MomZ"), true));
  const auto without = read_recording({.path = txt}, {.wanted = true}, {}, false).value();
  EXPECT_FALSE(without.plates);
  EXPECT_THAT(without.trial.warnings, ::testing::Contains(HasSubstr("are not read: 'FP1.CopX'")));
}

}  // namespace
}  // namespace kinemark::io
