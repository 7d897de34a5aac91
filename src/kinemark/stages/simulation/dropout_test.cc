// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/dropout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinemark/stages/simulation/internal/motion.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stages/simulation/testing/models.h"

namespace kinemark::simulation {
namespace {

double missing_share(const data::Trajectories& t) {
  return static_cast<double>(t.count_missing()) / static_cast<double>(t.frames() * t.markers());
}

// Durations of all gaps, s.
std::vector<double> gap_lengths(const data::Trajectories& t) {
  std::vector<double> out;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    std::int64_t length = 0;
    for (std::int64_t f = 0; f <= t.frames(); ++f) {
      if (f < t.frames() && !t.present(f, m)) {
        ++length;
      } else if (length > 0) {
        out.push_back(static_cast<double>(length) / t.time.rate_hz);
        length = 0;
      }
    }
  }
  std::ranges::sort(out);
  return out;
}

// P(lost | lost one stride earlier) of a walk on the spot, in which every pose comes back after a stride.
double repeat_rate(const SubjectOptions& options) {
  const auto s = simulate_subject(human(), options).value();
  const internal::Motion motion(human(), options);
  const auto stride = static_cast<std::int64_t>(std::llround(options.rate_hz / motion.stride_hz()));
  double lost = 0.0, again = 0.0;
  for (std::int64_t f = stride; f < s.markers.frames(); ++f)
    for (std::int64_t m = 0; m < s.markers.markers(); ++m)
      if (!s.markers.present(f - stride, m)) {
        lost += 1.0;
        again += !s.markers.present(f, m);
      }
  return again / lost;
}

TEST(Dropout, SharesAreExact) {
  for (const double share : {0.0, 0.05, 0.3, 0.9}) {
    const SubjectOptions chance{.rate_hz = 10.0, .dropout_random = share};
    const SubjectOptions sight{.duration_s = 5.0, .rate_hz = 10.0, .dropout_sight = share};
    EXPECT_NEAR(missing_share(simulate_subject(human(), chance).value().markers), share, 5e-4);
    EXPECT_NEAR(missing_share(simulate_subject(human(), sight).value().markers), share, 5e-4);
  }
  const double both =
      missing_share(simulate_subject(human(), {.rate_hz = 10.0, .dropout_random = 0.1, .dropout_sight = 0.2})
                        .value()
                        .markers);
  EXPECT_NEAR(both, 1.0 - 0.9 * 0.8, 0.03) << "drawn on their own, so they may coincide";
}

TEST(Dropout, RandomGapsLastAsSaid) {
  const TimeBase time{.rate_hz = 200.0, .frames = 20000};
  auto t = data::Trajectories::all_missing(std::vector<std::string>(40), time);
  const auto lost = internal::random_gaps(time.frames, 40, {.rate_hz = time.rate_hz, .dropout_random = 0.02});
  for (std::size_t i = 0; i < lost.size(); ++i)
    t.state[i] = lost[i] != 0 ? data::SampleState::missing : data::SampleState::measured;
  const auto gaps = gap_lengths(t);
  ASSERT_GT(gaps.size(), 200u);
  const double mean = std::accumulate(gaps.begin(), gaps.end(), 0.0) / static_cast<double>(gaps.size());
  EXPECT_NEAR(mean, 0.7 * 0.06 + 0.3 * 0.5, 0.04);
  EXPECT_NEAR(gaps[gaps.size() / 2], 0.075, 0.025) << "median of the mixture";
  EXPECT_GT(gaps.back(), 1.0) << "some are long";
  for (std::int64_t m = 0; m < 40; ++m) {
    bool any = false;
    for (std::int64_t f = 0; f < time.frames; ++f) any = any || !t.present(f, m);
    EXPECT_TRUE(any) << "every marker is hit in the end";
  }
}

TEST(Dropout, SightFollowsThePoseAndChanceDoesNot) {
  const SubjectOptions walk{.motion = MotionKind::walk, .duration_s = 10.0, .rate_hz = 30.0};
  SubjectOptions sight = walk, chance = walk;
  sight.dropout_sight = 0.15;
  chance.dropout_random = 0.15;
  EXPECT_GT(repeat_rate(sight), 0.85);
  EXPECT_LT(repeat_rate(chance), 0.3);
}

TEST(Dropout, SightGapsLastAsLongAsLimbsHide) {
  const auto s =
      simulate_subject(human(), {.duration_s = 15.0, .rate_hz = 20.0, .dropout_sight = 0.1}).value();
  const auto gaps = gap_lengths(s.markers);
  const double mean = std::accumulate(gaps.begin(), gaps.end(), 0.0) / static_cast<double>(gaps.size());
  EXPECT_GT(mean, 0.1);
  EXPECT_LT(mean, 1.5);
}

TEST(Dropout, NoMarkerIsHiddenForGood) {
  const auto s =
      simulate_subject(human(), {.duration_s = 15.0, .rate_hz = 10.0, .dropout_sight = 0.2}).value();
  for (std::int64_t m = 0; m < s.markers.markers(); ++m) {
    std::int64_t seen = 0;
    for (std::int64_t f = 0; f < s.markers.frames(); ++f) seen += s.markers.present(f, m);
    EXPECT_GT(seen, s.markers.frames() / 4) << s.markers.names[static_cast<std::size_t>(m)];
  }
}

TEST(Dropout, WhatTurnsAwayFromTheCamerasIsLostFirst) {
  // The hanging arm's marker looks sideways; when the arm is lifted so far that it looks up, cameras at 1
  // and 2.5 m see it worse. Both lists come from one call, so only the ranking is tested, not its threshold.
  const auto model = model::Model::compile(small_arm()).value();
  const internal::Segments segments(model);
  Eigen::MatrixXd states = model.default_state().replicate(1, 100);
  for (int f = 50; f < 100; ++f) states(model.coordinates()[0].state_idx, f) = 0.5 * 3.14159 + 0.001 * f;
  const auto lost = internal::lines_of_sight(model, segments, states, {.dropout_sight = 0.1});
  int hanging = 0, lifted = 0;
  for (int f = 0; f < 100; ++f) (f < 50 ? hanging : lifted) += lost[static_cast<std::size_t>(f * 4 + 1)];
  EXPECT_NE(hanging, lifted);
  EXPECT_TRUE(hanging == 0 || lifted == 0) << "one of the two poses is the worse one, in all its frames";
}

}  // namespace
}  // namespace kinemark::simulation
