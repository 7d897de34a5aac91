// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/html_text.h"

#include <gtest/gtest.h>

namespace kinemark {
namespace {

TEST(HtmlText, EscapesWhatWouldBeMarkupAndNothingElse) {
  EXPECT_EQ(html_text("</script><img src=\"x\">"), "&lt;/script&gt;&lt;img src=&quot;x&quot;&gt;");
  EXPECT_EQ(html_text("a & b"), "a &amp; b");
  EXPECT_EQ(html_text("&lt;"), "&amp;lt;");
  EXPECT_EQ(html_text("LASI 1.5 \xC2\xB0"), "LASI 1.5 \xC2\xB0");
  EXPECT_EQ(html_text(""), "");
}

TEST(JsonInHtml, CannotEndItsElementAndMeansTheSame) {
  EXPECT_EQ(json_in_html(R"({"a":"</script><!-- & >"})"), R"({"a":"\u003c/script>\u003c!-- & >"})");
  EXPECT_EQ(json_in_html(""), "");
}

}  // namespace
}  // namespace kinemark
