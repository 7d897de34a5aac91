// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/stages/analysis/path/internal/refit_values.h"

namespace kinemark::analysis::internal {
namespace {

const PathDefinition* definition_of(std::string_view id) {
  const auto all = path_definitions();
  const auto found = std::ranges::find(all, id, [](const auto& one) { return one.what.id; });
  return found == all.end() ? nullptr : &*found;
}

double spread_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v, squares += v * v;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
}

RefitValues values_with(double wander, double of_noise) {
  RefitValues out({definition_of("dominant_frequency"), definition_of("path_length")});
  out.wander = {wander, 0.0};
  out.wander_of_noise = {of_noise, 0.0};
  for (auto& deviations : out.by_less) deviations.assign(400, 0.0);
  return out;
}

TEST(RefitValues, RepetitionsThatDifferWidenDeviations) {
  auto values = values_with(5e-4, 1e-4);
  values.add_wander(1, 2);
  EXPECT_NEAR(spread_of(values.by_less[0]), 0.02, 0.002);
  double sum = 0.0;
  for (const double v : values.by_less[0]) sum += v;
  EXPECT_NEAR(sum, 0.0, 1e-9);  // the value stays
  EXPECT_EQ(spread_of(values.by_less[1]), 0.0);
}

TEST(RefitValues, WhatNoiseDoesIsNotAddedTwice) {
  auto values = values_with(1e-4, 2e-4);
  values.add_wander(1, 2);
  EXPECT_EQ(spread_of(values.by_less[0]), 0.0);
}

TEST(RefitValues, DoubtIsTheSpreadOfTheLoudThird) {
  auto values = values_with(0.0, 0.0);
  std::vector<double> deviations;
  for (int k = 0; k < 90; ++k) {
    values.let_through.push_back(k < 45 ? 1.0 : 4.0);
    deviations.push_back((k % 2 == 0 ? 1.0 : -1.0) * (k < 45 ? 1.0 : 3.0));
  }
  EXPECT_NEAR(values.doubt(deviations), 3.0, 0.01);
  deviations.pop_back();
  EXPECT_EQ(values.doubt(deviations), 1.0);  // no longer one of each refit
}

}  // namespace
}  // namespace kinemark::analysis::internal
