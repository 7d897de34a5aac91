// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/published_elbow.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::studies {
namespace {

TEST(PublishedElbow, NoiseAndLossesMakeTheReportsMethodErrAndOursHardly) {
  const auto quiet = study_published_elbow({.noise_m = 1e-5, .missing = 0.0, .paper_m = {}}, 3).value();
  const auto noisy = study_published_elbow({.noise_m = 2e-3, .missing = 0.0, .paper_m = {}}, 3).value();
  EXPECT_LT(quiet.classic_m, 2e-3);
  EXPECT_GT(noisy.classic_m, 15e-3);
  EXPECT_LT(noisy.ours_m, 4e-3);
}

TEST(PublishedElbow, ARecordingWithoutCompleteFramesHasNoNumber) {
  const auto errors = study_published_elbow({.noise_m = 7.5e-4, .missing = 0.8, .paper_m = {}}, 3);
  ASSERT_TRUE(errors);
  EXPECT_TRUE(std::isnan(errors->classic_m));
}

PublishedResult cell(double missing, double classic_m) {
  return {.cell = {.noise_m = 7.5e-4, .missing = missing, .paper_m = {}},
          .classic_m = {classic_m},
          .ours_m = {2e-3}};
}

TEST(PublishedElbow, TheShareIsBetweenCells) {
  EXPECT_NEAR(share_at({cell(0.0, 0.04), cell(0.2, 0.01), cell(0.4, 0.03)}, 0.02).value(), 0.3, 1e-12);
  EXPECT_FALSE(share_at({cell(0.2, 0.01), cell(0.4, 0.015)}, 0.02));
}

TEST(PublishedElbow, RowsAreMeansAndDeviationsOverRecordings) {
  auto cells = std::vector{cell(0.2, 0.010), cell(0.4, 0.032)};
  cells[0].cell.paper_m = 0.01016;
  cells[0].classic_m.push_back(0.012), cells[0].ours_m.push_back(4e-3);
  const auto rows = published_rows(cells);
  EXPECT_EQ(rows[0].quantity, "0.75 mm noise, 20 % missing: mean error of the elbow, mean of recordings");
  EXPECT_NEAR(*rows[0].paper, 10.16, 1e-12);
  EXPECT_NEAR(*rows[0].classic, 11.0, 1e-9);
  EXPECT_NEAR(rows[0].ours, 3.0, 1e-9);
  EXPECT_NEAR(*rows[1].classic, std::sqrt(2.0), 1e-9);
  EXPECT_EQ(rows[2].classic, 2.0);
  EXPECT_NEAR(*rows.back().classic, 20.0 + 20.0 * 19.0 / 21.0, 1e-9);
  EXPECT_EQ(rows.back().ours, 40.0);
  for (const auto& row : rows) EXPECT_FALSE(row.has_bound());
}

}  // namespace
}  // namespace kinemark::studies
