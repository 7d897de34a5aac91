// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/d_flow_forces.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const Vector3d kForce(20.0, 700.0, -30.0), kFree(0.0, 4.0, 0.0);  // y up, as D-Flow has it

enum class About { origin, point, elsewhere };

Vector3d point_of(int row) { return {0.2, 0.0, -0.5 + 0.03 * row}; }

std::string header(int plates, bool moments = true) {
  std::string out = "TimeStamp\tFrameNumber";
  for (int p = 1; p <= plates; ++p)
    for (const char* what : {"Cop", "For", "Mom"})
      for (const char axis : {'X', 'Y', 'Z'})
        if (moments || std::string_view(what) != "Mom") out += fmt::format("\tFP{}.{}{}", p, what, axis);
  return out + "\n";
}

/// One plate, loaded from row 3 on.
std::string walk(About about, double sign = 1.0, bool moments = true) {
  std::string out = header(1, moments);
  for (int row = 0; row < 12; ++row) {
    const double load = row < 3 ? 0.005 : 1.0;
    const Vector3d force = sign * load * kForce, point = point_of(row);
    Vector3d moment = sign * load * kFree;
    if (about == About::origin) moment += point.cross(force);
    if (about == About::elsewhere) moment += (point + Vector3d(1.0, 0.0, 2.0)).cross(force);
    out += fmt::format("{}\t{}", 0.01 * row, row);
    std::vector<Vector3d> cells{point, force};
    if (moments) cells.push_back(moment);
    for (const auto& v : cells) out += fmt::format("\t{:.6f}\t{:.6f}\t{:.6f}", v.x(), v.y(), v.z());
    out += "\n";
  }
  return out;
}

Vector3d three(const data::Table& table, std::int64_t row, const std::string& words) {
  Vector3d out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = table(row, table.find(words + "xyz"[axis]));
  return out;
}

data::Table good(const std::string& text, double contact_force_n = 20.0) {
  const auto table = parse_d_flow_forces(text, "walk.txt", contact_force_n);
  EXPECT_TRUE(table) << table.error().message;
  EXPECT_TRUE(table->validate());
  return *table;
}

TEST(DFlowForces, AreOnTheBodyWithFreeMomentsWhateverTheirMomentsAreAbout) {
  for (const auto about : {About::origin, About::point})
    for (const double sign : {1.0, -1.0}) {
      const auto table = good(walk(about, sign));
      EXPECT_LT((three(table, 7, "plate 1_v") - kForce).norm(), 1e-5);
      EXPECT_LT((three(table, 7, "plate 1_p") - point_of(7)).norm(), 1e-5);
      EXPECT_LT((three(table, 7, "plate 1_m") - kFree).norm(), 1e-3);
      EXPECT_EQ(three(table, 1, "plate 1_v"), Vector3d::Zero()) << "3.5 N: nobody";
      EXPECT_THAT(table.warnings, Contains(HasSubstr("it writes no corners")));
      const auto reversed = Contains(HasSubstr("their sign was reversed"));
      if (sign < 0.0) {
        EXPECT_THAT(table.warnings, reversed);
      }
      if (sign > 0.0) {
        EXPECT_THAT(table.warnings, Not(reversed));
      }
      EXPECT_THAT(table.warnings, Not(Contains(HasSubstr("neither about the origin"))));
    }
}

TEST(DFlowForces, MomentsAboutSomethingElseAreSaidAndLeftOut) {
  const auto table = good(walk(About::elsewhere));
  EXPECT_EQ(three(table, 7, "plate 1_m"), Vector3d::Zero());
  EXPECT_THAT(table.warnings,
              Contains(HasSubstr("plate 1: its moments (FP1.MomX) are neither about the origin nor")));
  EXPECT_EQ(three(good(walk(About::point, 1.0, false)), 7, "plate 1_m"), Vector3d::Zero());
}

TEST(DFlowForces, AreKnownByTheForceAndThePointOfAPlate) {
  EXPECT_TRUE(begins_d_flow_forces(header(2)));
  EXPECT_TRUE(begins_d_flow_forces(header(1, false)));
  for (const char* text : {"", "TimeStamp\tFP1.ForX\tFP1.ForY\tFP1.ForZ\n", "TimeStamp\tFP1.CopX\tFP1.ForX\n",
                           "FP1.CopX\tFP1.CopY\tFP1.CopZ\tFP1.ForX\tFP1.ForY\tFP1.ForZ\n",
                           "TimeStamp\tLHEE.PosX\tLHEE.PosY\tLHEE.PosZ\n"})
    EXPECT_FALSE(begins_d_flow_forces(text)) << text;
  const auto labels = d_flow_force_labels(
      {"FP2.ForX", "FP2.ForY", "FP2.ForZ", "FP2.CopX", "FP2.CopY", "FP2.CopZ", "FP1.ForX"});
  EXPECT_THAT(labels, Contains("FP2.CopZ"));
  EXPECT_THAT(labels, Not(Contains("FP1.ForX"))) << "its point is not there";
}

TEST(DFlowForces, TwoPlatesAreTwoForcesAndABlankIsNotKnown) {
  std::string text = header(2);
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("{}\t{}", 0.01 * row, row);
    for (int p = 1; p <= 2; ++p)
      text += fmt::format("\t0.{}\t0\t0\t0\t{}\t0\t0\t0\t0", p, row == 1 && p == 2 ? "" : "500");
    text += "\n";
  }
  const auto table = good(text);
  EXPECT_EQ(table.columns.size(), 18U);
  EXPECT_EQ(three(table, 0, "plate 2_p").x(), 0.2);
  EXPECT_TRUE(std::isnan(three(table, 1, "plate 2_v").y()));
  EXPECT_EQ(three(table, 1, "plate 1_v").y(), 500.0);
}

TEST(DFlowForces, SayWhatIsWrong) {
  const auto message = [](const std::string& text) {
    const auto table = parse_d_flow_forces(text, "f.txt", 20.0);
    return table ? std::string() : table.error().message;
  };
  EXPECT_THAT(message("time\tA\n0\t1\n"),
              HasSubstr("f.txt: labels no forces of D-Flow; need a time, FP1.ForX"));
  EXPECT_THAT(message(header(1)), HasSubstr("line 2: the file ends before the first row"));
  EXPECT_THAT(message(header(1) + "0\t1\n0\t2\n"),
              HasSubstr("line 3: the time is no number or does not increase"));
  EXPECT_THAT(message(header(1) + "x\t1\n"), HasSubstr("line 2: the time is no number"));
}

}  // namespace
}  // namespace kinemark::io
