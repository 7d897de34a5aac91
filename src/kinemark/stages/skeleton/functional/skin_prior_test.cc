// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_prior.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinemark::skeleton {
namespace {

TEST(SkinPrior, DefaultsAreUsable) { EXPECT_TRUE(SkinPrior{}.check()); }

TEST(SkinPrior, RefusesWhatIsNoSize) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(SkinPrior{.ball = bad}.check());
    EXPECT_FALSE(SkinPrior{.hinge = bad}.check());
    EXPECT_FALSE(SkinPrior{.misfit = bad}.check());
    EXPECT_FALSE(SkinPrior{.anywhere = bad}.check());
  }
  EXPECT_FALSE(SkinPrior{.ball_factor = 1.0}.check());
  EXPECT_FALSE(SkinPrior{.hinge_factor = 0.5}.check());
  EXPECT_FALSE(SkinPrior{.anywhere = 1.0}.check());
}

}  // namespace
}  // namespace kinemark::skeleton
