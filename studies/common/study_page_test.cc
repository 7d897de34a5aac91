// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/core/html_text.h"

namespace kinemark::studies {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

StudyPage example() {
  StudyPage page;
  page.title = "Study: arms & legs";
  page.heading = "Arms";
  page.description = "a < b";
  page.classic = "1986 method";
  page.figures = {{"Errors", "<svg id=\"one\"></svg>"}};
  page.table.seeds = {1};
  page.table.rows = {{.quantity = "error", .unit = "mm", .paper = 30.0, .ours = 2.0, .at_most = 3.0},
                     {.quantity = "share", .unit = "%", .ours = 1.0, .at_least = 2.0}};
  return page;
}

TEST(HtmlText, EscapesWhatMarksUpAndNothingElse) {
  EXPECT_EQ(html_text("a < b && c > \"d\""), "a &lt; b &amp;&amp; c &gt; &quot;d&quot;");
  EXPECT_EQ(html_text("&lt;"), "&amp;lt;") << "what is escaped already is text, too";
  EXPECT_EQ(html_text("5 % of 'x'\n\u00b5m"), "5 % of 'x'\n\u00b5m");
  EXPECT_EQ(html_text(""), "");
}

TEST(StudyPage, HoldsFiguresAndTheTable) {
  const auto html = study_html(example());
  EXPECT_THAT(html, HasSubstr("<title>Study: arms &amp; legs</title>"));
  EXPECT_THAT(html, HasSubstr("<p class=\"words\">a &lt; b</p>"));
  EXPECT_THAT(html, HasSubstr("<figcaption>Errors</figcaption><svg id=\"one\"></svg>"));
  EXPECT_THAT(html, HasSubstr("<th>1986 method</th>"));
  EXPECT_THAT(html, HasSubstr("<tr><th>error</th><td>mm</td><td>30</td><td></td><td>2</td>"));
  EXPECT_THAT(html, HasSubstr("<tr class=\"fails\"><th>share</th>"));
  EXPECT_THAT(html, Not(HasSubstr("http")));  // nothing is fetched
}

TEST(StudyPage, FiguresComeBeforeTheTableInTheOrderGiven) {
  auto page = example();
  page.figures.push_back({"Later & last", "<p>second</p>"});
  const auto html = study_html(page);
  const auto first = html.find(">Errors<"), second = html.find(">Later &amp; last<"),
             table = html.find("<table>");
  ASSERT_NE(second, std::string::npos);
  EXPECT_LT(first, second);
  EXPECT_LT(second, table);
}

TEST(StudyPage, NumbersOfNoUnitHaveNone) {
  auto page = example();
  page.table.rows = {{.quantity = "ratio", .unit = "1", .ours = 1.05}};
  EXPECT_THAT(study_html(page), HasSubstr("<th>ratio</th><td></td><td></td><td></td><td>1.05</td>"));
}

TEST(StudyPage, RowsWithoutABoundSaySo) {
  auto page = example();
  page.table.rows = {{.quantity = "count",
                      .unit = "1",
                      .ours = 4.0,
                      .expected = 3.0,
                      .expected_is = Expectation::predicted_sd}};
  const auto html = study_html(page);
  EXPECT_THAT(html, HasSubstr("<td>4</td><td>3 SD</td><td colspan=\"2\">no bound</td></tr>"));
  EXPECT_THAT(html, HasSubstr("SD: the standard deviation that ours states"));
  EXPECT_THAT(html, Not(HasSubstr("Cramer-Rao")));
}

TEST(HtmlText, ShowsWhatHtmlWouldTakeForItsOwn) {
  EXPECT_EQ(html_text("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(html_text("&amp;"), "&amp;amp;");
  EXPECT_EQ(html_text("m/s²"), "m/s²");
  EXPECT_EQ(html_text(""), "");
}

}  // namespace
}  // namespace kinemark::studies
