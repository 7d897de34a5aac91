// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

MeasuresOutcome outcome() {
  MeasuresOutcome out;
  out.measures.push_back({.id = "path_length",
                          .subject = "RFIN",
                          .quantity = data::Quantity::length,
                          .value = 0.34,
                          .interval = {.kind = data::IntervalKind::two_sided, .low = 0.33, .high = 0.35}});
  out.measures.push_back(
      {.id = "onset", .subject = "</script><b>", .quantity = data::Quantity::time, .remark = "no movement"});
  out.warnings.emplace_back("LFIN was measured in 3 frames; need 30 at least");
  return out;
}

TEST(MeasuresPage, HoldsTheTableTheFiguresAndWhatStandsOut) {
  const auto page = measures_page({.input = "sign.c3d"}, outcome(),
                                  {{"RFIN_path", {.title = "RFIN: path", .panels = {{}}}}});
  for (const char* part : {"\"kind\":\"measures\"", "Path length", "340 [330 to 350] mm", "RFIN: path",
                           "measure not determined", "LFIN was measured in 3 frames", "\"markers\":2"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(MeasuresPage, IsHeadedByWhatItIsOf) {
  const auto heading = [](workflow::MeasuresOf of) {
    MeasuresJob job{.input = "sign.c3d"};
    job.of = of;
    const auto page = measures_page(job, outcome(), {});
    return page.substr(page.find("\"heading\":\""), 80);
  };
  EXPECT_THAT(heading(workflow::MeasuresOf::paths), HasSubstr("\"Paths of markers\",\"rows\":\"Marker\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::muscles), HasSubstr("\"Electromyograms\",\"rows\":\"Channel\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::walking), HasSubstr("\"Walking and force plates\""));
  EXPECT_THAT(heading(workflow::MeasuresOf::everything), HasSubstr("\"All measures of a recording\""));
}

TEST(MeasuresPage, NamesAreTextInIt) {
  const auto page = measures_page({.input = "sign.c3d"}, outcome(), {});
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
}

}  // namespace
}  // namespace kinemark::pipeline
