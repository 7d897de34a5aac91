// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/marker_table.h"

#include <gmock/gmock.h>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kVectors =
    "DataType=Vec3\nversion=3\nUnits=mm\nendheader\ntime\tLASI\tRASI\n0\t0,250,900\t1,2,3\n0.01\t1,250,"
    "900\tnan,nan,nan\n";
const std::string kColumns =
    "name\nnRows=2\nendheader\ntime\tLASI_tx\tLASI_ty\tLASI_tz\tRASI_tx\tRASI_ty\tRASI_tz\n"
    "0\t0\t0.25\t0.9\t0.001\t0.002\t0.003\n0.01\t0.001\t0.25\t0.9\t\t\t\n";

TEST(MarkerTable, VectorsAndColumnsAreTheSameMarkers) {
  for (const auto& text : {kVectors, kColumns}) {
    ASSERT_TRUE(begins_marker_table(text.substr(0, 512)));
    const auto trial = parse_marker_table(text, "m.sto").value();
    EXPECT_THAT(trial.markers.names, ElementsAre("LASI", "RASI"));
    EXPECT_EQ(trial.markers.time.rate_hz, 100.0);
    EXPECT_EQ(trial.markers.frames(), 2);
    EXPECT_TRUE(trial.markers.x(1, 0).isApprox(Eigen::Vector3d(0.001, 0.25, 0.9), 1e-12));
    EXPECT_TRUE(trial.markers.present(0, 1));
    EXPECT_FALSE(trial.markers.present(1, 1));
    EXPECT_THAT(trial.warnings, IsEmpty());
    EXPECT_TRUE(trial.validate());
  }
}

TEST(MarkerTable, AMotionIsNone) {
  for (const std::string labels :
       {"pelvis_tx\tpelvis_ty\tpelvis_tz\tpelvis_tilt\tpelvis_list\tpelvis_rotation",
        "pelvis_tilt\tpelvis_tx\tpelvis_ty\tpelvis_tz", "knee_angle_r"})
    EXPECT_FALSE(begins_marker_table("Q\nendheader\ntime\t" + labels + "\n0\t1\n")) << labels;
  EXPECT_FALSE(begins_marker_table("PathFileType\t4\n"));
  EXPECT_FALSE(begins_marker_table("Q\nendheader\n"));
  EXPECT_FALSE(begins_marker_table("Q\nendheader\ntime\tforce_vx\tforce_vy\tforce_vz\n"));
}

TEST(MarkerTable, ABeginningMayCutTheLabels) {
  std::string text = "Q\nendheader\ntime";
  for (int m = 0; m < 40; ++m)
    for (const char* end : {"_tx", "_ty", "_tz"}) text += "\tmarker" + std::to_string(m) + end;
  for (const std::size_t size : {500, 501, 502, 503, 504, 505, 506, 507, 508, 509, 510, 511, 512})
    EXPECT_TRUE(begins_marker_table(text.substr(0, size))) << size;
}

TEST(MarkerTable, OtherColumnsAreNamedAndNotRead) {
  const auto trial =
      parse_marker_table("Q\nendheader\ntime\tA_tx\tA_ty\tA_tz\tscore\n0\t1\t2\t3\t9\n1\t1\t2\t3\t9\n",
                         "m.sto")
          .value();
  EXPECT_THAT(trial.markers.names, ElementsAre("A"));
  EXPECT_THAT(trial.warnings,
              ElementsAre(HasSubstr("1 of 4 columns are no positions of markers and are not read: 'score'")));
}

TEST(MarkerTable, WhatDoesNotFitIsOneSentence) {
  const auto message = [](const std::string& text) {
    return parse_marker_table(text, "m.sto").error().message;
  };
  EXPECT_THAT(message("Q\nendheader\ntime\tangle\n0\t1\n"),
              HasSubstr("m.sto: holds no positions of markers"));
  EXPECT_THAT(message("DataType=Vec3\nUnits=furlong\nendheader\ntime\tA\n0\t1,2,3\n"),
              HasSubstr("Units is 'furlong'"));
  EXPECT_THAT(message("DataType=Vec3\nendheader\ntime\tA\n"), HasSubstr("holds no positions"));
}

}  // namespace
}  // namespace kinemark::io
