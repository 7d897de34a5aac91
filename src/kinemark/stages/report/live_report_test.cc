// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/live_report.h"

#include <gmock/gmock.h>

namespace kinemark::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(LiveReport, SaysWhatIsKnownBeforeTheFirstFrame) {
  const LiveReport report{.title = "Walk",
                          .source = "sim:walk",
                          .version = "1",
                          .recording = "a.mcap",
                          .rate_hz = 240.0,
                          .markers = {"A", "B"},
                          .up = Eigen::Vector3d::UnitY(),
                          .up_from = "gravity",
                          .extent_m = {{Eigen::Vector3d(-1, 0, 2), Eigen::Vector3d(1, 2, 3)}},
                          .coordinates = {{"knee", true}, {"pelvis_tx", false}},
                          .bodies = {{"pelvis", -1, 11.5, {0.0, 0.1, 0.0}}},
                          .targets = {{.marker = 1, .body = 0, .x_in_body = {0.5, 0.0, 0.0}, .level = 1}},
                          .levels = {"A", "all others"},
                          .strict = true};
  const auto summary = live_report_json(report)["summary"];
  EXPECT_EQ(summary["schema"], "kinemark.live");
  EXPECT_EQ(summary["rate_hz"], 240.0);
  EXPECT_EQ(summary["recording"], "a.mcap");
  EXPECT_EQ(summary["up"].dump(), "[0.0,1.0,0.0]");
  EXPECT_EQ(summary["extent_m"].dump(), "[[-1.0,0.0,2.0],[1.0,2.0,3.0]]");
  EXPECT_EQ(summary["coordinates"].dump(),
            R"([{"name":"knee","unit":"deg"},{"name":"pelvis_tx","unit":"mm"}])");
  EXPECT_EQ(summary["bodies"].dump(),
            R"([{"name":"pelvis","parent":-1,"mass_kg":11.5,"com_m":[0.0,0.1,0.0]}])");
  EXPECT_EQ(summary["targets"].dump(), R"([{"marker":1,"body":0,"point_m":[0.5,0.0,0.0],"level":1}])");
  EXPECT_EQ(summary["levels"].dump(), R"(["A","all others"])");
  EXPECT_EQ(summary["strict"], true);
}

TEST(LiveReport, WhatIsNotKnownIsNull) {
  const auto summary = live_report_json({.title = "x", .rate_hz = 1.0})["summary"];
  EXPECT_TRUE(summary["recording"].is_null());
  EXPECT_TRUE(summary["extent_m"].is_null());
  EXPECT_EQ(summary["coordinates"].dump(), "[]");
}

TEST(LiveReport, ANameEndsNoScript) {
  const auto html = live_report_html({.title = "</script><img onerror=x>", .markers = {"</script>"}});
  EXPECT_THAT(html, HasSubstr("\\u003c/script>\\u003cimg"));
  EXPECT_THAT(html, Not(HasSubstr("</script><img")));
}

}  // namespace
}  // namespace kinemark::report
