// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/image_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

using ::testing::HasSubstr;

ImageTracks two_cameras() {
  ImageTracks tracks;
  tracks.names = {"A", "B", "C"};
  tracks.cameras.resize(2);
  tracks.cameras[0].name = "left";
  tracks.cameras[1].name = "right";
  tracks.noise_sd = {0.5, 0.4};
  tracks.time = {.rate_hz = 50.0, .frames = 2};
  for (int i = 0; i < 24; ++i) tracks.image.push_back(i);
  return tracks;
}

TEST(ImageTracks, LieFrameByFrameCameraByCamera) {
  const auto tracks = two_cameras();
  EXPECT_TRUE(tracks.validate());
  EXPECT_EQ(tracks.at(0, 0, 0), Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(tracks.at(0, 1, 2), Eigen::Vector2d(10.0, 11.0));
  EXPECT_EQ(tracks.at(1, 0, 1), Eigen::Vector2d(14.0, 15.0));
}

TEST(ImageTracks, SayWhatIsWrong) {
  auto tracks = two_cameras();
  tracks.image.pop_back();
  EXPECT_THAT(tracks.validate().error().message, HasSubstr("23 numbers; need 24"));
  tracks = two_cameras();
  tracks.noise_sd[1] = 0.0;
  EXPECT_THAT(tracks.validate().error().message, HasSubstr("'right'"));
  tracks.noise_sd.pop_back();
  EXPECT_THAT(tracks.validate().error().message, HasSubstr("2 cameras, but noise of 1"));
  tracks = two_cameras();
  tracks.time.rate_hz = -1.0;
  EXPECT_THAT(tracks.validate().error().message, HasSubstr("rate of -1 Hz"));
}

}  // namespace
}  // namespace kinemark::data
