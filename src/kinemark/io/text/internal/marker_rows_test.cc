// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/marker_rows.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::io::internal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = MarkerColumns::Kind;
using Eigen::Vector3d;

/// Frame, time and so many markers, in millimetres at 100 Hz.
MarkerColumns columns_of(int markers, bool frame = true, bool time = true, char separator = '\t') {
  MarkerColumns c{.separator = separator, .rates_hz = {100.0}};
  if (frame) c.columns.push_back({.kind = Kind::frame});
  if (time) c.columns.push_back({.kind = Kind::time});
  for (int m = 0; m < markers; ++m) {
    c.names.push_back(fmt::format("M{}", m));
    for (int axis = 0; axis < 3; ++axis)
      c.columns.push_back({.kind = Kind::coordinate, .marker = m, .axis = static_cast<std::int8_t>(axis)});
  }
  return c;
}

data::Trial rows_of(const std::string& text, const MarkerColumns& columns) {
  data::Trial trial;
  Lines lines(text);
  const Status status = read_marker_rows(lines, columns, text.size(), trial);
  EXPECT_TRUE(status) << status.error().message;
  if (status) {
    EXPECT_TRUE(trial.markers.validate()) << trial.markers.validate().error().message;
  }
  return trial;
}

std::string refusal(const std::string& text, const MarkerColumns& columns, std::size_t bytes = 0) {
  data::Trial trial;
  Lines lines(text);
  const Status status = read_marker_rows(lines, columns, bytes == 0 ? text.size() : bytes, trial);
  EXPECT_FALSE(status) << text;
  if (status) return "";
  EXPECT_EQ(status.error().code, Code::bad_input);
  EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  return status.error().message;
}

TEST(MarkerRows, EveryNumberComesBackInMetresAtItsPlace) {
  Random random(3, 3);
  for (const char separator : {'\t', ','})
    for (const double units : {1.0, 100.0, 1000.0}) {
      std::vector<double> written;
      std::string text;
      for (int f = 0; f < 20; ++f) {
        text += fmt::format("{}{}{:.2f}", f + 7, separator, 0.01 * f);
        for (int i = 0; i < 12; ++i) {
          written.push_back(random.uniform(-2000.0, 2000.0));
          text += fmt::format("{}{:.17g}", separator, written.back());
        }
        text += '\n';
      }
      auto columns = columns_of(4, true, true, separator);
      columns.units_per_metre = units;
      const auto trial = rows_of(text, columns);
      EXPECT_EQ(trial.first_frame, 7);
      EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 20}));
      EXPECT_THAT(trial.warnings, IsEmpty());
      for (std::size_t i = 0; i < written.size(); ++i)
        EXPECT_EQ(trial.markers.x_in_world[i], written[i] / units);
      EXPECT_EQ(trial.markers.count_missing(), 0);
    }
}

TEST(MarkerRows, ColumnsMayComeInAnyOrderAndSomeAreNotRead) {
  MarkerColumns c{.names = {"A"}, .units_per_metre = 1.0, .rates_hz = {50.0}};
  c.columns = {{.kind = Kind::coordinate, .marker = 0, .axis = 2},
               {.kind = Kind::unread},
               {.kind = Kind::coordinate, .marker = 0, .axis = 0},
               {.kind = Kind::coordinate, .marker = 0, .axis = 1}};
  const auto trial = rows_of("3\tnot read\t1\t2\n6\t\t4\t5\n", c);
  EXPECT_EQ(Vector3d(trial.markers.x(0, 0)), Vector3d(1, 2, 3));
  EXPECT_EQ(Vector3d(trial.markers.x(1, 0)), Vector3d(4, 5, 6));
  EXPECT_EQ(trial.markers.time, (TimeBase{50.0, 0.0, 2}));
}

TEST(MarkerRows, WhatIsNotWholeIsMissingAndCounted) {
  const auto trial = rows_of(
      "1\t0.00\t1\t2\t3\t4\t5\t6\n"
      "2\t0.01\t\t2\t3\t4\t5\t6\n"
      "3\t0.02\t1\tNaN\t3\tinf\t5\t6\n"
      "4\t0.03\t1\t2\t3\n"
      "5\t0.04\tnull\tNULL\tnull\t4\t5\t6\t7\n",
      columns_of(2));
  const std::vector<std::pair<int, int>> missing{{1, 0}, {2, 0}, {2, 1}, {3, 1}, {4, 0}};
  EXPECT_EQ(trial.markers.count_missing(), 5);
  for (const auto& [f, m] : missing) EXPECT_FALSE(trial.markers.present(f, m)) << f << " " << m;
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("2 samples have one or two blank coordinates")));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 samples are infinite")));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 of 5 rows end before the last marker")));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 of 5 rows hold cells beyond the last column")));
}

TEST(MarkerRows, NinesInAllCoordinatesMarkWhatWasNotSeen) {
  const auto trial = rows_of(
      "1\t0.00\t-9999\t-9999\t-9999\n2\t0.01\t9999\t1\t2\n3\t0.02\t999999\t999999\t999999\n4\t0."
      "03\t99\t99\t99\n",
      columns_of(1));
  EXPECT_FALSE(trial.markers.present(0, 0));
  EXPECT_TRUE(trial.markers.present(1, 0)) << "one of three is a place";
  EXPECT_FALSE(trial.markers.present(2, 0));
  EXPECT_TRUE(trial.markers.present(3, 0)) << "0.1 m from the origin";
  EXPECT_THAT(trial.warnings,
              testing::ElementsAre("2 samples are 999, 9999, ... in all coordinates, taken as not seen"));
}

TEST(MarkerRows, TimesMayBeInAnotherUnit) {
  auto columns = columns_of(1);
  columns.rates_hz.clear();
  columns.time_units_per_second = 1000.0;
  columns.is_time_unit_open = false;
  const auto trial = rows_of("1\t0\t1\t2\t3\n2\t10\t1\t2\t3\n3\t20\t1\t2\t3\n", columns);
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 3}));
}

TEST(MarkerRows, NumbersWithoutARowAreMissingFrames) {
  const auto trial = rows_of("11\t1\t2\t3\n12\t4\t5\t6\n15\t7\t8\t9\n", columns_of(1, true, false));
  EXPECT_EQ(trial.first_frame, 11);
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.1, 5})) << "frame 1 is at 0 s";
  EXPECT_EQ(trial.markers.count_missing(), 2);
  EXPECT_EQ(Vector3d(trial.markers.x(4, 0)), Vector3d(0.007, 0.008, 0.009));
  EXPECT_FALSE(trial.markers.present(2, 0) || trial.markers.present(3, 0));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("2 frames between the rows have no row and are missing")));
}

TEST(MarkerRows, TimesAreTheClockWhereThereAreSome) {
  auto columns = columns_of(1);
  columns.rates_hz = {120.0};
  const auto trial =
      rows_of("1\t2.00\t1\t2\t3\n2\t2.02\t1\t2\t3\n3\t2.06\t1\t2\t3\n4\t2.08\t1\t2\t3\n", columns);
  EXPECT_NEAR(trial.markers.time.rate_hz, 50.0, 1e-9);
  EXPECT_NEAR(trial.markers.time.t0_s, 2.0, 1e-12);
  EXPECT_EQ(trial.markers.frames(), 5);
  EXPECT_FALSE(trial.markers.present(2, 0)) << "at 2.04 s there is no row";
}

TEST(MarkerRows, ABlankLineEndsThem) {
  const std::string text = "1\t0.00\t1\t2\t3\n2\t0.01\t1\t2\t3\n\nDevices\n1\t2\n";
  data::Trial trial;
  Lines lines(text);
  ASSERT_TRUE(read_marker_rows(lines, columns_of(1), text.size(), trial));
  EXPECT_EQ(trial.markers.frames(), 2);
  EXPECT_EQ(lines.number(), 2);
}

TEST(MarkerRows, AStatedCountThatIsWrongIsSaid) {
  auto columns = columns_of(1);
  columns.stated_frames = 9;
  EXPECT_THAT(rows_of("1\t0.00\t1\t2\t3\n2\t0.01\t1\t2\t3\n", columns).warnings,
              Contains(HasSubstr("header says 9 frames, 2 rows are there; the rows are used")));
}

TEST(MarkerRows, SaysLineAndColumnOfWhatIsWrong) {
  const auto c = columns_of(1);
  const std::string good = "1\t0.00\t1\t2\t3\n";
  EXPECT_EQ(refusal(good + "x\t0.01\t1\t2\t3\n", c),
            "line 2, column 1: the frame number is 'x'; expected a number");
  EXPECT_EQ(refusal(good + "2.5\t0.01\t1\t2\t3\n", c),
            "line 2, column 1: the frame number is '2.5'; expected a number");
  EXPECT_EQ(refusal(good + "2\t\t1\t2\t3\n", c), "line 2, column 2: the time is blank; expected a number");
  EXPECT_EQ(refusal(good + "2\tinf\t1\t2\t3\n", c), "line 2, column 2: the time is 'inf'; expected a number");
  EXPECT_EQ(refusal(good + "2\t0.01\t1\thm\t3\n", c),
            "line 2, column 4: y of marker 'M0' is 'hm'; expected a number");
  EXPECT_THAT(refusal("", c), HasSubstr("ends before the first row"));
  EXPECT_THAT(refusal(good, columns_of(0)), HasSubstr("names no marker"));
}

TEST(MarkerRows, NumbersThatDoNotRiseOrLeapTooFarAreRefused) {
  const auto c = columns_of(1, true, false);
  EXPECT_EQ(refusal("5\t1\t2\t3\n5\t1\t2\t3\n", c),
            "line 2 (frame 5): the frame number does not increase; expected more than 5");
  EXPECT_THAT(refusal("5\t1\t2\t3\n900000000000\t1\t2\t3\n", c),
              HasSubstr("more than are believed of this file"));
  auto no_rate = c;
  no_rate.rates_hz.clear();
  EXPECT_THAT(refusal("5\t1\t2\t3\n", no_rate), HasSubstr("no frame rate and the rows hold no times"));
}

TEST(MarkerRows, AShortTextCannotAskForMuchMemory) {
  std::string text;
  for (int f = 0; f < 3000; ++f) text += "1\n";
  EXPECT_THAT(refusal(text, columns_of(1000)),
              HasSubstr("3000 rows for 1000 markers do not fit into the 6000 bytes"));
}

TEST(RemoveZeros, RunsOfZerosAreTakenAwayUnlessThePathGoesThroughThem) {
  // Every pattern of zeros (z), far samples (f), near ones (n) and missing ones (-) of length five.
  const std::string kinds = "zfn-";
  for (int code = 0; code < 1024; ++code) {
    std::string word;
    for (int i = 0, rest = code; i < 5; ++i, rest /= 4) word += kinds[static_cast<std::size_t>(rest % 4)];
    auto t = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 5});
    for (std::int64_t f = 0; f < 5; ++f) {
      const char kind = word[static_cast<std::size_t>(f)];
      if (kind == '-') continue;
      t.x(f, 0) = Vector3d(kind == 'z' ? 0.0 : kind == 'n' ? 0.005 : 0.0051, 0.0, 0.0);
      t.state[t.index(f, 0)] = data::SampleState::measured;
    }
    // A run stays when there is something beside it and all of that is near; ends of the recording do not
    // count.
    std::int64_t expected = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      if (word[i] != 'z') continue;
      std::size_t left = i, right = i;
      while (left > 0 && word[left - 1] == 'z') --left;
      while (right < 4 && word[right + 1] == 'z') ++right;
      const std::string beside =
          (left > 0 ? word.substr(left - 1, 1) : "") + (right < 4 ? word.substr(right + 1, 1) : "");
      if (beside.empty() || beside.find_first_not_of('n') != std::string::npos) ++expected;
    }
    EXPECT_EQ(remove_zeros(t, 0), expected) << word;
    EXPECT_EQ(t.count_missing(), std::ranges::count(word, '-') + expected) << word;
    EXPECT_EQ(remove_zeros(t, 0), 0) << "nothing is left to remove: " << word;
  }
}

}  // namespace
}  // namespace kinemark::io::internal
