// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Damaged and hostile documents: one sentence each, in memory that the text explains.
#include <fmt/core.h>
#include <gmock/gmock.h>

#include <string>

#include "kinemark/io/keypoints/keypoints_json.h"
#include "kinemark/io/keypoints/openpose.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kVideo =
    R"({"meta_info":{"keypoint_id2name":{"0":"a","1":"b"}},"instance_info":[{"frame_id":0,"instances":[{"keypoints":[[10,20],[30,40]],"keypoint_scores":[0.9,0.8]}]},{"frame_id":1,"instances":[]}]})";
const std::string kImages =
    R"({"images":[{"id":1},{"id":2}],"categories":[{"id":1,"keypoints":["a","b"]}],"annotations":[{"image_id":2,"category_id":1,"keypoints":[10,20,2,30,40,1]}]})";
const std::string kFrame = R"({"version":1.3,"people":[{"person_id":[-1],"pose_keypoints_2d":[)";

/// Whole frames or one sentence.
void expect_sound(const Result<Keypoints>& read, const std::string& what) {
  if (read) {
    EXPECT_EQ(read->image.size(), 2 * static_cast<std::size_t>(read->frames()) * read->names.size()) << what;
  } else {
    EXPECT_THAT(read.error().message, Not(HasSubstr("\n"))) << what;
    EXPECT_NE(exit_status(read.error().code), 4) << what;
  }
}

TEST(KeypointsHostile, EveryShorterDocumentIsRefused) {
  for (const auto& whole : {kVideo, kImages})
    for (std::size_t n = 0; n < whole.size(); ++n) {
      const auto read = parse_keypoints_json(whole.substr(0, n), "x.json");
      ASSERT_FALSE(read) << n;
      EXPECT_EQ(read.error().code, Code::bad_input) << n;
    }
}

TEST(KeypointsHostile, EveryChangedByteGivesFramesOrASentence) {
  for (const auto& whole : {kVideo, kImages})
    for (std::size_t i = 0; i < whole.size(); ++i)
      for (const char c : {'\0', '"', '[', '}', '9', '-', '\xff'}) {
        auto text = whole;
        text[i] = c;
        expect_sound(parse_keypoints_json(text, "x.json"), fmt::format("{} {}", i, static_cast<int>(c)));
      }
}

TEST(KeypointsHostile, FramesFarApartDoNotTakeMemory) {
  const auto gap = [](const char* last) {
    const auto read = parse_keypoints_json(
        fmt::format(
            R"([{{"frame_id":0,"instances":[{{"keypoints":[[10,20]]}}]}},{{"frame_id":{},"instances":[]}}])",
            last),
        "x.json");
    return read ? "read without complaint" : read.error().message;
  };
  EXPECT_EQ(gap("50000"), "read without complaint");
  EXPECT_THAT(gap("1000000000"), HasSubstr("almost nobody is in them"));
  EXPECT_THAT(gap("1000000001"), HasSubstr("need 0 to 1000000000"));
  EXPECT_THAT(gap("9223372036854775807"), HasSubstr("need 0 to 1000000000"));
  EXPECT_THAT(gap("18446744073709551615"), HasSubstr("need 0 to 1000000000"));
  EXPECT_THAT(gap("-5"), HasSubstr("is frame -5"));
}

TEST(KeypointsHostile, ManyFramesOfNobodyBeforeALargePersonDoNotTakeMemory) {
  std::string text = "[";
  for (int f = 0; f < 20'000; ++f) text += fmt::format(R"({{"frame_id":{},"instances":[]}},)", f);
  text += R"({"frame_id":20000,"instances":[{"keypoints":[)";
  for (int m = 0; m < 1000; ++m) text += fmt::format("{}[5,6]", m == 0 ? "" : ",");
  text += "]}]}]";
  EXPECT_THAT(parse_keypoints_json(text, "x.json").error().message,
              HasSubstr("frame 20000: 20001 frames of 1000 points, but almost nobody"));
}

TEST(KeypointsHostile, AnnotationsOfManyCategoriesEndAtTheSecond) {
  std::string text = R"({"annotations":[)";
  for (int n = 0; n < 50'000; ++n)
    text += fmt::format(R"({}{{"image_id":1,"category_id":{},"keypoints":[]}})", n == 0 ? "" : ",", n);
  EXPECT_EQ(parse_keypoints_json(text + "]}", "x.json").error().code, Code::not_supported);
}

TEST(KeypointsHostile, DeepNestingEndsWhereverItStands) {
  const std::string deep(1'000'000, '[');
  for (const std::string& begin :
       {std::string(R"({"instance_info":)"), std::string(R"({"annotations":[{"keypoints":)"),
        std::string(R"({"meta_info":{"a":)")})
    EXPECT_THAT(parse_keypoints_json(begin + deep, "x.json").error().message,
                HasSubstr("more than 32 levels"));
  OpenPoseFrames frames({});
  EXPECT_THAT(frames.add(0, kFrame + deep).error().message, HasSubstr("more than 32 levels"));
}

TEST(KeypointsHostile, EveryShorterFrameOfOpenPoseIsRefused) {
  std::string whole = kFrame;
  for (int m = 0; m < 15; ++m) whole += fmt::format("{}10,20,0.9", m == 0 ? "" : ",");
  whole += "]}]}";
  for (std::size_t n = 0; n <= whole.size(); ++n) {
    OpenPoseFrames frames({});
    const auto status = frames.add(0, whole.substr(0, n));
    EXPECT_EQ(status.has_value(), n == whole.size()) << n;
  }
}

TEST(KeypointsHostile, NumbersBeyondAnyRangeAreNotSeenOrRefused) {
  const auto of = [](const char* x) {
    return parse_keypoints_json(
        fmt::format(R"([{{"frame_id":0,"instances":[{{"keypoints":[[{},20]],"keypoint_scores":[1]}}]}}])", x),
        "x.json");
  };
  EXPECT_EQ(of("1e300")->at(0, 0).x(), 1e300);
  EXPECT_THAT(of("1e999").error().message, HasSubstr("number that is too large"));
  EXPECT_TRUE(of("NaN")->at(0, 0).array().isNaN().all());
  EXPECT_TRUE(of("null")->at(0, 0).array().isNaN().all());
}

}  // namespace
}  // namespace kinemark::io
