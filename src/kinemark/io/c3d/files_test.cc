// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Real recordings of many makers against what an independent parser found in them.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "kinemark/io/c3d/reader.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using data::Trial;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

struct Facts {
  const char* file;
  std::int64_t points;
  std::int64_t frames;
  double rate_hz;
  std::int64_t first_frame;
  std::int64_t channels;
  std::int64_t samples_per_frame;
  std::size_t plates;
  const char* units;
  std::int64_t missing;
  const char* label;          ///< of the first value
  std::int64_t frame;         ///< its frame, in the file's own counting
  std::array<double, 3> xyz;  ///< in the file's units
};

// clang-format off
constexpr Facts kFacts[] = {
    {"opensim-core-formats/walking2.c3d", 44, 1249, 250, 1, 12, 8, 2, "mm", 27567, "RTH1", 207, {-2565.473, 305.549, 855.609}},
    {"c3d-org/sample01/Eb015pi.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample01/Eb015pr.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample01/Eb015si.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample01/Eb015sr.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample01/Eb015vi.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample01/Eb015vr.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample06/MACsample.c3d", 33, 180, 60, 1, 16, 17, 0, "mm", 3565, "RSHO", 17, {-284.441, 76.222, 1491.320}},
    {"c3d-org/sample08/TESTAPI.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample08/TESTBPI.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample08/TESTCPI.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample08/TESTDPI.c3d", 26, 450, 50, 1, 16, 4, 2, "mm", 226, "RFT1", 1, {248.583, 226.833, 37.417}},
    {"c3d-org/sample10/TYPE-2.C3D", 13, 199, 60, 1, 6, 20, 1, "mm", 653, "RF", 1, {-1392.188, -15.348, 597.748}},
    {"c3d-org/sample10/TYPE-4.C3D", 13, 199, 60, 1, 6, 20, 1, "mm", 653, "RF", 1, {-1392.188, -15.348, 597.748}},
    {"c3d-org/sample13/Dance.c3d", 40, 499, 65.0533, 1, 8, 1, 0, "mm", 0, "Channel101", 1, {1721.546, -358.525, -195.998}},
    {"c3d-org/sample18/bad_parameter_section.c3d", 45, 332, 120, 1, 32, 10, 2, "mm", 6044, "P1", 1, {-587.371, 234.130, 526.258}},
    {"c3d-org/sample20/phasespace_sample.c3d", 40, 701, 30, 1, 0, 0, 0, "", 1281, "point 1", 1, {160.521, -135.208, 1296.680}},
    {"c3d-org/sample21/sample21.c3d", 14, 574, 60, 1, 12, 17, 2, "mm", 0, "LASI", 1, {-789.347, 656.880, 1281.814}},
    {"c3d-org/sample22/BKINtechnologies.c3d", 2, 5065, 1000, 1, 20, 1, 0, "m", 0, "Right_Hand", 1, {0.185, 0.651, 0.000}},
    {"c3d-org/sample28/dynamic.C3D", 34, 296, 100, 1, 6, 1, 1, "", 3572, "r knee 1", 1, {-1161.335, 436.848, 347.796}},
    {"btk-others/FunctionalLHip.c3d", 74, 1577, 120, 165, 36, 9, 3, "mm", 59926, "LASI", 165, {599.279, 575.053, 946.697}},
    {"btk-others/FunctionalWalk.c3d", 146, 438, 120, 480, 36, 9, 3, "mm", 16671, "LASI", 480, {-1686.453, 697.767, 900.730}},
    {"btk-others/MyCube.c3d", 14, 1, 50, 1, 0, 0, 0, "mm", 0, "PBLeiden01_1", 1, {56.415, 23.847, 358.445}},
    {"btk-others/mocap36.c3d", 36, 1380, 100, 1, 0, 0, 0, "mm", 8244, "Skeleton_Hip2", 1, {-138.368, 24.723, 973.546}},
    {"btk-others/badParameterOffset.c3d", 41, 111, 250, 1, 0, 0, 0, "mm", 222, "Point    1", 1, {168.093, 1204.292, 1635.358}},
    {"btk-others/ADemo1_rewrite_c3d_pc_float.c3d", 24, 512, 200, 1, 16, 2, 1, "mm", 85, "L.Sac.Wand", 1, {1907.900, -10.900, 891.900}},
    {"btk-others/ADemo1_rewrite_c3d_pc_integer.c3d", 24, 512, 200, 1, 16, 2, 1, "mm", 85, "L.Sac.Wand", 1, {1907.900, -10.900, 891.900}},
    {"btk-others/Gait.c3d", 33, 487, 100, 1, 28, 10, 2, "mm", 9682, "RSHO", 134, {2229.471, 137.356, 1382.491}},
    {"btk-others/PiG_Calibration3_FF.c3d", 66, 95, 100, 604, 0, 0, 0, "mm", 4, "LASI", 604, {275.169, 363.780, 977.217}},
    {"btk-others/PiG_Motion3_FF.c3d", 97, 293, 100, 725, 34, 10, 3, "mm", 4429, "LASI", 725, {65.042, -1412.916, 960.528}},
    {"ezc3d-testFiles/Qualisys.c3d", 55, 340, 200, 705, 69, 10, 2, "mm", 0, "L_IAS", 705, {-220.123, 306.425, 846.336}},
    {"ezc3d-testFiles/Optotrak.c3d", 54, 29, 30, 1, 0, 0, 0, "mm", 59, "Marker_1", 1, {326.314, 328.631, -366.171}},
    {"ezc3d-testFiles/C3DRotationExample.c3d", 0, 340, 85, 1, 0, 0, 0, "mm", 0, "", 0, {0, 0, 0}},
    {"ezc3d-testFiles/FP_Type1.c3d", 22, 634, 100, 1, 24, 2, 4, "m", 0, "sacrum", 1, {-0.022, 0.984, -0.048}},
    {"kineticstoolkit/walkingOptiTrack.c3d", 12, 3361, 160, 0, 0, 0, 0, "mm", 2996, "Foot_Marker1", 0, {18.692, 107.081, 28.400}},
    {"kineticstoolkit/sample_probing_acromion_R.c3d", 41, 140, 69.5, 1, 0, 0, 0, "m", 2, "Probe1", 1, {-0.723, 1.197, 0.110}},
    {"kineticstoolkit/sample_probing_medial_epicondyle_R.c3d", 41, 140, 69.5, 1, 0, 0, 0, "m", 0, "Probe1", 1, {-0.702, 0.707, 0.161}},
    {"kineticstoolkit/sample_probing_olecrane_R.c3d", 41, 140, 69.5, 1, 0, 0, 0, "m", 140, "Probe1", 1, {-0.748, 0.711, 0.137}},
    {"kineticstoolkit/sample_probing_radial_styloid_R.c3d", 41, 140, 69.5, 1, 0, 0, 0, "m", 250, "Probe1", 1, {-0.340, 0.732, 0.012}},
    {"kineticstoolkit/sample_probing_ulnar_styloid_R.c3d", 41, 140, 69.5, 1, 0, 0, 0, "m", 0, "Probe1", 1, {-0.372, 0.700, 0.095}},
    {"kineticstoolkit/sample_static.c3d", 41, 700, 69.9, 1, 0, 0, 0, "m", 5883, "WheelchairRearR", 1, {-0.934, 0.848, -0.291}},
    {"kineticstoolkit/sample_propulsion.c3d", 41, 700, 69.9926, 1, 0, 0, 0, "m", 6384, "WheelchairRearR", 1, {-0.938, 0.846, -0.293}},
    {"pycgm-rom/Sample_Static.c3d", 141, 275, 100, 1, 10, 1, 1, "mm", 0, "LFHD", 1, {174.575, 324.513, 1728.944}},
    {"biobuddy/right_knee.c3d", 73, 922, 100, 100, 13, 20, 2, "mm", 0, "HV", 100, {575.795, 604.502, 1678.961}},
    {"biobuddy/static.c3d", 49, 138, 100, 1164, 20, 20, 0, "mm", 0, "HV", 1164, {627.721, 503.856, 1724.249}},
    {"cmu-mocap/cmu_02_05.c3d", 41, 1854, 120, 1, 0, 0, 0, "mm", 3, "TakeoMonday:RBWT", 1, {-158.742, 532.915, 999.431}},
    {"cmu-mocap/85_02.c3d", 41, 810, 120, 1, 0, 0, 0, "mm", 0, "Male:LFWT", 1, {116.398, 1075.617, 991.908}},
};
// clang-format on

TEST(C3dFiles, EveryRealFileHoldsWhatItIsKnownToHold) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const Facts& facts : kFacts) {
    SCOPED_TRACE(facts.file);
    const auto read = read_c3d(data / facts.file);
    ASSERT_TRUE(read) << read.error().message;
    const Trial& t = *read;
    EXPECT_TRUE(t.validate()) << t.validate().error().message;
    EXPECT_EQ(t.markers.markers() + t.channels.count(), facts.points);
    EXPECT_EQ(t.markers.frames(), facts.frames);
    EXPECT_NEAR(t.markers.time.rate_hz, facts.rate_hz, 1e-4);
    EXPECT_EQ(t.first_frame, facts.first_frame);
    EXPECT_EQ(t.last_frame(), facts.first_frame + facts.frames - 1);
    EXPECT_DOUBLE_EQ(
        t.markers.time.t0_s,
        static_cast<double>(std::max<std::int64_t>(0, facts.first_frame - 1)) / t.markers.time.rate_hz);
    EXPECT_EQ(static_cast<std::int64_t>(t.analog.names.size()), facts.channels);
    EXPECT_EQ(t.analog.samples, facts.frames * facts.samples_per_frame);
    EXPECT_EQ(t.force_plates.size(), facts.plates);
    EXPECT_EQ(t.units_in_file, facts.units);
    const auto channel_numbers_missing =
        std::ranges::count_if(t.channels.values, [](double v) { return std::isnan(v); });
    EXPECT_EQ(t.markers.count_missing() + channel_numbers_missing / 3, facts.missing);
    // One file holds analog samples that are no numbers; they are handed on as they are.
    EXPECT_EQ(std::ranges::count_if(t.analog.values, [](double v) { return !std::isfinite(v); }),
              std::string_view(facts.file) == "biobuddy/static.c3d" ? 78 : 0);
    if (facts.points == 0) continue;
    const std::int64_t m = t.markers.find(facts.label);
    ASSERT_GE(m, 0) << facts.label;
    const double metres = t.units_in_file == "m" ? 1.0 : 1e-3;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(t.markers.x(facts.frame - facts.first_frame, m)[axis],
                  metres * facts.xyz[static_cast<std::size_t>(axis)], 0.00051 * metres);
  }
}

TEST(C3dFiles, TheFirstValueIsThatOfTheFirstFrameWhereTheMarkerIsSeen) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const Facts& facts : kFacts) {
    if (facts.points == 0) continue;
    const Trial t = read_c3d(data / facts.file).value();
    const std::int64_t m = t.markers.find(facts.label);
    for (std::int64_t f = 0; f < facts.frame - facts.first_frame; ++f)
      EXPECT_FALSE(t.markers.present(f, m)) << facts.file << " frame " << f;
  }
}

/// Largest difference of two arrays; infinite when their sizes or their NaNs differ.
double worst_difference(const auto& a, const auto& b) {
  if (a.size() != b.size()) return HUGE_VAL;
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return HUGE_VAL;
    if (!std::isnan(a[i])) worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i])));
  }
  return worst;
}

constexpr std::array<const char*, 6> kEncodings = {"Eb015pi.c3d", "Eb015pr.c3d", "Eb015si.c3d",
                                                   "Eb015sr.c3d", "Eb015vi.c3d", "Eb015vr.c3d"};

TEST(C3dFiles, SixEncodingsOfOneRecordingAgree) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const std::filesystem::path folder = data / "c3d-org" / "sample01";
  const Trial a = read_c3d(folder / kEncodings[0]).value();
  constexpr double kStep = 0.0833334e-3;  // m, one unit of the integer scale
  for (const char* name : kEncodings) {
    SCOPED_TRACE(name);
    const Trial b = read_c3d(folder / name).value();
    ASSERT_EQ(a.markers.names, b.markers.names);
    ASSERT_EQ(a.markers.state, b.markers.state);
    ASSERT_EQ(a.camera_mask, b.camera_mask);
    EXPECT_LE(worst_difference(a.markers.x_in_world, b.markers.x_in_world), kStep);
    EXPECT_LE(worst_difference(a.residual_m, b.residual_m), 1e-9);
    EXPECT_LE(worst_difference(a.analog.values, b.analog.values), 1e-3);
  }
}

TEST(C3dFiles, ValuesPublishedForTheSixEncodings) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const char* name : kEncodings) {
    SCOPED_TRACE(name);
    const Trial t = read_c3d(data / "c3d-org" / "sample01" / name).value();
    EXPECT_NEAR(t.markers.x(8, 0).x(), 0.2504166, 1e-7);
    EXPECT_NEAR(t.markers.x(16, 17).x(), 0.285, 1e-7);
    EXPECT_NEAR(t.markers.x(16, 17).y(), 0.2224166, 1e-7);
    EXPECT_NEAR(t.markers.x(16, 17).z(), 0.5644166, 1e-7);
    EXPECT_NEAR(t.residual_m[t.markers.index(0, 0)], 1.3333e-3, 1e-7);
    EXPECT_NEAR(t.residual_m[t.markers.index(20, 14)], 1.91667e-3, 1e-7);
    EXPECT_DOUBLE_EQ(t.analog.rate_hz, 200.0);
    EXPECT_NEAR(t.analog.values[0], -26.6599, 1e-3);
    EXPECT_NEAR(t.analog.values[16], -25.8, 1e-3);
    EXPECT_EQ(t.analog.names[0], "FX1");
    EXPECT_EQ(t.analog.units[0], "nt");
    ASSERT_EQ(t.events.size(), 3U);
    EXPECT_EQ(t.events[0].label, "RIC");
    EXPECT_NEAR(t.events[0].time_s, 2.72, 1e-6);
    EXPECT_NEAR(t.events[1].time_s, 5.40, 1e-6);
    EXPECT_NEAR(t.events[2].time_s, 7.32, 1e-6);
    ASSERT_EQ(t.force_plates.size(), 2U);
    EXPECT_THAT(t.force_plates[1].channel_idx, ElementsAre(8, 9, 10, 11, 12, 13));
    EXPECT_NEAR(t.force_plates[0].corners_in_world[0].x(), 0.5200451, 1e-6);
    EXPECT_NEAR(t.force_plates[0].origin_in_plate.z(), -0.0216, 1e-6);
  }
}

TEST(C3dFiles, MovedBlocksReadAsTheOriginal) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const Trial a = read_c3d(data / "c3d-org" / "sample01" / "Eb015pi.c3d").value();
  for (const char* name : {"TESTAPI.c3d", "TESTBPI.c3d", "TESTCPI.c3d", "TESTDPI.c3d"}) {
    const Trial b = read_c3d(data / "c3d-org" / "sample08" / name).value();
    EXPECT_EQ(a.markers.names, b.markers.names) << name;
    EXPECT_EQ(a.markers.state, b.markers.state) << name;
    EXPECT_EQ(a.analog.values, b.analog.values) << name;
    EXPECT_EQ(worst_difference(a.markers.x_in_world, b.markers.x_in_world), 0.0) << name;
  }
}

TEST(C3dFiles, OneRecordingAsFloatAndAsIntegerAgrees) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const Trial a = read_c3d(data / "btk-others" / "ADemo1_rewrite_c3d_pc_float.c3d").value();
  const Trial b = read_c3d(data / "btk-others" / "ADemo1_rewrite_c3d_pc_integer.c3d").value();
  ASSERT_EQ(a.markers.state, b.markers.state);
  EXPECT_LE(worst_difference(a.markers.x_in_world, b.markers.x_in_world), 5e-5);
}

TEST(C3dFiles, WhatMakersGotWrongIsReportedInAWarning) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto warnings = [&](const char* file) { return read_c3d(data / file).value().warnings; };
  EXPECT_THAT(warnings("ezc3d-testFiles/Optotrak.c3d"),
              Contains(AllOf(HasSubstr("cut short"), HasSubstr("1149 frames"), HasSubstr("29 whole ones"))));
  EXPECT_THAT(warnings("ezc3d-testFiles/C3DRotationExample.c3d"), Contains(HasSubstr("ROTATION group")));
  EXPECT_THAT(warnings("c3d-org/sample20/phasespace_sample.c3d"),
              AllOf(Contains(HasSubstr("the header alone is used")), Contains(HasSubstr("mm is assumed"))));
  EXPECT_THAT(warnings("c3d-org/sample18/bad_parameter_section.c3d"),
              Contains(HasSubstr("parameter section is corrupt")));
  EXPECT_THAT(warnings("c3d-org/sample28/dynamic.C3D"),
              AllOf(Contains(HasSubstr("POINT:RATE is missing")), Contains(HasSubstr("repeats"))));
  EXPECT_THAT(warnings("btk-others/PiG_Motion3_FF.c3d"), Contains(HasSubstr("carries no residuals")));
  EXPECT_THAT(warnings("kineticstoolkit/walkingOptiTrack.c3d"), Contains(HasSubstr("POINT:DATA_START is 0")));
  EXPECT_THAT(warnings("c3d-org/sample06/MACsample.c3d"), Contains(HasSubstr("the header's is used")));
  EXPECT_THAT(warnings("c3d-org/sample01/Eb015pi.c3d"), ElementsAre());
  EXPECT_THAT(warnings("biobuddy/right_knee.c3d"), ElementsAre());
}

TEST(C3dFiles, SamplesThatWereNotMeasuredSaySo) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  // Filled gaps carry a fourth word of 0; the markers of the walk have cameras, most
  // of them a residual that is less than half a step and so stored as 0.
  const Trial walk = read_c3d(data / "btk-others" / "FunctionalWalk.c3d").value();
  const auto count = [](const Trial& t, SampleState s) { return std::ranges::count(t.markers.state, s); };
  EXPECT_EQ(count(walk, SampleState::measured), 15756);
  EXPECT_EQ(count(walk, SampleState::interpolated), 18408)
      << "without the outputs of Plug-in Gait, which are no markers";
  ASSERT_FALSE(walk.residual_m.empty());
  for (std::size_t i = 0; i < walk.residual_m.size(); ++i)
    ASSERT_EQ(std::isfinite(walk.residual_m[i]), walk.markers.state[i] == SampleState::measured);
  const Trial pig = read_c3d(data / "btk-others" / "PiG_Motion3_FF.c3d").value();
  EXPECT_EQ(count(pig, SampleState::interpolated), 0);
  EXPECT_TRUE(pig.residual_m.empty());
  EXPECT_TRUE(pig.camera_mask.empty());
}

TEST(C3dFiles, EventsAreOnTheRecordingsClock) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const Trial walk = read_c3d(data / "btk-others" / "FunctionalWalk.c3d").value();
  ASSERT_EQ(walk.events.size(), 11U);
  EXPECT_EQ(walk.events[0].label, "Foot Strike");
  EXPECT_EQ(walk.events[0].context, "Left");
  EXPECT_NEAR(walk.events[0].time_s, 5.05, 1e-6);
  for (const data::Event& event : walk.events) {
    EXPECT_GE(event.time_s, walk.markers.time.t0_s);
    EXPECT_LE(event.time_s, walk.markers.time.time_s(walk.markers.frames()));
  }
  const Trial robot = read_c3d(data / "c3d-org" / "sample22" / "BKINtechnologies.c3d").value();
  ASSERT_EQ(robot.events.size(), 2U);
  EXPECT_EQ(robot.events[1].label, "TARGET_ON");
  EXPECT_NEAR(robot.events[1].time_s, 1.614, 1e-6);
  EXPECT_EQ(read_c3d(data / "c3d-org" / "sample18" / "bad_parameter_section.c3d").value().events.size(), 7U)
      << "the event group is destroyed, the header's events are not";
}

TEST(C3dFiles, WrongPointersAndMissingDescriptionsStillGiveTheData) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const Trial t = read_c3d(data / "btk-others" / "badParameterOffset.c3d").value();
  EXPECT_NEAR(t.markers.x(0, 0).x(), 0.168093002, 1e-8);
  EXPECT_NEAR(t.markers.x(10, 29).y(), 0.731903015, 1e-8);
  EXPECT_EQ(read_c3d(data / "btk-others" / "mocap36.c3d").value().markers.names[35].substr(0, 9),
            "Skeleton_");
}

TEST(C3dFiles, AnEmptyFileIsOneSentence) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto empty = read_c3d(data / "btk-others" / "Empty.c3d");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Code::bad_input);
  EXPECT_THAT(empty.error().message, AllOf(HasSubstr("Empty.c3d: is not a C3D file"), Not(HasSubstr("\n"))));
}

TEST(C3dFiles, ParametersCanBeListed) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto reader = C3dReader::open(data / "c3d-org" / "sample10" / "TYPE-4.C3D").value();
  const C3dParameter* matrix = reader.parameters().find("force_platform", "cal_matrix");
  ASSERT_NE(matrix, nullptr);
  EXPECT_EQ(matrix->type, C3dType::float32);
  EXPECT_THAT(matrix->dims, ElementsAre(6, 6, 1));
  EXPECT_EQ(reader.description().force_plates.at(0).calibration, matrix->numbers);
  EXPECT_EQ(reader.layout().processor, Processor::dec);
  EXPECT_FALSE(reader.layout().is_float);
}

}  // namespace
}  // namespace kinemark::io
