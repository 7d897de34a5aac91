// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/point_frames.h"

#include <gmock/gmock.h>

#include <limits>

#include "kinemark/core/missing.h"

namespace kinemark::io::internal {
namespace {

using ::testing::HasSubstr;

using People = std::vector<Person>;

constexpr std::size_t kBytes = 1000;

Person person(double x, std::optional<std::int64_t> number = {}, double score = 0.9) {
  return {.number = number, .values = {x, 2.0 * x, score}};
}

std::string sentence(const Status& status) { return status ? "no complaint" : status.error().message; }

/// x of the only point in each frame.
std::vector<double> xs(PointFrames& frames) {
  const auto points = frames.finish({"A"});
  std::vector<double> out;
  if (!points) {
    ADD_FAILURE() << points.error().message;
    return out;
  }
  for (std::int64_t f = 0; f < points->frames(); ++f) out.push_back(points->at(f, 0).x());
  return out;
}

TEST(PointFrames, FramesThatAreLeftOutAndEmptyOnesShowNobody) {
  PointFrames frames({});
  ASSERT_TRUE(frames.add(7, {}, kBytes));
  ASSERT_TRUE(frames.add(8, People{person(10.0)}, kBytes));
  ASSERT_TRUE(frames.add(11, People{person(11.0)}, kBytes));
  ASSERT_TRUE(frames.add(12, {}, kBytes));
  const auto read = xs(frames);
  ASSERT_EQ(read.size(), 6U) << "frames 7 to 12";
  EXPECT_EQ(read[1], 10.0);
  EXPECT_EQ(read[4], 11.0);
  for (const std::size_t f : {0U, 2U, 3U, 5U}) EXPECT_TRUE(std::isnan(read[f])) << f;
}

TEST(PointFrames, AScoreOfZeroIsNeverSeenNorWhatIsNoNumber) {
  PointFrames frames({.min_likelihood = 0.0, .person = {}});
  const double inf = std::numeric_limits<double>::infinity();
  const Person zero{.values = {0.0, 0.0, 0.0,  5.0, 6.0, 0.01, kNaN, 1.0, 1.0, 1.0, kNaN, 1.0,
                               2.0, 3.0, kNaN, 3.0, inf, 1.0,  3.0,  4.0, inf, 9.0, 9.0,  -0.5}};
  ASSERT_TRUE(frames.add(0, People{zero}, kBytes));
  const auto points = frames.finish({"A", "B", "C", "D", "E", "F", "G", "H"}).value();
  EXPECT_EQ(points.at(0, 1), Eigen::Vector2d(5.0, 6.0));
  for (const std::size_t m : {0U, 2U, 3U, 4U, 5U, 6U, 7U})
    EXPECT_TRUE(points.at(0, m).array().isNaN().all()) << m;
}

TEST(PointFrames, TheBoundItselfIsLikelyEnough) {
  PointFrames frames({.min_likelihood = 0.5, .person = {}});
  ASSERT_TRUE(frames.add(0, People{person(3.0, {}, 0.5)}, kBytes));
  ASSERT_TRUE(frames.add(1, People{person(4.0, {}, 0.499)}, kBytes));
  ASSERT_TRUE(frames.add(2, People{person(5.0, {}, 1.2)}, kBytes)) << "scores of RTMPose pass 1";
  const auto read = xs(frames);
  EXPECT_EQ(read[0], 3.0);
  EXPECT_TRUE(std::isnan(read[1]));
  EXPECT_EQ(read[2], 5.0);
}

TEST(PointFrames, SeveralPeopleNeedAChoice) {
  PointFrames frames({});
  const auto status = frames.add(0, People{person(10.0), person(20.0)}, kBytes);
  EXPECT_EQ(status.error().code, Code::not_supported);
  EXPECT_EQ(status.error().message, "shows 2 people; choose one with --person");
}

TEST(PointFrames, WithoutNumbersThePlaceInTheFrameChooses) {
  PointFrames frames({.person = 2});
  ASSERT_TRUE(frames.add(0, People{person(10.0), person(20.0)}, kBytes));
  ASSERT_TRUE(frames.add(1, People{person(11.0)}, kBytes));
  const auto read = xs(frames);
  EXPECT_EQ(read[0], 20.0);
  EXPECT_TRUE(std::isnan(read[1]));
}

TEST(PointFrames, NumbersOfTheFileChooseWhereverThePersonStands) {
  PointFrames frames({.person = 0});
  ASSERT_TRUE(frames.add(0, People{person(10.0, 4), person(20.0, 0)}, kBytes));
  ASSERT_TRUE(frames.add(1, People{person(21.0, 0), person(11.0, 4)}, kBytes));
  ASSERT_TRUE(frames.add(2, People{person(12.0, 4)}, kBytes));
  EXPECT_THAT(sentence(frames.add(3, People{person(1.0, 0), person(2.0, 0)}, kBytes)),
              HasSubstr("shows person 0 twice"));
  PointFrames whole({.person = 0});
  ASSERT_TRUE(whole.add(0, People{person(10.0, 4), person(20.0, 0)}, kBytes));
  ASSERT_TRUE(whole.add(1, People{person(21.0, 0), person(11.0, 4)}, kBytes));
  EXPECT_THAT(xs(whole), ::testing::ElementsAre(20.0, 21.0));
}

TEST(PointFrames, APersonWhoIsNowhereIsRefused) {
  for (const std::int64_t absent : {0, 3}) {
    PointFrames frames({.person = absent});
    ASSERT_TRUE(frames.add(0, People{person(10.0), person(20.0)}, kBytes));
    EXPECT_EQ(frames.finish({"A"}).error().message,
              "1 frames, but none shows person " + std::to_string(absent));
  }
  PointFrames nobody({});
  ASSERT_TRUE(nobody.add(0, {}, kBytes));
  ASSERT_TRUE(nobody.add(1, {}, kBytes));
  EXPECT_EQ(nobody.finish({}).error().message, "2 frames, but none shows anybody");
  EXPECT_EQ(PointFrames({}).finish({}).error().message, "has no frames");
}

TEST(PointFrames, FramesRiseAndLieInRange) {
  PointFrames frames({});
  ASSERT_TRUE(frames.add(5, People{person(10.0)}, kBytes));
  EXPECT_THAT(sentence(frames.add(5, {}, kBytes)), HasSubstr("comes after frame 5"));
  EXPECT_THAT(sentence(frames.add(4, {}, kBytes)), HasSubstr("comes after frame 5"));
  EXPECT_THAT(sentence(frames.add(-1, {}, kBytes)), HasSubstr("is frame -1"));
  EXPECT_THAT(sentence(frames.add(std::numeric_limits<std::int64_t>::max(), {}, kBytes)),
              HasSubstr("need 0 to"));
}

TEST(PointFrames, AFewBytesDoNotMakeManyValues) {
  PointFrames frames({});
  ASSERT_TRUE(frames.add(0, People{person(10.0)}, 100));
  EXPECT_THAT(sentence(frames.add(900'000'000, People{person(11.0)}, 100)),
              HasSubstr("900000001 frames of 1 points, but almost nobody is in them"));
  PointFrames many({});
  const Person crowd{.values = std::vector<double>(3 * 1001, 1.0)};
  EXPECT_THAT(sentence(many.add(0, People{crowd}, 10'000)), HasSubstr("at most 1000"));
}

TEST(PointFrames, PeopleAndNamesHaveTheSamePoints) {
  PointFrames frames({});
  ASSERT_TRUE(frames.add(0, People{person(10.0)}, kBytes));
  EXPECT_THAT(sentence(frames.add(1, People{{.values = {1.0, 2.0, 1.0, 3.0, 4.0, 1.0}}}, kBytes)),
              HasSubstr("shows a person of 2 points; the one before has 1"));
  EXPECT_EQ(frames.finish({"A", "B"}).error().message, "names 2 points; a person has 1");
  EXPECT_EQ(frames.finish({" "}).error().message, "one of its points has no name");
  PointFrames pair({});
  ASSERT_TRUE(pair.add(0, People{{.values = {10.0, 2.0, 1.0, 3.0, 4.0, 1.0}}}, kBytes));
  EXPECT_EQ(pair.finish({"A", " A"}).error().message, "point 'A' occurs twice");
}

TEST(PointFrames, SharesOfTheImageAreNoPixels) {
  PointFrames shares({});
  ASSERT_TRUE(shares.add(0, People{person(0.5)}, kBytes));
  EXPECT_THAT(shares.finish({"A"}).error().message, HasSubstr("between -1 and 1; need pixels"));
  PointFrames one_beyond({});
  ASSERT_TRUE(one_beyond.add(0, People{person(0.5)}, kBytes));
  ASSERT_TRUE(one_beyond.add(1, People{person(1.5)}, kBytes));
  EXPECT_TRUE(one_beyond.finish({"A"}));
  PointFrames unseen({});
  ASSERT_TRUE(unseen.add(0, People{person(0.5, {}, 0.1)}, kBytes));
  EXPECT_TRUE(unseen.finish({"A"})) << "nothing is seen, as in a CSV where nothing is likely";
}

}  // namespace
}  // namespace kinemark::io::internal
