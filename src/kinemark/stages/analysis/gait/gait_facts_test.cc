// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_facts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Eigen::RowVector2d;
using Eigen::Vector2d;

// Six seconds at 100 Hz: heels that stand from strike to strike. Left strikes at 0.5 s, right 0.52 s later,
// each again after 1 s; a stride is 1.2 m, the right heel 0.66 m before the left one and 0.1 m beside it.
struct Stepping {
  double turn_rad = 0.0;                // of the laboratory about the vertical
  Vector2d place{0.0, 0.0};             // where it begins, m
  double later_s = 0.0;                 // of the clock
  RowVector2d ground{0.0, 0.0};         // how the ground moves, m/s
  bool mirrored = false;                // left and right change places
  double beside_m = 0.1;                // of the right heel from the left one's line
  static constexpr double kOff = 0.62;  // s of stance

  [[nodiscard]] Side side(Side of) const { return mirrored ? data::opposite(of) : of; }
  [[nodiscard]] static double strike_s(Side of, int step) { return step + (of == Side::left ? 0.5 : 1.02); }
  [[nodiscard]] Vector2d heel_at(Side of, double time_s) const {
    const double step = std::floor(time_s - strike_s(of, 0) + 1e-9), right = of == Side::right ? 1.0 : 0.0;
    const Vector2d x(1.2 * step + 0.66 * right, (mirrored ? 1.0 : -1.0) * beside_m * right);
    return place + Eigen::Rotation2Dd(turn_rad) * x;
  }
  [[nodiscard]] GaitPaths paths() const {
    GaitPaths out{
        .rate_hz = 100.0, .start_s = later_s, .feet = {}, .pelvis = math::SeriesMatrix::Zero(600, 3)};
    for (const Side of : data::kBothSides) {
      auto& foot = out.feet[data::index_of(side(of))];
      foot.heel = foot.toe = math::SeriesMatrix::Zero(600, 3);
      foot.known.assign(600, true);
      for (int f = 0; f < 600; ++f)
        foot.heel.row(f).leftCols<2>() = heel_at(of, 0.01 * f).transpose() + 0.01 * f * ground;
    }
    return out;
  }
  [[nodiscard]] std::vector<data::GaitEvent> events() const {
    std::vector<data::GaitEvent> out;
    for (const Side of : data::kBothSides)
      for (int step = 0; strike_s(of, step) < 5.9; ++step) {
        out.push_back({.side = side(of), .what = FootEvent::strike, .time_s = later_s + strike_s(of, step)});
        out.push_back(
            {.side = side(of), .what = FootEvent::off, .time_s = later_s + strike_s(of, step) + kOff});
      }
    return out;
  }
  [[nodiscard]] std::vector<GaitCycle> cycles() const { return find_cycles(paths(), events(), ground); }
};

void expect_the_steps_of(const Stepping& walk) {
  const auto cycles = walk.cycles();
  ASSERT_EQ(cycles.size(), 9u);  // five of the left foot, four of the right
  int of_left = 0;
  for (const auto& cycle : cycles) {
    const bool left = cycle.side == walk.side(Side::left);
    of_left += left;
    EXPECT_NEAR(cycle.end_s - cycle.start_s, 1.0, 1e-9);
    EXPECT_NEAR(cycle.off_s - cycle.start_s, 0.62, 1e-9);
    EXPECT_NEAR(cycle.other_strike_s - cycle.start_s, left ? 0.52 : 0.48, 1e-9);
    if (left && cycle.start_s < walk.later_s + 0.6)
      EXPECT_TRUE(std::isnan(cycle.other_off_s));  // the step that ends there began before the recording
    else
      EXPECT_NEAR(cycle.other_off_s - cycle.start_s, left ? 0.14 : 0.10, 1e-9);
    if (!std::isfinite(cycle.stride_length())) continue;
    EXPECT_NEAR(cycle.stride_length(), 1.2, 1e-9);
    EXPECT_NEAR(cycle.step_length(), left ? 0.66 : 0.54, 1e-9);
    EXPECT_NEAR(cycle.step_width(), walk.beside_m, 1e-9);
    EXPECT_NEAR(cycle.print.sd, 0.0, 1e-7);
  }
  EXPECT_EQ(of_left, 5);
  EXPECT_TRUE(std::isfinite(cycles[1].stride_length()) && std::isfinite(cycles[6].stride_length()));
}

TEST(FindCycles, HaveTheTimesAndPrintsOfTheWalk) { expect_the_steps_of({}); }
TEST(FindCycles, DoNotDependOnWhereTheLaboratoryStands) {
  for (const double turn : {0.7, 1.6, 3.1, -2.2})
    expect_the_steps_of({.turn_rad = turn, .place = {3.0, -40.0}});
}
TEST(FindCycles, DoNotDependOnTheClock) { expect_the_steps_of({.later_s = 12.5}); }
TEST(FindCycles, LeftAndRightAreSwappedInTheMirror) { expect_the_steps_of({.mirrored = true}); }
TEST(FindCycles, AreThoseOverGroundOnATreadmill) {
  expect_the_steps_of({.ground = {-1.2, 0.0}});
  expect_the_steps_of({.turn_rad = 0.5, .ground = {-0.9, 0.4}, .mirrored = true});
}
TEST(FindCycles, FeetThatCrossHaveANegativeWidth) { expect_the_steps_of({.beside_m = -0.03}); }

TEST(FindCycles, DoNotDependOnTheOrderOfEvents) {
  const Stepping walk;
  auto events = walk.events();
  std::ranges::reverse(events);
  const auto cycles = find_cycles(walk.paths(), events, walk.ground), sorted = walk.cycles();
  ASSERT_EQ(cycles.size(), sorted.size());
  for (std::size_t i = 0; i < cycles.size(); ++i) EXPECT_EQ(cycles[i].start_s, sorted[i].start_s);
}

TEST(FindCycles, ALostStrikeMakesNoLongCycle) {
  const Stepping walk;
  auto events = walk.events();
  std::erase_if(events, [](const auto& e) {
    return e.side == Side::left && e.what == FootEvent::strike && std::abs(e.time_s - 2.5) < 1e-6;
  });
  const auto cycles = find_cycles(walk.paths(), events, walk.ground);
  EXPECT_EQ(cycles.size(), 7u);  // the two that meet at it are gone
  for (const auto& cycle : cycles) EXPECT_NEAR(cycle.end_s - cycle.start_s, 1.0, 1e-9);
  // The other foot's cycle keeps its times, and has no step of this one.
  const auto& of_right = cycles[4];
  EXPECT_EQ(of_right.side, Side::right);
  EXPECT_NEAR(of_right.start_s, 2.02, 1e-9);
  EXPECT_NEAR(of_right.stride_length(), 1.2, 1e-9);
  EXPECT_TRUE(std::isnan(of_right.other_strike_s) && std::isnan(of_right.step_length()));
  EXPECT_EQ(std::ranges::count_if(cycles, [](const auto& c) { return std::isnan(c.other_strike_s); }), 1);
}

TEST(FindCycles, AStrikeThatWasNotSeenLeavesNoPrint) {
  const Stepping walk;
  auto events = walk.events();
  std::erase_if(events, [](const auto& e) { return e.side == Side::right; });
  for (const auto& cycle : find_cycles(walk.paths(), events, walk.ground)) {
    EXPECT_TRUE(std::isnan(cycle.other_strike_s));
    EXPECT_TRUE(cycle.other_print.x.hasNaN());
    EXPECT_TRUE(std::isnan(cycle.step_length()) && std::isnan(cycle.step_width()));
  }
}

TEST(FindCycles, LastFromThreeTenthsOfASecondToSix) {
  const Stepping walk;
  for (const auto& [duration_s, is_one] :
       {std::pair{0.29, false}, std::pair{0.31, true}, std::pair{5.99, true}, std::pair{6.01, false}}) {
    const std::vector<data::GaitEvent> events{
        {.side = Side::left, .what = FootEvent::strike, .time_s = 1.0},
        {.side = Side::left, .what = FootEvent::strike, .time_s = 1.0 + duration_s}};
    EXPECT_EQ(find_cycles(walk.paths(), events, walk.ground).size() == 1u, is_one) << duration_s;
  }
  EXPECT_TRUE(find_cycles(walk.paths(), {}, walk.ground).empty());
}

TEST(FindCycles, APrintIsTheMeanFrom20To45PercentOfTheStance) {
  const Stepping walk;
  auto paths = walk.paths();
  auto& heel = paths.feet[0].heel;
  for (int f = 0; f < 600; ++f) heel.row(f).leftCols<2>() = RowVector2d(0.003 * f, 0.0);  // slides
  const auto with_off = find_cycles(paths, walk.events(), walk.ground);
  // 0.124 to 0.279 s after the strike: frames 12 to 28.
  EXPECT_NEAR(with_off[1].print.x.x(), 0.003 * (150 + 20), 1e-9);
  const double variance = (17.0 * 17.0 - 1.0) / 12.0;  // of frames evenly spaced
  EXPECT_NEAR(with_off[1].print.sd, 0.003 * std::sqrt(0.5 * variance), 1e-9);
  auto strikes = walk.events();
  std::erase_if(strikes, [](const auto& e) { return e.what == FootEvent::off; });
  const auto without = find_cycles(paths, strikes, walk.ground);
  EXPECT_NEAR(without[1].print.x.x(), 0.003 * (150 + 0.5 * (12 + 27)), 1e-9);  // 60 % of the cycle
  EXPECT_TRUE(std::isnan(without[1].off_s));
}

TEST(FindCycles, AHeelThatWasNotSeenHasNoPrint) {
  const Stepping walk;
  auto paths = walk.paths();
  paths.feet[0].known[165] = false;  // within the stance from 1.5 s
  const auto cycles = find_cycles(paths, walk.events(), walk.ground);
  EXPECT_TRUE(cycles[1].print.x.hasNaN());
  EXPECT_TRUE(cycles[0].next_print.x.hasNaN());
  EXPECT_FALSE(cycles[2].print.x.hasNaN());
  EXPECT_NEAR(cycles[1].end_s, 2.5, 1e-9);
  paths.feet[1] = {};
  for (const auto& cycle : find_cycles(paths, walk.events(), walk.ground))
    EXPECT_TRUE((cycle.side == Side::right ? cycle.print : cycle.other_print).x.hasNaN());
}

TEST(Bridges, AreStrikesBetweenWhichOneIsMissing) {
  std::vector<data::GaitEvent> events;
  for (const double t : {0.0, 1.0, 2.0, 3.0, 5.0, 6.0})  // the strike at 4 s is missing
    events.push_back({.side = Side::left, .what = FootEvent::strike, .time_s = t});
  for (const double t : {0.5, 1.5, 2.5})
    events.push_back({.side = Side::right, .what = FootEvent::strike, .time_s = t});
  const auto bridges = find_bridges(events);
  ASSERT_EQ(bridges.size(), 1u);
  EXPECT_EQ(bridges[0].side, Side::left);
  EXPECT_EQ(bridges[0].start_s, 3.0);
  EXPECT_EQ(bridges[0].end_s, 5.0);
  EXPECT_NEAR(bridges[0].strides, 2.0, 1e-12);
  // Without the gap there is none; two leavings within a stride tell too, where there is nothing to compare
  // with.
  std::vector<data::GaitEvent> two{{.side = Side::left, .what = FootEvent::strike, .time_s = 0.0},
                                   {.side = Side::left, .what = FootEvent::off, .time_s = 0.3},
                                   {.side = Side::left, .what = FootEvent::strike, .time_s = 0.95}};
  EXPECT_TRUE(find_bridges(two).empty());
  two.push_back({.side = Side::left, .what = FootEvent::off, .time_s = 0.75});
  EXPECT_EQ(find_bridges(two).size(), 1u);
}

TEST(Strides, AreJudgedOnceAndKeptWhereTheirEventsErr) {
  const Stepping walk;
  std::vector<data::GaitEvent> events;
  for (const double time_s : {0.0, 5.99, 11.97})
    events.push_back({.side = Side::left, .what = FootEvent::strike, .time_s = time_s});
  const auto strides = find_strides(events);
  ASSERT_EQ(strides.size(), 2u);
  EXPECT_EQ(strides[1].start, 1u);
  EXPECT_EQ(strides[1].end, 2u);
  events[2].time_s = 12.1;
  const auto cycles = cycles_of(walk.paths(), events, strides, walk.ground);
  ASSERT_EQ(cycles.size(), 2u) << "of 6.11 s";
  EXPECT_EQ(cycles[1].end_s, 12.1);
  EXPECT_EQ(find_cycles(walk.paths(), events, walk.ground).size(), 1u);
  events[1].time_s = NAN;  // found no more
  EXPECT_TRUE(cycles_of(walk.paths(), events, strides, walk.ground).empty());
}

TEST(Bridges, AreNoCycles) {
  const Stepping walker;
  auto events = walker.events();
  const auto before = find_cycles(walker.paths(), events, walker.ground).size();
  std::erase_if(events, [](const auto& event) {
    return event.side == Side::left && std::abs(event.time_s - 2.5) < 0.3;
  });
  const auto cycles = find_cycles(walker.paths(), events, walker.ground);
  EXPECT_EQ(cycles.size(), before - 2);
  for (const auto& cycle : cycles) EXPECT_LT(cycle.end_s - cycle.start_s, 1.2);
}

TEST(Cycles, OfBackwardWalkingHaveTheirWidthsTheRightWayRound) {
  const Stepping walker;
  const auto cycles = find_cycles(walker.paths(), walker.events(), walker.ground),
             backward = find_cycles(walker.paths(), walker.events(), walker.ground, true);
  ASSERT_EQ(cycles.size(), backward.size());
  for (std::size_t i = 0; i < cycles.size(); ++i)
    if (std::isfinite(cycles[i].step_width())) {
      EXPECT_EQ(cycles[i].step_width(), -backward[i].step_width());
    }
}

}  // namespace
}  // namespace kinemark::analysis
