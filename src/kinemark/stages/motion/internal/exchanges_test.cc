// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/exchanges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Frames = std::vector<std::int64_t>;

class Exchanges : public ::testing::Test {
 protected:
  Exchanges()
      : model(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(model, 120, 0.5e-3, 3)),
        problem(make_problem(model, markers, {}).value()) {}

  /// Two markers of one body, and a third of it that is not as far from both.
  void find_trio(int& one, int& other) const {
    const auto& m = problem.model.markers();
    for (one = 0; one < problem.model.marker_count(); ++one)
      for (other = one + 1; other < problem.model.marker_count(); ++other)
        for (int k = 0; k < problem.model.marker_count(); ++k) {
          const auto place = [&](int i) { return m[static_cast<std::size_t>(i)]; };
          if (k == one || k == other || place(one).body != place(other).body ||
              place(k).body != place(one).body)
            continue;
          const double a = (place(one).x_in_body - place(k).x_in_body).norm(),
                       b = (place(other).x_in_body - place(k).x_in_body).norm();
          if (std::abs(a - b) > 0.02 && (place(one).x_in_body - place(other).x_in_body).norm() > 0.04) return;
        }
    FAIL() << "the body has no such markers";
  }

  void plant(int one, int other, const Frames& frames) {
    exchange_back(problem, {{.one = one, .other = other, .frames = frames}}, markers);
  }

  model::Model model;
  data::Trajectories markers;
  Problem problem;
};

TEST_F(Exchanges, NothingIsFoundInACleanRecording) {
  EXPECT_TRUE(find_path_exchanges(problem, markers).empty());
}

TEST_F(Exchanges, WhatWasPlantedIsFoundAndUndoneToTheBit) {
  const auto clean = markers;
  Frames frames;
  for (std::int64_t f = 5; f < 100; f += 4) frames.push_back(f);
  plant(2, 9, frames);
  EXPECT_NE(markers.x_in_world, clean.x_in_world);
  const auto found = find_path_exchanges(problem, markers);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].frames, frames);
  exchange_back(problem, found, markers);
  EXPECT_EQ(markers.x_in_world, clean.x_in_world);
}

TEST_F(Exchanges, TheModelTellsWhichHalfOfTheFramesIsWrong) {
  int one = 0, other = 0;
  find_trio(one, other);
  for (const std::int64_t first : {0, 1}) {
    Frames frames;
    for (std::int64_t f = first; f < 120; f += 2) frames.push_back(f);
    plant(one, other, frames);
    const auto found = find_path_exchanges(problem, markers);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].frames, frames) << first;
    plant(one, other, frames);  // as they were
  }
}

TEST_F(Exchanges, OnlyFramesInWhichBothNameEachOtherAreMutual) {
  std::vector<Outlier> outliers{{.marker = 1, .first_frame = 10, .last_frame = 20, .partner = 4},
                                {.marker = 4, .first_frame = 12, .last_frame = 25, .partner = 1},
                                {.marker = 2, .first_frame = 10, .last_frame = 20, .partner = 4},
                                {.marker = 5, .first_frame = 3, .last_frame = 3}};
  const auto found = take_mutual(outliers);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].one, 1);
  EXPECT_EQ(found[0].other, 4);
  EXPECT_EQ(found[0].frames.front(), 12);
  EXPECT_EQ(found[0].frames.back(), 20);
  ASSERT_EQ(outliers.size(), 4U);
  EXPECT_EQ(outliers[0].last_frame, 11) << "what only one of them names stays";
  EXPECT_EQ(outliers[0].partner, -1) << "it does not lie where the other should";
  EXPECT_EQ(outliers[1].first_frame, 21);
  EXPECT_EQ(outliers[2].last_frame, 20);
}

TEST_F(Exchanges, ASecondExchangeTakesTheFirstBack) {
  std::vector<Exchange> all{{.one = 1, .other = 4, .frames = {3, 5, 7}}};
  add_exchanges({{.one = 1, .other = 4, .frames = {5, 9}}, {.one = 0, .other = 2, .frames = {1}}}, all);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].frames, (Frames{3, 7, 9}));
  add_exchanges({{.one = 0, .other = 2, .frames = {1}}}, all);
  EXPECT_EQ(all.size(), 1U) << "nothing is left of it";
}

}  // namespace
}  // namespace kinemark::motion::internal
