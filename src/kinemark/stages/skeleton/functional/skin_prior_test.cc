// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_prior.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::skeleton {
namespace {

TEST(SkinPrior, DefaultsAreUsable) { EXPECT_TRUE(SkinPrior{}.check()); }

TEST(SkinPrior, RefusesWhatIsNoSize) {
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_FALSE(SkinPrior{.turn = bad}.check());
    EXPECT_FALSE(SkinPrior{.turn_weight = bad}.check());
    EXPECT_FALSE(SkinPrior{.slide_m = bad}.check());
  }
}

}  // namespace
}  // namespace kinemark::skeleton
