// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/poizner/study_poizner_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "kinemark/pipeline/poizner/study_figures.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(StudyPoizner, ReadsSeeds) {
  EXPECT_THAT(parse_seeds("3").value(), ElementsAre(3));
  EXPECT_THAT(parse_seeds("1-4").value(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parse_seeds("1,7-8").value(), ElementsAre(1, 7, 8));
  for (const char* wrong : {"", "1,", "a", "4-2", "1-", "-3", "1-99999", "1 2"})
    EXPECT_EQ(parse_seeds(wrong).error().code, Code::usage) << wrong;
}

TEST(StudyPoizner, RowsPassWithinTheirBounds) {
  StudyRow row{.quantity = "x", .unit = "mm", .ours = 0.7, .at_least = 0.6, .at_most = 1.3};
  EXPECT_TRUE(row.pass());
  row.ours = 1.4;
  EXPECT_FALSE(row.pass());
  row.ours = 0.5;
  EXPECT_FALSE(row.pass());
  row.ours = std::nan("");
  EXPECT_FALSE(row.pass());
}

TEST(StudyPoizner, OneRigMakesTheWholeTable) {
  PoiznerJob job;
  job.seeds = {2};
  const auto study = study_poizner(job);
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->rows.size(), 59U);
  EXPECT_TRUE(study->pass()) << study_table(*study);
  std::set<std::string> names;
  for (const auto& row : study->rows) {
    EXPECT_TRUE(std::isfinite(row.ours)) << row.quantity;
    EXPECT_TRUE(row.at_least || row.at_most) << row.quantity;
    EXPECT_TRUE(names.insert(row.quantity).second) << row.quantity;
    if (row.classic && row.at_most && row.quantity.find("ratio") == std::string::npos) {
      EXPECT_LT(row.ours, *row.classic + 0.6) << row.quantity;
    }
  }
  const auto json = study_json(*study);
  EXPECT_EQ(json["rows"].size(), study->rows.size());
  EXPECT_EQ(json["pass"].get<bool>(), study->pass());
  EXPECT_TRUE(json["rows"][3]["paper"].is_null());
  EXPECT_THAT(study_table(*study), HasSubstr("arm: hand, error of position"));
  const auto page = study_page(*study);
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
}  // namespace kinemark::pipeline
