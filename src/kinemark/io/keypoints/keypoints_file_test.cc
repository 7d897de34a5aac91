// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_file.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class KeypointsFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_text(folder_ / name, text, true));
    return folder_ / name;
  }
  static std::string frame(int x) {
    std::string text = R"({"version": 1.3, "people": [{"pose_keypoints_2d": [)";
    for (int m = 0; m < 18; ++m) text += std::string(m == 0 ? "" : ",") + std::to_string(x) + ",2,0.9";
    return text + "]}]}";
  }
  /// x of the first point in the first frame.
  static double first_x(const std::filesystem::path& path) {
    const auto points = read_keypoints(path);
    EXPECT_TRUE(points) << points.error().message;
    return points ? points->at(0, 0).x() : 0.0;
  }
  testing_support::ScratchFolder folder_;
};

TEST_F(KeypointsFile, TheContentTellsTheWriterNotTheEnding) {
  EXPECT_EQ(first_x(write("dlc.csv", "scorer,n,n\nbodyparts,A,A\ncoords,x,y\n0,11,2\n")), 11.0);
  EXPECT_EQ(first_x(write("m.txt", R"( [{"frame_id": 0, "instances": [{"keypoints": [[12, 2]]}]}])")), 12.0);
  EXPECT_EQ(
      first_x(write("coco.json", R"({"images": [{"id": 1}], "categories": [{"id": 1, "keypoints": ["a"]}],
                           "annotations": [{"image_id": 1, "category_id": 1, "keypoints": [13, 5, 2]}]})")),
      13.0);
  EXPECT_EQ(first_x(write("v_0_keypoints.json", frame(14))), 14.0);
  EXPECT_EQ(first_x(folder_ / ""), 14.0) << "a folder is of OpenPose";
}

TEST_F(KeypointsFile, FilesThatAreReadAreNamed) {
  const auto csv = write("dlc.csv", "scorer,n,n\nbodyparts,A,A\ncoords,x,y\n0,11,2\n");
  const auto later = write("v_1_keypoints.json", frame(1)), first = write("v_0_keypoints.json", frame(2));
  EXPECT_THAT(keypoints_files(csv).value(), ElementsAre(csv));
  EXPECT_THAT(keypoints_files(later).value(), ElementsAre(first, later));
  EXPECT_EQ(keypoints_files(folder_ / "").value().size(), 2U);
  EXPECT_EQ(keypoints_files(folder_ / "absent.json").error().code, Code::io);
}

TEST_F(KeypointsFile, ItsBeginningTellsAFileOfPoints) {
  for (const char* begin :
       {"scorer,net,net\n", "scorer,net,net\nindividuals,a,a\nbodyparts,A,A\ncoords,x,y\n",
        R"({"version":1.3,"people":[]})", R"({"meta_info": {)",
        R"([{"frame_id": 0, "instances": [{"keypoints": [)", R"( {"images": [)"})
    EXPECT_TRUE(begins_keypoints(begin)) << begin;
  for (const char* begin :
       {"", "scorer,net,net,net\nbodyparts,A,A,A\ncoords,x,y,z\n", "frame,time_s,marker,x_m,y_m,z_m\n",
        R"({"SamplingFrequency": 100})", "scorers\n", R"("people")"})
    EXPECT_FALSE(begins_keypoints(begin)) << begin;
}

TEST_F(KeypointsFile, WhatIsWrongIsSaidWithTheFile) {
  EXPECT_THAT(read_keypoints(write("x.json", "{\"a\":\n")).error().message,
              HasSubstr("x.json: line 2: is no JSON"));
  EXPECT_THAT(read_keypoints(write("x.csv", "frame\n")).error().message, HasSubstr("need 'scorer'"));
  EXPECT_THAT(read_keypoints(write("empty", "")).error().message, HasSubstr("ends before a line 'scorer'"));
  EXPECT_EQ(read_keypoints(folder_ / "absent").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
