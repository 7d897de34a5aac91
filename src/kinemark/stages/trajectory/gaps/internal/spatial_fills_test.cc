// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Candidates from other markers, against the samples that were hidden.
#include "kinemark/stages/trajectory/gaps/internal/spatial_fills.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "kinemark/stages/trajectory/gaps/testing/moving_bodies.h"

namespace kinemark::trajectory::internal {
namespace {

const std::vector<Index> kFrames = {0, 40, 90, 120};
const std::vector<double> kSd(5, 0.001);

TEST(LocalFrameTest, ARigidBodyStandsStillInIt) {
  const Recording r(testing::moving_bodies({.frames = 200}));
  const std::vector<Index> markers = {0, 1, 2, 3};
  const LocalFrame frame(r, markers, std::span(kSd).first(4), kFrames);
  ASSERT_TRUE(frame.has_rotation());
  const auto local = [&](Index marker, Index f) -> Eigen::Vector3d {
    const LocalPose p = frame.at(f);
    EXPECT_NEAR(p.R.determinant(), 1.0, 1e-12);
    return p.R.transpose() * (r.x(marker, f) - p.c);
  };
  for (Index f = 0; f < 200; f += 7) EXPECT_LT((local(4, f) - local(4, 0)).norm(), 1e-9) << f;
}

TEST(LocalFrameTest, TwoMarkersOrALineGiveAPositionOnly) {
  data::Trajectories t = testing::moving_bodies({.frames = 200});
  for (Index f = 0; f < 200; ++f) t.x(f, 2) = 0.5 * (t.x(f, 0) + t.x(f, 1));
  const Recording r(t);
  const std::vector<Index> two = {0, 1};
  const std::vector<Index> line = {0, 1, 2};
  EXPECT_FALSE(LocalFrame(r, two, std::span(kSd).first(2), kFrames).has_rotation());
  const LocalFrame frame(r, line, std::span(kSd).first(3), kFrames);
  EXPECT_FALSE(frame.has_rotation());
  EXPECT_TRUE(frame.at(50).R == Eigen::Matrix3d::Identity());
  EXPECT_LT((frame.at(50).c - 0.5 * (t.x(50, 0) + t.x(50, 1))).norm(), 1e-12);
}

/// A recording with one hidden stretch of marker 1, and its candidates.
struct Hidden {
  explicit Hidden(Index first, Index end, GapMethod method = GapMethod::automatic,
                  testing::BodiesOptions o = {})
      : Hidden(testing::moving_bodies(o), first, end, method) {}
  Hidden(data::Trajectories t, Index first_frame, Index end_frame, GapMethod method)
      : whole(std::move(t)), first(first_frame), end(end_frame) {
    data::Trajectories gappy = whole;
    testing::hide(gappy, 1, first, end - 1);
    const Recording r(gappy);
    const Index support = support_frames(whole.time.rate_hz);
    problem = pose_gap(r, find_rigid_neighbours(r, 1),
                       {.marker = 1,
                        .first = first,
                        .end = end,
                        .left = std::min(support, first),
                        .right = std::min(support, whole.frames() - end)},
                       true, 1);
    WalkCache cache;
    spatial_fills(r, problem, method, cache, fills);
  }
  [[nodiscard]] double rms_m(const Fill& fill) const {
    double squares = 0.0;
    for (Index f = first; f < end; ++f)
      squares += (fill.gap.row(f - first).transpose() - whole.x(f, 1)).squaredNorm();
    return std::sqrt(squares / static_cast<double>(end - first));
  }
  [[nodiscard]] std::vector<FillKind> kinds() const {
    std::vector<FillKind> all;
    for (const Fill& f : fills) all.push_back(f.kind);
    return all;
  }

  data::Trajectories whole;
  Index first, end;
  GapProblem problem;
  std::vector<Fill> fills;
};

TEST(SpatialFills, EveryCandidateOfARigidBodyFindsTheHiddenSamples) {
  const Hidden h(200, 260, GapMethod::automatic, {.bodies = 1});
  EXPECT_GE(h.fills.size(), 8U);
  for (const Fill& fill : h.fills) {
    SCOPED_TRACE(to_string(fill.kind));
    ASSERT_EQ(fill.gap.rows(), 60);
    ASSERT_EQ(fill.gap.cols(), 3);
    EXPECT_EQ(fill.errors.rows(), h.problem.rows.size());
    EXPECT_EQ(fill.errors.cols(), 3 * h.problem.windows());
    EXPECT_TRUE(fill.gap.allFinite() && fill.errors.allFinite());
    const bool pca = fill.kind == FillKind::pca_untied || fill.kind == FillKind::pca_chord;
    EXPECT_LT(h.rms_m(fill), pca ? 0.03 : 1e-6) << "four other markers of the body leave no doubt";
  }
}

TEST(SpatialFills, ErrorsOnWindowsTellThoseInTheGap) {
  std::map<FillKind, double> estimated, actual;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Hidden h(200, 240, GapMethod::automatic, {.noise_m = 0.001, .seed = seed});
    for (const Fill& fill : h.fills) {
      estimated[fill.kind] += fill.rms_m() * fill.rms_m();
      actual[fill.kind] += h.rms_m(fill) * h.rms_m(fill);
    }
  }
  EXPECT_GE(estimated.size(), 8U);
  for (const auto& [kind, squares] : estimated) {
    const double ratio = std::sqrt(actual[kind] / squares);
    EXPECT_GT(ratio, 0.5) << to_string(kind);
    EXPECT_LT(ratio, 2.0) << to_string(kind);
  }
}

TEST(SpatialFills, MoveWithTheLaboratory) {
  const data::Trajectories here = testing::moving_bodies({.noise_m = 0.0005});
  data::Trajectories there = here;
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized());
  const Eigen::Vector3d shift(1.0, -2.0, 0.5);
  for (std::int64_t f = 0; f < here.frames(); ++f)
    for (std::int64_t m = 0; m < here.markers(); ++m)
      there.x(f, m) = turn * Eigen::Vector3d(here.x(f, m)) + shift;
  const Hidden a(here, 200, 240, GapMethod::automatic), b(there, 200, 240, GapMethod::automatic);
  ASSERT_EQ(a.kinds(), b.kinds());
  for (std::size_t i = 0; i < a.fills.size(); ++i) {
    EXPECT_NEAR(a.fills[i].rms_m(), b.fills[i].rms_m(), 2e-6) << to_string(a.fills[i].kind);
    for (Index k = 0; k < 40; ++k) {
      const Eigen::Vector3d moved = turn * Eigen::Vector3d(a.fills[i].gap.row(k).transpose()) + shift;
      EXPECT_LT((moved - b.fills[i].gap.row(k).transpose()).norm(), 1e-5) << to_string(a.fills[i].kind);
    }
  }
}

TEST(SpatialFills, TiedOnesMeetTheSamplesAtBothEnds) {
  // The target does not belong to the body entirely: it slides by 8 mm along it.
  data::Trajectories t = testing::moving_bodies({});
  for (std::int64_t f = 0; f < t.frames(); ++f)
    t.x(f, 1) +=
        0.004 * std::sin(0.02 * static_cast<double>(f)) * Eigen::Vector3d(t.x(f, 2) - t.x(f, 0)).normalized();
  const Hidden h(t, 200, 240, GapMethod::automatic);
  for (const Fill& fill : h.fills) {
    if (is_untied(fill.kind)) continue;
    const double step = (t.x(200, 1) - t.x(199, 1)).norm();
    EXPECT_LT((fill.gap.row(0).transpose() - t.x(200, 1)).norm(), 0.5 * step + 5e-4) << to_string(fill.kind);
    EXPECT_LT((fill.gap.row(39).transpose() - t.x(239, 1)).norm(), 0.5 * step + 5e-4) << to_string(fill.kind);
  }
}

TEST(SpatialFills, EachMethodMakesItsOwnKinds) {
  using enum FillKind;
  EXPECT_EQ(Hidden(200, 240, GapMethod::rigid).kinds(), std::vector{rigid_walk});
  EXPECT_EQ(Hidden(200, 240, GapMethod::regression).kinds(), std::vector{regression_walk});
  EXPECT_EQ(Hidden(200, 240, GapMethod::pca).kinds(), std::vector{pca_chord});
  const auto all = Hidden(200, 240).kinds();
  for (const FillKind kind : all) {
    EXPECT_FALSE(is_temporal(kind)) << to_string(kind);
    EXPECT_EQ(std::ranges::count(all, kind), 1) << to_string(kind);
  }
}

TEST(SpatialFills, WithoutSupportOnlyUntiedOnesAreLeft) {
  for (const GapMethod method :
       {GapMethod::automatic, GapMethod::rigid, GapMethod::regression, GapMethod::pca}) {
    const data::Trajectories t = testing::moving_bodies({.bodies = 1});
    data::Trajectories gappy = t;
    testing::hide(gappy, 1, 100, 129);
    const Recording r(gappy);
    const GapProblem p =
        pose_gap(r, find_rigid_neighbours(r, 1), {.marker = 1, .first = 100, .end = 130}, true, 1);
    WalkCache cache;
    std::vector<Fill> fills;
    spatial_fills(r, p, method, cache, fills);
    EXPECT_FALSE(fills.empty());
    for (const Fill& fill : fills) {
      EXPECT_TRUE(is_untied(fill.kind)) << to_string(fill.kind);
      double worst = 0.0;
      for (Index i = 0; i < 30; ++i)
        worst = std::max(worst, (fill.gap.row(i).transpose() - t.x(100 + i, 1)).norm());
      EXPECT_LT(worst, method == GapMethod::rigid ? 1e-9 : 0.05) << to_string(fill.kind);
    }
  }
}

TEST(SpatialFills, TwoNeighboursGiveNoRotationAndNoRigidPlace) {
  data::Trajectories t = testing::moving_bodies({.bodies = 1});
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (const std::int64_t m : {0, 4}) t.set_missing(f, m);
  const Hidden h(t, 200, 240, GapMethod::automatic);
  EXPECT_EQ(h.problem.predictors.size(), 2U);
  EXPECT_FALSE(h.fills.empty());
  EXPECT_EQ(std::ranges::count(h.kinds(), FillKind::rigid_untied), 0);
  EXPECT_EQ(std::ranges::count(h.kinds(), FillKind::pca_untied), 0)
      << "two markers have no components worth it";
}

}  // namespace

}  // namespace kinemark::trajectory::internal
