// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/internal/hypotheses.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

const std::vector<std::string> kLegNames{"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LTIB",
                                         "RTIB", "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"};

/// Every marker where its name says, give or take 4 mm.
SeenFrame standing(const StandingBody& body, std::uint64_t seed) {
  Random random(seed, 0);
  SeenFrame out;
  out.x.resize(3, static_cast<Eigen::Index>(body.markers.size()));
  out.sd = Eigen::VectorXd::Constant(out.x.cols(), 0.003);
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    Vector3d x = body.markers[m].x_in_segment;
    for (int s = body.markers[m].segment; s >= 0; s = body.segments[at(s)].parent)
      x += body.segments[at(s)].joint_in_parent;
    for (int a = 0; a < 3; ++a) x[a] += 0.004 * random.gaussian();
    out.x.col(static_cast<Eigen::Index>(m)) = x;
  }
  return out;
}

int marker(const StandingBody& body, const std::string& name) {
  return static_cast<int>(std::ranges::find(body.markers, name, &StandingBody::Marker::name) -
                          body.markers.begin());
}

class Hypotheses : public ::testing::Test {
 protected:
  StandingBody body_ = body_of_names(kLegNames);
  SharedPrior prior_ = prior_of(body_);
};

TEST_F(Hypotheses, AreInOrderAndNoneExplainsACleanFrame) {
  const auto all = explain(body_, prior_, standing(body_, 1));
  EXPECT_TRUE(std::ranges::is_sorted(all, std::greater{}, &Hypothesis::score));
  for (const auto& h : all) {
    EXPECT_LT(h.score, 12.0) << h.first << " " << h.second;
    EXPECT_GE(h.misfit, 0.12);
  }
}

TEST_F(Hypotheses, AnExchangeIsFound) {
  auto frame = standing(body_, 2);
  const int a = marker(body_, "LKNE"), b = marker(body_, "LANK");
  frame.x.col(a).swap(frame.x.col(b));
  const auto all = explain(body_, prior_, frame);
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().first, std::min(a, b));
  EXPECT_EQ(all.front().second, std::max(a, b));
  EXPECT_GT(all.front().score, 100.0);
}

TEST_F(Hypotheses, AnExchangeIsWeighedByItselfAsAmongAll) {
  auto frame = standing(body_, 3);
  const int a = marker(body_, "LASI"), b = marker(body_, "RASI");
  frame.x.col(a).swap(frame.x.col(b));
  const auto alone = explain_exchange(body_, prior_, frame, a, b);
  const auto best = explain(body_, prior_, frame).front();
  EXPECT_EQ(best.first, a);
  EXPECT_EQ(best.second, b);
  EXPECT_NEAR(alone.score, best.score, 1e-6 * best.score);
  EXPECT_EQ(alone.shift, Vector3d::Zero());
  // Exchanged back, the same exchange makes it worse.
  frame.x.col(a).swap(frame.x.col(b));
  EXPECT_LT(explain_exchange(body_, prior_, frame, a, b).score, 0.0);
}

TEST_F(Hypotheses, AShiftIsWeighedByItselfAsAmongAll) {
  auto frame = standing(body_, 8);
  const int a = marker(body_, "LASI");
  frame.x.col(a) += Vector3d(0.0, 0.1, 0.0);
  const auto alone = explain_shift(body_, prior_, frame, a), best = explain(body_, prior_, frame).front();
  EXPECT_EQ(best.first, a);
  EXPECT_EQ(best.second, -1);
  EXPECT_NEAR(alone.score, best.score, 1e-9 * best.score);
  EXPECT_LT(explain_shift(body_, prior_, frame, marker(body_, "RTOE")).score, best.score);
}

TEST_F(Hypotheses, TheShareSeenIsTheShareFound) {
  // Known places as beside a movement: each coordinate to 4 mm, so that most shifts show.
  SharedPrior known = prior_;
  known.information.diagonal().array() += 1.0 / (0.004 * 0.004);
  const Least least{.score = 7.0, .fall = 0.0};
  for (const double size : {0.02, 0.04}) {
    const auto clean = standing(body_, 9);
    const double said = share_seen(body_, known, clean, size, least);
    int planted = 0, found = 0;
    Random random(31, 0);
    for (int m = 0; m < clean.x.cols(); ++m)
      for (int k = 0; k < 3; ++k) {
        Vector3d way;
        for (int a = 0; a < 3; ++a) way[a] = random.gaussian();
        auto frame = clean;
        frame.x.col(m) += size * way.normalized();
        const auto h = explain_shift(body_, known, frame, m);
        ++planted;
        found += h.score >= least.score && h.gain * h.misfit >= least.fall ? 1 : 0;
      }
    EXPECT_NEAR(said, static_cast<double>(found) / planted, 0.2) << size;
    EXPECT_GT(said, 0.0);
  }
}

TEST_F(Hypotheses, MoreIsSeenOfLargerShiftsAndNothingWhereNoneIsEnough) {
  const auto frame = standing(body_, 10);
  const Least least{.score = 12.0, .fall = 8.0};
  const double near = share_seen(body_, prior_, frame, 0.05, least),
               far = share_seen(body_, prior_, frame, 0.12, least);
  EXPECT_LT(near, far);
  EXPECT_EQ(share_seen(body_, prior_, frame, 0.05, {.score = 1e9, .fall = 0.0}), 0.0);
  auto nothing = frame;
  nothing.x.setConstant(std::nan(""));
  EXPECT_EQ(share_seen(body_, prior_, nothing, 0.05, least), 0.0);
}

TEST_F(Hypotheses, AShiftIsFoundWithItsSizeAndSpread) {
  for (const double size : {0.09, 0.15}) {
    auto frame = standing(body_, 4);
    const int a = marker(body_, "RASI");
    frame.x.col(a) += Vector3d(0.0, size, 0.0);
    const auto best = explain(body_, prior_, frame).front();
    ASSERT_EQ(best.first, a) << size;
    EXPECT_EQ(best.second, -1);
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(std::abs(best.shift[k] - (k == 1 ? size : 0.0)), 3.5 * best.shift_sd[k]) << k;
  }
}

TEST_F(Hypotheses, TheFreedomToLieAnywhereIsPaidFor) {
  const auto all = explain(body_, prior_, standing(body_, 5));
  for (const auto& h : all) {
    if (h.second < 0) {
      EXPECT_LT(h.score, h.gain);
    } else {
      EXPECT_EQ(h.score, h.gain);
    }
  }
}

TEST_F(Hypotheses, MarkersThatAreNotSeenAreNotNamed) {
  auto frame = standing(body_, 6);
  const int a = marker(body_, "LTOE"), b = marker(body_, "RTIB");
  frame.x.col(a).setConstant(std::nan(""));
  frame.x.col(b).setConstant(std::nan(""));
  for (const auto& h : explain(body_, prior_, frame)) {
    EXPECT_NE(h.first, a);
    EXPECT_NE(h.second, a);
    EXPECT_NE(h.first, b);
    EXPECT_NE(h.second, b);
  }
}

TEST_F(Hypotheses, AreTheSameWhereverTheBodyStands) {
  auto here = standing(body_, 7);
  here.x.col(marker(body_, "LASI")) += Vector3d(0.0, 0.12, 0.0);
  auto there = here;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.0, Vector3d(0.2, 1.0, -0.4).normalized()).toRotationMatrix();
  there.x = turn * here.x;
  there.x.colwise() += Vector3d(3.0, -1.0, 2.0);
  const auto a = explain(body_, prior_, here).front(), b = explain(body_, prior_, there).front();
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.second, b.second);
  EXPECT_NEAR(a.score, b.score, 0.02 * a.score);
  EXPECT_LT((a.shift - b.shift).norm(), 2e-3) << "it is told in the body's axes";
}

}  // namespace
}  // namespace kinemark::motion::internal
