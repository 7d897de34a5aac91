// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/vendor_exports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

data::Trial good_export(const std::string& text, VendorExport which) {
  EXPECT_EQ(vendor_export_of(text), which);
  const auto trial = parse_vendor_export(text, "t", which);
  EXPECT_TRUE(trial) << trial.error().message;
  if (!trial) return {};
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  return *trial;
}

std::string bad_export(const std::string& text, VendorExport which, Code code = Code::bad_input) {
  const auto trial = parse_vendor_export(text, "t", which);
  EXPECT_FALSE(trial) << text;
  if (trial) return "";
  EXPECT_EQ(trial.error().code, code);
  EXPECT_EQ(trial.error().message.find('\n'), std::string::npos) << "one sentence";
  return trial.error().message;
}

std::string with(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

const std::string kQtmKeys =
    "NO_OF_FRAMES\t3\nNO_OF_CAMERAS\t7\nNO_OF_MARKERS\t2\nFREQUENCY\t100\nNO_OF_ANALOG\t0\n"
    "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nTIME_STAMP\t2026-01-02, 03:04:05\t6.7\nDATA_INCLUDED\t3D\n";
const std::string kQtm = kQtmKeys +
                         "EVENT\tgrasp\t2\t0.01\nMARKER_NAMES\tA\tB\nTRAJECTORY_TYPES\tMeasured\tVirtual\n"
                         "Frame\tTime\tA X\tA Y\tA Z\tB X\tB Y\tB Z\n"
                         "1\t0.00000\t1\t2\t3\t4\t5\t6\n2\t0.01000\t0.000\t0.000\t0.000\t7\t8\t9\n"
                         "3\t0.02000\t1000\t2\t3\t\t\t\n";

TEST(QtmText, ReadsMarkersTimesAndEvents) {
  const auto trial = good_export(kQtm, VendorExport::qtm);
  EXPECT_EQ(trial.format, "QTM TSV");
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 3}));
  EXPECT_EQ(trial.first_frame, 1);
  EXPECT_EQ(trial.markers.x(0, 0), Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(trial.markers.x(2, 0).x(), 1.0);
  ASSERT_THAT(trial.events, SizeIs(1));
  EXPECT_EQ(trial.events[0].label, "grasp");
  EXPECT_EQ(trial.events[0].time_s, 0.01);
}

TEST(QtmText, ZerosAndBlanksAreMissingAndVirtualSamplesAreNotMeasured) {
  const auto trial = good_export(kQtm, VendorExport::qtm);
  EXPECT_FALSE(trial.markers.present(1, 0));
  EXPECT_FALSE(trial.markers.present(2, 1));
  EXPECT_EQ(trial.markers.state[trial.markers.index(0, 0)], data::SampleState::measured);
  EXPECT_EQ(trial.markers.state[trial.markers.index(0, 1)], data::SampleState::interpolated);
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 samples of 1 markers are exactly (0, 0, 0)")));
}

TEST(QtmText, ColumnsOfFramesAndTimesMayBeAbsent) {
  const std::string rows = "1\t2\t3\t4\t5\t6\n7\t8\t9\t10\t11\t12\n13\t14\t15\t16\t17\t18\n";
  const std::string names = "MARKER_NAMES\tA\tB\n";
  for (const std::string& text :
       {kQtmKeys + names + rows, kQtmKeys + names + "A X\tA Y\tA Z\tB X\tB Y\tB Z\n" + rows}) {
    const auto trial = good_export(text, VendorExport::qtm);
    EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 3}));
    EXPECT_EQ(trial.markers.x(2, 1), Eigen::Vector3d(0.016, 0.017, 0.018));
    EXPECT_THAT(trial.warnings, IsEmpty());
  }
  const auto numbered =
      good_export(kQtmKeys + names + "11\t1\t2\t3\t4\t5\t6\n12\t1\t2\t3\t4\t5\t6\n14\t1\t2\t3\t4\t5\t6\n",
                  VendorExport::qtm);
  EXPECT_EQ(numbered.first_frame, 11);
  EXPECT_EQ(numbered.markers.time, (TimeBase{100.0, 0.1, 4}));
  EXPECT_FALSE(numbered.markers.present(2, 0));
}

TEST(QtmText, MixedTrajectoriesAreSaid) {
  const auto trial = good_export(with(kQtm, "Measured\tVirtual", "Measured\tMixed"), VendorExport::qtm);
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("in trajectories that are mixed or edited: 'B'")));
  EXPECT_THAT(good_export(kQtm, VendorExport::qtm).warnings, testing::Not(Contains(HasSubstr("kept apart"))));
}

TEST(QtmText, SaysWhatIsWrong) {
  const auto bad = [](const std::string& text) { return bad_export(text, VendorExport::qtm); };
  EXPECT_THAT(bad(with(kQtm, "1000\t2", "1000\tx")),
              "t: line 16, column 4: y of marker 'A' is 'x'; expected a number");
  EXPECT_THAT(bad(with(kQtm, "2\t0.01000", "2\tlate")), HasSubstr("line 15, column 2: the time is 'late'"));
  EXPECT_THAT(bad(with(kQtm, "FREQUENCY\t100", "FREQUENCY\tEXT")), HasSubstr("FREQUENCY is 'EXT'"));
  EXPECT_THAT(bad(with(kQtm, "FREQUENCY\t100", "FREQUENCY\t-1")), HasSubstr("FREQUENCY"));
  EXPECT_THAT(bad(kQtmKeys), HasSubstr("without MARKER_NAMES"));
  EXPECT_THAT(bad(kQtmKeys + "MARKER_NAMES\tA\n"), HasSubstr("before the first row"));
  EXPECT_THAT(bad(with(kQtm, "DATA_INCLUDED\t3D", "DATA_INCLUDED\t6D")),
              HasSubstr("line 9: the file holds 6D data, and no line BODY_NAMES names its bodies"));
  EXPECT_THAT(bad_export(with(kQtm, "DATA_INCLUDED\t3D", "DATA_INCLUDED\t2D"), VendorExport::qtm,
                         Code::not_supported),
              HasSubstr("holds 2D data"));
}

const std::string kBodyRows =
    "100\t200\t300\t0\t0\t0\t0.3\t1\t0\t0\t0\t1\t0\t0\t0\t1\t"
    "400\t500\t600\t10\t20\t30\t0.5\t0.8\t0.6\t0\t-0.6\t0.8\t0\t0\t0\t1\n"
    "110\t200\t300\t0\t0\t90\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1\t"
    "0.000\t0.000\t0.000\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\n";
const std::string kBodyLabels =
    "stick X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]\tRot[2]\tRot[3]\tRot[4]\tRot[5]\tRot[6]"
    "\tRot[7]\tRot[8]\t"
    "hand X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\tRot[1]\tRot[2]\tRot[3]\tRot[4]\tRot[5]\tRot[6]"
    "\tRot[7]\tRot[8]\n";
const std::string kBodyKeys =
    "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t4\nNO_OF_BODIES\t2\nFREQUENCY\t100\nDATA_INCLUDED\t6D\n"
    "BODY_NAMES\tstick\thand\n";

TEST(QtmText, RigidBodiesAreTheirOriginsWithAnglesAndAxesAsChannels) {
  const std::string numbered = "1\t0.00000\t" + kBodyRows;
  const auto lines = numbered.find('\n') + 1;
  for (const std::string& text : {kBodyKeys + kBodyLabels + kBodyRows, kBodyKeys + kBodyRows,
                                  kBodyKeys + "Frame\tTime\t" + kBodyLabels + numbered.substr(0, lines) +
                                      "2\t0.01000\t" + numbered.substr(lines)}) {
    const auto trial = good_export(text, VendorExport::qtm);
    EXPECT_THAT(trial.markers.names, ElementsAre("stick", "hand"));
    EXPECT_EQ(trial.markers.x(1, 0), Eigen::Vector3d(0.11, 0.2, 0.3));
    EXPECT_FALSE(trial.markers.present(1, 1));
    const auto& channels = trial.channels;
    EXPECT_THAT(channels.names, ElementsAre("stick_angles", "stick_axis_x", "stick_axis_y", "stick_axis_z",
                                            "hand_angles", "hand_axis_x", "hand_axis_y", "hand_axis_z"));
    EXPECT_EQ(channels.units[4], "deg");
    EXPECT_EQ(channels.kinds[4], data::ChannelKind::angle);
    EXPECT_EQ(channels.rate_hz, 100.0);
    const auto value = [&](std::size_t f, std::size_t c) {
      const auto* at = channels.values.data() + 3 * (8 * f + c);
      return Eigen::Vector3d(at[0], at[1], at[2]);
    };
    EXPECT_EQ(value(0, 0), Eigen::Vector3d::Zero()) << "angles of zero are angles";
    EXPECT_TRUE(value(0, 4).isApprox(Eigen::Vector3d(10, 20, 30), 1e-15));
    EXPECT_TRUE(value(0, 6).isApprox(Eigen::Vector3d(-0.6, 0.8, 0), 1e-15)) << "the second column";
    EXPECT_EQ(value(1, 1), Eigen::Vector3d::UnitY()) << "yaw of 90 deg takes x to y";
    for (std::size_t c = 4; c < 8; ++c) EXPECT_TRUE(value(1, c).array().isNaN().all()) << c;
    EXPECT_THAT(trial.warnings, Contains(HasSubstr("positions are the origins of 2 rigid bodies")));
  }
  EXPECT_THAT(good_export(kQtm, VendorExport::qtm).warnings,
              testing::Not(Contains(HasSubstr("positions are the origins of"))));
}

TEST(QtmText, SaysWhatIsWrongWithRigidBodies) {
  const auto bad = [](const std::string& text, Code code = Code::not_supported) {
    return bad_export(text, VendorExport::qtm, code);
  };
  EXPECT_THAT(bad(with(kBodyKeys, "stick\thand", "stick\thand\tfoot") + kBodyRows),
              HasSubstr("line 7: 32 columns for 3 rigid bodies; need 16 for each"));
  EXPECT_THAT(bad(kBodyKeys + "MARKER_NAMES\tA\n" + kBodyRows),
              HasSubstr("line 7: names bodies and markers; export them in files of their own"));
  EXPECT_THAT(bad(kBodyKeys + with(kBodyRows, "0.8\t0.6", "0.8\tx"), Code::bad_input),
              HasSubstr("line 7, column 25: y of marker 'hand_axis_x' is 'x'"));
  EXPECT_THAT(bad(kBodyKeys, Code::bad_input), HasSubstr("before the first row of data"));
}

const std::string kMotiveKeys =
    "Format Version,1.23,Take Name,walk,Capture Frame Rate,120.000000,Export Frame Rate,100.000000,"
    "Total Exported Frames,2,Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n";
const std::string kMotive = kMotiveKeys +
                            ",Type,Marker,Marker,Marker,Rigid Body,Rigid Body,Marker,Marker,Marker\n"
                            ",Name,s:A,s:A,s:A,Hand,Hand,\"s:B,b\",\"s:B,b\",\"s:B,b\"\n"
                            ",ID,1,1,1,2,2,3,3,3\n"
                            ",,Position,Position,Position,Rotation,Position,Position,Position,Position\n"
                            "Frame,Time (Seconds),X,Y,Z,X,X,X,Y,Z\n"
                            "0,0.000000,0.1,0.2,0.3,9,9,,,\n1,0.010000,0.4,0.5,0.6,9,9,1,2,3\n";

TEST(MotiveText, ReadsPositionsOfMarkers) {
  const auto trial = good_export(kMotive, VendorExport::motive);
  EXPECT_EQ(trial.format, "Motive CSV");
  EXPECT_THAT(trial.markers.names, ElementsAre("s:A", "s:B,b"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 2}));
  EXPECT_EQ(trial.first_frame, 0);
  EXPECT_EQ(trial.markers.x(1, 0), Eigen::Vector3d(0.4, 0.5, 0.6));
  EXPECT_FALSE(trial.markers.present(0, 1));
  EXPECT_EQ(trial.markers.x(1, 1), Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(trial.warnings,
              Contains("columns that are solved, not measured, are not read: 2 of Rigid Body"));
}

TEST(MotiveText, RowsAreFoundInEveryVersion) {
  // 1.25 has a row of parents; exports exist whose rows carry no label.
  const auto parent = with(kMotive, ",,Position", ",Parent,,,,,,,,\n,,Position");
  EXPECT_EQ(good_export(parent, VendorExport::motive).markers.x(1, 0), Eigen::Vector3d(0.4, 0.5, 0.6));
  const auto bare = with(with(kMotive, ",Type", ","), ",Name", ",");
  EXPECT_THAT(good_export(bare, VendorExport::motive).markers.names, ElementsAre("s:A", "s:B,b"));
  const auto mm =
      good_export(with(kMotive, "Length Units,Meters", "Length Units,Millimeters"), VendorExport::motive);
  EXPECT_EQ(mm.markers.x(1, 1), Eigen::Vector3d(0.001, 0.002, 0.003));
}

TEST(MotiveText, NamesThatStandTwiceAreTwoMarkers) {
  const auto trial =
      good_export(with(kMotive, "\"s:B,b\",\"s:B,b\",\"s:B,b\"", "s:A,s:A,s:A"), VendorExport::motive);
  EXPECT_THAT(trial.markers.names, ElementsAre("s:A", "s:A_2"));
  EXPECT_EQ(trial.markers.x(1, 0), Eigen::Vector3d(0.4, 0.5, 0.6));
  EXPECT_EQ(trial.markers.x(1, 1), Eigen::Vector3d(1, 2, 3));
}

TEST(MotiveText, SaysWhatIsWrong) {
  const auto bad = [](const std::string& text) { return bad_export(text, VendorExport::motive); };
  EXPECT_THAT(bad(with(kMotive, "0.4,0.5", "0.4,up")),
              HasSubstr("line 9, column 4: y of marker 's:A' is 'up'"));
  EXPECT_THAT(bad(with(kMotive, "Meters", "Furlongs")),
              HasSubstr("line 1: length unit 'Furlongs' is unknown"));
  EXPECT_THAT(bad(with(kMotive, "Export Frame Rate,100", "Export Frame Rate,fast100")),
              HasSubstr("Export Frame Rate"));
  EXPECT_THAT(bad(kMotiveKeys), HasSubstr("the row that begins with Frame is not found"));
  EXPECT_THAT(
      bad("Format Version,1.23\n\n,Type,Bone\n,Name,Hip\n,,Position\nFrame,Time (Seconds),X\n0,0,1\n"),
      HasSubstr("no column is the position of a marker"));
  EXPECT_THAT(bad(with(kMotive, "\"s:B,b\"\n", "\"s:B,b\n")), HasSubstr("quote"));
}

const std::string kNexus =
    "Trajectories\n100\n,,s:A,,,s:B,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n"
    "5,0,1,2,3,4,5,6\n6,0,7,8,9,,,\n\nModel Outputs\n100\n";

TEST(ViconText, ReadsTheSectionOfTrajectories) {
  const auto trial = good_export(kNexus, VendorExport::vicon);
  EXPECT_EQ(trial.format, "Vicon CSV");
  EXPECT_THAT(trial.markers.names, ElementsAre("s:A", "s:B"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.04, 2}));
  EXPECT_EQ(trial.first_frame, 5);
  EXPECT_EQ(trial.markers.x(1, 0), Eigen::Vector3d(0.007, 0.008, 0.009));
  EXPECT_FALSE(trial.markers.present(1, 1));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("a blank line ends the trajectories; line 9")));
}

TEST(ViconText, SectionsBeforeItArePassedOver) {
  const auto trial = good_export("Devices\n1000\n,,Force\n1,0,2\n\n" + kNexus, VendorExport::vicon);
  EXPECT_THAT(trial.markers.names, ElementsAre("s:A", "s:B"));
  EXPECT_THAT(trial.warnings, Contains("sections that are not read: devices"));
  const auto rates = good_export(with(kNexus, "X,Y,Z,X,Y,Z", "X,Y,Z,X',Y',Z'"), VendorExport::vicon);
  EXPECT_FALSE(rates.markers.present(0, 1));
  EXPECT_THAT(rates.warnings, Contains(HasSubstr("3 columns of trajectories are not X, Y or Z")));
}

TEST(ViconText, FramesWithoutARowAreMissing) {
  const auto trial = good_export(with(kNexus, "6,0,7", "8,0,7"), VendorExport::vicon);
  EXPECT_THAT(trial.warnings, Contains("2 frames between the rows have no row and are missing"));
  ASSERT_EQ(trial.markers.time, (TimeBase{100.0, 0.04, 4}));
  EXPECT_FALSE(trial.markers.present(1, 0));
  EXPECT_EQ(trial.markers.x(3, 0).x(), 0.007);
}

TEST(ViconText, NamesThatAreNoneAreMade) {
  const auto trial = good_export(with(kNexus, "s:B", "\x83"), VendorExport::vicon);
  EXPECT_THAT(trial.markers.names, ElementsAre("s:A", "point 2"));
  EXPECT_THAT(trial.warnings, Contains("line 3 names 1 of 2 markers; the others are called 'point n'"));
}

TEST(ViconText, SaysWhatIsWrong) {
  const auto bad = [](const std::string& text) { return bad_export(text, VendorExport::vicon); };
  EXPECT_THAT(bad("Trajectories\nfast\n"), HasSubstr("line 2: the frame rate is 'fast'"));
  EXPECT_THAT(bad("Trajectories\n100\n"), HasSubstr("line 3: the file ends where the row of marker names"));
  EXPECT_THAT(bad("Devices\n100\n"), HasSubstr("without a section of trajectories; it has devices"));
  EXPECT_THAT(bad(with(kNexus, ",,mm,mm", ",,miles,mm")), HasSubstr("line 5: length unit 'miles'"));
  EXPECT_THAT(bad(with(kNexus, "6,0,7", "5,0,7")),
              HasSubstr("line 7 (frame 5): the frame number does not increase"));
  EXPECT_THAT(bad(with(kNexus, "6,0,7", "half,0,7")),
              HasSubstr("line 7, column 1: the frame number is 'half'"));
}

const std::string kPhaseSpace =
    "0.000000,4,1,2,3,-1,0,0,0\n0.002083,5,1000,2,3,2,4,5,6\n0.004167,0,7,8,9,3,7,8,9\n";

TEST(PhaseSpaceText, ReadsMarkersAndTheirConditions) {
  const auto trial = good_export(kPhaseSpace, VendorExport::phasespace);
  EXPECT_EQ(trial.format, "PhaseSpace CSV");
  EXPECT_THAT(trial.markers.names, ElementsAre("M000", "M001"));
  EXPECT_NEAR(trial.markers.time.rate_hz, 480.0, 0.1);
  EXPECT_EQ(trial.markers.frames(), 3);
  EXPECT_EQ(trial.markers.x(0, 0), Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(trial.markers.x(1, 0).x(), 1.0);
  EXPECT_FALSE(trial.markers.present(0, 1)) << "a condition of -1";
  EXPECT_FALSE(trial.markers.present(2, 0)) << "a condition of 0, with coordinates";
  EXPECT_TRUE(trial.markers.present(2, 1));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("its markers are called M000 to M001, and millimetres")));
}

TEST(PhaseSpaceText, ABlankConditionIsNotSeenAndARowMayEndEarly) {
  const auto trial =
      good_export(with(with(kPhaseSpace, ",5,1000", ",,1000"), ",3,7,8,9", ""), VendorExport::phasespace);
  EXPECT_FALSE(trial.markers.present(1, 0));
  EXPECT_TRUE(trial.markers.present(1, 1));
  EXPECT_FALSE(trial.markers.present(2, 1));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 of 3 rows end before the last marker")));
}

TEST(PhaseSpaceText, IsKnownByItsFirstRowEvenIfCut) {
  std::string row = "12.5";
  for (int m = 0; m < 60; ++m) row += ",3,-12.25,1e3,0.5";
  EXPECT_EQ(vendor_export_of(std::string_view(row).substr(0, 512)), VendorExport::phasespace);
  for (const std::string_view begin :
       {"1,2,3\n", "0.1,2,3,4,5,6\n", "0.1,2.5,3,4,5\n", "0.1,2,3,four,5\n", "0.1,2,3\n4,5"})
    EXPECT_FALSE(vendor_export_of(begin)) << begin;
}

TEST(PhaseSpaceText, SaysWhatIsWrong) {
  const auto bad = [](const std::string& text) { return bad_export(text, VendorExport::phasespace); };
  EXPECT_THAT(bad(""), HasSubstr("the file is empty"));
  EXPECT_THAT(bad("0.1,1,2,3\n"),
              HasSubstr("line 1: holds 4 cells; expected a time, and of each marker its"));
  EXPECT_THAT(bad(with(kPhaseSpace, ",5,", ",seen,")),
              HasSubstr("line 2, column 2: the condition of marker 'M000' is 'seen'"));
  EXPECT_THAT(bad(with(kPhaseSpace, "1000", "far")), HasSubstr("line 2, column 3: x of marker 'M000'"));
  EXPECT_THAT(bad(with(kPhaseSpace, "0.002083", "")), HasSubstr("line 2, column 1: the time is blank"));
  EXPECT_THAT(bad(with(kPhaseSpace, "0.004167", "0.000001")), HasSubstr("line 3"));
}

TEST(VendorExport, OthersAreNotTakenForOne) {
  for (const std::string_view begin : {"", "frame,time_s,marker,x_m,y_m,z_m\n", "PathFileType\t4\n",
                                       "Format of mine,1\n", "NO_OF_FRAMES 5\n", "Trajectoriesof,1\n"})
    EXPECT_FALSE(vendor_export_of(begin)) << begin;
}

const std::string kCoordinates =
    "Time,LASI_X,LASI_Y,LASI_Z,RASI_X,RASI_Y,RASI_Z\n0.00,0,0.25,0.9,0.4,0.3,1.0\n0.01,0.01,0.25,0.9,,,\n";

TEST(CoordinateTables, LabelsOfEveryHand) {
  const std::string rows = "0.00,0,0.25,0.9,0.4,0.3,1.0\n0.01,0.01,0.25,0.9,,,\n";
  const auto expected = good_export(kCoordinates, VendorExport::coordinates);
  EXPECT_THAT(expected.markers.names, ElementsAre("LASI", "RASI"));
  EXPECT_EQ(expected.markers.time.rate_hz, 100.0);
  EXPECT_FALSE(expected.markers.present(1, 1));
  EXPECT_THAT(
      expected.warnings,
      Contains(HasSubstr("no unit of length is stated; taken for m, as the markers reach over 0.4 m")));
  for (const std::string labels : {
           "time,LASI.x,LASI.y,LASI.z,RASI.x,RASI.y,RASI.z",
           "t,LASI X,LASI Y,LASI Z,RASI X,RASI Y,RASI Z",
           "Time (s),LASI:X,LASI:Y,LASI:Z,RASI:X,RASI:Y,RASI:Z",
           "\"Time [s]\",\"LASI-x\",\"LASI-y\",\"LASI-z\",\"RASI-x\",\"RASI-y\",\"RASI-z\"",
           ",LASI,,,RASI,,\ntime,X,Y,Z,X,Y,Z",
           "Time,LASI,,,RASI,,\n,X1,Y1,Z1,X2,Y2,Z2",
           "Time,LASI,LASI,LASI,RASI,RASI,RASI\n,x,y,z,x,y,z",
       }) {
    const auto trial = good_export(labels + "\n" + rows, VendorExport::coordinates);
    EXPECT_EQ(trial.markers.names, expected.markers.names) << labels;
    EXPECT_EQ(trial.markers.state, expected.markers.state) << labels;
    EXPECT_TRUE(trial.markers.x(0, 1).isApprox(expected.markers.x(0, 1))) << labels;
  }
}

TEST(CoordinateTables, TheUnitIsTheLabelsTheLinesTheUsersOrTheBodys) {
  const auto x_of = [](const std::string& text, std::string_view unit = {}) {
    const auto trial = parse_vendor_export(text, "t", VendorExport::coordinates, unit).value();
    EXPECT_EQ(trial.warnings.size(), 1U) << "the rate alone";
    return trial.markers.x(0, 0).x();
  };
  const std::string rows = "0,250,1,2\n0.01,250,1,2\n";
  EXPECT_DOUBLE_EQ(x_of("time,A_X (mm),A_Y (mm),A_Z (mm)\n" + rows), 0.25);
  EXPECT_DOUBLE_EQ(x_of("time,A_X,A_Y,A_Z\ns,cm,cm,cm\n" + rows), 2.5);
  EXPECT_DOUBLE_EQ(x_of("time,A_X,A_Y,A_Z\n[s],[mm],[mm],[mm]\n" + rows), 0.25);
  EXPECT_DOUBLE_EQ(x_of("time,A_X,A_Y,A_Z\n" + rows, "m"), 250.0);
  EXPECT_DOUBLE_EQ(x_of("time,A_X (mm),A_Y,A_Z\n" + rows, "m"), 0.25) << "what the file states wins";
  EXPECT_THAT(bad_export("time,A_X (mm),A_Y (mm),A_Z (mm),B_X (cm),B_Y (cm),B_Z (cm)\n0,1,2,3,4,5,6\n",
                         VendorExport::coordinates),
              HasSubstr("some coordinates are in 'mm', others in 'cm'"));
  EXPECT_DOUBLE_EQ(x_of("time,A_X,A_Y,A_Z\ns,mm,mm,mm\n" + rows), 0.25);
  const auto open = bad_export("time,A_X,A_Y,A_Z\n0,0,1,2\n0.01,700,1,2\n", VendorExport::coordinates);
  EXPECT_THAT(open, HasSubstr("reach over 700, may be of several; give it with --unit mm, cm or m, or in the "
                              "labels: 'A_X (mm)'"));
}

TEST(CoordinateTables, WithoutTimesTheRateIsGiven) {
  const auto read = [](const std::string& text) {
    EXPECT_TRUE(lacks_times(text)) << text;
    return parse_vendor_export(text, "t", VendorExport::coordinates, "m", 50.0).value();
  };
  for (const char* label :
       {"frame", "Frame #", "Frame No.", "frame_number", "FNUM", "", "Unnamed: 0", "index"}) {
    const auto trial = read(std::string(label) + ",A_x,A_y,A_z\n3,1,2,3\n4,1.5,2,3\n6,2,2,3\n");
    EXPECT_EQ(trial.markers.time, (TimeBase{50.0, 0.04, 4})) << label;
    EXPECT_EQ(trial.first_frame, 3);
    EXPECT_DOUBLE_EQ(trial.markers.x(1, 0).x(), 1.5);
    EXPECT_FALSE(trial.markers.present(2, 0)) << "frame 5 has no row";
    EXPECT_THAT(trial.warnings, ElementsAre("1 frames between the rows have no row and are missing"));
  }
  // Rows alone, one after another; frames from 0; as anipose writes them.
  EXPECT_EQ(read("A_x,A_y,A_z\n1,2,3\n2,2,3\n").markers.time, (TimeBase{50.0, 0.0, 2}));
  EXPECT_EQ(read("frame,A_x,A_y,A_z\n0,1,2,3\n1,2,2,3\n").markers.time, (TimeBase{50.0, 0.0, 2}));
  const auto pose = read(
      "knee_x,knee_y,knee_z,knee_error,knee_ncams,knee_score,M_00,center_0,fnum\n"
      "1,2,3,0.5,3,0.9,1,0,0\n,,,,0,,1,0,1\n2,2,3,0.5,3,0.9,1,0,2\n");
  EXPECT_EQ(pose.markers.names, std::vector<std::string>{"knee"});
  EXPECT_EQ(pose.markers.time, (TimeBase{50.0, 0.0, 3}));
  EXPECT_FALSE(pose.markers.present(1, 0));
  EXPECT_FALSE(lacks_times("time,A_x,A_y,A_z\n0,1,2,3\n"));
  EXPECT_FALSE(lacks_times("frame,time_ms,A_x,A_y,A_z\n1,0,1,2,3\n"));
  const auto bad = parse_vendor_export("A_x,A_y,A_z\n1,2,3\n", "t", VendorExport::coordinates, "m", -3.0);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, Code::usage);
  const auto back =
      parse_vendor_export("frame,A_x,A_y,A_z\n2,0,0,0\n1,0,0,0\n", "t", VendorExport::coordinates, "m", 50.0);
  ASSERT_FALSE(back);
  EXPECT_THAT(back.error().message, HasSubstr("the frame number does not increase; expected more than 2"));
}

TEST(CoordinateTables, TimesAreInTheUnitThatTheirLabelSays) {
  for (const std::string label : {"time_ms", "Time (ms)", "Zeit [msec]"}) {
    const auto trial = good_export(label + ",A_x (m),A_y (m),A_z (m)\n0,1,2,3\n10,1,2,3\n20,1,2,3\n",
                                   VendorExport::coordinates);
    EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 3})) << label;
  }
  const auto micro =
      good_export("Timestamp (us),A_x (m),A_y (m),A_z (m)\n5000,1,2,3\n15000,1,2,3\n25000,1,2,3\n",
                  VendorExport::coordinates);
  EXPECT_EQ(micro.markers.time, (TimeBase{100.0, 0.005, 3}));
  // Ten seconds from frame to frame are asked about where nothing says that they are seconds.
  const std::string rows = ",A_x (m),A_y (m),A_z (m)\n0,1,2,3\n10,1,2,3\n20,1,2,3\n";
  EXPECT_THAT(
      bad_export("time" + rows, VendorExport::coordinates),
      HasSubstr("rows are 10 s apart, if the times are in seconds; if they are in milliseconds, call their "
                "column 'time_ms', else 'time_s'"));
  EXPECT_EQ(good_export("time_s" + rows, VendorExport::coordinates).markers.time.rate_hz, 0.1);
}

TEST(CoordinateTables, APointWithoutANameNeedsItsUnit) {
  const std::string text = "t,x,y,z\n0,250,1,2\n0.01,251,1,2\n";
  EXPECT_THAT(
      bad_export(text, VendorExport::coordinates),
      HasSubstr("x, y and z name no marker, and nothing tells that they are a position; if they are, give "
                "their unit of length with --unit mm, cm or m"));
  const auto trial = parse_vendor_export(text, "t", VendorExport::coordinates, "mm").value();
  EXPECT_EQ(trial.markers.names, std::vector<std::string>{"point 1"});
  EXPECT_DOUBLE_EQ(trial.markers.x(1, 0).x(), 0.251);
}

TEST(CoordinateTables, OrderOfAxesTitlesAndWordsForNothing) {
  const auto trial = good_export(
      "Subject: A\n# comment\ntime,A_Z (m),A_X (m),A_Y "
      "(m)\n0,3,1,2\n0.01,NA,1,2\n0.02,-,None,#N/A\n0.03,3.5,1,2\n",
      VendorExport::coordinates);
  EXPECT_EQ(trial.markers.x(0, 0), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(trial.markers.present(1, 0));
  EXPECT_FALSE(trial.markers.present(2, 0));
  EXPECT_DOUBLE_EQ(trial.markers.x(3, 0).z(), 3.5);
  const auto units = good_export("Name,A,,\nunits,mm,mm,mm\ntime,x,y,z\n0,250,1,2\n0.01,250,1,2\n",
                                 VendorExport::coordinates);
  EXPECT_DOUBLE_EQ(units.markers.x(0, 0).x(), 0.25);
}

TEST(CoordinateTables, WhatElseStandsThereIsNamedOrRefused) {
  const auto trial = good_export("frame,time,A_x,A_y,A_z,A_error,mood\n5,0,1,0,0,9,1\n6,0.01,1.5,0,0,9,1\n",
                                 VendorExport::coordinates);
  EXPECT_EQ(trial.first_frame, 5);
  EXPECT_THAT(trial.warnings,
              Contains(HasSubstr(
                  "2 of 7 columns are no coordinates of markers and are not read: 'A_error', 'mood'")));
  EXPECT_THAT(
      bad_export("frame,A_x,A_y,A_z\n1,0,0,0\n", VendorExport::coordinates),
      HasSubstr("line 1: is a table of coordinates without a column of times; give its frame rate with "
                "--rate HZ, or a column called 'time'"));
  EXPECT_THAT(bad_export("time,A_x (furlong),A_y,A_z\n1,0,0,0\n", VendorExport::coordinates),
              HasSubstr("'furlong' is unknown"));
  for (const char* other :
       {"frame,time_s,marker,x_m,y_m,z_m\n", "measure,subject,value\n", "time,A_x,B_y,A_z\n0,1,2,3\n",
        "time,acc_x,acc_y,acc_z\n0,1,2,9.8\n", "t,wrist force X,wrist force Y,wrist force Z\n",
        "t,Angular velocity_x,Angular velocity_y,Angular velocity_z\n", "time,angle\n0,1\n", "",
        "x,y,z\n1,2,3\n"})
    EXPECT_NE(vendor_export_of(other), VendorExport::coordinates) << other;
}

TEST(DFlow, MarkersAreMetresAndZerosAreNotSeen) {
  const std::string text =
      "TimeStamp\tFrameNumber\tLHEE.PosX\tLHEE.PosY\tLHEE.PosZ\tRHEE.PosX\tRHEE.PosY\tRHEE.PosZ\tFP1."
      "CopX\tFP1."
      "ForX\n"
      "10.00\t100\t0.1\t1.2\t0.3\t0.4\t0.5\t0.6\t0\t3\n"
      "10.01\t101\t0.2\t1.3\t0.4\t0.000000\t0.0\t0\t0\t3\n"
      "10.02\t102\t0.3\t1.4\t0.5\t0.7\t0.8\t0.9\t0\t3\n";
  EXPECT_TRUE(begins_d_flow(text));
  const auto trial = parse_vendor_export(text, "walk.txt", VendorExport::coordinates);
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->format, "D-Flow");
  EXPECT_EQ(trial->units_in_file, "m");
  EXPECT_EQ(trial->first_frame, 100);
  EXPECT_NEAR(trial->markers.time.rate_hz, 100.0, 1e-9);
  EXPECT_NEAR(trial->markers.time.t0_s, 10.0, 1e-12);
  EXPECT_THAT(trial->markers.names, ElementsAre("LHEE", "RHEE"));
  EXPECT_EQ(trial->markers.x(1, 0), Eigen::Vector3d(0.2, 1.3, 0.4));
  EXPECT_FALSE(trial->markers.present(1, 1));
  EXPECT_TRUE(trial->markers.present(2, 1));
  EXPECT_THAT(trial->warnings,
              Contains(HasSubstr("2 of 10 columns are no coordinates of markers and are not read: "
                                 "'FP1.CopX', 'FP1.ForX'")));
}

TEST(DFlow, IsKnownByItsLabelsAlone) {
  EXPECT_FALSE(begins_d_flow("time\tLHEE_X\tLHEE_Y\tLHEE_Z\n"));
  EXPECT_FALSE(begins_d_flow("TimeStamp\tFrameNumber\tFP1.CopX\tFP1.CopY\tFP1.CopZ\n"));
  EXPECT_FALSE(begins_d_flow("time\t.PosX\t.PosY\t.PosZ\n")) << "no marker has this name";
}

}  // namespace
}  // namespace kinemark::io
