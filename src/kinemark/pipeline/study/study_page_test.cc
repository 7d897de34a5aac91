// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study/study_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

StudyPage example() {
  StudyPage page;
  page.title = "Study: arms & legs";
  page.heading = "Arms";
  page.words = "a < b";
  page.classic = "1986 method";
  page.figures = {{"Errors", "<svg id=\"one\"></svg>"}};
  page.table.seeds = {1};
  page.table.rows = {{.quantity = "error", .unit = "mm", .paper = 30.0, .ours = 2.0, .at_most = 3.0},
                     {.quantity = "share", .unit = "%", .ours = 1.0, .at_least = 2.0}};
  return page;
}

TEST(StudyPage, HoldsFiguresAndTheTable) {
  const auto html = study_html(example());
  EXPECT_THAT(html, HasSubstr("<title>Study: arms &amp; legs</title>"));
  EXPECT_THAT(html, HasSubstr("<p>a &lt; b</p>"));
  EXPECT_THAT(html, HasSubstr("<figcaption>Errors</figcaption><svg id=\"one\"></svg>"));
  EXPECT_THAT(html, HasSubstr("<th>1986 method</th>"));
  EXPECT_THAT(html, HasSubstr("<tr><th>error</th><td>mm</td><td>30</td><td></td><td>2</td>"));
  EXPECT_THAT(html, HasSubstr("<tr class=\"fails\"><th>share</th>"));
  EXPECT_THAT(html, Not(HasSubstr("http")));  // nothing is fetched
}

TEST(StudyPage, IsWrittenWholeAndReplacesOnlyByForce) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch / "page.html";
  ASSERT_TRUE(write_study_page(example(), path, false));
  EXPECT_EQ(io::read_text(path).value(), study_html(example()));
  EXPECT_EQ(write_study_page(example(), path, false).error().code, Code::io);
  EXPECT_TRUE(write_study_page(example(), path, true));
}

}  // namespace
}  // namespace kinemark::pipeline
