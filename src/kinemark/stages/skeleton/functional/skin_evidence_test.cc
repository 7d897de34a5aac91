// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton {
namespace {

using data::SkinVerdict;

struct Seen {
  SkinEvidence evidence;
  data::SkinAccount account;
};

Seen look(const testing::SwingSetup& swings) {
  const testing::JointSetup setup(testing::make_swings(swings));
  const auto kind = swings.hinge ? data::JointKind::hinge : data::JointKind::ball;
  JointFit fit = fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, kind);
  const auto slide = measure_skin_slide(setup.samples, setup.parent, setup.child, setup.task.motion, fit);
  Seen out{.evidence = find_skin(setup.samples, setup.parent, setup.child, setup.task.motion, fit)};
  out.account = account_of_skin(out.evidence, slide);
  return out;
}

bool says(const data::SkinAccount& account, const char* words) {
  return account.description.find(words) != std::string::npos;
}

TEST(SkinEvidence, SkinIsSaidWhereMarkersSlideTheSameInEveryMovement) {
  for (const bool hinge : {false, true})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto seen = look({.hinge = hinge, .own_slide_m = 0.008, .seed = seed});
      EXPECT_EQ(seen.account.verdict, SkinVerdict::follows) << seed;
      EXPECT_TRUE(says(seen.account, "The markers' shape follows the posture, the same in"));
      EXPECT_TRUE(says(seen.account, "is in the error bar"));
      EXPECT_GT(seen.evidence.shape.explained, 0.3);
      EXPECT_GE(seen.evidence.shape.alike, seen.evidence.movements - 2);
    }
}

TEST(SkinEvidence, SkinIsNotSaidOfNoiseWhiteOrColoured) {
  for (const double keeps : {0.0, 0.9, 0.98})
    for (const bool hinge : {false, true})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const auto seen = look({.hinge = hinge, .noise_sd_m = 0.003, .keeps = keeps, .seed = seed});
        EXPECT_NE(seen.account.verdict, SkinVerdict::follows) << keeps << " " << seed;
        EXPECT_FALSE(says(seen.account, "follows the posture")) << seed;
      }
}

TEST(SkinEvidence, MovementsThatDoNotPredictEachOtherSpeakAgainstSkin) {
  const auto of = [](std::int64_t movements, double p) {
    return calc_skin_probability({.movements = movements, .shape = {.p_value = p}});
  };
  const double odds = 0.2 * std::pow(0.01, -0.8);
  EXPECT_EQ(of(12, 0.005), 1.0) << "skin is named";
  EXPECT_NEAR(of(12, 0.01), odds / (1.0 + odds), 1e-12);
  EXPECT_LT(of(12, 0.5), 0.3);
  EXPECT_LT(of(12, 0.5), of(12, 0.1));
  EXPECT_EQ(of(7, 0.5), 1.0) << "too few movements say nothing";
  EXPECT_EQ(of(12, std::nan("")), 1.0);
}

TEST(SkinEvidence, NothingIsSeenOnRigidMarkersOfManyMovementsOnly) {
  const auto many = look({.movements = 10, .hinge = true});
  EXPECT_EQ(many.account.verdict, SkinVerdict::none_seen);
  EXPECT_TRUE(says(many.account, "No sliding of markers with the posture is seen (less than"));
  EXPECT_TRUE(says(many.account, "assumes that what does not deform does not slide"));
  const auto few = look({.movements = 5, .hinge = true});
  EXPECT_EQ(few.account.verdict, SkinVerdict::cannot_tell);
  EXPECT_TRUE(says(few.account,
                   "Whether the markers slide with the posture cannot be distinguished from 5 movements"));
  const auto sliding = look({.movements = 10, .hinge = true, .own_slide_m = 0.005});
  EXPECT_FALSE(says(sliding.account, "No sliding of markers with the posture is seen"));
  EXPECT_FALSE(
      says(sliding.account, "Whether the markers slide with the posture cannot be distinguished from"));
  EXPECT_FALSE(says(many.account, "Whether the markers slide with the posture cannot be distinguished from"));
  EXPECT_FALSE(says(few.account, "The error bar assumes that what does not deform does not slide"));
}

TEST(SkinEvidence, FewerThanFourMovementsAreNotTested) {
  const auto seen = look({.movements = 2, .own_slide_m = 0.01});
  EXPECT_TRUE(std::isnan(seen.evidence.shape.p_value));
  EXPECT_EQ(seen.account.verdict, SkinVerdict::cannot_tell);
}

TEST(SkinEvidence, AJointThatMovesIsNotSkin) {
  const auto moves = look({.joint_slide_m = 0.03});
  EXPECT_NE(moves.account.verdict, SkinVerdict::follows);
  EXPECT_TRUE(says(moves.account, "the joint or the markers")) << moves.account.description;
  EXPECT_GT(moves.account.gap_m, 0.001);
  const auto still = look({});
  EXPECT_FALSE(says(still.account, "the joint or the markers"));
  EXPECT_TRUE(std::isnan(still.account.gap_m));
  EXPECT_FALSE(says(look({.own_slide_m = 0.01}).account, "the joint or the markers"))
      << "the shape explains the gap";
}

TEST(SkinEvidence, NothingIsSaidWhereNothingWasMeasured) {
  const auto account = account_of_skin({}, {});
  EXPECT_EQ(account.verdict, SkinVerdict::untested);
  EXPECT_TRUE(account.description.empty());
}

}  // namespace
}  // namespace kinemark::skeleton
