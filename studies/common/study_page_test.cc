// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
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
  page.figures = {
      {.paper = "Smith 1990", .number = 1, .name = "errors", .numbers = {{"a < b", "mm", 2.0, {}, 1.0}}}};
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

/// What the page holds, without the page around it.
nlohmann::json data_of(const std::string& html) {
  const std::string begin = "id=\"kinemark-data\">";
  const auto from = html.find(begin) + begin.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(StudyPage, HoldsFiguresInOrderAndTheTable) {
  auto page = example();
  page.figures.push_back({.paper = "Smith 1990", .name = "later & last"});
  const auto data = data_of(study_html(page));
  EXPECT_EQ(data["summary"]["kind"], "study");
  EXPECT_EQ(data["summary"]["trial"], "Arms");
  const auto& result = data["result"];
  EXPECT_EQ(result["description"], "a < b");
  EXPECT_EQ(result["classic"], "1986 method");
  ASSERT_EQ(result["figures"].size(), 2U);
  EXPECT_EQ(result["figures"][0]["caption"], "Smith 1990, figure 1: errors");
  const auto body = result["figures"][0]["body"].get<std::string>();
  EXPECT_THAT(body, HasSubstr("<svg"));
  EXPECT_THAT(body, HasSubstr("<p>A &lt; b: 2 mm in the paper, 1 mm here.</p>"));
  EXPECT_EQ(result["figures"][1]["caption"], "later & last");
  ASSERT_EQ(result["rows"].size(), 2U);
  EXPECT_EQ(result["rows"][0]["paper"], 30.0);
}

TEST(StudyPage, TellsWhichBoundsAreMissed) {
  auto page = example();
  const auto missed = data_of(study_html(page))["summary"];
  EXPECT_EQ(missed["verdict"], "attention");
  ASSERT_EQ(missed["groups"].size(), 1U);
  EXPECT_EQ(missed["groups"][0]["title"], "1 bound missed");
  EXPECT_EQ(missed["groups"][0]["items"][0]["text"], "share: 1 %, asked is at least 2.");
  page.table.rows.pop_back();
  const auto met = data_of(study_html(page))["summary"];
  EXPECT_EQ(met["verdict"], "good");
  EXPECT_TRUE(met["groups"].empty());
}

TEST(StudyPage, ARowWithoutABoundMissesNone) {
  auto page = example();
  page.table.rows = {{.quantity = "count",
                      .unit = "1",
                      .ours = 4.0,
                      .expected = 3.0,
                      .expected_is = Expectation::predicted_sd}};
  const auto data = data_of(study_html(page));
  EXPECT_EQ(data["summary"]["verdict"], "good");
  EXPECT_THAT(data["result"]["columns"].get<std::string>(),
              HasSubstr("SD: the standard deviation that ours states"));
  EXPECT_THAT(data["result"]["columns"].get<std::string>(), Not(HasSubstr("Cramer-Rao")));
}

TEST(HtmlText, ShowsWhatHtmlWouldTakeForItsOwn) {
  EXPECT_EQ(html_text("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(html_text("&amp;"), "&amp;amp;");
  EXPECT_EQ(html_text("m/s²"), "m/s²");
  EXPECT_EQ(html_text(""), "");
}

}  // namespace
}  // namespace kinemark::studies
