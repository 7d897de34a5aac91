// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/openpose.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

/// A list of triples: x of point m is begin + m, y is 2 x, the score is the same for all.
std::string triples(std::size_t points, double begin, double score = 0.9) {
  std::string out = "[";
  for (std::size_t m = 0; m < points; ++m) {
    const double x = begin + static_cast<double>(m);
    out += fmt::format("{}{},{},{}", m == 0 ? "" : ",", x, 2.0 * x, score);
  }
  return out + "]";
}

std::string person(double begin, const std::string& number = "-1", const std::string& more = "") {
  return fmt::format(R"({{"person_id":[{}],"pose_keypoints_2d":{}{},"pose_keypoints_3d":[]}})", number,
                     triples(25, begin), more);
}

std::string frame(const std::string& people) { return R"({"version":1.3,"people":[)" + people + "]}\n"; }

/// What add() or finish() says of these frames.
std::string refusal(const std::vector<std::string>& texts, const KeypointsOptions& options = {}) {
  OpenPoseFrames frames(options);
  for (std::size_t f = 0; f < texts.size(); ++f)
    if (auto s = frames.add(static_cast<std::int64_t>(f), texts[f]); !s) return s.error().message;
  const auto points = frames.finish();
  return points ? "read without complaint" : points.error().message;
}

TEST(OpenPose, BodyPointsByTheirNames) {
  OpenPoseFrames frames({});
  ASSERT_TRUE(frames.add(0, frame(person(100.0))));
  ASSERT_TRUE(frames.add(1, frame("")));
  ASSERT_TRUE(frames.add(2, frame(person(200.5))));
  const auto points = frames.finish().value();
  ASSERT_EQ(points.frames(), 3);
  ASSERT_EQ(points.names.size(), 25U);
  EXPECT_EQ(points.names[0], "Nose");
  EXPECT_EQ(points.names[8], "MidHip");
  EXPECT_EQ(points.names[11], "RAnkle");
  EXPECT_EQ(points.names[24], "RHeel");
  EXPECT_EQ(points.at(0, 3), Eigen::Vector2d(103.0, 206.0));
  EXPECT_EQ(points.at(2, 24), Eigen::Vector2d(224.5, 449.0));
  for (std::size_t m = 0; m < 25; ++m) EXPECT_TRUE(points.at(1, m).array().isNaN().all()) << m;
}

TEST(OpenPose, NothingFoundIsMissingNotZero) {
  OpenPoseFrames frames({.min_likelihood = 0.0, .person = {}});
  ASSERT_TRUE(frames.add(0, frame(R"({"pose_keypoints_2d":[5,6,0.5,0,0,0)" + [] {
                           std::string rest;
                           for (int m = 2; m < 15; ++m) rest += ",7,8,0.9";
                           return rest;
                         }() + "]}")));
  const auto points = frames.finish().value();
  EXPECT_EQ(points.names[14], "Chest") << "15 points are MPI";
  EXPECT_EQ(points.at(0, 0), Eigen::Vector2d(5.0, 6.0));
  EXPECT_TRUE(points.at(0, 1).array().isNaN().all());
}

TEST(OpenPose, HandsAndFaceFollowTheBody) {
  const std::string more =
      fmt::format(R"(,"face_keypoints_2d":{},"hand_right_keypoints_2d":{},"hand_left_keypoints_2d":{})",
                  triples(70, 3000.0), triples(21, 2000.0), triples(21, 1000.0));
  OpenPoseFrames frames({});
  ASSERT_TRUE(frames.add(0, frame(person(10.0, "-1", more))));
  const auto points = frames.finish().value();
  ASSERT_EQ(points.names.size(), 25U + 21U + 21U + 70U);
  EXPECT_EQ(points.names[25], "LHand0");
  EXPECT_EQ(points.names[66], "RHand20");
  EXPECT_EQ(points.names[136], "Face69");
  EXPECT_EQ(points.at(0, 25).x(), 1000.0);
  EXPECT_EQ(points.at(0, 66).x(), 2020.0);
  EXPECT_EQ(points.at(0, 136).x(), 3069.0);
}

TEST(OpenPose, PeopleAreChosenByTheirNumberWhereTheyHaveOne) {
  const auto both = [](const char* first, const char* second) {
    return frame(person(100.0, first) + "," + person(200.0, second));
  };
  EXPECT_EQ(refusal({both("-1", "-1")}), "shows 2 people; choose one with --person");
  OpenPoseFrames by_place({.person = 2});
  ASSERT_TRUE(by_place.add(0, both("-1", "-1")));
  EXPECT_EQ(by_place.finish()->at(0, 0).x(), 200.0);
  OpenPoseFrames by_number({.person = 7});
  ASSERT_TRUE(by_number.add(0, both("7", "2")));
  ASSERT_TRUE(by_number.add(1, both("2", "7")));
  const auto points = by_number.finish().value();
  EXPECT_EQ(points.at(0, 0).x(), 100.0);
  EXPECT_EQ(points.at(1, 0).x(), 200.0);
}

TEST(OpenPose, WhatIsNoFrameIsRefused) {
  EXPECT_THAT(refusal({""}), HasSubstr("is no frame of OpenPose"));
  EXPECT_THAT(refusal({R"({"instances": []})"}), HasSubstr("is no frame of OpenPose"));
  EXPECT_THAT(refusal({R"({"people": [)"}), HasSubstr("line 1: is no JSON"));
  EXPECT_THAT(refusal({frame("7")}), HasSubstr("person 1: is no object"));
  EXPECT_THAT(refusal({frame("{}")}), HasSubstr("person 1: has no pose_keypoints_2d"));
  EXPECT_THAT(refusal({frame(R"({"pose_keypoints_2d":[1,2]})")}),
              HasSubstr("is no list of x, y and confidence"));
  EXPECT_THAT(refusal({frame(R"({"pose_keypoints_2d":["1",2,3]})")}), HasSubstr("is no list of x, y"));
  EXPECT_THAT(refusal({frame(R"({"pose_keypoints_2d":{"a":1}})")}), HasSubstr("is no list of x, y"));
  EXPECT_THAT(refusal({frame(R"({"pose_keypoints_2d":[],"pose_keypoints_3d":[1,2,3,1]})")}),
              HasSubstr("pose_keypoints_3d alone, points in three dimensions"));
  EXPECT_THAT(refusal({frame(R"({"pose_keypoints_2d":[9,2,1,3,4,1]})")}),
              HasSubstr("people have points of body 2;"));
  EXPECT_THAT(refusal({frame(person(10.0)), frame(R"({"pose_keypoints_2d":)" + triples(18, 1.0) + "}")}),
              HasSubstr("person 1 has points of body 18; those before have body 25"));
  EXPECT_THAT(refusal({frame("")}), HasSubstr("1 frames, but none shows anybody"));
  EXPECT_THAT(refusal({frame(person(10.0))}, {.min_likelihood = 2.0, .person = {}}),
              HasSubstr("likelihood is 2"));
  EXPECT_EQ(refusal({frame(R"({"pose_keypoints_2d":)" + triples(18, 10.0) + "}")}), "read without complaint");
}

class OpenPoseFolder : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_text(folder_ / name, text, true));
  }
  std::string sentence_of(const std::filesystem::path& path) const {
    const auto points = read_openpose(path);
    return points ? "read without complaint" : points.error().message;
  }
  testing_support::ScratchFolder folder_;
};

TEST_F(OpenPoseFolder, AFolderOrAnyOfItsFilesIsTheVideo) {
  write("walk_000000000009_keypoints.json", frame(person(9.0)));
  write("walk_000000000010_keypoints.json", frame(person(10.0)));
  write("walk_000000000012_keypoints.json", frame(person(12.0)));
  write("notes.txt", "not a frame");
  for (const auto& path : {folder_ / "", folder_ / "walk_000000000010_keypoints.json"}) {
    const auto points = read_openpose(path);
    ASSERT_TRUE(points) << points.error().message;
    ASSERT_EQ(points->frames(), 4) << "9 to 12";
    EXPECT_EQ(points->at(0, 0).x(), 9.0);
    EXPECT_EQ(points->at(1, 0).x(), 10.0);
    EXPECT_TRUE(std::isnan(points->at(2, 0).x())) << "11 is absent";
    EXPECT_EQ(points->at(3, 0).x(), 12.0);
  }
  const auto files = openpose_files(folder_ / "").value();
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[2].number, 12);
}

TEST_F(OpenPoseFolder, TwoVideosAreKeptApart) {
  write("a_1_keypoints.json", frame(person(1.0)));
  write("b_1_keypoints.json", frame(person(2.0)));
  EXPECT_THAT(sentence_of(folder_ / ""), HasSubstr("holds frames of 'a_' and of 'b_'; give one file"));
  EXPECT_EQ(read_openpose(folder_ / "b_1_keypoints.json")->at(0, 0).x(), 2.0);
}

TEST_F(OpenPoseFolder, WhatIsWrongIsSaidWithItsFile) {
  EXPECT_THAT(sentence_of(folder_ / ""), HasSubstr("holds no frames of OpenPose"));
  write("frame.json", frame(person(1.0)));
  EXPECT_THAT(sentence_of(folder_ / "frame.json"), HasSubstr("is not called as a frame of OpenPose is"));
  write("x_keypoints.json", frame(person(1.0)));
  EXPECT_THAT(sentence_of(folder_ / "x_keypoints.json"), HasSubstr("is not called as a frame"));
  write("v_1_keypoints.json", frame(person(1.0)));
  write("v_01_keypoints.json", frame(person(1.0)));
  EXPECT_THAT(sentence_of(folder_ / ""), HasSubstr("v_1_keypoints.json: comes after frame 1"));
  std::filesystem::remove(folder_ / "v_01_keypoints.json");
  write("v_2_keypoints.json", "{\"people\":[\n{]}");
  EXPECT_THAT(sentence_of(folder_ / ""), HasSubstr("v_2_keypoints.json: line 2: is no JSON"));
  std::filesystem::remove(folder_ / "v_2_keypoints.json");
  write("v_99999999999999999999_keypoints.json", frame(person(1.0)));
  EXPECT_EQ(sentence_of(folder_ / ""), "read without complaint") << "no number of a frame";
  write("v_999999999_keypoints.json", frame(person(1.0)));
  EXPECT_THAT(sentence_of(folder_ / ""), HasSubstr("almost nobody is in them"));
  EXPECT_EQ(read_openpose(folder_ / "absent" / "v_1_keypoints.json").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
