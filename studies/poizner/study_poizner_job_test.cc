// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/study_poizner_job.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "studies/poizner/study_figures.h"
#include "studies/poizner/study_rows.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

const Result<PoiznerStudy>& rig_two() {
  static const auto study = study_poizner({.seeds = {2}});
  return study;
}

const StudyRow& row_named(const std::vector<StudyRow>& rows, const std::string& quantity) {
  return *std::ranges::find(rows, quantity, &StudyRow::quantity);
}

TEST(StudyPoizner, OneRigMakesTheWholeTable) {
  const auto& study = rig_two();
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->table.rows.size(), 72U);
  EXPECT_TRUE(study->table.pass()) << study_text(study->table);
  std::set<std::string> names;
  for (const auto& row : study->table.rows) {
    EXPECT_TRUE(std::isfinite(row.ours)) << row.quantity;
    EXPECT_EQ(row.has_bound(), !row.quantity.ends_with("by spread over all samples")) << row.quantity;
    EXPECT_TRUE(names.insert(row.quantity).second) << row.quantity;
    if (row.classic && row.at_most && row.quantity.find("ratio") == std::string::npos) {
      EXPECT_LT(row.ours, *row.classic + 0.6) << row.quantity;
    }
  }
  // A rig without a number is not hidden by one that has it, whichever comes first.
  for (const std::size_t without : {0U, 1U}) {
    auto seeds = study->seeds;
    seeds.push_back(seeds.front());
    seeds[without].chi2_per_dof = std::nan("");
    seeds[without].wheels.front().ours.sd_m = std::nan("");
    int fail = 0;
    for (const auto& row : study_rows(seeds))
      if (!row.pass()) {
        EXPECT_TRUE(std::isnan(row.ours)) << row.quantity;
        ++fail;
      }
    EXPECT_EQ(fail, 3) << without;  // chi2 smallest and largest, scatter of the diameter
  }
  const auto json = study_json(study->table);
  EXPECT_EQ(json["rows"].size(), study->table.rows.size());
  EXPECT_EQ(json["pass"].get<bool>(), study->table.pass());
  EXPECT_TRUE(json["rows"][3]["paper"].is_null());
  EXPECT_THAT(study_text(study->table), HasSubstr("arm: hand, error of position"));
  const auto page = study_page(*study);
  ASSERT_TRUE(page) << page.error().message;
  ASSERT_EQ(page->figures.size(), 6U);
  for (int number = 1; number <= 6; ++number) {
    const auto& figure = page->figures[static_cast<std::size_t>(number - 1)];
    EXPECT_EQ(figure.title(), fmt::format("Poizner 1986, figure {}", number));
    EXPECT_FALSE(figure.curves.empty()) << number;
    const auto svg = report::figure_svg(figure.figure);
    EXPECT_GT(svg.size(), 2000U) << number;
    EXPECT_EQ(svg.find("nan"), std::string::npos) << number;
    EXPECT_EQ(svg.find("href"), std::string::npos) << number << ": nothing is fetched";
  }
  EXPECT_THAT(study_html(*page), HasSubstr("Poizner 1986, figure 6: the sign LOOK-AT[Continuative]"));
}

TEST(StudyPoizner, WhatIsExpectedIsOfTheRigWhoseResultIsShown) {
  ASSERT_TRUE(rig_two());
  const PoiznerSeed& good = rig_two()->seeds.front();
  PoiznerSeed bad = good;
  bad.tree.ours.sd_m *= 2.0;
  bad.tree.cramer_rao_sd_m *= 3.0;
  bad.arm.leds[1].ours.velocity *= 5.0;
  bad.arm.leds[1].predicted.velocity *= 7.0;
  const auto& name = good.arm.leds[1].name;
  for (const auto& seeds : {std::vector{good, bad, good}, std::vector{bad, good, good}}) {
    const auto rows = study_rows(seeds);
    const auto& scatter = row_named(rows, "still tree: scatter of a frame, y");
    EXPECT_EQ(scatter.expected_is, Expectation::cramer_rao);
    EXPECT_DOUBLE_EQ(scatter.ours, 2e3 * good.tree.ours.sd_m.y());
    EXPECT_DOUBLE_EQ(*scatter.expected, 3e3 * good.tree.cramer_rao_sd_m.y());
    const auto& velocity = row_named(rows, "arm: " + name + ", error of velocity");
    EXPECT_EQ(velocity.expected_is, Expectation::predicted_sd);
    EXPECT_DOUBLE_EQ(*velocity.expected, 7e3 * good.arm.leds[1].predicted.velocity);
  }
}

TEST(StudyPoizner, ScatterReachesTheBoundAndDoesNotBeatIt) {
  ASSERT_TRUE(rig_two());
  for (const auto& row : rig_two()->table.rows) {
    if (row.expected_is != Expectation::cramer_rao) continue;
    // 30 scatters of 100 frames each: their median is known to 1.3 %.
    EXPECT_GT(row.ours, 0.95 * *row.expected) << row.quantity;
    EXPECT_LT(row.ours, 1.2 * *row.expected) << row.quantity;
  }
}

TEST(StudyPoizner, TheOrderOfTheRigsChangesNoBit) {
  ASSERT_TRUE(rig_two());
  std::vector<PoiznerSeed> seeds(7, rig_two()->seeds.front());
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (auto* values : {&seeds[i].tree.predicted_sd_m, &seeds[i].tree.ours.distance_error_m})
      for (double& value : *values) value *= std::pow(1.7, static_cast<double>(i));
  const auto forwards = study_json({.seeds = {}, .rows = study_rows(seeds)});
  std::ranges::reverse(seeds);
  EXPECT_EQ(forwards, study_json({.seeds = {}, .rows = study_rows(seeds)}));
  std::swap(seeds[1], seeds[5]);
  EXPECT_EQ(forwards, study_json({.seeds = {}, .rows = study_rows(seeds)}));
}

TEST(StudyPoizner, StopsWhenAskedAndNeedsASeed) {
  PoiznerJob job;
  EXPECT_EQ(study_poizner(job, [](std::int64_t, std::int64_t) { return false; }).error().code,
            Code::cancelled);
  job.seeds.clear();
  EXPECT_EQ(study_poizner(job).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::studies
