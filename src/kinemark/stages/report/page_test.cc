// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "support/test_data.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

TEST(JsonForHtml, CannotEndItsElementAndMeansTheSame) {
  const Json json = {{"</script>", "<!--<script>alert(1)</SCRIPT>"}};
  const std::string text = json_for_html(json);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(Json::parse(text), json);
}

TEST(JsonForHtml, ReplacesBytesThatAreNotUtf8) {
  const std::string text = json_for_html({{"name", "knee\xff\xc3(\x01"}});
  EXPECT_THAT(Json::parse(text)["name"].get<std::string>(), HasSubstr("knee\xef\xbf\xbd"));
  EXPECT_THAT(text, HasSubstr("u0001"));
}

TEST(Page, TemplateIsTheCommittedFileByteForByte) {
  std::ifstream in(testing_support::project_folder() / "viewer/dist/report.html", std::ios::binary);
  std::stringstream file;
  file << in.rdbuf();
  EXPECT_EQ(page_template(), file.str());
  EXPECT_LT(page_template().size(), 400'000U) << "with its script packed";
}

TEST(Page, DataGoIntoTheirElementAndNothingElseChanges) {
  const std::string page = fill_page({{"a", "</script>"}});
  const std::string data = R"({"a":"\u003c/script>"})";
  const std::size_t at = page.find(data);
  ASSERT_NE(at, std::string::npos);
  EXPECT_TRUE(page.substr(0, at).ends_with(R"(id="kinemark-data">)"));
  EXPECT_TRUE(page.substr(at + data.size()).starts_with("</script>"));
  std::string emptied = page;
  emptied.replace(at, data.size(), "null");
  EXPECT_EQ(emptied, page_template());
}

}  // namespace
}  // namespace kinemark::report::internal
