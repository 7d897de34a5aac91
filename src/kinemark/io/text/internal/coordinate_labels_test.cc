// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/coordinate_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

CoordinateLabels read(std::string_view text, std::int64_t* last_line = nullptr) {
  Lines lines(text);
  auto out = read_coordinate_labels(lines);
  if (last_line != nullptr) *last_line = lines.number();
  return out;
}

TEST(CoordinateLabel, NamesItsMarkerItsAxisAndItsUnit) {
  for (const char* text :
       {"LASI_X", "LASI.x", "LASI X", "LASI:X", "LASI-x", "LASI/X", "LASI|x", "X_LASI", "x LASI", "LASI(X)",
        "LASI[x]", "LASI_pos_x", "LASI position X", "LASI_PosX", "LASI__x", "LASI - X"}) {
    const auto label = coordinate_label(text);
    EXPECT_EQ(label.name, "LASI") << text;
    EXPECT_EQ(label.axis, 0) << text;
    EXPECT_EQ(label.unit, "") << text;
    EXPECT_FALSE(label.of_d_flow) << text;
  }
  for (const char* text : {"LASI_Z (mm)", "LASI z [mm]", "LASI_Z_mm", "LASI.z.mm"}) {
    const auto label = coordinate_label(text);
    EXPECT_EQ(label.name, "LASI") << text;
    EXPECT_EQ(label.axis, 2) << text;
    EXPECT_EQ(label.unit, "mm") << text;
  }
  EXPECT_EQ(coordinate_label("x_m").name, "") << "metres";
  EXPECT_EQ(coordinate_label("x_coord").name, "") << "of whom is not said";
  EXPECT_EQ(coordinate_label("pos_x").name, "");
  EXPECT_TRUE(coordinate_label("LASI.PosX").of_d_flow);
  EXPECT_EQ(coordinate_label("pelvis_w").axis, CoordinateLabel::kW);
  for (const char* text : {"LASI", "LASIX", "max", "", "x1", "position", "LASI_score"})
    EXPECT_LT(coordinate_label(text).axis, 0) << text;
}

TEST(CoordinateLabel, TimesSayTheirUnitInSeveralLanguages) {
  for (const char* text : {"time", "Time (s)", "t", "Temps (s)", "Zeit [s]", "Tiempo", "timestamps",
                           "time_stamp", "Time_s", "elapsed_time", "sec", "s", "seconds", "TIME"})
    EXPECT_EQ(coordinate_label(text).units_per_second, 1.0) << text;
  for (const char* text : {"time_ms", "Time (ms)", "Time [msec]", "timestamp_ms", "Zeit [Milliseconds]"})
    EXPECT_EQ(coordinate_label(text).units_per_second, 1e3) << text;
  EXPECT_EQ(coordinate_label("Timestamp (us)").units_per_second, 1e6);
  EXPECT_EQ(coordinate_label("time_ns").units_per_second, 1e9);
  for (const char* text : {"time", "t", "timestamp", "Temps"})
    EXPECT_TRUE(coordinate_label(text).is_time_unit_open) << text;
  for (const char* text : {"time_s", "Time (s)", "seconds", "time_ms", "s"})
    EXPECT_FALSE(coordinate_label(text).is_time_unit_open) << text;
  for (const char* text : {"LASI", "timer", "reaction time", "ms", "stance"})
    EXPECT_EQ(coordinate_label(text).units_per_second, 0.0) << text;
  EXPECT_TRUE(coordinate_label("Frame#").is_frame);
  EXPECT_FALSE(coordinate_label("framework").is_frame);
}

TEST(CoordinateLabels, ColumnsOfAMarkerStandInAnyOrder) {
  const auto mixed = read("time,A_X,A_Z,A_Y,B_X,B_Y,B_Z\n");
  EXPECT_THAT(mixed.names, ElementsAre("A", "B"));
  EXPECT_EQ(mixed.columns[2].axis, 2);
  EXPECT_EQ(mixed.columns[2].marker, 0);
  const auto by_axis = read("t\tA_x\tB_x\tA_y\tB_y\tA_z\tB_z\n");
  EXPECT_THAT(by_axis.names, ElementsAre("A", "B"));
  EXPECT_EQ(by_axis.columns[6].marker, 1);
  const auto twice = read("time,A_X,A_Y,A_Z,A_X,A_Y,A_Z\n");
  EXPECT_THAT(twice.names, ElementsAre("A", "A"));
  EXPECT_EQ(twice.columns[4].marker, 1);
}

TEST(CoordinateLabels, AnAxisRightBehindTheNameCounts) {
  EXPECT_THAT(read("time,LASIX,LASIY,LASIZ\n").names, ElementsAre("LASI"));
  EXPECT_THAT(read("Time,X1,Y1,Z1,X2,Y2,Z2\n").names, ElementsAre("point 1", "point 2"));
  // Short stems are of forces, moments and coordinates of a model.
  for (const char* text :
       {"time,Fx,Fy,Fz\n", "time,FP1_Fx,FP1_Fy,FP1_Fz\n", "time\tpelvis_tx\tpelvis_ty\tpelvis_tz\n"})
    EXPECT_THAT(read(text).columns, IsEmpty()) << text;
}

TEST(CoordinateLabels, WhatIsNoPositionIsNoMarker) {
  for (const char* text :
       {"time,acc_x,acc_y,acc_z\n", "time,LHipAngles_X,LHipAngles_Y,LHipAngles_Z\n", "time,F_X,F_Y,F_Z\n",
        "time,w1,x1,y1\n", "time,hip force x,hip force y,hip force z\n",
        "time,pelvis_w,pelvis_x,pelvis_y,pelvis_z\n", "Time (s),W,X,Y,Z\n", "time,A_X,A_Y\n",
        "frame,time_s,marker,x_m,y_m,z_m\n", "index,object,point,x_coord,y_coord,z_coord,frame_time\n",
        "x,y,z\n", "t,x,y,z,temperature\n", ""})
    EXPECT_THAT(read(text).columns, IsEmpty()) << text;
  EXPECT_THAT(read("t,x,y,z\n").names, ElementsAre("")) << "alone they may be one";
}

TEST(CoordinateLabels, NamesStandAboveAxesWithOtherLinesBetween) {
  std::int64_t last = 0;
  const auto deeplabcut = read(
      "scorer,net,net,net,net,net,net\nbodyparts,A,A,A,B,B,B\ncoords,x,y,z,x,y,z\n0,1,2,3,4,5,6\n", &last);
  EXPECT_THAT(deeplabcut.names, ElementsAre("A", "B"));
  EXPECT_TRUE(deeplabcut.columns[0].is_frame);
  EXPECT_EQ(last, 3);
  const auto units = read("Name,A,,,B,,\nunits,m,m,m,m,m,m\ntime,x,y,z,x,y,z\n");
  EXPECT_THAT(units.names, ElementsAre("A", "B"));
  EXPECT_THAT(units.units, ElementsAre("units", "m", "m", "m", "m", "m", "m"));
}

TEST(CoordinateLabels, NumbersStandForAxesWhereEveryNameHasThree) {
  for (const char* text :
       {"time,LASI_1,LASI_2,LASI_3,RASI_1,RASI_2,RASI_3\n",
        "time,LASI.1,LASI.2,LASI.3,RASI.1,RASI.2,RASI.3\n",
        "time,LASI[0],LASI[1],LASI[2],RASI[0],RASI[1],RASI[2]\n",
        "t\tLASI(1)\tLASI(2)\tLASI(3)\tRASI(1)\tRASI(2)\tRASI(3)\n",
        "time,LASI_1 (mm),LASI_2 (mm),LASI_3 (mm),RASI_1 (mm),RASI_2 (mm),RASI_3 (mm)\n"}) {
    const auto found = read(text);
    ASSERT_EQ(found.columns.size(), 7U) << text;
    EXPECT_THAT(found.names, ElementsAre("LASI", "RASI")) << text;
    EXPECT_TRUE(found.are_numbered) << text;
    EXPECT_EQ(found.columns[3].axis, 2) << text;
    EXPECT_EQ(found.columns[4].marker, 1) << text;
  }
  EXPECT_EQ(read("time,LASI_1 (mm),LASI_2 (mm),LASI_3 (mm)\n").columns.at(1).unit, "mm");
  EXPECT_EQ(read("time,LASI[0],LASI[1],LASI[2]\n").columns.at(1).unit, "");
  // By axis, as a table that was stacked.
  EXPECT_EQ(read("time,A_1,B_1,A_2,B_2,A_3,B_3\n").columns.at(6).axis, 2);
  EXPECT_FALSE(read("time,LASI_1_x,LASI_1_y,LASI_1_z\n").are_numbered);
}

TEST(CoordinateLabels, AFourthThatIsOneIsOfHomogeneousCoordinates) {
  const auto found =
      read("Time,LASI[0],LASI[1],LASI[2],LASI[3],RASI[0],RASI[1],RASI[2],RASI[3]\n0,1,2,3,1.0,1,2,3,1.0\n");
  EXPECT_THAT(found.names, ElementsAre("LASI", "RASI"));
  EXPECT_EQ(found.columns.at(5).marker, 1);
  EXPECT_LT(found.columns.at(4).marker, 0);
  for (const char* row : {"0,0.1,0.2,0.3,0.9\n", "0,1,2,3,\n", ""})
    EXPECT_THAT(read(std::string("Time,q[0],q[1],q[2],q[3]\n") + row).columns, IsEmpty())
        << "a quaternion: " << row;
}

TEST(CoordinateLabels, PandasNamesItsIndexBelowTheAxes) {
  std::int64_t last = 0;
  for (const char* head : {",A,A,A,B,B,B\n,x,y,z,x,y,z\n", "channel,A,A,A,B,B,B\naxis,x,y,z,x,y,z\n"}) {
    const auto found = read(std::string(head) + "time,,,,,,\n0,1,2,3,4,5,6\n", &last);
    EXPECT_THAT(found.names, ElementsAre("A", "B")) << head;
    EXPECT_EQ(found.columns.at(0).units_per_second, 1.0) << head;
    EXPECT_FALSE(found.columns.at(0).is_frame) << head;
    EXPECT_EQ(last, 3) << head;
    read(std::string(head) + "0,1,2,3,4,5,6\n", &last);
    EXPECT_EQ(last, 2) << "no such line";
    read(std::string(head) + "time,,,,1,,\n", &last);
    EXPECT_EQ(last, 2) << "a number of a marker";
  }
}

TEST(CoordinateLabels, NumbersThatTellMarkersOrChannelsApartAreNoAxes) {
  for (const char* text :
       {"time,LASI_1,LASI_2\n", "time,LASI_1,LASI_2,LASI_3,LASI_4\n", "time,LASI_1,LASI_2,LASI_4\n",
        "time,LASI_2,LASI_3,LASI_4\n", "time,Marker_1,Marker_2,Marker_3\n",
        "time,sensor 1,sensor 2,sensor 3\n", "time,LASI_1,LASI_2,LASI_3,RASI_0,RASI_1,RASI_2\n",
        "time,LASI_1,LASI_2,LASI_3,force\n", "time,acc_1,acc_2,acc_3\n", "time,LASI_1,LASI_1,LASI_2\n",
        "time,A1,A2,A3\n"})
    EXPECT_THAT(read(text).columns, IsEmpty()) << text;
}

TEST(CoordinateLabels, TitlesAndCommentsArePassedOver) {
  std::int64_t last = 0;
  EXPECT_THAT(read("Subject: A\nDate: today\n\ntime,A_X,A_Y,A_Z\n0,1,2,3\n", &last).names, ElementsAre("A"));
  EXPECT_EQ(last, 4);
  EXPECT_THAT(read("# a comment, with, many, commas, in, it\ntime,A_X,A_Y,A_Z\n").names, ElementsAre("A"));
  EXPECT_THAT(read("# time A\n# time,A_X,A_Y,A_Z\n0,1,2,3\n", &last).names, ElementsAre("A"));
  EXPECT_EQ(last, 2);
  // Not in a table that has a head of its own, nor below rows as wide as the labels.
  EXPECT_THAT(read("forces\nversion=1\nendheader\ntime\tA_X\tA_Y\tA_Z\n").columns, IsEmpty());
  EXPECT_THAT(read("1,2,3,4,5,6\n1,2,3,4,5,6\ntime,A_X,A_Y,A_Z\n").columns, IsEmpty());
}

TEST(CoordinateLabels, MarkersAreFirstOrMostOfAll) {
  EXPECT_THAT(read("time,trial,A_X,A_Y,A_Z,B_X,B_Y,B_Z\n").names, ElementsAre("A", "B"));
  EXPECT_THAT(read("time,A_X,A_Y,A_Z,p,q,r,s,t1,u,v\n").names, ElementsAre("A"));
  EXPECT_THAT(read("time,p,q,r,s,t1,u,v,A_X,A_Y,A_Z\n").columns, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io::internal
