// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

using data::InterpolationKernel;

/// Largest residual over the frames that are predicted, and how many those are.
std::pair<double, int> worst(const std::vector<double>& y, int factor, int phase,
                             InterpolationKernel kernel) {
  Knots knots;
  std::vector<double> out(y.size());
  EXPECT_TRUE(residuals(y, factor, phase, kernel, knots, out));
  std::pair<double, int> result{0.0, 0};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] == kNotPredicted) continue;
    result.first = std::max(result.first, std::abs(out[i]));
    ++result.second;
    EXPECT_NE(static_cast<int>(i) % factor, phase);
  }
  return result;
}

std::vector<double> sampled(int n, double (*f)(double)) {
  std::vector<double> y;
  for (int i = 0; i < n; ++i) y.push_back(f(0.01 * i));
  return y;
}

TEST(Residuals, EachKernelReproducesThePolynomialsItShould) {
  const auto line = sampled(400, [](double x) { return 3.0 - 2.0 * x; });
  const auto parabola = sampled(400, [](double x) { return 1.0 + x - 4.0 * x * x; });
  const auto cubic = sampled(400, [](double x) { return x * x * x - 2.0 * x * x; });
  for (const InterpolationKernel k :
       {InterpolationKernel::linear, InterpolationKernel::spline, InterpolationKernel::catmull_rom,
        InterpolationKernel::lagrange, InterpolationKernel::pchip, InterpolationKernel::akima})
    EXPECT_LT(worst(line, 4, 1, k).first, 1e-12) << to_string(k);
  EXPECT_NEAR(worst(line, 4, 1, InterpolationKernel::hold).first, 0.06, 1e-9);
  for (const InterpolationKernel k :
       {InterpolationKernel::catmull_rom, InterpolationKernel::lagrange, InterpolationKernel::akima})
    EXPECT_LT(worst(parabola, 4, 1, k).first, 1e-12) << to_string(k);
  EXPECT_LT(worst(cubic, 4, 1, InterpolationKernel::lagrange).first, 1e-12);
  // A natural spline is wrong at the ends only, by 0.27 per knot inwards: 8 knots in, little is left.
  EXPECT_LT(worst(cubic, 4, 1, InterpolationKernel::spline).first, 1e-6);
  EXPECT_GT(worst(cubic, 4, 1, InterpolationKernel::catmull_rom).first, 1e-7);
  EXPECT_GT(worst(parabola, 4, 1, InterpolationKernel::linear).first, 1e-3);
}

TEST(Residuals, LagrangeAndCatmullRomAreOneFormulaAtFactorTwo) {
  Random random(1, 1);
  std::vector<double> y(200);
  for (double& v : y) v = random.gaussian();
  Knots knots;
  std::vector<double> a(y.size());
  std::vector<double> b(y.size());
  ASSERT_TRUE(residuals(y, 2, 0, InterpolationKernel::lagrange, knots, a));
  ASSERT_TRUE(residuals(y, 2, 0, InterpolationKernel::catmull_rom, knots, b));
  for (std::size_t i = 0; i < y.size(); ++i)
    if (a[i] != kNotPredicted) {
      EXPECT_NEAR(a[i], b[i], 1e-12);
    }
}

TEST(Residuals, PchipDoesNotOvershoot) {
  Random random(2, 1);
  std::vector<double> y(400);
  for (double& v : y) v = random.gaussian();
  Knots knots;
  std::vector<double> out(y.size());
  ASSERT_TRUE(residuals(y, 4, 0, InterpolationKernel::pchip, knots, out));
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (out[i] == kNotPredicted) continue;
    const double made = y[i] - out[i];
    const std::size_t left = i / 4 * 4;
    EXPECT_GE(made, std::min(y[left], y[left + 4]) - 1e-12);
    EXPECT_LE(made, std::max(y[left], y[left + 4]) + 1e-12);
  }
}

TEST(Residuals, LeavesOutTheEndsAndRefusesShortStretches) {
  const std::vector<double> y(100, 1.0);
  // Knots 0, 4, ..., 96: 25 of them. Intervals from the third to the third last knot, three frames in each.
  EXPECT_EQ(worst(y, 4, 0, InterpolationKernel::linear).second, 3 * (25 - 5));
  EXPECT_EQ(worst(y, 4, 0, InterpolationKernel::spline).second, 3 * (25 - 17));
  Knots knots;
  std::vector<double> out(30);
  EXPECT_FALSE(residuals(std::vector<double>(30, 1.0), 4, 0, InterpolationKernel::linear, knots, out));
  EXPECT_FALSE(residuals(std::vector<double>(30, 1.0), 4, 3, InterpolationKernel::spline, knots, out));
  std::vector<double> none;
  EXPECT_FALSE(residuals({}, 2, 1, InterpolationKernel::hold, knots, none));
}

using data::InterpolationKernel;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A marker on a smooth path, missing in the frames for which `gap` holds.
template <class Gap>
data::Trajectories path(std::int64_t frames, const Gap& gap) {
  auto t = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    if (gap(f)) continue;
    const double s = 0.01 * static_cast<double>(f);
    t.x(f, 0) = Eigen::Vector3d(std::sin(s), std::cos(2.0 * s), s);
    t.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  return t;
}

std::vector<double> noise(int n, double sd, double step = 0.0) {
  Random random(4, 9);
  std::vector<double> y;
  for (int i = 0; i < n; ++i) {
    const double value = 0.3 + std::sin(0.05 * i) + sd * random.gaussian();
    y.push_back(step > 0.0 ? step * std::round(value / step) : value);
  }
  return y;
}

/// Rows in which these phases win by a factor of e^2, one block each 100 frames.
PhaseTable table_of(int factor, const std::vector<int>& winners) {
  PhaseTable table{.factor = factor};
  for (std::size_t r = 0; r < winners.size(); ++r) {
    for (int p = 0; p < factor; ++p) table.log_residual.push_back(p == winners[r] ? -9.0F : -7.0F);
    table.log_rounding.push_back(-12.0F);
    table.frame.push_back(50 + 100 * static_cast<std::int64_t>(r));
  }
  return table;
}

std::vector<int> phases(const std::vector<data::PhaseRun>& runs) {
  std::vector<int> out;
  for (const auto& run : runs) out.push_back(run.phase);
  return out;
}

TEST(RoundingStep, IsThatOfTheNumbers) {
  for (const double step : {1e-4, 2e-4, 5e-4})
    EXPECT_NEAR(rounding_step_m(noise(2000, 0.001, step)), step, 1e-3 * step) << step;
}

TEST(RoundingStep, OfUnroundedNumbersIsFarBelowTheirNoise) {
  EXPECT_LT(rounding_step_m(noise(2000, 0.001)), 3e-4);
}

TEST(RoundingStep, StaysWithinItsBounds) {
  EXPECT_LE(rounding_step_m(noise(500, 0.5, 0.25)), 1e-3) << "a millimetre at most";
  const std::vector<double> constant(100, 1.5);
  EXPECT_NEAR(rounding_step_m(constant), 6e-8 * 1.5, 1e-15) << "single precision, where nothing differs";
  EXPECT_GT(rounding_step_m(std::vector<double>(100, 0.0)), 0.0);
  EXPECT_GT(rounding_step_m({}), 0.0);
}

TEST(Pieces, AreTheAxesOfEveryCompleteStretch) {
  const auto t = path(200, [](std::int64_t f) { return f == 60 || (f >= 100 && f < 110); });
  const auto pieces = pieces_of(t, 0, 0);
  ASSERT_THAT(pieces, SizeIs(9)) << "three spans of three axes";
  for (std::size_t k = 0; k < 9; ++k) {
    const std::int64_t first[] = {0, 61, 110};
    const std::size_t length[] = {60, 39, 90};
    EXPECT_EQ(pieces[k].first_frame, first[k / 3]);
    ASSERT_EQ(pieces[k].y.size(), length[k / 3]);
    for (std::size_t i = 0; i < pieces[k].y.size(); ++i)
      EXPECT_EQ(pieces[k].y[i], t.x(first[k / 3] + static_cast<std::int64_t>(i), 0)[static_cast<int>(k % 3)]);
    EXPECT_GT(pieces[k].step_m, 0.0);
  }
}

TEST(Pieces, LeaveOutStretchesThatAreTooShortToTest) {
  const std::int64_t least = min_stretch(2, InterpolationKernel::linear);
  EXPECT_THAT(pieces_of(path(least - 1, [](std::int64_t) { return false; }), 0, 0), IsEmpty());
  EXPECT_THAT(pieces_of(path(least, [](std::int64_t) { return false; }), 0, 0), SizeIs(3));
  EXPECT_THAT(pieces_of(path(500, [](std::int64_t f) { return f % 10 == 0; }), 0, 0), IsEmpty());
  EXPECT_THAT(pieces_of(path(500, [](std::int64_t) { return true; }), 0, 0), IsEmpty());
}

TEST(Pieces, OfALongRecordingAreDrawnEvenly) {
  const auto t = path(20 * 2048, [](std::int64_t) { return false; });
  const auto all = pieces_of(t, 0, 0), some = pieces_of(t, 0, 4 * 2048);
  EXPECT_THAT(all, SizeIs(3 * 20));
  ASSERT_THAT(some, SizeIs(3 * 4));
  std::vector<std::int64_t> firsts;
  for (std::size_t k = 0; k < some.size(); k += 3) firsts.push_back(some[k].first_frame);
  EXPECT_THAT(firsts, ElementsAre(2 * 2048, 7 * 2048, 12 * 2048, 17 * 2048));
}

TEST(PhaseTable, RowsOfAnInterpolatedStreamPointToItsPhase) {
  for (const int factor : {2, 3, 4})
    for (const std::int64_t first : {0, 1, 7}) {
      const auto source = noise(2000, 0.002);
      Piece piece{.first_frame = first, .y = {}, .step_m = 1e-9};
      for (std::size_t i = 0; i + 1 < source.size(); ++i)
        for (int k = 0; k < factor; ++k)
          piece.y.push_back(source[i] + k * (source[i + 1] - source[i]) / factor);
      PhaseTable table{.factor = factor};
      Knots knots;
      add_rows(piece, InterpolationKernel::linear, knots, table);
      ASSERT_GT(table.rows(), 20U);
      EXPECT_EQ(table.log_residual.size(), table.rows() * static_cast<std::size_t>(factor));
      const auto verdict = judge(table, InterpolationKernel::linear);
      EXPECT_TRUE(verdict.fires) << factor;
      EXPECT_EQ(verdict.factor, factor);
      EXPECT_EQ(verdict.phase, first % factor) << "counted from frame 0";
      EXPECT_EQ(verdict.agreement, 1.0);
    }
}

TEST(PhaseTable, NoiseOfItsOwnInEverySamplePointsNowhere) {
  PhaseTable table{.factor = 2};
  Knots knots;
  add_rows({.first_frame = 0, .y = noise(4000, 0.002), .step_m = 1e-9}, InterpolationKernel::linear, knots,
           table);
  EXPECT_GT(table.rows(), 50U);
  EXPECT_FALSE(judge(table, InterpolationKernel::linear).fires);
}

TEST(PhaseTable, WhatIsLostInTheRoundingIsNoEvidence) {
  PhaseTable table{.factor = 2};
  Knots knots;
  add_rows({.first_frame = 0, .y = noise(4000, 1e-7), .step_m = 0.01}, InterpolationKernel::linear, knots,
           table);
  EXPECT_EQ(table.rows(), 0U);
  EXPECT_FALSE(judge(table, InterpolationKernel::linear).fires);
}

TEST(PhaseTable, TablesAddUp) {
  auto one = table_of(3, {0, 1});
  one.append(table_of(3, {2}));
  EXPECT_EQ(one.rows(), 3U);
  EXPECT_THAT(one.frame, ElementsAre(50, 150, 50));
  EXPECT_EQ(one.log_residual[8], -9.0F);
}

TEST(Judge, NeedsSixBlocksAndMoreForSmallFactors) {
  EXPECT_FALSE(judge(table_of(4, std::vector<int>(5, 2)), InterpolationKernel::hold).fires);
  EXPECT_TRUE(judge(table_of(4, std::vector<int>(8, 2)), InterpolationKernel::hold).fires);
  EXPECT_FALSE(judge(table_of(2, std::vector<int>(8, 1)), InterpolationKernel::hold).fires)
      << "one in 2^8 by accident";
  EXPECT_TRUE(judge(table_of(2, std::vector<int>(20, 1)), InterpolationKernel::hold).fires);
}

TEST(Judge, OneContradictionInTenIsForgiven) {
  std::vector<int> winners(40, 1);
  for (const std::size_t wrong : {3, 17, 30}) winners[wrong] = 0;
  EXPECT_TRUE(judge(table_of(2, winners), InterpolationKernel::hold).fires);
  for (const std::size_t wrong : {5, 9, 13, 21}) winners[wrong] = 0;
  EXPECT_FALSE(judge(table_of(2, winners), InterpolationKernel::hold).fires);
}

TEST(Judge, APhaseThatChangesOnceIsASlip) {
  std::vector<int> winners(60, 0);
  std::fill(winners.begin() + 30, winners.end(), 2);
  const auto verdict = judge(table_of(3, winners), InterpolationKernel::hold);
  EXPECT_TRUE(verdict.fires);
  EXPECT_TRUE(verdict.slips);
}

TEST(FollowPhase, ChangesHalfwayBetweenTheBlocks) {
  std::vector<int> winners(30, 0);
  std::fill(winners.begin() + 12, winners.end(), 1);
  const auto runs = follow_phase(table_of(2, winners));
  ASSERT_THAT(phases(runs), ElementsAre(0, 1));
  EXPECT_EQ(runs[0].first_frame, 0);
  EXPECT_EQ(runs[1].first_frame, 1200) << "the last block of the old phase lies at 1150, the next at 1250";
}

TEST(FollowPhase, AFewContradictingBlocksAreNoChange) {
  std::vector<int> winners(40, 1);
  for (const std::size_t wrong : {10, 11, 12}) winners[wrong] = 0;
  EXPECT_THAT(phases(follow_phase(table_of(2, winners))), ElementsAre(1));
  for (std::size_t wrong = 10; wrong < 22; ++wrong) winners[wrong] = 0;
  EXPECT_THAT(phases(follow_phase(table_of(2, winners))), ElementsAre(1, 0, 1));
}

TEST(FollowPhase, RowsMayComeInAnyOrderAndNoneIsOneRun) {
  std::vector<int> winners(30, 0);
  std::fill(winners.begin() + 12, winners.end(), 1);
  const auto table = table_of(2, winners);
  PhaseTable rotated{.factor = 2};
  for (std::size_t r = table.rows(); r-- > 0;) {
    for (std::size_t p = 0; p < 2; ++p) rotated.log_residual.push_back(table.log_residual[2 * r + p]);
    rotated.log_rounding.push_back(table.log_rounding[r]);
    rotated.frame.push_back(table.frame[r]);
  }
  const auto runs = follow_phase(rotated);
  ASSERT_THAT(phases(runs), ElementsAre(0, 1));
  EXPECT_EQ(runs[1].first_frame, 1200);
  const auto none = follow_phase(PhaseTable{.factor = 2});
  ASSERT_THAT(none, SizeIs(1));
  EXPECT_EQ(none[0].first_frame, 0);
}

}  // namespace

}  // namespace kinemark::trajectory::internal
