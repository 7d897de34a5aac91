// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/text/vendor_exports.h"

namespace kinemark::io {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Result<data::Trial> read(const std::string& text, std::string_view unit = {}) {
  return parse_vendor_export(text, "t.csv", VendorExport::coordinates, unit, 0.0);
}

/// Three rows of one marker in mm, at the times given.
std::string rows_at(const std::vector<std::string>& times) {
  std::string out = "time,A_x (mm),A_y (mm),A_z (mm)\n";
  double x = 100.0;
  for (const auto& time : times) out += fmt::format("{},{},20,1000\n", time, x += 1.0);
  return out;
}

TEST(NumberedAxes, AreReadWithTheirUnit) {
  const std::string text =
      "time,LASI_1,LASI_2,LASI_3,RASI_1,RASI_2,RASI_3\n0,1,2,3,4,5,6\n0.01,1,2,3,4,5,6\n";
  const auto trial = read(text, "mm").value();
  EXPECT_THAT(trial.markers.names, ::testing::ElementsAre("LASI", "RASI"));
  EXPECT_EQ(trial.markers.x(1, 1), Eigen::Vector3d(0.004, 0.005, 0.006));
  EXPECT_THAT(trial.warnings,
              Contains(HasSubstr("three numbered columns of each name ('LASI') are taken for x, y and z")));
}

TEST(NumberedAxes, WithoutAUnitAreAskedAbout) {
  const auto refused = read("time,LASI_1,LASI_2,LASI_3\n0,1,2,3\n0.01,1,2,3\n");
  ASSERT_FALSE(refused);
  EXPECT_THAT(
      refused.error().message,
      HasSubstr(
          "three numbered columns of each name ('LASI'), and nothing tells that they are x, y and z of a "
          "marker; if they are, give their unit of length with --unit mm, cm or m"));
  const auto named = read("time,LASI_x,LASI_y,LASI_z\n0,1,2,3\n0.01,1,2,3\n", "m").value();
  EXPECT_THAT(named.warnings, Not(Contains(HasSubstr("numbered columns"))));
}

TEST(ClockTimes, BecomeSecondsFromTheFirst) {
  for (const auto& times :
       {std::vector<std::string>{"2024-05-01T10:00:00.010", "2024-05-01T10:00:00.020",
                                 "2024-05-01T10:00:00.030"},
        {"2024-05-01 23:59:59.990Z", "2024-05-02 00:00:00.000Z", "2024-05-02 00:00:00.010Z"},
        {"10:00:00.010", "10:00:00.020", "10:00:00.030"},
        {"23:59:59.99", "0:00:00.00", "0:00:00.01"}}) {
    const auto trial = read(rows_at(times)).value();
    EXPECT_NEAR(trial.markers.time.rate_hz, 100.0, 1e-6) << times[0];
    EXPECT_EQ(trial.markers.time.t0_s, 0.0) << times[0];
    EXPECT_EQ(trial.markers.frames(), 3) << times[0];
    EXPECT_THAT(
        trial.warnings,
        Contains(HasSubstr(fmt::format(
            "times are those of a clock; they are taken as seconds from the first, '{}'", times[0]))));
  }
  EXPECT_THAT(read(rows_at({"0.01", "0.02", "0.03"})).value().warnings,
              Not(Contains(HasSubstr("of a clock"))));
}

TEST(ClockTimes, ThatStandStillGoBackOrAreMixedWithNumbersAreRefused) {
  const auto message = [](const std::vector<std::string>& times) {
    const auto trial = read(rows_at(times));
    return trial ? std::string() : trial.error().message;
  };
  EXPECT_THAT(message({"10:00:00", "10:00:00", "10:00:01"}), HasSubstr("time stands still at 0 s"));
  EXPECT_THAT(message({"10:00:02", "10:00:01", "10:00:00"}), HasSubstr("time goes back from 0 to -1 s"));
  EXPECT_THAT(message({"10:00:00.01", "0.02", "0.03"}),
              HasSubstr("line 3, column 1: the time is '0.02'; expected a number"));
  EXPECT_THAT(message({"0.01", "10:00:00.02", "0.03"}),
              HasSubstr("the time is '10:00:00.02'; expected a number"));
  EXPECT_THAT(message({"10:00:00 AM", "10:00:01 AM", "10:00:02 AM"}), HasSubstr("the time is '10:00:00 AM'"));
}

TEST(ClockTimes, WithAHoleHaveMissingFrames) {
  const auto trial =
      read(rows_at({"10:00:00.00", "10:00:00.01", "10:00:00.02", "10:00:00.05", "10:00:00.06"})).value();
  EXPECT_EQ(trial.markers.frames(), 7);
  EXPECT_FALSE(trial.markers.present(3, 0));
  EXPECT_THAT(read(rows_at({"10:00:00", "10:00:01", "10:00:02"})).value().warnings, Not(IsEmpty()))
      << "1 Hz, said";
}

TEST(ZerosInTables, AreNotSeenExceptOnAPathThroughTheOrigin) {
  const std::string rows =
      "0,100,200,3000,3,0,0\n0.01,0,0,0,0,0,0\n0.02,0.0,0,0.000,-3,0,0\n0.03,103,200,3000,-6,0,0\n";
  for (const std::string unit : {"mm", ""}) {
    const std::string label = unit.empty() ? "" : " (mm)";
    std::string head = "time";
    for (const char* name : {"A_x", "A_y", "A_z", "B_x", "B_y", "B_z"}) head += "," + (name + label);
    const auto trial = read(head + "\n" + rows).value();
    EXPECT_FALSE(trial.markers.present(1, 0)) << unit;
    EXPECT_FALSE(trial.markers.present(2, 0)) << unit;
    EXPECT_TRUE(trial.markers.present(1, 1)) << "B passes through the origin";
    EXPECT_THAT(trial.warnings,
                Contains(HasSubstr("2 samples of 1 markers are exactly (0, 0, 0), taken as not seen: 'A'")));
  }
  const auto whole = read("time,A_x (mm),A_y (mm),A_z (mm)\n0,0,0,1\n0.01,0,0,1\n").value();
  EXPECT_THAT(whole.warnings, Not(Contains(HasSubstr("(0, 0, 0)"))));
}

}  // namespace
}  // namespace kinemark::io
