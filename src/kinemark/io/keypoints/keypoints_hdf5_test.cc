// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_hdf5.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/keypoints/keypoints_file.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path file(const char* name) { return std::filesystem::path(KINEMARK_TESTDATA) / name; }

TEST(KeypointsHdf5, AFileOfEitherProgramIsWhatItsCsvWouldBe) {
  std::string csv =
      "scorer,n,n,n,n,n,n\nbodyparts,wrist,wrist,wrist,ellbogen_\u00fc,ellbogen_\u00fc,ellbogen_\u00fc\n"
      "coords,x,y,likelihood,x,y,likelihood\n"
      "0,0,0.5,0.9,10,10.5,0.9\n1,1,1.5,0.9,11,11.5,0.3\n2,,,,12,12.5,0.9\n3,3,3.5,0.9,13,13.5,0.9\n";
  const auto want = parse_keypoints_csv(csv, "x.csv").value();
  for (const char* name : {"dlc_table.h5", "dlc_fixed.h5", "sleap_one.h5"}) {
    const auto got = read_keypoints(file(name));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->names, want.names);
    ASSERT_EQ(got->image.size(), want.image.size());
    for (std::size_t i = 0; i < want.image.size(); ++i)
      EXPECT_TRUE(got->image[i] == want.image[i] || (std::isnan(got->image[i]) && std::isnan(want.image[i])))
          << i;
  }
  const auto all = read_keypoints(file("dlc_table.h5"), {.min_likelihood = 0.2}).value();
  EXPECT_EQ(all.at(1, 1).x(), 11.0) << "a score of 0.3 is enough";
}

TEST(KeypointsHdf5, SeveralPeopleNeedAChoice) {
  for (const char* name : {"dlc_individuals.h5", "sleap_frames_first.h5"}) {
    const auto refused = read_keypoints(file(name));
    EXPECT_EQ(refused.error().code, Code::not_supported);
    EXPECT_THAT(refused.error().message, HasSubstr("shows 2 people; choose one with --person: 1 ('"));
    EXPECT_EQ(read_keypoints(file(name), {.person = 2}).value().at(0, 1).x(), 110.0);
    EXPECT_EQ(read_keypoints(file(name), {.person = 1}).value().at(0, 1).x(), 10.0);
    EXPECT_THAT(read_keypoints(file(name), {.person = 3}).error().message,
                HasSubstr("has no person 3; it has 2"));
    EXPECT_THAT(read_keypoints(file(name), {.person = 0}).error().message, HasSubstr("has no person 0"));
  }
}

PoseTable two_people() {
  return {.frames = 2,
          .people = {"", "b"},
          .points = {"p"},
          .values = {kNaN, kNaN, 1.0, 5.0, 6.0, 0.9, kNaN, kNaN, 1.0, 7.0, 8.0, 0.9}};
}

TEST(KeypointsHdf5, TracksThatAreNeverSeenAreNobody) {
  const auto points = points_of_person(two_people());
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ(points->at(1, 0).x(), 7.0);
  EXPECT_THAT(points->names, ElementsAre("p"));
  auto empty = two_people();
  std::ranges::fill(empty.values, kNaN);
  EXPECT_THAT(points_of_person(empty).error().message, HasSubstr("2 frames, but none shows anybody"));
}

TEST(KeypointsHdf5, AFileThatCannotBeReadIsOneSentence) {
  EXPECT_THAT(read_keypoints(file("sleap_project.slp")).error().message,
              HasSubstr("sleap_project.slp: is a project"));
  auto wrong = two_people();
  wrong.frames = 3;
  EXPECT_THAT(points_of_person(wrong).error().message, HasSubstr("do not fit"));
  EXPECT_FALSE(points_of_person(two_people(), {.min_likelihood = 2.0}));
}

}  // namespace
}  // namespace kinemark::io
