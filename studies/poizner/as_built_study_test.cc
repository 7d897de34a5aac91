// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/as_built_study.h"

#include <gtest/gtest.h>

namespace kinemark::studies {
namespace {

TEST(AsBuilt, ARigWithoutItsFaultsErrsLittle) {
  const AsBuiltOptions none{.lens_m = 0.0,
                            .turn_rad = 0.0,
                            .roll_rad = 0.0,
                            .stray_share = 0.0,
                            .offset_counts = 0.0,
                            .drift_counts = 0.0,
                            .outermost = 0.7,
                            .glint_share = 0.0,
                            .grid = {.placement_sd_m = 0.0,
                                     .tilt_sd_deg = 0.0,
                                     .roll_sd_deg = 0.0,
                                     .distance_sd_m = 0.0,
                                     .centre_sd_m = 0.0}};
  const auto clean = study_as_built(3, none), built = study_as_built(3);
  ASSERT_TRUE(clean) << clean.error().message;
  ASSERT_TRUE(built) << built.error().message;
  ASSERT_EQ(clean->classic.worst_distance_m.size(), 10u);
  EXPECT_LT(clean->classic.worst_place_m(), 3e-3);
  EXPECT_GT(built->classic.worst_place_m(), 10e-3);
  EXPECT_LT(clean->classic.wheel.max_error_m, 2.5e-3);
  EXPECT_GT(built->classic.wheel.max_error_m, 4e-3);  // the glint
  EXPECT_EQ(built->from_middle_m.front(), 0.0);
  EXPECT_LT(built->ours.worst_place_m(), built->classic.worst_place_m());
}

TEST(AsBuilt, RowsAreOfMedianAndTenthsOverRigs) {
  std::vector<AsBuiltOutcome> rigs(3);
  for (std::size_t k = 0; k < rigs.size(); ++k)
    for (auto* measures : {&rigs[k].classic, &rigs[k].ours})
      measures->worst_distance_m = {1e-3 * static_cast<double>(k + 1), 20e-3 * static_cast<double>(k + 1)};
  const auto rows = as_built_rows(rigs);
  EXPECT_EQ(rows[0].quantity, "tree, best of ten places: largest error of a distance, median of rigs");
  EXPECT_EQ(rows[0].paper, 2.0);
  EXPECT_NEAR(*rows[0].classic, 2.0, 1e-12);
  EXPECT_FALSE(rows[1].paper);
  EXPECT_LT(*rows[1].classic, 2.0);
  EXPECT_GT(*rows[2].classic, 2.0);
  EXPECT_NEAR(*rows[3].classic, 40.0, 1e-12);
  for (const auto& row : rows) EXPECT_FALSE(row.has_bound());
}

}  // namespace
}  // namespace kinemark::studies
