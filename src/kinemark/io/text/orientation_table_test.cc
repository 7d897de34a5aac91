// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/orientation_table.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kSensorHeader =
    "DataRate=100.0\nDataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\ttibia_r_imu\n";

TEST(OrientationTable, IsOfOpenSense) {
  const auto read =
      parse_orientations(
          kSensorHeader +
              "0.00\t1,0,0,0\t0.7071,0,0,0.7071\n0.01\tnan,nan,nan,nan\t0, 1, 0, 0\n0.02\t0,0,0,0\t1,0,0,0\n",
          "q.sto")
          .value();
  EXPECT_THAT(read.names, ElementsAre("pelvis_imu", "tibia_r_imu"));
  EXPECT_EQ(read.time.rate_hz, 100.0);
  EXPECT_EQ(read.frames(), 3);
  EXPECT_THAT(read.warnings,
              ElementsAre("sensor 'pelvis_imu': quaternions of zeros in 1 rows, taken as missing"));
  EXPECT_FALSE(read.present(1, 0));
  EXPECT_FALSE(read.present(2, 0)) << "a quaternion of length 0 is none";
  EXPECT_TRUE((read.rotation(0, 1) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12))
      << "made unit";
  EXPECT_TRUE(read.rotation(1, 1).isApprox(Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix()));
}

TEST(OrientationTable, MissingCellsAreNoQuaternionsOfZeros) {
  const auto read =
      parse_orientations(kSensorHeader + "0.00\t1,0,0,0\t1,0,0,0\n0.01\tnan,nan,nan,nan\t-1,0,0,0\n", "q.sto")
          .value();
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_FALSE(read.present(1, 0));
  EXPECT_TRUE(read.rotation(1, 1).isApprox(Eigen::Matrix3d::Identity())) << "a change of sign is no turn";
}

TEST(OrientationTable, AGapInTimeIsFramesWithout) {
  const auto read =
      parse_orientations(kSensorHeader +
                             "0\t1,0,0,0\t1,0,0,0\n0.01\t1,0,0,0\t1,0,0,0\n0.02\t1,0,0,0\t1,0,0,0\n"
                             "0.03\t1,0,0,0\t1,0,0,0\n0.05\t1,0,0,0\t1,0,0,0\n",
                         "q.sto")
          .value();
  EXPECT_EQ(read.frames(), 6);
  EXPECT_FALSE(read.present(4, 0));
  EXPECT_TRUE(read.present(5, 0));
}

TEST(OrientationTable, SaysWhatIsWrong) {
  const auto message = [](const std::string& text) {
    return parse_orientations(text, "q.sto").error().message;
  };
  EXPECT_THAT(message(kSensorHeader + "0\t1,0,0,0\t2,0,0,0\n0.01\t1,0,0,0\t1,0,0,0\n"),
              HasSubstr("row 1, 'tibia_r_imu': a quaternion of length 2"));
  EXPECT_THAT(message(kSensorHeader + "0\t1,0,0\t1,0,0,0\n"),
              HasSubstr("expected 4 numbers with commas between"));
  EXPECT_THAT(message(kSensorHeader), HasSubstr("holds no orientation"));
  EXPECT_THAT(message("Q\nendheader\ntime\tknee\n0\t1\n"), HasSubstr("holds no orientations"));
}

TEST(OrientationTable, IsNoTableOfNumbers) {
  const auto read = parse_table(kSensorHeader + "0\t1,0,0,0\t1,0,0,0\n", "q.sto");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Code::not_supported);
  EXPECT_THAT(read.error().message, HasSubstr("--orientations"));
}

TEST(OrientationTable, SaysWhichFilesHoldOrientations) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "q.sto", kSensorHeader + "0\t1,0,0,0\t1,0,0,0\n", true));
  ASSERT_TRUE(write_text(scratch / "a.sto", "Q\nendheader\ntime\tknee\n0\t1\n", true));
  EXPECT_TRUE(holds_orientations(scratch / "q.sto").value());
  EXPECT_FALSE(holds_orientations(scratch / "a.sto").value());
  EXPECT_FALSE(holds_orientations(scratch / "none.sto"));
}

}  // namespace
}  // namespace kinemark::io
