// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/keypoints_csv.h"

#include <gmock/gmock.h>

#include <cmath>

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kHeader =
    "scorer,DLC_net,DLC_net,DLC_net,DLC_net,DLC_net,DLC_net\n"
    "bodyparts,wrist,wrist,wrist,elbow,elbow,elbow\n"
    "coords,x,y,likelihood,x,y,likelihood\n";

Result<Keypoints> parse(const std::string& text, const KeypointsOptions& options = {}) {
  return parse_keypoints_csv(text, "cam.csv", options);
}

std::string sentence(const std::string& text) {
  const auto read = parse(text);
  return read ? "read without complaint" : read.error().message;
}

TEST(KeypointsCsv, PointsOfEveryFrame) {
  const auto read = parse(std::string(kHeader) + "0,10.5,20.25,0.9,30,40,1\n1,11,-21,0.7,31,4.1e1,0.99\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_THAT(read->names, ElementsAre("wrist", "elbow"));
  ASSERT_EQ(read->frames(), 2);
  EXPECT_EQ(read->at(0, 0), Eigen::Vector2d(10.5, 20.25));
  EXPECT_EQ(read->at(0, 1), Eigen::Vector2d(30.0, 40.0));
  EXPECT_EQ(read->at(1, 0), Eigen::Vector2d(11.0, -21.0));
  EXPECT_EQ(read->at(1, 1), Eigen::Vector2d(31.0, 41.0));
}

TEST(KeypointsCsv, WhatIsUnlikelyBlankOrNanIsNotSeen) {
  const auto text = std::string(kHeader) + "0,1,2,0.59,3,4,0.6\n1,,,,5,6,\n2,nan,NaN,0.9,7,8,0\n";
  const auto seen = [](const Keypoints& k, std::int64_t f, std::size_t m) { return k.at(f, m).allFinite(); };
  const auto usual = parse(text).value();
  EXPECT_FALSE(seen(usual, 0, 0));
  EXPECT_TRUE(seen(usual, 0, 1)) << "the bound itself is likely enough";
  for (const std::int64_t f : {1, 2})
    for (const std::size_t m : {0U, 1U}) EXPECT_FALSE(seen(usual, f, m)) << f << ' ' << m;
  const auto all = parse(text, {.min_likelihood = 0.0}).value();
  EXPECT_TRUE(seen(all, 0, 0));
  EXPECT_TRUE(seen(all, 2, 1));
  EXPECT_FALSE(seen(all, 1, 1)) << "a blank likelihood says that nobody looked";
  EXPECT_FALSE(seen(all, 2, 0));
}

TEST(KeypointsCsv, PointsMayComeWithoutLikelihoodAndInAnyOrderOfColumns) {
  const auto read =
      parse("scorer,a,a,a,a\r\nbodyparts,P,Q,P,Q\r\ncoords,y,x,x,y\r\n0,1,2,3,4\r\n\r\n").value();
  EXPECT_EQ(read.at(0, 0), Eigen::Vector2d(3.0, 1.0));
  EXPECT_EQ(read.at(0, 1), Eigen::Vector2d(2.0, 4.0));
}

TEST(KeypointsCsv, NamesInQuotesMayHoldCommas) {
  const auto read = parse("scorer,a,a\nbodyparts,\"hand, left\",\"hand, left\"\ncoords,x,y\n0,1,2").value();
  EXPECT_THAT(read.names, ElementsAre("hand, left"));
}

TEST(KeypointsCsv, FramesAreCountedFromZeroWithoutAGap) {
  const std::string header = kHeader;
  EXPECT_THAT(sentence(header + "1,1,2,1,3,4,1\n"),
              HasSubstr("cam.csv: line 4: begins with '1'; need frame 0"));
  EXPECT_THAT(sentence(header + "0,1,2,1,3,4,1\n2,1,2,1,3,4,1\n"),
              HasSubstr("line 5: begins with '2'; need frame 1"));
  EXPECT_THAT(sentence(header + "0,1,2,1,3,4,1\n0,1,2,1,3,4,1\n"), HasSubstr("need frame 1"));
  EXPECT_THAT(sentence(header + "img000.png,1,2,1,3,4,1\n"), HasSubstr("'img000.png'"));
  EXPECT_THAT(sentence(header + ",1,2,1,3,4,1\n"), HasSubstr("begins with ''"));
  EXPECT_THAT(sentence(header), HasSubstr("has a header but no frames"));
}

TEST(KeypointsCsv, CellsThatMakeNoSenseAreNamedWithTheirLine) {
  const std::string header = kHeader;
  EXPECT_THAT(sentence(header + "0,1,two,1,3,4,1\n"), HasSubstr("line 4: column 3 is 'two'; need a number"));
  EXPECT_THAT(sentence(header + "0,inf,2,1,3,4,1\n"), HasSubstr("column 2 is 'inf'"));
  EXPECT_THAT(sentence(header + "0,1,,1,3,4,1\n"), HasSubstr("point 'wrist' has x but not y"));
  EXPECT_THAT(sentence(header + "0,1,2,1,,4,1\n"), HasSubstr("point 'elbow' has y but not x"));
  EXPECT_THAT(sentence(header + "0,1,2,1.5,3,4,1\n"), HasSubstr("likelihood of 1.5; need 0 to 1"));
  EXPECT_THAT(sentence(header + "0,1,2,-0.1,3,4,1\n"), HasSubstr("need 0 to 1"));
  EXPECT_THAT(sentence(header + "0,1,2,1,3,4\n"), HasSubstr("line 4: has 6 cells; the header has 7"));
  EXPECT_THAT(sentence(header + "0,\"1,2,1,3,4,1\n"), HasSubstr("a quote is not closed"));
}

TEST(KeypointsCsv, AHeaderThatIsNoneIsRefused) {
  EXPECT_THAT(sentence(""), HasSubstr("ends before a line 'scorer'"));
  EXPECT_THAT(sentence("frame,time_s,marker\n0,0,A\n"),
              HasSubstr("line 1: begins with 'frame'; need 'scorer'"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P,P\n0,1,2\n"),
              HasSubstr("line 3: begins with '0'; need 'coords'"));
  EXPECT_THAT(sentence("scorer\nbodyparts\ncoords\n0\n"), HasSubstr("names no point"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P\ncoords,x,y\n0,1,2\n"), HasSubstr("have 3, 2 and 3 cells"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P,P\ncoords,x,z\n0,1,2\n"), HasSubstr("column 3 is 'z'"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P,P\ncoords,x,x\n0,1,2\n"),
              HasSubstr("point 'P' has two columns x"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P,Q\ncoords,x,y\n0,1,2\n"),
              HasSubstr("point 'P' has no column y"));
  EXPECT_THAT(sentence("scorer,a,a\nbodyparts,P,\ncoords,x,y\n0,1,2\n"),
              HasSubstr("column 3 belongs to no point"));
}

TEST(KeypointsCsv, OfSeveralIndividualsOneIsChosen) {
  const std::string text =
      "scorer,a,a,a,a\nindividuals,m1,m1,m2,m2\nbodyparts,P,P,P,P\ncoords,x,y,x,y\n0,1,2,3,4\n";
  const auto open = parse(text);
  EXPECT_EQ(open.error().code, Code::not_supported);
  EXPECT_THAT(open.error().message,
              HasSubstr("shows 2 people; choose one with --person: 1 ('m1'), 2 ('m2')"));
  EXPECT_EQ(parse(text, {.person = 1}).value().at(0, 0).x(), 1.0);
  EXPECT_EQ(parse(text, {.person = 2}).value().at(0, 0).x(), 3.0);
  EXPECT_THAT(parse(text, {.person = 3}).error().message, HasSubstr("has no person 3; it has 2"));
  EXPECT_EQ(parse("scorer,a,a\nindividuals,m1,m1\nbodyparts,P,P\ncoords,x,y\n0,1,2\n").value().at(0, 0).y(),
            2.0);
  EXPECT_THAT(parse("scorer,a,a\nindividuals,m1\nbodyparts,P,P\ncoords,x,y\n0,1,2\n").error().message,
              HasSubstr("scorer and individuals have 3 and 2 cells"));
}

TEST(KeypointsCsv, ALikelihoodThatCannotBeIsUsage) {
  for (const double bad : {-0.1, 1.1, std::nan("")})
    EXPECT_EQ(parse(kHeader, {.min_likelihood = bad}).error().code, Code::usage) << bad;
  EXPECT_EQ(read_keypoints_csv("/nowhere/cam.csv").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
