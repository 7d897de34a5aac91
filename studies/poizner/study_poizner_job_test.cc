// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/study_poizner_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "studies/poizner/study_figures.h"
#include "studies/poizner/study_rows.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;

TEST(StudyPoizner, OneRigMakesTheWholeTable) {
  PoiznerJob job;
  job.seeds = {2};
  const auto study = study_poizner(job);
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->table.rows.size(), 59U);
  EXPECT_TRUE(study->table.pass()) << study_text(study->table);
  std::set<std::string> names;
  for (const auto& row : study->table.rows) {
    EXPECT_TRUE(std::isfinite(row.ours)) << row.quantity;
    EXPECT_TRUE(row.at_least || row.at_most) << row.quantity;
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
  const auto page = study_html(study_page(*study));
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_THAT(page, HasSubstr("Acceleration of the hand"));
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);  // nothing is fetched
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
