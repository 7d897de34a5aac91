// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/study_macaque_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "studies/macaque/macaque_figures.h"
#include "studies/macaque/macaque_rows.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

MacaqueJob few_cells() {
  MacaqueJob job;
  job.noise_mm = {1.0};
  job.missing = {0.0, 0.4};
  job.frames = 120;
  job.sleeve_noise_mm = {};
  return job;
}

TEST(StudyMacaque, CellsBecomeATableAndAPage) {
  const auto study = study_macaque(few_cells());
  ASSERT_TRUE(study) << study.error().message;
  // Collinear and staggered: 0 and 40 % without and with noise, and 40 % going with the pose.
  EXPECT_EQ(study->elbow.size(), 10U);
  ASSERT_NE(study->find(1.0, 0.4, true, true), nullptr);
  EXPECT_EQ(study->find(1.0, 0.2, true), nullptr);
  EXPECT_EQ(study->find(0.0, 0.0, false)->errors.ours.frames, 0);
  std::set<std::string> names;
  for (const auto& row : study->table.rows) {
    EXPECT_TRUE(std::isfinite(row.ours)) << row.quantity;
    // The share of known frames of a single seed is not conclusive: it is reported without a bound.
    const bool share = row.quantity.find("frames known (") != std::string::npos;
    const bool count = row.unit == "1" && row.quantity.find("frames") != std::string::npos;
    EXPECT_TRUE(count || row.has_bound() != share) << row.quantity;
    EXPECT_TRUE(names.insert(row.quantity).second) << row.quantity;
  }
  EXPECT_GT(names.size(), 8U);
  const auto page = macaque_page(*study);
  ASSERT_TRUE(page) << page.error().message;
  ASSERT_EQ(page->figures.size(), 9U);
  std::string drawn;
  for (std::size_t i = 0; i < page->figures.size(); ++i) {
    const auto& figure = page->figures[i];
    EXPECT_EQ(figure.number, i < 7 ? static_cast<int>(i + 1) : 0) << "those of the report, then others";
    EXPECT_FALSE(figure.curves.empty()) << figure.caption();
    drawn += report::figure_svg(figure.figure);
  }
  EXPECT_THAT(drawn, HasSubstr("#b8b8b8"));  // the arm's shadow
  EXPECT_EQ(drawn.find("nan"), std::string::npos);
  EXPECT_EQ(drawn.find("href"), std::string::npos);
  EXPECT_THAT(study_html(*page), HasSubstr("Macaque report, figure 6: error of the elbow"));
}

TEST(StudyMacaque, SeedsArePooled) {
  auto job = few_cells();
  job.missing = {0.0};
  job.frames = 60;
  job.seeds = {1, 2};
  const auto both = study_macaque(job).value();
  const auto cell = both.find(1.0, 0.0, true);
  ASSERT_NE(cell, nullptr);
  EXPECT_EQ(cell->errors.ours.frames, 120);
  EXPECT_GE(cell->worst_over_bound, cell->errors.ours.over_bound() - 1e-9);
  const auto one = study_elbow(cell->cell, 1).value();
  auto two = study_elbow(cell->cell, 2).value();
  two += one;
  EXPECT_DOUBLE_EQ(cell->errors.ours.rms_answered_m(), two.ours.rms_answered_m());
  EXPECT_EQ(both.table.seeds, job.seeds);
}

TEST(ElbowResult, KeepsTheWorstSeedAndASeedWithoutANumber) {
  const auto of = [](double ratio) {
    ElbowErrors errors;
    errors.ours.bounded = 10;
    errors.ours.squares_bounded = ratio * ratio;
    errors.ours.bound_squares = 1.0;
    return errors;
  };
  ElbowResult result;
  result.add(of(1.2));
  result.add(of(0.9));
  EXPECT_DOUBLE_EQ(result.worst_over_bound, 1.2);
  EXPECT_EQ(result.errors.ours.bounded, 20);
  result.add({});  // a seed without one bounded frame
  result.add(of(1.0));
  EXPECT_TRUE(std::isnan(result.worst_over_bound));
}

/// A study of one cell with these errors of ours in mm on every frame, and a bound of 1 mm.
MacaqueStudy made_up(double error_mm, double share_determined) {
  MacaqueStudy out;
  for (const double noise_mm : {1.0, 2.0})
    for (const double missing : {0.0, 0.2, 0.4}) {
      ElbowResult r{{1e-3 * noise_mm, missing, 0.0, false, 100}, {}, error_mm};
      auto& ours = r.errors.ours;
      ours.frames = ours.answered = 100;
      ours.determined = ours.bounded = static_cast<std::int64_t>(100.0 * share_determined);
      ours.squares_answered = 100.0 * error_mm * error_mm * 1e-6;
      ours.squares_determined = ours.squares_bounded = share_determined * ours.squares_answered;
      ours.bound_squares = share_determined * 100.0 * 1e-6;
      ours.coordinates = 300;
      ours.within_1sd = 205;
      ours.within_2sd = 286;
      out.elbow.push_back(r);
    }
  return out;
}

const StudyRow* row(const std::vector<StudyRow>& rows, const std::string& part) {
  for (const auto& r : rows)
    if (r.quantity.find(part) != std::string::npos) return &r;
  return nullptr;
}

TEST(MacaqueRows, HoldErrorsAgainstTheBoundAndTheReport) {
  auto study = made_up(1.05, 1.0);
  const auto good = macaque_rows(study, 10);
  for (const auto& r : good) EXPECT_TRUE(r.pass()) << r.quantity;
  ASSERT_NE(row(good, "2 mm noise, 0 % missing"), nullptr);
  EXPECT_EQ(row(good, "2 mm noise, 0 % missing")->paper, 30.0);
  EXPECT_EQ(row(good, "1 mm noise, 20 % missing")->paper, 10.16);
  EXPECT_EQ(row(good, "4 of 5")->paper, 40.0);
  EXPECT_EQ(row(good, "4 of 5")->ours, 40.0);

  const auto worse = macaque_rows(made_up(1.12, 1.0), 10);
  EXPECT_FALSE(row(worse, "worst cell")->pass());
  EXPECT_TRUE(row(macaque_rows(made_up(1.12, 1.0), 1), "worst cell")->pass());  // a single seed scatters
  EXPECT_FALSE(row(macaque_rows(made_up(1.0, 0.7), 10), "20 % missing: frames known")->pass());
  EXPECT_TRUE(row(macaque_rows(made_up(1.05, 0.95), 1), "20 % missing: frames known")->pass());
  EXPECT_FALSE(row(macaque_rows(made_up(1.05, 0.95), 3), "20 % missing: frames known")->pass());
  EXPECT_EQ(row(macaque_rows(made_up(1.0, 0.7), 10), "4 of 5")->ours, -1.0);

  study.elbow[2].worst_over_bound = 1.16;
  EXPECT_TRUE(row(macaque_rows(study, 10), "worst cell")->pass());
  EXPECT_FALSE(row(macaque_rows(study, 10), "worst seed")->pass());
  EXPECT_EQ(row(macaque_rows(study, 1), "worst seed"), nullptr);  // it is the worst cell's
  study.elbow[2].worst_over_bound = std::nan("");
  EXPECT_FALSE(row(macaque_rows(study, 10), "worst seed")->pass());
  study.elbow[2].errors.ours.bound_squares = std::nan("");
  EXPECT_FALSE(row(macaque_rows(study, 10), "worst cell")->pass());
}

TEST(MacaqueRows, ErrorsBeyondFiveSdMustBeFlagged) {
  auto study = made_up(1.0, 1.0);
  study.elbow[0].errors.ours.beyond_5sd = 100;
  study.elbow[0].errors.ours.beyond_5sd_determined = 1;
  const auto good = macaque_rows(study, 10);
  EXPECT_EQ(row(good, "with an error beyond 5 SD")->ours, 100.0);
  EXPECT_FALSE(row(good, "with an error beyond 5 SD")->has_bound());
  EXPECT_TRUE(row(good, "5 SD and called determined")->has_bound());
  EXPECT_TRUE(row(good, "5 SD and called determined")->pass());
  study.elbow[0].errors.ours.beyond_5sd_determined = 2;
  EXPECT_FALSE(row(macaque_rows(study, 10), "5 SD and called determined")->pass());
}

TEST(MacaqueRows, WithoutAnErrorBeyondFiveSdNothingIsSaidOfTheirFlags) {
  const auto rows = macaque_rows(made_up(1.0, 1.0), 10);
  EXPECT_EQ(row(rows, "with an error beyond 5 SD")->ours, 0.0);
  EXPECT_FALSE(row(rows, "5 SD and called determined")->has_bound()) << "0 of 0 is no success";
}

TEST(MacaqueRows, SayHowManyFramesTheyLeaveOut) {
  auto study = made_up(1.0, 0.9);
  EXPECT_EQ(row(macaque_rows(study, 10), "all cells: frames")->ours, 600.0);
  EXPECT_EQ(row(macaque_rows(study, 10), "not called determined")->ours, 60.0);
  EXPECT_TRUE(row(macaque_rows(study, 10), "against the bound")->pass());
  study.elbow[1].errors.ours.determined_without_bound = 1;
  EXPECT_FALSE(row(macaque_rows(study, 10), "against the bound")->pass());
}

TEST(MacaqueRows, ASeedWithoutAResultIsNotMadeUpForByOthers) {
  auto study = made_up(1.0, 1.0);
  study.elbow[1].worst_over_bound = std::nan("");
  for (const std::size_t seeds : {2U, 10U})
    EXPECT_FALSE(row(macaque_rows(study, seeds), "worst cell")->pass()) << seeds;
}

TEST(MacaqueRows, SleeveIsAnsweredInEveryFrame) {
  MacaqueStudy study;
  SleeveResult sleeve{{0.001, false, 1.0}, {}};
  auto& alone = sleeve.errors.alone;
  alone.bounded = 100;
  alone.squares_bounded = alone.bound_squares = 1e-4;
  auto& smoothed = sleeve.errors.smoothed;
  smoothed.frames = smoothed.answered = 100;
  smoothed.determined = 60;
  smoothed.bridged = 40;
  smoothed.squares_answered = 1e-4;
  smoothed.squares_determined = 0.6e-4;
  smoothed.squares_bridged = 0.4e-4;
  study.sleeve = {sleeve};
  for (const auto& r : macaque_rows(study, 10)) EXPECT_TRUE(r.pass()) << r.quantity;
  study.sleeve[0].errors.smoothed.ambiguous = 1;
  EXPECT_FALSE(row(macaque_rows(study, 10), "frames answered")->pass()) << "ambiguous is no answer";
  study.sleeve[0].errors.smoothed.ambiguous = 0;
  study.sleeve[0].errors.smoothed.answered = 99;
  EXPECT_FALSE(row(macaque_rows(study, 10), "frames answered")->pass());
  study.sleeve[0].errors.smoothed.squares_bridged = 1.4e-4;
  EXPECT_FALSE(row(macaque_rows(study, 10), "bridged / determined")->pass());
  study.sleeve[0].errors.alone.beyond_5sd_determined = 1;
  EXPECT_FALSE(row(macaque_rows(study, 10), "alone: errors beyond")->pass());
  study.sleeve[0].errors.smoothed.beyond_5sd = 1;
  EXPECT_FALSE(row(macaque_rows(study, 10), "continuity: errors beyond")->pass());
}

TEST(MacaqueRows, CellsThatWereNotAskedForHaveNoRow) {
  EXPECT_TRUE(macaque_rows({}, 10).empty());
  auto study = made_up(1.0, 1.0);
  std::erase_if(study.elbow, [](const ElbowResult& r) { return r.cell.missing > 0.0; });
  const auto rows = macaque_rows(study, 10);
  EXPECT_NE(row(rows, "2 mm noise, 0 % missing"), nullptr);
  EXPECT_EQ(row(rows, "20 % missing"), nullptr);
  EXPECT_EQ(row(rows, "4 of 5"), nullptr);  // without the 40 % the largest missing share is unknown
  EXPECT_EQ(row(rows, "staggered"), nullptr);
  EXPECT_EQ(row(rows, "sleeve"), nullptr);
}

TEST(MacaqueRows, IntervalsThatAreTooWideFailAsThoseThatAreTooNarrow) {
  for (const auto& [within_1sd, within_2sd, good] :
       {std::tuple{205, 286, true}, std::tuple{150, 286, false}, std::tuple{240, 286, false},
        std::tuple{205, 260, false}, std::tuple{205, 300, false}}) {
    auto study = made_up(1.0, 1.0);
    for (auto& r : study.elbow) {
      r.errors.ours.within_1sd = within_1sd;
      r.errors.ours.within_2sd = within_2sd;
    }
    const auto rows = macaque_rows(study, 10);
    EXPECT_EQ(row(rows, "within one")->pass() && row(rows, "within two")->pass(), good)
        << within_1sd << " " << within_2sd;
  }
}

TEST(StudyMacaque, SameSeedSameTableForAnyNumberOfThreads) {
  auto job = few_cells();
  job.missing = {0.0};
  job.frames = 40;
  job.threads = 1;
  const auto one = study_macaque(job).value();
  job.threads = 3;
  const auto three = study_macaque(job).value();
  ASSERT_EQ(one.table.rows.size(), three.table.rows.size());
  for (std::size_t i = 0; i < one.table.rows.size(); ++i)
    EXPECT_EQ(one.table.rows[i].ours, three.table.rows[i].ours) << one.table.rows[i].quantity;
}

TEST(StudyMacaque, StopsWhenAskedAndNeedsASeed) {
  auto job = few_cells();
  EXPECT_EQ(study_macaque(job, [](std::int64_t, std::int64_t) { return false; }).error().code,
            Code::cancelled);
  job.seeds.clear();
  EXPECT_EQ(study_macaque(job).error().code, Code::usage);
  job = few_cells();
  job.missing = {2.0};
  EXPECT_EQ(study_macaque(job).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::studies
