// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/desk_report.h"

#include <gmock/gmock.h>

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(DeskReport, SaysWhereTrialsGo) {
  const auto summary = desk_report_json({.source = "sim:rig", .version = "1", .folder = "day"})["summary"];
  EXPECT_EQ(summary["schema"], "kinemark.desk");
  EXPECT_EQ(summary["schema_version"], 1);
  EXPECT_EQ(summary["source"], "sim:rig");
  EXPECT_EQ(summary["version"], "1");
  EXPECT_EQ(summary["folder"], "day");
}

TEST(DeskReport, ANameEndsNoScript) {
  const auto html = desk_report_html({.source = "</script><img onerror=x>", .folder = "</script>"});
  EXPECT_THAT(html, HasSubstr("\\u003c/script>\\u003cimg"));
  EXPECT_THAT(html, Not(HasSubstr("</script><img")));
}

}  // namespace
}  // namespace kinemark::report
