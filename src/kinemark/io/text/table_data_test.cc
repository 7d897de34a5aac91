// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Every real MOT and STO file, against what an independent parser found in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::IsEmpty;

struct Expected {
  const char* file;
  std::size_t columns;  ///< without time
  std::int64_t rows;
  double first_s, last_s;
  bool stated, degrees;  ///< what the file says; what angles_are_degrees() concludes
  const char* name;
  const char* first_column;
  double first_value;
};

const std::vector<Expected> kFiles = {
    {"opensim-core-ik/std_subject01_walk1_ik.mot", 23, 73, 0.4, 1.6, false, true, "first trial",
     "pelvis_tilt", 5.21211788},
    {"opensim-core-ik/std_subject1_abdbonepin_IK.mot", 17, 1901, 0.0, 19.0, true, true, "Coordinates",
     "ground_thorax_rot_x", 0.55133044},
    {"opensim-gait2354/subject01_walk1_ik.mot", 23, 73, 0.4, 1.6, true, true, "Coordinates", "pelvis_tilt",
     4.84455933},
    {"opensim-hamner-fullbody/ik_model_marker_locations.sto", 111, 599, 0.0, 9.96666667, true, false,
     "Model Marker Locations from IK", "R.ASIS_tx", 0.80734226},
    {"opensim-hamner-fullbody/subject02_running_ik.mot", 37, 599, 0.0, 9.96666667, true, true, "Coordinates",
     "pelvis_tilt", -3.88006486},
    {"opensim-arm26/arm26_InverseKinematics.mot", 2, 121, 0.0, 1.0, true, true, "Coordinates",
     "r_shoulder_elev", -0.03394423},
    {"bmc-rajagopal-run/IK/results/ik_output_run.mot", 39, 122, 0.0, 0.80666667, true, true, "Coordinates",
     "pelvis_tilt", -18.41593820},
    {"nimble-arnold-synthetic/subject01/coordinates.sto", 33, 223, 3.38, 4.49, false, false, "",
     "pelvis_tilt", -0.137665069139959},
    {"opensim-core-formats/std_walking2_grfs.sto", 18, 101, 0.0, 4.9955, false, true,
     "ds_std_walking2_grfs.sto", "f1_1", 2.27511001},
    {"opensim-core-formats/gait10dof18musc_ik_CRLF_line_ending.mot", 10, 15, 0.0, 0.23333333, true, true,
     "Coordinates", "pelvis_tilt", 10.32995988},
};

TEST(TableData, EveryRealFileReadsAsInventoried) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const Expected& want : kFiles) {
    SCOPED_TRACE(want.file);
    const auto table = read_table(data / want.file);
    ASSERT_TRUE(table) << table.error().message;
    ASSERT_TRUE(table->validate());
    EXPECT_EQ(table->columns.size(), want.columns);
    EXPECT_EQ(table->rows(), want.rows);
    EXPECT_EQ(table->time_s.front(), want.first_s);
    EXPECT_EQ(table->time_s.back(), want.last_s);
    EXPECT_EQ(table->degrees_stated, want.stated);
    EXPECT_EQ(angles_are_degrees(*table), want.degrees);
    EXPECT_EQ(table->name, want.name);
    EXPECT_EQ(table->columns[0], want.first_column);
    EXPECT_EQ((*table)(0, 0), want.first_value);
    EXPECT_THAT(table->warnings, IsEmpty());
    for (const double value : table->values) ASSERT_TRUE(std::isfinite(value));
  }
}

TEST(TableData, EveryRealFileSurvivesARoundTripInBothVersions) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const testing_support::ScratchFolder scratch;
  for (const Expected& want : kFiles) {
    SCOPED_TRACE(want.file);
    const auto before = read_table(data / want.file).value();
    for (const int version : {1, 3}) {
      const auto path = scratch / "out.sto";
      ASSERT_TRUE(write_table(path, before, {.force = true, .version = version}));
      const auto after = read_table(path);
      ASSERT_TRUE(after) << after.error().message;
      EXPECT_EQ(after->columns, before.columns);
      EXPECT_EQ(after->time_s, before.time_s);
      EXPECT_EQ(after->values, before.values) << "bit for bit";
      EXPECT_EQ(after->name, before.name.empty() ? "out" : before.name);
      EXPECT_EQ(angles_are_degrees(*after), want.degrees);
      EXPECT_EQ(after->degrees_stated, want.stated || want.degrees);
      EXPECT_THAT(after->warnings, IsEmpty());
    }
  }
}

TEST(TableData, AMarkerFileIsNoTable) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const char* file : {"btk-others/Gait.trc", "btk-others/Gait.c3d", "btk-others/Empty.trc"}) {
    const auto table = read_table(data / file);
    ASSERT_FALSE(table) << file;
    EXPECT_EQ(table.error().code, Code::bad_input);
    EXPECT_THAT(table.error().message, testing::HasSubstr("a MOT or STO table")) << file;
  }
}

}  // namespace
}  // namespace kinemark::io
