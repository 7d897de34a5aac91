// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/numpy/npz.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/numpy/testing/archive.h"

namespace kinemark::io {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace testing_npz;
using Members = std::vector<std::pair<std::string, std::string>>;

Result<data::Trial> parse(const Members& members, std::string_view unit = {}, bool compressed = false) {
  return parse_npz(bytes_of(zip(members, compressed)), "walk.npz", unit);
}

std::string refusal(const Members& members, std::string_view unit = {}) {
  const auto trial = parse(members, unit);
  return trial ? "read without complaint" : trial.error().message;
}

const std::string kRate = npy("<f8", "()", doubles({100.0}));
const std::string kMetres = texts({"m"}, "()");
const std::string kTwoNames = texts({"LASI", "RASI"}, "(2,)");

/// Two frames of two markers: 0, 1, 2, ... in the order frames, markers, coordinates.
std::string block(const std::string& shape = "(2, 2, 3)") {
  return npy("<f8", shape, doubles({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(Npz, OneArrayOfPositionsWithNamesAndARate) {
  for (const bool compressed : {false, true}) {
    const auto trial =
        parse({{"markers.npy", block()}, {"names.npy", kTwoNames}, {"fs.npy", kRate}, {"unit.npy", kMetres}},
              {}, compressed);
    ASSERT_TRUE(trial) << trial.error().message;
    EXPECT_EQ(trial->format, "NPZ");
    EXPECT_EQ(trial->units_in_file, "m");
    EXPECT_EQ(trial->markers.time.rate_hz, 100.0);
    EXPECT_THAT(trial->markers.names, ElementsAre("LASI", "RASI"));
    EXPECT_EQ(trial->markers.frames(), 2);
    EXPECT_EQ(trial->markers.x(1, 0), Eigen::Vector3d(6, 7, 8));
    EXPECT_EQ(trial->markers.x(0, 1), Eigen::Vector3d(3, 4, 5));
    EXPECT_THAT(trial->warnings, IsEmpty());
  }
}

TEST(Npz, NamesAndTimesSettleTheOrderOfTheAxes) {
  // Three frames of two markers, markers first.
  std::vector<double> x;
  for (int i = 0; i < 18; ++i) x.push_back(i);
  const Members members{{"xyz.npy", npy("<f8", "(2, 3, 3)", doubles(x))},
                        {"labels.npy", kTwoNames},
                        {"t.npy", npy("<f8", "(3,)", doubles({1.0, 1.01, 1.02}))},
                        {"units.npy", kMetres}};
  const auto trial = parse(members);
  EXPECT_THAT(trial.error().message, HasSubstr("no array of three axes"))
      << "either of two axes of three may be frames";
  std::vector<double> y(x.begin(), x.end());
  y.resize(24);
  const auto four = parse({{"xyz.npy", npy("<f8", "(2, 4, 3)", doubles(y))},
                           {"labels.npy", kTwoNames},
                           {"t.npy", npy("<f8", "(4,)", doubles({1.0, 1.01, 1.02, 1.03}))},
                           {"units.npy", kMetres}});
  ASSERT_TRUE(four) << four.error().message;
  EXPECT_EQ(four->markers.frames(), 4);
  EXPECT_EQ(four->markers.time.rate_hz, 100.0);
  EXPECT_NEAR(four->markers.time.t0_s, 1.0, 1e-9);
  EXPECT_EQ(four->markers.x(2, 0), Eigen::Vector3d(6, 7, 8));
  EXPECT_EQ(four->markers.x(0, 1), Eigen::Vector3d(12, 13, 14));
}

TEST(Npz, AnArrayForEachMarkerUnderItsName) {
  const auto trial = parse({{"time.npy", npy("<f8", "(3,)", doubles({0.0, 0.01, 0.02}))},
                            {"LASI.npy", npy("<f8", "(3, 3)", doubles({0, 0, 3000, NAN, 0, 0, 1, 2, 3}))},
                            {"RASI.npy", npy("<f8", "(3, 3)", doubles({200, 0, 0, 0, 5, 0, 7, 8, 9}))},
                            {"angles.npy", npy("<f8", "(2, 3)", doubles({0, 0, 0, 0, 0, 0}))}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("LASI", "RASI"));
  EXPECT_FALSE(trial->markers.present(1, 0));
  EXPECT_TRUE(trial->markers.x(2, 1).isApprox(Eigen::Vector3d(0.007, 0.008, 0.009)));
  EXPECT_THAT(trial->warnings, Contains(HasSubstr("taken for mm")));
  EXPECT_THAT(trial->warnings,
              Contains("1 of 4 arrays are no positions, names or times and are not read: angles (2 x 3)"));
}

TEST(Npz, FramesThatTimesSkipAreMissing) {
  std::vector<double> times, x;
  for (int f = 0; f < 20; ++f) {
    times.push_back(0.01 * (f < 10 ? f : f + 3));
    for (int k = 0; k < 3; ++k) x.push_back(0.1 * f);
  }
  const auto trial = parse({{"t.npy", npy("<f8", "(20,)", doubles(times))},
                            {"P.npy", npy("<f8", "(20, 3)", doubles(x))},
                            {"unit.npy", kMetres}});
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->markers.frames(), 23);
  EXPECT_FALSE(trial->markers.present(11, 0));
  EXPECT_TRUE(trial->markers.present(13, 0));
  EXPECT_THAT(trial->warnings, Contains("times skip 3 frames, which are missing"));
}

TEST(Npz, WithoutNamesPointsAreNumbered) {
  const auto trial = parse({{"data.npy", block()}, {"fs.npy", kRate}}, "m");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("point 1", "point 2"));
  EXPECT_THAT(trial->warnings, Contains(HasSubstr("no array names the 2 markers")));
}

TEST(Npz, WhatDoesNotFitSaysWhatIsThereAndWhatWasExpected) {
  EXPECT_THAT(refusal({{"a.npy", npy("<f8", "(2,)", doubles({1, 2}))}}),
              ::testing::AllOf(
                  HasSubstr("walk.npz: no positions are found: holds a (2); expected an array of frames x "
                            "markers x 3"),
                  HasSubstr("('fs')")));
  EXPECT_THAT(refusal({{"markers.npy", block()}}), HasSubstr("no clock is found"));
  EXPECT_THAT(refusal({{"a.npy", block()}, {"b.npy", block()}, {"fs.npy", kRate}}),
              HasSubstr("several arrays may be the positions"));
  EXPECT_THAT(
      refusal({{"a.npy", block()}, {"names.npy", texts({"A", "B", "C", "D"}, "(4,)")}, {"fs.npy", kRate}}),
      HasSubstr("no array of three axes is as long as its names"));
  EXPECT_THAT(refusal({{"a.npy", block()}, {"fs.npy", kRate}, {"unit.npy", texts({"parsec"}, "()")}}),
              HasSubstr("'parsec'"));
  EXPECT_THAT(refusal({{"names.npy", npy("|O", "(2,)", "x")}}),
              HasSubstr("array 'names': holds Python objects"));
  EXPECT_THAT(refusal({}), HasSubstr("holds no array"));
  EXPECT_THAT(refusal({{"P.npy", npy("<f8", "(2, 3)", doubles({1, 1, 1, 1, 1, 1}))}, {"fs.npy", kRate}}),
              HasSubstr("give it with --unit"));
}

TEST(Npz, IsKnownByItsFirstMember) {
  EXPECT_TRUE(is_npz(zip({{"t.npy", kRate}})));
  EXPECT_FALSE(is_npz(zip({{"word/document.xml", ""}})));
  EXPECT_FALSE(is_npz(""));
  EXPECT_FALSE(is_npz("PK\3\4"));
}

}  // namespace
}  // namespace kinemark::io
