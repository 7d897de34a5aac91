// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/markers/plausible.h"

#include <gmock/gmock.h>

#include <cmath>

namespace kinemark::io {
namespace {

using data::SampleState;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Four markers of a body that walks at `speed_m_s`, `size` times as large as a person.
data::Trial walk(double size = 1.0, double speed_m_s = 1.3, std::int64_t frames = 200) {
  data::Trial trial{.source = "w.trc", .format = "TRC", .units_in_file = "mm", .first_frame = 10};
  trial.markers = data::Trajectories::all_missing({"HEAD", "HIP", "KNEE", "HEEL"},
                                                  {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 4; ++m) {
      const double t = 0.01 * static_cast<double>(f);
      trial.markers.x(f, m) = size * Eigen::Vector3d(speed_m_s * t + 0.1 * std::sin(6.0 * t), 0.2,
                                                     1.7 - 0.55 * static_cast<double>(m));
      trial.markers.state[trial.markers.index(f, m)] = SampleState::measured;
    }
  return trial;
}

TEST(RejectImplausible, OneSampleFarFromAll) {
  for (const double wrong : {12.0, -150.0, 2000.0, 1e30, 1e200})
    for (const std::int64_t frame : {0, 1, 100, 199}) {
      auto trial = walk();
      trial.residual_m.assign(800, 0.001F);
      trial.markers.x(frame, 2).y() = wrong;
      const auto before = trial.markers.x_in_world;
      reject_implausible(trial);
      ASSERT_EQ(trial.warnings.size(), 1U) << wrong << " " << frame;
      EXPECT_THAT(trial.warnings[0], AllOf(HasSubstr("1 sample is where no marker can be and is rejected"),
                                           HasSubstr("'KNEE' in frame " + std::to_string(frame + 10))));
      const auto i = trial.markers.index(frame, 2);
      EXPECT_EQ(trial.markers.state[i], SampleState::rejected);
      EXPECT_TRUE(std::isnan(trial.residual_m[i]));
      EXPECT_TRUE(trial.validate()) << "coordinates of a rejected sample are NaN";
      EXPECT_EQ(trial.markers.count_missing(), 1);
    }
}

/// The box that a reader would tell of.
Eigen::AlignedBox3d box_of(const data::Trial& trial) {
  Eigen::AlignedBox3d out;
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers.markers(); ++m)
      if (trial.markers.present(f, m)) out.extend(Eigen::Vector3d(trial.markers.x(f, m)));
  return out;
}

TEST(RejectImplausible, AKnownBoxChangesNothing) {
  for (const double wrong : {0.5, 7.0, 9.0, 9.5, 9.99, 10.01, 11.0, 30.0, 101.0, 1e6})
    for (const double speed_m_s : {0.0, 1.3, 4.4, 5.0, 40.0}) {
      auto with = walk(1.0, speed_m_s);
      with.markers.x(100, 2).x() += wrong;
      auto without = with;
      reject_implausible(with, box_of(with));
      reject_implausible(without);
      EXPECT_EQ(with.warnings, without.warnings) << wrong << " " << speed_m_s;
      EXPECT_EQ(with.markers.state, without.markers.state);
    }
}

TEST(RejectImplausible, ASmallBoxIsBelieved) {
  auto trial = walk();
  trial.markers.x(100, 2).y() = 1e6;
  const Eigen::AlignedBox3d claimed(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(5.7));
  reject_implausible(trial, claimed);
  EXPECT_THAT(trial.warnings, IsEmpty()) << "no pass over the positions";
  reject_implausible(trial, Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(5.8)));
  EXPECT_EQ(trial.warnings.size(), 1U) << "10.05 m across: a sample may be wrong";
}

TEST(RejectImplausible, TheUnitIsDoubtedInASmallBoxToo) {
  auto trial = walk(0.0005);
  reject_implausible(trial, box_of(trial));
  ASSERT_EQ(trial.warnings.size(), 1U);
  EXPECT_THAT(trial.warnings[0], HasSubstr("so the unit (mm) is probably wrong"));
}

TEST(RejectImplausible, MarkersAtOnePointAreSaid) {
  auto trial = walk();
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < 4; ++m) trial.markers.x(f, m) = Eigen::Vector3d(1.0, 1.0, 1.0);
  reject_implausible(trial, box_of(trial));
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr(" lie all at one point")));
  EXPECT_EQ(trial.markers.count_missing(), 0);
}

TEST(RejectImplausible, WhatMovesOnIsLeftAlone) {
  for (auto trial :
       {walk(), walk(1.0, 10.0), walk(1.0, 40.0, 1000), walk(20.0), walk(0.01), walk(1.0, 1.3, 1)}) {
    const auto before = trial.markers.state;
    reject_implausible(trial);
    EXPECT_THAT(trial.warnings, IsEmpty());
    EXPECT_EQ(trial.markers.state, before);
  }
}

TEST(RejectImplausible, ALongGapMayBeCrossed) {
  auto trial = walk(1.0, 10.0, 1000);
  for (std::int64_t f = 100; f < 998; ++f) trial.markers.set_missing(f, 1);
  trial.markers.set_missing(999, 1);
  reject_implausible(trial);
  EXPECT_THAT(trial.warnings, IsEmpty()) << "90 m in 9 s, seen once at its end";
}

TEST(RejectImplausible, AStretchBeyondTheLaboratory) {
  auto trial = walk();
  for (std::int64_t f = 50; f < 60; ++f) trial.markers.x(f, 0).x() += 300.0;
  reject_implausible(trial);
  EXPECT_THAT(trial.warnings, ElementsAre(AllOf(HasSubstr("10 samples are"),
                                                HasSubstr("'HEAD' in frame 60, "), HasSubstr("and 4 more"))));
  EXPECT_EQ(trial.markers.count_missing(), 10);
}

TEST(RejectImplausible, ChannelsThatAreNoPositionsAreLeftAlone) {
  // Programs keep moments among the points, in Nmm as if they were millimetres.
  auto trial = walk();
  for (std::int64_t f = 0; f < 200; ++f)
    trial.markers.x(f, 3) = Eigen::Vector3d(90.0 * std::sin(0.05 * static_cast<double>(f)), 20.0, -3.0);
  reject_implausible(trial);
  EXPECT_THAT(trial.warnings, IsEmpty());
  trial.markers.x(30, 3).x() = 1e25;
  reject_implausible(trial);
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("'HEEL' in frame 40")));
}

TEST(RejectImplausible, TheSizeOfABodyTellsTheUnit) {
  for (const auto& [size, span] : {std::pair{0.001, "span 0.00165 m"}, {1000.0, "span 1.65e+03 m"}}) {
    auto trial = walk(size);
    reject_implausible(trial);
    EXPECT_THAT(trial.warnings, ElementsAre(AllOf(HasSubstr("the markers of frame "), HasSubstr(span),
                                                  HasSubstr("the unit (mm) is probably wrong"))))
        << size;
    EXPECT_EQ(trial.markers.count_missing(), 0) << "the whole recording is in doubt, not samples of it";
  }
}

TEST(RejectImplausible, NothingIsThere) {
  data::Trial empty;
  reject_implausible(empty);
  auto unseen = walk();
  unseen.markers = data::Trajectories::all_missing({"A", "B", "C"}, unseen.markers.time);
  reject_implausible(unseen);
  EXPECT_THAT(unseen.warnings, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io
