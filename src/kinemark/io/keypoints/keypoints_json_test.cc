// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_json.h"

#include <gmock/gmock.h>

#include <string>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<Keypoints> parse(const std::string& text, const KeypointsOptions& options = {}) {
  return parse_keypoints_json(text, "video.json", options);
}

std::string sentence(const std::string& text, const KeypointsOptions& options = {}) {
  const auto read = parse(text, options);
  return read ? "read without complaint" : read.error().message;
}

const std::string kMeta =
    R"({"meta_info": {"num_keypoints": 2, "keypoint_id2name": {"1": "left_eye", "0": "nose"}},
  "instance_info": )";

TEST(Mmpose, FramesOfAVideo) {
  const auto read = parse(kMeta + R"([
    {"frame_id": 1, "instances": [{"keypoints": [[10.5, 20.25], [30, 40]], "keypoint_scores": [0.9, 0.5], "bbox": [[1, 2, 3, 4]]}]},
    {"frame_id": 2, "instances": []},
    {"frame_id": 4, "instances": [{"keypoints": [[11, 21], [NaN, 41]], "keypoint_scores": [1.4, 0.7]}]}]})");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->names, ElementsAre("nose", "left_eye"));
  ASSERT_EQ(read->frames(), 4);
  EXPECT_EQ(read->at(0, 0), Eigen::Vector2d(10.5, 20.25));
  EXPECT_TRUE(read->at(0, 1).array().isNaN().all()) << "0.5 is less than 0.6";
  EXPECT_TRUE(read->at(1, 0).array().isNaN().all());
  EXPECT_TRUE(read->at(2, 0).array().isNaN().all()) << "frame 3 is absent";
  EXPECT_EQ(read->at(3, 0), Eigen::Vector2d(11.0, 21.0));
  EXPECT_TRUE(read->at(3, 1).array().isNaN().all());
}

TEST(Mmpose, AListAloneHasNoNamesAndMayHaveNoScores) {
  const auto read = parse(R"([{"frame_id": 0, "instances": [{"keypoints": [[10, 20], [30, 40]]}]}])").value();
  EXPECT_THAT(read.names, ElementsAre("keypoint_0", "keypoint_1"));
  EXPECT_EQ(read.at(0, 1), Eigen::Vector2d(30.0, 40.0));
  const auto null =
      parse(R"([{"frame_id": 0, "instances": [{"keypoints": [[10, 20]], "keypoint_scores": null}]}])");
  EXPECT_EQ(null.value().at(0, 0), Eigen::Vector2d(10.0, 20.0));
}

TEST(Mmpose, PeopleAreChosenByTrackOrPlace) {
  const auto two = [](const std::string& first, const std::string& second) {
    return R"([{"frame_id": 0, "instances": [{)" + first + R"("keypoints": [[10, 20]]}, {)" + second +
           R"("keypoints": [[30, 40]]}]}])";
  };
  EXPECT_EQ(sentence(two("", "")), "video.json: frame 0: shows 2 people; choose one with --person");
  EXPECT_EQ(parse(two("", ""), {.person = 2})->at(0, 0).x(), 30.0);
  EXPECT_EQ(parse(two(R"("track_id": 5, )", R"("track_id": 1, )"), {.person = 5})->at(0, 0).x(), 10.0);
  EXPECT_EQ(parse(two(R"("instance_id": 5, )", R"("instance_id": 0, )"), {.person = 0})->at(0, 0).x(), 30.0);
  EXPECT_EQ(sentence(two("", ""), {.person = 3}), "video.json: 1 frames, but none shows person 3");
}

TEST(Mmpose, WhatMakesNoSenseIsNamedWithItsFrame) {
  const auto one = [](const std::string& instance) {
    return sentence(R"([{"frame_id": 6, "instances": [)" + instance + "]}]");
  };
  EXPECT_EQ(one("{}"), "video.json: frame 6: person 1: has no keypoints");
  EXPECT_THAT(one("3"), HasSubstr("frame 6: person 1: has no keypoints"));
  EXPECT_THAT(one(R"({"keypoints": 3})"), HasSubstr("or no list"));
  EXPECT_THAT(one(R"({"keypoints": [[1, 2]], "keypoint_scores": [1, 1]})"), HasSubstr("not as many as"));
  EXPECT_THAT(one(R"({"keypoints": [[1, 2]], "keypoint_scores": ["1"]})"), HasSubstr("not as many as"));
  EXPECT_THAT(one(R"({"keypoints": [[1, 2], [3]]})"), HasSubstr("its keypoint 1 is not two numbers"));
  EXPECT_THAT(one(R"({"keypoints": [[1, "2"]]})"), HasSubstr("its keypoint 0 is not two numbers"));
  EXPECT_THAT(one(R"({"keypoints": [[1, 2, 3]]})"), HasSubstr("points in three dimensions; need pixels"));
  EXPECT_THAT(one(R"({"keypoints": []})"), HasSubstr("its person has no points"));
  EXPECT_THAT(sentence(kMeta + R"([{"instances": []}]})"), HasSubstr("no list of frames"));
  EXPECT_THAT(sentence(kMeta + R"([{"frame_id": 1}]})"), HasSubstr("no list of frames"));
  EXPECT_THAT(sentence(kMeta + R"([{"frame_id": 1.5, "instances": []}]})"), HasSubstr("no list of frames"));
  EXPECT_THAT(sentence(kMeta + R"([{"keypoints": [[1, 2]]}]})"), HasSubstr("no list of frames"));
  EXPECT_THAT(sentence(kMeta + R"([{"frame_id": 1, "instances": []}, {"frame_id": 1, "instances": []}]})"),
              HasSubstr("frame 1: comes after frame 1"));
  EXPECT_THAT(sentence(kMeta + R"([{"frame_id": 1, "instances": [{"keypoints": [[1, 2]]}]}]})"),
              HasSubstr("names 2 points; a person has 1"));
}

/// Three images, of a person with two points in the first and the last.
std::string coco(const std::string& first, const std::string& second, const std::string& more = "") {
  return R"({"info": {"year": 2026}, "annotations": [
    {"id": 1, "image_id": 30, "category_id": 1, "bbox": [1, 2, 3, 4], "keypoints": )" +
         second + R"(},
    {"id": 2, "image_id": 20, "category_id": 1, "keypoints": )" +
         first + "}" + more + R"(],
    "images": [{"id": 20, "file_name": "a.png"}, {"id": 25, "file_name": "b.png"}, {"id": 30, "file_name": "c.png"}],
    "categories": [{"id": 1, "name": "person", "keypoints": ["nose", "left_eye"], "skeleton": [[1, 2]]}, {"id": 2, "name": "car"}]})";
}

TEST(Coco, ImagesAreFramesInTheirOrder) {
  const auto read = parse(coco("[10, 20, 2, 30, 40, 1]", "[0, 0, 0, 31, 41, 2]"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->names, ElementsAre("nose", "left_eye"));
  ASSERT_EQ(read->frames(), 3);
  EXPECT_EQ(read->at(0, 0), Eigen::Vector2d(10.0, 20.0));
  EXPECT_EQ(read->at(0, 1), Eigen::Vector2d(30.0, 40.0)) << "1 is labelled, though hidden";
  EXPECT_TRUE(read->at(1, 0).array().isNaN().all()) << "an image of nobody";
  EXPECT_TRUE(read->at(2, 0).array().isNaN().all()) << "0 is not labelled";
  EXPECT_EQ(read->at(2, 1), Eigen::Vector2d(31.0, 41.0));
}

TEST(Coco, AScoreInPlaceOfVisibilityIsALikelihood) {
  const auto read = parse(coco("[10, 20, 0.59, 30, 40, 0.61]", "[1, 2, 1, 3, 4, 1]")).value();
  EXPECT_TRUE(read.at(0, 0).array().isNaN().all());
  EXPECT_EQ(read.at(0, 1), Eigen::Vector2d(30.0, 40.0));
}

TEST(Coco, BoxesAndOutlinesAreNoPoints) {
  const auto read = parse(coco("[10, 20, 2, 30, 40, 2]", "[1, 2, 1, 3, 4, 1]",
                               R"(, {"id": 3, "image_id": 25, "category_id": 2, "bbox": [0, 0, 1, 1]})"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames(), 3);
}

TEST(Coco, PeopleAreChosenByTrackOrPlace) {
  const auto two = [](const std::string& track) {
    return coco("[10, 20, 2, 30, 40, 2]", "[1, 2, 2, 3, 4, 2]",
                R"(, {"id": 3, "image_id": 20, "category_id": 1, )" + track +
                    R"("keypoints": [50, 60, 2, 70, 80, 2]})");
  };
  EXPECT_EQ(sentence(two("")), "video.json: image 20: shows 2 people; choose one with --person");
  EXPECT_EQ(parse(two(""), {.person = 2})->at(0, 0).x(), 50.0);
  EXPECT_EQ(parse(two(R"("track_id": 9, )"), {.person = 9})->at(0, 0).x(), 50.0);
  EXPECT_EQ(parse(two(R"("attributes": {"track_id": 4}, )"), {.person = 4})->at(0, 0).x(), 50.0);
}

TEST(Coco, WhatMakesNoSenseIsRefused) {
  const std::string good = "[10, 20, 2, 30, 40, 2]";
  EXPECT_THAT(sentence(coco(good, "[1, 2]")),
              HasSubstr("image 30: keypoints are no list of x, y and visibility"));
  EXPECT_THAT(sentence(coco(good, "\"12\"")), HasSubstr("image 30: keypoints are no list"));
  EXPECT_THAT(sentence(coco(good, "[1, 2, 2]")), HasSubstr("image 30: shows a person of 1 points"));
  EXPECT_THAT(sentence(coco(good, good, R"(, {"image_id": 99, "category_id": 1, "keypoints": [1, 2, 2]})")),
              HasSubstr("of image 99, which is not there"));
  EXPECT_THAT(sentence(coco(good, good, R"(, {"image_id": 20, "category_id": 2, "keypoints": [1, 2, 2]})")),
              HasSubstr("image 20: shows points of categories 1 and 2"));
  EXPECT_THAT(sentence(coco(good, good, R"(, {"image_id": 20})")),
              HasSubstr("no image_id or no category_id"));
  EXPECT_THAT(
      sentence(
          R"({"images": [{"id": 1}, {"id": 1}], "annotations": [{"image_id": 1, "category_id": 1, "keypoints": [5, 5, 2]}],
                           "categories": [{"id": 1, "keypoints": ["a"]}]})"),
      HasSubstr("image 1 occurs twice"));
  EXPECT_THAT(sentence(R"({"images": [{"name": 1}]})"), HasSubstr("image 1 has no id"));
  EXPECT_THAT(sentence(R"({"images": [{"id": 1}], "annotations": []})"),
              HasSubstr("no annotations with keypoints"));
  EXPECT_THAT(
      sentence(
          R"({"images": [{"id": 1}], "annotations": [{"image_id": 1, "category_id": 1, "keypoints": [5, 5, 2]}]})"),
      HasSubstr("category 1 has no names of keypoints"));
  EXPECT_THAT(sentence(R"({"categories": [{"id": 1, "keypoints": ["a"]}, {"id": 1, "keypoints": ["a"]}]})"),
              HasSubstr("category 1 occurs twice"));
  EXPECT_THAT(sentence(R"({"categories": [{"id": 1, "keypoints": [1]}]})"), HasSubstr("no list of names"));
  EXPECT_THAT(sentence(R"({"categories": [{"keypoints": ["a"]}]})"), HasSubstr("a category has no id"));
}

TEST(KeypointsJson, ADocumentOfSomethingElseIsRefused) {
  for (const char* other : {"{}", "[]", "[1, 2]", "3", R"({"a": [1]})",
                            R"([{"image_id": 1, "keypoints": [1, 2, 3]}])", R"({"instance_info": []})"})
    EXPECT_THAT(sentence(other), HasSubstr("video.json: holds no points: need JSON of MMPose")) << other;
  EXPECT_EQ(sentence("{\"images\":\n[{]"), "video.json: line 2: is no JSON");
}

TEST(KeypointsJson, OptionsThatCannotBeAreUsage) {
  EXPECT_EQ(parse("{}", {.min_likelihood = 1.5, .person = {}}).error().code, Code::usage);
  EXPECT_EQ(parse("{}", {.person = -1}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::io
