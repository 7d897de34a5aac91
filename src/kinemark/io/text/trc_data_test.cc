// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Every real TRC file, against what an independent parser found in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/io/text/trc.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Expected {
  const char* file;
  std::int64_t frames, markers;
  double rate_hz;
  const char* units;
  double t0_s;
  std::int64_t first_frame, missing;
  const char* first_name;
  std::array<double, 3> first_in_file_units;  ///< of the first marker's first sample; all 0: not seen
};

// clang-format off
const std::vector<Expected> kFiles = {
  {"opensim-core-ik/subject01_synthetic_marker_data.trc", 73, 31, 60.0, "m", 0.4, 1, 0, "Sternum", {0.67076, 1.3961, -0.025106}},
  {"opensim-core-ik/abdbonepin.trc", 1991, 11, 100.0, "mm", 0.0, 0, 0, "gu", {246.329, -29.647, -6.82}},
  {"opensim-gait2354/subject01_walk1.trc", 151, 41, 60.0, "mm", 0.0, 1, 0, "R.ASIS", {617.247620, 1055.275020, 170.781980}},
  {"opensim-gait2354/subject01_static.trc", 300, 49, 60.0, "mm", 0.0, 1, 0, "R.ASIS", {608.664310, 1072.713130, 157.442150}},
  {"opensim-hamner-fullbody/subject02_running.trc", 600, 41, 60.0, "mm", 0.0, 1, 600, "R.ASIS", {809.009400, 1034.518310, -64.610810}},
  {"opensim-arm26/arm26_elbow_flex.trc", 121, 3, 120.0, "mm", 0.0, 1, 0, "r_acromion", {-13.05452443, 839.50547557, 169.5054756}},
  {"opensim-arm26/arm26_elbow_flex_old_800mm_low.trc", 121, 3, 120.0, "mm", 0.0, 1, 0, "r_acromion", {-13.05452443, 39.50547557, 169.5054756}},
  {"bmc-rajagopal-run/ExpData/motion_capture_run.trc", 123, 78, 150.0, "mm", 0.0, 1, 2460, "RACR", {-29.96947, 1430.34631, -94.01600}},
  {"nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", 223, 64, 200.00000000000426, "m", 3.38, 1, 0, "CLAV", {0.9834270263967388, 1.440941319575298, -0.5147695234547278}},
  {"opensim-core-formats/dataWithBlanksForMissingMarkers.trc", 464, 40, 250.0, "mm", 0.0, 1, 15005, "LTH3", {}},
  {"opensim-core-formats/dataWithEformat.trc", 5, 14, 119.88012, "m", 0.008342, 1, 0, "RFAsuperior", {-0.273, 0.0746, -1.57}},
  {"opensim-core-formats/dataWithNaNsOfDifferentCases.trc", 5, 14, 250.0, "mm", 0.0, 1, 5, "toe", {175.798014, -333.753526, 33.121135}},
  {"opensim-core-formats/dataWithNaNsWithSpaces.trc", 427, 42, 100.0, "mm", 0.0, 1, 22, "LASI", {}},
  {"opensim-core-formats/exampleFormat.trc", 5, 3, 100.0, "m", 0.01, 1, 2, "marker1", {}},
  {"opensim-core-formats/std_walking2_markers.trc", 126, 44, 25.0, "mm", 0.0, 1, 2809, "RTH1", {}},
  {"opensim-core-formats/gait10dof18musc_walk_CRLF_line_ending.trc", 10, 41, 60.0, "mm", 0.0, 1, 0, "R.ASIS", {617.247620, 1055.275020, 170.781980}},
  {"btk-others/Gait.trc", 487, 33, 100.0, "mm", 0.0, 1, 7306, "R.Shoulder", {}},
  {"btk-others/ballet_reduced.trc", 100, 41, 30.0, "mm", 0.0, 1, 0, "RFHD", {93.08053, 1542.35255, -121.98482}},
  {"btk-others/T.trc", 89, 41, 30.0, "mm", 0.0, 1, 0, "RFHD", {-336.42437, 1639.63722, -22.06800}},
  {"biobuddy/static.trc", 138, 49, 100.0, "m", 0.0, 1, 0, "HV", {0.62772, 0.50386, 1.72425}},
};
// clang-format on

TEST(TrcData, EveryRealFileReadsAsInventoried) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const Expected& want : kFiles) {
    SCOPED_TRACE(want.file);
    const auto trial = read_trc(data / want.file);
    ASSERT_TRUE(trial) << trial.error().message;
    ASSERT_TRUE(trial->validate()) << trial->validate().error().message;
    const data::Trajectories& m = trial->markers;
    EXPECT_EQ(m.frames(), want.frames);
    EXPECT_EQ(m.markers(), want.markers);
    EXPECT_EQ(m.time.rate_hz, want.rate_hz);
    EXPECT_EQ(trial->units_in_file, want.units);
    EXPECT_EQ(m.time.t0_s, want.t0_s);
    EXPECT_EQ(trial->first_frame, want.first_frame);
    EXPECT_EQ(m.count_missing(), want.missing);
    EXPECT_EQ(m.names[0], want.first_name);
    EXPECT_EQ(trial->format, "TRC");
    const bool seen = want.first_in_file_units != std::array<double, 3>{};
    ASSERT_EQ(m.present(0, 0), seen);
    for (int axis = 0; axis < 3 && seen; ++axis)
      EXPECT_NEAR(m.x(0, 0)[axis],
                  want.first_in_file_units[static_cast<std::size_t>(axis)] /
                      (trial->units_in_file == "m" ? 1.0 : 1000.0),
                  1e-15);
    EXPECT_EQ(std::count_if(m.state.begin(), m.state.end(),
                            [](auto s) { return s == data::SampleState::measured; }),
              want.frames * want.markers - want.missing);
  }
}

TEST(TrcData, TellsWhatIsOddAndNothingElse) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto warnings = [&](const char* file) { return read_trc(data / file).value().warnings; };
  for (const char* clean :
       {"opensim-gait2354/subject01_walk1.trc", "opensim-gait2354/subject01_static.trc",
        "opensim-arm26/arm26_elbow_flex.trc", "opensim-core-ik/subject01_synthetic_marker_data.trc",
        "nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", "btk-others/T.trc",
        "opensim-core-formats/dataWithEformat.trc", "opensim-core-formats/exampleFormat.trc"})
    EXPECT_THAT(warnings(clean), IsEmpty()) << clean;
  EXPECT_THAT(warnings("opensim-core-ik/abdbonepin.trc"),
              Contains(HasSubstr("header says 3514 frames, 1991 rows are there")));
  EXPECT_THAT(warnings("biobuddy/static.trc"),
              Contains(HasSubstr("header says 1300 frames, 138 rows are there")));
  EXPECT_THAT(warnings("btk-others/Gait.trc"),
              testing::AllOf(Contains(HasSubstr("header says 66 markers, 33 are named")),
                             Contains(HasSubstr("beyond the 33 named markers"))));
  EXPECT_THAT(
      warnings("opensim-hamner-fullbody/subject02_running.trc"),
      ElementsAre(HasSubstr("1 of 41 markers are (0, 0, 0) in every frame, taken as not seen: 'L.Bicep'")));
  EXPECT_THAT(warnings("bmc-rajagopal-run/ExpData/motion_capture_run.trc"),
              ElementsAre(HasSubstr("20 of 78 markers have no sample in any frame: 'RASH'")));
  EXPECT_THAT(warnings("opensim-core-formats/std_walking2_markers.trc"),
              Contains(HasSubstr("row 126 is at 4.992 s, 0.008 s off an even 25 Hz")));
}

TEST(TrcData, TheBrokenOnesGiveOneSentence) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  EXPECT_THAT(read_trc(data / "btk-others/Empty.trc").error().message,
              testing::EndsWith("Empty.trc: the file is empty; expected a TRC file"));
  EXPECT_THAT(
      read_trc(data / "btk-others/Truncated.trc").error().message,
      testing::EndsWith("Truncated.trc: line 3: the file ends where the values of the header were expected"));
  const auto wrong_type = read_trc(data / "btk-others/Gait.c3d");
  EXPECT_EQ(wrong_type.error().code, Code::bad_input);
  EXPECT_EQ(wrong_type.error().message.substr(wrong_type.error().message.find("line 1")),
            "line 1: is no head of a TRC file; a TRC file begins with PathFileType")
      << "what is in a file of another kind is not quoted";
  const auto missing = read_trc(data / "no such.trc");
  EXPECT_EQ(missing.error().code, Code::io);
}

TEST(TrcData, EveryRealFileSurvivesARoundTrip) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const testing_support::ScratchFolder scratch;
  for (const Expected& want : kFiles) {
    SCOPED_TRACE(want.file);
    const auto before = read_trc(data / want.file).value();
    for (const LengthUnit units : {LengthUnit::millimetre, LengthUnit::metre}) {
      const auto path = scratch / "out.trc";
      ASSERT_TRUE(write_trc(path, before, {.force = true, .units = units}));
      const auto after = read_trc(path);
      ASSERT_TRUE(after) << after.error().message;
      EXPECT_EQ(after->markers.names, before.markers.names);
      EXPECT_EQ(after->markers.time, before.markers.time);
      EXPECT_EQ(after->markers.state, before.markers.state);
      EXPECT_EQ(after->first_frame, before.first_frame);
      double worst = 0.0;
      for (std::size_t i = 0; i < before.markers.x_in_world.size(); ++i)
        if (const double x = before.markers.x_in_world[i]; x == x)
          worst = std::max(worst, std::abs(after->markers.x_in_world[i] - x));
      EXPECT_LE(worst, units == LengthUnit::metre ? 0.0 : 1e-15);
    }
  }
}

}  // namespace
}  // namespace kinemark::io
