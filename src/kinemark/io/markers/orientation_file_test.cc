// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/orientation_file.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kBodies =
    "NO_OF_FRAMES\t1\nNO_OF_BODIES\t1\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_NAMES\tstick\n"
    "100\t200\t300\t0\t0\t0\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n";
const std::string kMarkers =
    "NO_OF_FRAMES\t1\nNO_OF_MARKERS\t1\nFREQUENCY\t100\nDATA_INCLUDED\t3D\nMARKER_NAMES\tA\n1\t2\t3\n";

TEST(OrientationFile, IsReadByEndingAndContent) {
  const testing_support::ScratchFolder scratch;
  const auto write = [&](const char* name, const std::string& text) {
    EXPECT_TRUE(write_text(scratch / name, text, true));
    return scratch / name;
  };
  const auto sto =
      write("a.sto", "DataType=Quaternion\nversion=3\nendheader\ntime\tpelvis\n0\t0,1,0,0\n0.01\t0,1,0,0\n");
  const auto tsv = write("b.TSV", kBodies);
  const auto csv = write("c.csv", "time,hand_w,hand_x,hand_y,hand_z\n0,1,0,0,0\n0.01,1,0,0,0\n");
  for (const auto& [path, name] : {std::pair{sto, "pelvis"}, {tsv, "stick"}, {csv, "hand"}}) {
    EXPECT_TRUE(has_orientations(path)) << path;
    const auto read = read_orientation_file(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_THAT(read->names, ElementsAre(name));
  }
}

TEST(OrientationFile, OthersAreRefusedWithTheFormatsThatHaveThem) {
  const testing_support::ScratchFolder scratch;
  const auto write = [&](const char* name, const std::string& text) {
    EXPECT_TRUE(write_text(scratch / name, text, true));
    return scratch / name;
  };
  for (const auto& path : {write("a.trc", "PathFileType\t4\n"), write("b.tsv", kMarkers),
                           write("c.csv", "time,A_x,A_y,A_z\n0,1,2,3\n")}) {
    EXPECT_FALSE(has_orientations(path)) << path;
    const auto read = read_orientation_file(path);
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().code, Code::not_supported);
    EXPECT_THAT(read.error().message,
                HasSubstr("ROTATION group (Theia, Visual3D), .tsv of rigid bodies (QTM, 6D)"));
  }
  EXPECT_FALSE(has_orientations(scratch / "none.sto"));
  EXPECT_FALSE(has_orientations(scratch / "none.c3d"));
  EXPECT_EQ(read_orientation_file(scratch / "none.csv").error().code, Code::io);
}

TEST(OrientationFile, TheiaHasThemInItsC3d) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto path = data / "ezc3d-testFiles/C3DRotationExample.c3d";
  EXPECT_TRUE(has_orientations(path));
  const auto read = read_orientation_file(path).value();
  EXPECT_EQ(read.frames(), 340);
  EXPECT_EQ(read.time.rate_hz, 85.0);
}

}  // namespace
}  // namespace kinemark::io
