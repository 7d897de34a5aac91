// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

namespace kinemark::trajectory::internal {
namespace {

/// Values of a polynomial beside and inside a gap.
struct Samples {
  Eigen::MatrixXd near, gap;
};

Samples polynomial(const GapShape& s, const Eigen::VectorXd& coefficients) {
  const auto value = [&](Index k) {
    double v = 0.0;
    const double t = 0.1 * static_cast<double>(k - s.left);
    for (Index i = coefficients.size() - 1; i >= 0; --i) v = v * t + coefficients(i);
    return v;
  };
  Samples out{Eigen::MatrixXd(s.near(), 1), Eigen::MatrixXd(s.length, 1)};
  for (Index k = 0; k < s.near(); ++k) out.near(k) = value(k < s.left ? k : k + s.length);
  for (Index k = 0; k < s.length; ++k) out.gap(k) = value(s.left + k);
  return out;
}

const Eigen::VectorXd kCubic = (Eigen::VectorXd(4) << 0.3, -1.2, 0.7, 0.4).finished();

TEST(Chord, IsStraightBetweenTheNearestSamplesAndHoldsWithOneSide) {
  const GapShape both{.length = 5, .left = 3, .right = 2};
  const Samples line = polynomial(both, kCubic.head(2));
  EXPECT_LT((chord_operator(both) * line.near - line.gap).norm(), 1e-12);
  const GapShape left{.length = 4, .left = 3};
  const GapShape right{.length = 4, .right = 3};
  const Eigen::Vector3d near(1.0, 2.0, 5.0);
  EXPECT_TRUE((chord_operator(left) * near).isConstant(5.0));
  EXPECT_TRUE((chord_operator(right) * near).isConstant(1.0));
}

TEST(Spline, ReproducesCubicsAndPassesThroughItsKnots) {
  for (const Index side : {2, 3, 10}) {
    const GapShape s{.length = 7, .left = side, .right = side + 1};
    const Samples cubic = polynomial(s, kCubic);
    EXPECT_LT((spline_operator(s) * cubic.near - cubic.gap).norm(), 1e-10) << side;
  }
  const GapShape three{.length = 4, .left = 2, .right = 1};  // a parabola
  const Samples parabola = polynomial(three, kCubic.head(3));
  EXPECT_LT((spline_operator(three) * parabola.near - parabola.gap).norm(), 1e-12);
}

TEST(Walk, IsTheLeastSquaresSolution) {
  for (const int order : {1, 2, 3}) {
    const GapShape s{.length = 9, .left = 6, .right = 8};
    const double lambda = walk_lambda(order, 5.0, 100.0);
    const Index n = s.length + s.near();
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
    for (int k = 0; k < order; ++k) D = (D.bottomRows(D.rows() - 1) - D.topRows(D.rows() - 1)).eval();
    Eigen::VectorXd W = Eigen::VectorXd::Ones(n);
    W.segment(s.left, s.length).setZero();
    const Eigen::MatrixXd N = Eigen::MatrixXd(W.asDiagonal()) + lambda * D.transpose() * D;
    const Eigen::MatrixXd all = N.fullPivLu().inverse();
    Eigen::MatrixXd expected(s.length, s.near());
    expected << all.block(s.left, 0, s.length, s.left),
        all.block(s.left, s.left + s.length, s.length, s.right);
    EXPECT_LT((walk_operator(s, order, lambda) - expected).norm(), 1e-7 * expected.norm()) << order;
  }
}

TEST(Walk, ReproducesPolynomialsBelowItsOrderAndExtrapolatesThem) {
  for (const int order : {1, 2, 3})
    for (const GapShape s :
         {GapShape{.length = 6, .left = 9, .right = 9}, GapShape{.length = 6, .left = 12}}) {
      const Samples p = polynomial(s, kCubic.head(order));
      EXPECT_LT((walk_operator(s, order, 100.0) * p.near - p.gap).norm(), 1e-7) << order << " " << s.right;
    }
}

TEST(Pchip, ReproducesLinesAndNeverOvershoots) {
  const GapShape s{.length = 8, .left = 4, .right = 4};
  const Eigen::VectorX<Index> rows = Eigen::VectorX<Index>::LinSpaced(8, 0, 7);
  const Samples line = polynomial(s, kCubic.head(2));
  EXPECT_LT((pchip_fill(s, line.near, rows) - line.gap).norm(), 1e-12);
  Eigen::MatrixXd near(8, 1);
  near << 0.0, 3.0, 9.0, 10.0, 11.0, 11.5, 3.0, 1.0;  // rises steeply to a flat top
  const Eigen::MatrixXd fill = pchip_fill(s, near, rows);
  EXPECT_GE(fill.minCoeff(), 10.0);
  EXPECT_LE(fill.maxCoeff(), 11.0);
  for (Index k = 0; k + 1 < 8; ++k) EXPECT_LE(fill(k), fill(k + 1));
}

TEST(WalkCacheTest, GivesTheRowsOfTheOperatorAgainAndAgain) {
  WalkCache cache;
  const GapShape s{.length = 40, .left = 8, .right = 8};
  const Eigen::VectorX<Index> rows = (Eigen::VectorX<Index>(3) << 0, 20, 39).finished();
  const Eigen::MatrixXd all = walk_operator(s, 2, 1e4);
  const auto first = cache.get(s, 2, 1e4, rows);
  EXPECT_TRUE(*first == all(rows, Eigen::indexing::all));
  EXPECT_EQ(first, cache.get(s, 2, 1e4, rows));
  EXPECT_FALSE(*cache.get(s, 2, 1e3, rows) == *first);
}

using testing::hide;
using testing::moving_bodies;

/// The gap of frames [first, end) with the usual support, clipped to the recording.
GapSpan span_of(const data::Trajectories& t, Index marker, Index first, Index end) {
  const Index support = support_frames(t.time.rate_hz);
  return {.marker = marker,
          .first = first,
          .end = end,
          .left = std::min(support, first),
          .right = std::min(support, t.frames() - end)};
}

GapProblem pose(const data::Trajectories& t, const GapSpan& span, bool use_neighbours = true,
                std::uint64_t seed = 1) {
  const Recording r(t);
  return pose_gap(r, find_rigid_neighbours(r, span.marker), span, use_neighbours, seed);
}

/// What every problem must hold, seen from the trajectories themselves.
void expect_sound(const data::Trajectories& t, const GapProblem& p) {
  EXPECT_EQ(p.shape.length, p.span.end - p.span.first);
  EXPECT_LE(p.window.length, p.shape.length);
  EXPECT_EQ(p.window.left, p.shape.left);
  EXPECT_EQ(p.window.right, p.shape.right);
  EXPECT_EQ(p.sd_m.size(), p.predictors.size());
  EXPECT_TRUE(std::ranges::is_sorted(p.starts));
  const auto complete = [&](Index m, Index first, Index end) {
    for (Index f = first; f < end; ++f)
      if (f < 0 || f >= t.frames() || !t.present(f, m)) return false;
    return true;
  };
  for (const Index s : p.starts) {
    const Index first = s - p.window.left, end = s + p.window.length + p.window.right;
    EXPECT_TRUE(complete(p.span.marker, first, end)) << s;
    for (const Index m : p.predictors) EXPECT_TRUE(complete(m, first, end)) << s << " " << m;
  }
  for (const Index m : p.candidates)
    EXPECT_TRUE(complete(m, p.span.first - p.span.left, p.span.end + p.span.right)) << m;
  for (const Index m : p.predictors) EXPECT_EQ(std::ranges::count(p.candidates, m), 1) << m;
  EXPECT_EQ(std::ranges::count(p.candidates, p.span.marker), 0);
  for (Index r = 0; r < p.rows.size(); ++r) {
    EXPECT_GE(p.rows(r), 0);
    EXPECT_LT(p.rows(r), p.window.length);
    if (r > 0) {
      EXPECT_LT(p.rows(r - 1), p.rows(r));
    }
  }
  EXPECT_EQ(p.rows(0), 0);
}

TEST(SupportFrames, AreAThirdOfASecondWithinReason) {
  EXPECT_EQ(support_frames(100.0), 30);
  EXPECT_EQ(support_frames(10.0), 6);
  EXPECT_EQ(support_frames(0.001), 6);
  EXPECT_EQ(support_frames(1000.0), 60);
}

TEST(RigidNeighbours, ThoseOfTheSameBodyComeFirst) {
  const auto t = moving_bodies({.frames = 400, .bodies = 3, .noise_m = 0.0005});
  const Recording r(t);
  for (Index target = 0; target < 15; ++target) {
    const auto found = find_rigid_neighbours(r, target);
    ASSERT_EQ(found.size(), 14U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(found[k].marker / 5, target / 5) << target;
      EXPECT_LT(found[k].sd_m, 0.002) << "of noise only";
    }
    for (std::size_t k = 4; k < 14; ++k) EXPECT_GT(found[k].sd_m, 0.002) << target;
    for (std::size_t k = 1; k < 14; ++k) EXPECT_LE(found[k - 1].sd_m, found[k].sd_m);
  }
}

TEST(RigidNeighbours, SdIsThatOfTheDistances) {
  const auto t = moving_bodies({.frames = 200, .bodies = 2});
  double sum = 0.0, squares = 0.0;
  for (Index f = 0; f < 200; ++f) {
    const double d = (t.x(f, 0) - t.x(f, 7)).norm();
    sum += d;
    squares += d * d;
  }
  const double sd = std::sqrt(squares / 200.0 - sum * sum / 4e4);
  const auto found = find_rigid_neighbours(Recording(t), 0);
  const auto seventh = std::ranges::find(found, Index{7}, &Neighbour::marker);
  ASSERT_NE(seventh, found.end());
  EXPECT_NEAR(seventh->sd_m / sd, 1.0, 0.03) << "but for the outermost distances";
}

TEST(RigidNeighbours, MarkersSeldomSeenTogetherAreLeftOut) {
  auto t = moving_bodies({.frames = 200});
  hide(t, 3, 0, 120);  // seen in 79 of the target's 200 frames
  hide(t, 4, 0, 90);   // in 109
  std::set<Index> markers;
  for (const Neighbour& n : find_rigid_neighbours(Recording(t), 0)) markers.insert(n.marker);
  EXPECT_FALSE(markers.contains(3));
  EXPECT_TRUE(markers.contains(4));
  EXPECT_FALSE(markers.contains(0)) << "itself";
  hide(t, 0, 0, 199);
  EXPECT_TRUE(find_rigid_neighbours(Recording(t), 0).empty()) << "a target that is never seen";
}

TEST(GapProblem, IsSoundWhereverTheGapLies) {
  for (const auto& [first, end] :
       {std::pair<Index, Index>{0, 20}, {3, 4}, {100, 150}, {250, 380}, {395, 400}, {399, 400}}) {
    auto t = moving_bodies({.frames = 400});
    hide(t, 2, first, end - 1);
    const GapProblem p = pose(t, span_of(t, 2, first, end));
    expect_sound(t, p);
    EXPECT_GE(p.windows(), 8) << first;
    EXPECT_EQ(p.predictors.size(), 9U) << first;
    EXPECT_TRUE(p.dropped.empty());
  }
}

TEST(GapProblem, RaggedRecordingsAreSoundToo) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    auto t = moving_bodies({.frames = 300, .bodies = 3, .seed = seed});
    Random random(seed, 8);
    for (int hole = 0; hole < 25; ++hole) {
      const auto marker = static_cast<std::int64_t>(random.uniform(0.0, 14.99));
      const auto first = static_cast<std::int64_t>(random.uniform(0.0, 280.0));
      hide(t, marker, first, first + static_cast<std::int64_t>(random.uniform(0.0, 19.0)));
    }
    hide(t, 0, 140, 160);
    Index left = 0, right = 0;
    while (left < 30 && t.present(139 - left, 0)) ++left;
    while (right < 30 && t.present(161 + right, 0)) ++right;
    expect_sound(t, pose(t, {.marker = 0, .first = 140, .end = 161, .left = left, .right = right}));
  }
}

TEST(GapProblem, AMarkerLostInTheGapIsNoCandidate) {
  auto t = moving_bodies({.frames = 400});
  hide(t, 2, 100, 149);
  hide(t, 3, 149, 149);
  hide(t, 4, 125, 200);
  const GapProblem p = pose(t, span_of(t, 2, 100, 150));
  expect_sound(t, p);
  EXPECT_EQ(std::ranges::count(p.candidates, Index{3}) + std::ranges::count(p.candidates, Index{4}), 0);
  EXPECT_EQ(p.predictors.size(), 7U);
}

TEST(GapProblem, DoubtfulNeighboursAreDroppedWhileEnoughAreLeft) {
  auto t = moving_bodies({.frames = 400});
  hide(t, 2, 100, 149);
  const auto pose_with_doubts = [&](Index doubted) {
    Recording r(t);
    std::vector<std::vector<std::uint8_t>> flags(10, std::vector<std::uint8_t>(400, 0));
    for (Index m = 0; m < doubted; ++m)
      for (std::size_t f = 100; f < 150; ++f) flags[static_cast<std::size_t>(9 - m)][f] = 1;
    r.set_doubtful(flags);
    return pose_gap(r, find_rigid_neighbours(r, 2), span_of(t, 2, 100, 150), true, 1);
  };
  EXPECT_EQ(pose_with_doubts(0).dropped.size(), 0U);
  const GapProblem some = pose_with_doubts(4);
  EXPECT_EQ(std::set<Index>(some.dropped.begin(), some.dropped.end()), (std::set<Index>{6, 7, 8, 9}));
  for (const Index m : some.dropped) EXPECT_EQ(std::ranges::count(some.predictors, m), 0);
  EXPECT_EQ(pose_with_doubts(7).dropped.size(), 0U) << "two that are left would be too few: all are asked";
}

TEST(GapProblem, WindowsShrinkWhenTheRecordingHasNoLongOnes) {
  auto t = moving_bodies({.frames = 260});
  hide(t, 2, 70, 189);  // 120 frames, 70 on either side
  const GapProblem p = pose(t, span_of(t, 2, 70, 190));
  expect_sound(t, p);
  EXPECT_TRUE(p.shortened() || p.windows() == 0);
  EXPECT_EQ(p.all_rows.size(), 120);
}

TEST(GapProblem, WithoutNeighboursThereAreNoPredictorsAndOneSeedIsOneAnswer) {
  auto t = moving_bodies({.frames = 2000});
  hide(t, 2, 100, 149);
  const GapSpan span = span_of(t, 2, 100, 150);
  const GapProblem alone = pose(t, span, false);
  EXPECT_TRUE(alone.predictors.empty() && alone.candidates.empty());
  EXPECT_GE(alone.windows(), 8);
  EXPECT_EQ(pose(t, span, true, 7).starts, pose(t, span, true, 7).starts);
  EXPECT_NE(pose(t, span, true, 7).starts, pose(t, span, true, 8).starts);
}

TEST(Gather, PutsEveryFrameInItsPlace) {
  auto t = moving_bodies({.frames = 300});
  hide(t, 2, 100, 119);
  const GapProblem p = pose(t, span_of(t, 2, 100, 120));
  const Signal s =
      gather(p, 2, true, [](Index f, auto out) { out << static_cast<double>(f), -static_cast<double>(f); });
  ASSERT_GT(p.windows(), 0);
  for (Index w = 0; w < p.windows(); ++w) {
    for (Index r = 0; r < p.rows.size(); ++r)
      EXPECT_EQ(s.rows(r, 2 * w), static_cast<double>(p.start(w) + p.rows(r)));
    EXPECT_EQ(s.near(0, 2 * w), static_cast<double>(p.start(w) - p.window.left));
    EXPECT_EQ(s.near(p.window.left - 1, 2 * w + 1), -static_cast<double>(p.start(w) - 1));
    EXPECT_EQ(s.near(p.window.left, 2 * w), static_cast<double>(p.start(w) + p.window.length));
  }
  EXPECT_EQ(s.gap(0, 0), 100.0);
  EXPECT_EQ(s.gap(19, 1), -119.0);
  EXPECT_EQ(s.gap_near(p.shape.left, 0), 120.0) << "the first sample behind the gap";
  EXPECT_EQ(gather(p, 1, false, [](Index, auto out) { out.setZero(); }).gap.rows(), 0);
}

}  // namespace

}  // namespace kinemark::trajectory::internal
