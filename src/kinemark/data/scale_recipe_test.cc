// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/scale_recipe.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

TEST(ScaleRecipe, MeasuresOnlyWhatAStepAsksFor) {
  ScaleRecipe recipe;
  EXPECT_FALSE(recipe.measures()) << "there is nothing to measure";
  recipe.measurements = {{.name = "thigh", .pairs = {{"HIP", "KNEE"}}, .bodies = {{.body = "femur"}}}};
  EXPECT_TRUE(recipe.measures());
  recipe.order = {ScaleStep::manual};
  EXPECT_FALSE(recipe.measures()) << "no step measures";
}

}  // namespace
}  // namespace kinemark::data
