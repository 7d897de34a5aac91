// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Feet that land in different ways: on the heel, flat, on the toes. What one errs by is not what the other
// does.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using testing::KnownWalk;

// The right foot of a walker, of which the heel is up by this angle while it lands and comes down within
// `down_s` after.
void put_on_toes(data::Trajectories& markers, KnownWalk of, double up_rad, double down_s) {
  constexpr double kBefore_s = 0.2;
  of.land_rad = 0.02, of.late_rad = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double t = markers.time.time_s(f),
                 after = std::remainder(t - of.strike_s(Side::right, 0), of.stride_s),
                 u = std::clamp(after < 0.0 ? 1.0 + after / kBefore_s : 1.0 - after / down_s, 0.0, 1.0),
                 angle = up_rad * u * u * (3.0 - 2.0 * u), c = std::cos(angle), s = std::sin(angle);
    const auto foot = of.foot_at(Side::right, t);
    const Eigen::Vector3d back = foot[0] - foot[1], level(back.x(), back.y(), 0.0);
    markers.x(f, 2) = foot[1] + (c - s * back.z() / level.norm()) * level +
                      Eigen::Vector3d(0.0, 0.0, s * level.norm() + c * back.z());
    markers.x(f, 3) = foot[1];
  }
}

// Another's right foot, at the same instants.
void put_on_anothers(data::Trajectories& markers, const KnownWalk& of, KnownWalk other) {
  other.speed_m_per_s = of.speed_m_per_s, other.stride_s = of.stride_s, other.stance = of.stance;
  other.right_later = of.right_later, other.width_m = of.width_m, other.heading_rad = of.heading_rad;
  other.first_strike_s = of.first_strike_s, other.duration_s = of.duration_s;
  const auto feet = other.markers(0.0003, 3);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (const std::int64_t m : {2, 3}) markers.x(f, m) = Eigen::Vector3d(feet.x(f, m));
}

MarkerEvents marker_events_of(const data::Trajectories& markers) {
  const auto which = find_gait_markers(markers).value();
  auto smoother = GaitSmoother::create(markers, which, 0.0).value();
  return find_marker_events(smoother, which).value();
}

// Left mean error of strikes less the right one, s; and the SD that is stated of one foot.
std::array<double, 2> difference_of(const MarkerEvents& found, const KnownWalk& walk) {
  std::array<double, 2> sum{}, count{};
  double foot_s = 0.0;
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    const auto& event = found.events[i];
    if (event.what != FootEvent::strike) continue;
    foot_s = found.fused[i].error.foot_s;
    for (const auto& truth : walk.events()) {
      if (truth.side != event.side || truth.what != event.what || std::abs(truth.time_s - event.time_s) > 0.2)
        continue;
      sum[data::index_of(event.side)] += event.time_s - truth.time_s,
          count[data::index_of(event.side)] += 1.0;
    }
  }
  return {sum[0] / count[0] - sum[1] / count[1], foot_s};
}

TEST(FootErrors, AreThoseOfFeetThatLandInDifferentWays) {
  Random random(21, 1);
  double squares = 0.0, stated = 0.0;
  int within = 0, all = 0;
  for (int k = 0; k < 60; ++k) {
    auto walk = KnownWalk::draw(random);
    walk.duration_s = 8.0;
    auto markers = walk.markers(0.0003, 3);
    const double up_rad = random.uniform(0.0, 0.6), down_s = random.uniform(0.05, 0.3);
    if (k % 2 == 0)
      put_on_toes(markers, walk, up_rad, down_s);
    else
      put_on_anothers(markers, walk, KnownWalk::draw(random));
    const auto [difference_s, foot_s] = difference_of(marker_events_of(markers), walk);
    squares += difference_s * difference_s, stated += 2.0 * foot_s * foot_s;
    within += std::abs(difference_s) < 2.0 * std::sqrt(2.0) * foot_s, ++all;
  }
  EXPECT_TRUE(squares / stated > 0.5 && squares / stated < 1.3) << squares / stated;
  EXPECT_GE(within, 0.9 * all);
}

TEST(FootErrors, AreSmallWhereBothLandAlike) {
  for (const double seed : {1.0, 2.0, 3.0}) {
    Random random(static_cast<std::uint64_t>(seed), 2);
    const auto found = marker_events_of(KnownWalk::draw(random).markers(0.0003, 3));
    for (const auto& fused : found.fused) EXPECT_LT(fused.error.foot_s, 0.006);
  }
}

TEST(FootErrors, ReachStepTimesAndNoStrideTime) {
  const KnownWalk walk;
  const auto even = walk.markers(0.0003, 3);
  auto uneven = even;
  put_on_toes(uneven, walk, 0.5, 0.1);
  const GaitOptions options{.measures = {"step_time", "stride_time"}, .refits = 39};
  const auto one = analyze_gait(even, {}, options).value(), two = analyze_gait(uneven, {}, options).value();
  ASSERT_EQ(one.measures.size(), two.measures.size());
  for (std::size_t i = 0; i < one.measures.size(); ++i)
    if (one.measures[i].id == "step_time") {
      EXPECT_GT(two.measures[i].sd, 2.0 * one.measures[i].sd);
    } else {
      EXPECT_LT(two.measures[i].sd, 1.5 * one.measures[i].sd);
    }
}

}  // namespace
}  // namespace kinemark::analysis
