// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/image_files.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "kinemark/io/file.h"
#include "kinemark/io/rig/rig_file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr TimeBase kTwoFrames{.rate_hz = 50.0, .t0_s = 1.0, .frames = 2};

/// A rig of two pinhole cameras and a detector, and a file of points for each of two.
class ReadImages : public ::testing::Test {
 protected:
  ReadImages() {
    data::Rig rig;
    for (const char* name : {"left", "right", "sheet"}) {
      data::Camera camera;
      camera.name = name;
      camera.kind =
          std::string(name) == "sheet" ? data::CameraKind::lateral_effect : data::CameraKind::pinhole;
      camera.focal = 900.0;
      rig.cameras.push_back(camera);
    }
    EXPECT_TRUE(io::write_rig(folder_ / "rig.toml", rig, false));
    write("l.csv",
          "scorer,n,n,n,n,n,n\nbodyparts,A,A,A,B,B,B\ncoords,x,y,likelihood,x,y,likelihood\n"
          "0,1,2,0.9,3,4,0.9\n1,5,6,0.5,7,8,0.9\n");
    write("r.csv", "scorer,n,n,n,n\nbodyparts,C,C,A,A\ncoords,x,y,x,y\n0,10,20,30,40\n1,50,60,70,80\n");
    files_.rig = folder_ / "rig.toml";
    files_.cameras = {{"right", folder_ / "r.csv"}, {"left", folder_ / "l.csv"}};
    files_.noise_sd_px = 0.7;
  }
  void write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(io::write_text(folder_ / name, text, true));
  }
  std::string sentence() const {
    const auto read = read_images(files_, kTwoFrames);
    return read ? "read without complaint" : read.error().message;
  }
  testing_support::ScratchFolder folder_;
  ImageFiles files_;
};

TEST_F(ReadImages, PutsEveryPointToItsCameraAndName) {
  const auto tracks = read_images(files_, kTwoFrames);
  ASSERT_TRUE(tracks) << tracks.error().message;
  EXPECT_TRUE(tracks->validate());
  EXPECT_THAT(tracks->names, ElementsAre("C", "A", "B"));
  EXPECT_THAT(tracks->noise_sd, ElementsAre(0.7, 0.7));
  EXPECT_EQ(tracks->cameras.at(0).name, "right");
  EXPECT_EQ(tracks->time, kTwoFrames);
  EXPECT_EQ(tracks->at(1, 0, 0), Eigen::Vector2d(50.0, 60.0));
  EXPECT_EQ(tracks->at(0, 0, 1), Eigen::Vector2d(30.0, 40.0));
  EXPECT_EQ(tracks->at(0, 1, 1), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(tracks->at(1, 1, 2), Eigen::Vector2d(7.0, 8.0));
  EXPECT_TRUE(tracks->at(1, 1, 1).array().isNaN().all()) << "unlikely";
  EXPECT_TRUE(tracks->at(0, 1, 0).array().isNaN().all()) << "a point that the left file does not have";
  EXPECT_TRUE(tracks->at(0, 0, 2).array().isNaN().all());
  files_.min_likelihood = 0.5;
  EXPECT_EQ(read_images(files_, kTwoFrames)->at(1, 1, 1), Eigen::Vector2d(5.0, 6.0));
}

TEST_F(ReadImages, SaysWhichCameraItCannotUse) {
  files_.cameras[0].camera = "middle";
  EXPECT_THAT(sentence(), HasSubstr("rig.toml: has no camera 'middle'; it has left, right, sheet"));
  files_.cameras[0].camera = "sheet";
  EXPECT_THAT(sentence(), HasSubstr("camera 'sheet' is lateral-effect"));
}

TEST_F(ReadImages, FilesHaveTheFramesOfTheMarkers) {
  write("l.csv", "scorer,n,n\nbodyparts,A,A\ncoords,x,y\n0,1,2\n");
  EXPECT_THAT(sentence(), HasSubstr("l.csv: has 1 frames; the markers have 2"));
  write("l.csv", "scorer,n,n\nbodyparts,A,A\ncoords,x,y\n0,1,2\n1,3,none\n");
  EXPECT_THAT(sentence(), HasSubstr("l.csv: line 5: column 3 is 'none'"));
  files_.cameras[1].points = folder_ / "absent.csv";
  EXPECT_EQ(read_images(files_, kTwoFrames).error().code, Code::io);
}

TEST_F(ReadImages, ReadsDocumentsOfJsonAndChoosesThePerson) {
  write("l.json",
        R"([{"frame_id": 0, "instances": [{"keypoints": [[10, 20]]}, {"keypoints": [[30, 40]]}]},
            {"frame_id": 1, "instances": [{"keypoints": [[11, 21]]}]}])");
  files_.cameras = {{"left", folder_ / "l.json"}};
  EXPECT_THAT(sentence(), HasSubstr("l.json: frame 0: shows 2 people; choose one with --person"));
  files_.person = 2;
  const auto tracks = read_images(files_, kTwoFrames);
  ASSERT_TRUE(tracks) << tracks.error().message;
  EXPECT_THAT(tracks->names, ElementsAre("keypoint_0"));
  EXPECT_EQ(tracks->at(0, 0, 0), Eigen::Vector2d(30.0, 40.0));
  EXPECT_TRUE(tracks->at(1, 0, 0).array().isNaN().all()) << "frame 1 shows one person";
  files_.person = -1;
  EXPECT_EQ(files_.check().error().code, Code::usage);
}

TEST_F(ReadImages, AskedForWhatCannotBeIsUsage) {
  EXPECT_TRUE(ImageFiles{}.check()) << "no images is nothing wrong";
  const auto refused = [](const ImageFiles& files) {
    const auto status = files.check();
    return status ? "accepted" : status.error().message;
  };
  auto files = files_;
  files.cameras.clear();
  EXPECT_THAT(refused(files), HasSubstr("give --images CAMERA=FILE"));
  files = files_;
  files.rig.clear();
  EXPECT_THAT(refused(files), HasSubstr("give --rig"));
  files = files_;
  files.cameras.push_back(files.cameras.front());
  EXPECT_THAT(refused(files), HasSubstr("camera 'right' has two files"));
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    files = files_;
    files.noise_sd_px = bad;
    EXPECT_THAT(refused(files), HasSubstr("it must be more than 0")) << bad;
  }
  files = files_;
  files.min_likelihood = 2.0;
  EXPECT_EQ(files.check().error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline
