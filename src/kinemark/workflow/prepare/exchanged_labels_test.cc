// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/exchanged_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/foundations/testing/walking_body.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A foot of three markers that swings, frames counted from 5.
data::Trial swinging_foot() {
  data::Trial trial;
  auto& t = trial.markers;
  t = data::Trajectories::all_missing({"HEEL", "TOE", "MT5"},
                                      {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200, .first_number = 5});
  trial.first_frame = 5;
  Random random(1, 1);
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      const double s = t.time.time_s(f);
      const Eigen::Vector3d sites[] = {{0, 0, 0}, {0.2, 0.02, 0}, {0.17, 0.07, 0}};
      t.x(f, m) = sites[m] + Eigen::Vector3d(s + 0.2 * std::sin(6 * s), 0, 0.1 * std::cos(6 * s)) +
                  0.0003 * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  return trial;
}

data::Finding every_third() {
  data::Finding swap{.kind = data::FindingKind::label_swap, .subject = "TOE", .partner = "MT5"};
  for (std::int64_t f = 1; f < 130; f += 3) swap.frames.push_back(f);
  swap.first_frame = swap.frames.front();
  swap.last_frame = swap.frames.back();
  return swap;
}

TEST(ExchangedLabels, AnEditHasTheFilesOwnFrames) {
  const auto trial = swinging_foot();
  auto swap = every_third();
  auto edit = edit_of(swap, trial);
  EXPECT_EQ(edit.frames, "6-132/3");
  EXPECT_FALSE(edit.first_frame);
  EXPECT_TRUE(edit.check());
  swap.frames.clear();
  edit = edit_of(swap, trial);
  EXPECT_EQ(edit.frames, "");
  EXPECT_EQ(edit.first_frame, 6);
  EXPECT_EQ(edit.last_frame, 132);
}

TEST(ExchangedLabels, WhatIsFoundIsUndoneToTheBitAndSaysSo) {
  const auto clean = swinging_foot();
  auto trial = clean;
  ASSERT_TRUE(exchange_back(trial, std::vector{every_third()}));
  trial.markers.method.clear();
  trial.markers.methods.clear();
  EXPECT_NE(trial.markers.x_in_world, clean.markers.x_in_world);
  const auto found = find_label_swaps(trial).value();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].frames, every_third().frames);
  ASSERT_EQ(sure_swaps(found).size(), 1U);
  const auto screening = screen_markers(trial, {.exchange_back = true, .reject_defects = true}).value();
  EXPECT_EQ(screening.exchanged.size(), 1U);
  EXPECT_TRUE(screening.sure.empty());
  EXPECT_FALSE(screening.rejected);
  EXPECT_EQ(trial.markers.x_in_world, clean.markers.x_in_world);
  EXPECT_EQ(trial.markers.made_by(1, 1), "exchanged with MT5");
  EXPECT_EQ(trial.markers.made_by(1, 2), "exchanged with TOE");
  EXPECT_EQ(trial.markers.made_by(2, 1), "") << "as recorded";
  EXPECT_EQ(trial.markers.made_by(1, 0), "");
  EXPECT_EQ(trial.markers.state[trial.markers.index(1, 1)], data::SampleState::measured);
}

/// Two labels of a walking body exchanged from a frame on.
data::Trial walk_with(const std::string& one, const std::string& other, std::int64_t first) {
  data::Trial trial;
  auto& t = trial.markers;
  t = motion::testing::walking_body(
      {"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"}, 120);
  const auto a = t.find(one), b = t.find(other);
  for (std::int64_t f = first; f < t.frames(); ++f) {
    const Eigen::Vector3d kept = t.x(f, a);
    t.x(f, a) = t.x(f, b);
    t.x(f, b) = kept;
  }
  return trial;
}

TEST(ExchangedLabels, TheBodySaysWhichHalfIsRight) {
  const auto clean = walk_with("LKNE", "LKNE", 0);
  for (const auto& [one, other] : {std::pair("LKNE", "RKNE"), std::pair("LASI", "LPSI")})
    for (const std::int64_t first : {36, 84}) {
      auto trial = walk_with(one, other, first);
      const auto found = sure_swaps(find_label_swaps(trial).value());
      ASSERT_EQ(found.size(), 1U) << one << " " << first;
      EXPECT_EQ(std::pair(found[0].first_frame, found[0].last_frame), std::pair(first, std::int64_t{119}));
      if (found[0].subject.ends_with("KNE"))  // of LASI and LPSI the right side's distances say it
        EXPECT_THAT(found[0].description,
                    HasSubstr("; the other frames are right, as a body has markers of these names there"));
      ASSERT_TRUE(screen_markers(trial, {.exchange_back = true}));
      EXPECT_EQ(trial.markers.x_in_world, clean.markers.x_in_world);
    }
}

TEST(ExchangedLabels, OfNamesThatNoBodyHasTheFewerFramesAreNamed) {
  auto trial = walk_with("LKNE", "RKNE", 36);
  for (std::size_t m = 0; m < trial.markers.names.size(); ++m)
    trial.markers.names[m] = "point " + std::to_string(m);
  const auto found = find_label_swaps(trial).value();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].first_frame, found[0].last_frame),
            (std::pair<std::int64_t, std::int64_t>(0, 35)));
  EXPECT_THAT(found[0].description,
              Not(HasSubstr("; the other frames are right, as a body has markers of these names there")));
}

TEST(ExchangedLabels, OfACleanRecordingNothingIsSaid) {
  auto trial = swinging_foot();
  const auto before = trial.markers.x_in_world;
  EXPECT_TRUE(find_label_swaps(trial).value().empty());
  EXPECT_TRUE(screen_markers(trial, {.exchange_back = true}).value().exchanged.empty());
  EXPECT_EQ(trial.markers.x_in_world, before);
  EXPECT_TRUE(trial.markers.methods.empty());
}

TEST(ExchangedLabels, OnlyWhatIsSureIsUndone) {
  auto swap = every_third();
  swap.confidence = 0.6;
  EXPECT_TRUE(sure_swaps(std::vector{swap}).empty());
  swap.confidence = 0.9;
  EXPECT_EQ(sure_swaps(std::vector{swap}).size(), 1U);
  swap.kind = data::FindingKind::swap_within;
  EXPECT_TRUE(sure_swaps(std::vector{swap}).empty());
}

TEST(ExchangedLabels, MarkersThatAreNotThereAreRefusedAndNothingChanges) {
  auto trial = swinging_foot();
  const auto before = trial.markers.x_in_world;
  auto swap = every_third();
  swap.partner = "NOSE";
  EXPECT_FALSE(exchange_back(trial, std::vector{swap}));
  EXPECT_EQ(trial.markers.x_in_world, before);
}

}  // namespace
}  // namespace kinemark::workflow
