// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/example_trial.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report {
namespace {

using internal::example_trial;
using internal::ExampleTrial;
using internal::unpack_codes;
using internal::unpack_curve;
using testing::HasSubstr;
using testing::Not;

using Json = nlohmann::ordered_json;

IkReport report_of(const ExampleTrial& t, bool with_markers = true) {
  const data::Trajectories* markers = with_markers ? &t.markers : nullptr;
  return {.summary = summarize(t.run, t.motion, markers).value(), .motion = &t.motion, .markers = markers};
}

TEST(ReportJson, HoldsEveryFrameOfAShortTrial) {
  const ExampleTrial t = example_trial(600);
  const Json series = report_json(report_of(t))["series"];
  EXPECT_EQ(series["frame_step"], 1);
  EXPECT_EQ(series["points"], 600);
  ASSERT_EQ(series["coordinates"].size(), 20U);
  for (const std::int64_t j : {0, 3, 19}) {
    const Json& c = series["coordinates"][static_cast<std::size_t>(j)];
    const auto value = unpack_curve(c["value"]);
    const auto sd = unpack_curve(c["sd"]);
    ASSERT_EQ(value.size(), 600U);
    const double unit = t.motion.is_rotation[static_cast<std::size_t>(j)] ? kDegPerRad : 1.0;
    for (std::int64_t f = 0; f < 600; f += 7) {
      const std::size_t i = t.motion.index(f, j);
      if (t.motion.determined[i] == 0) {
        EXPECT_TRUE(std::isnan(value[static_cast<std::size_t>(f)])) << "never a number that no marker fixes";
        EXPECT_TRUE(std::isnan(sd[static_cast<std::size_t>(f)]));
      } else {
        // To a 32nd of the standard deviation, and that to a 40th of itself.
        const double bar = unit * t.motion.q_sd[i];
        EXPECT_NEAR(value[static_cast<std::size_t>(f)], unit * t.motion.q[i], std::min(0.005, bar / 20));
        EXPECT_NEAR(sd[static_cast<std::size_t>(f)], bar, bar / 35);
      }
    }
  }
}

TEST(ReportJson, SaysWhereCoordinatesAreUndeterminedAndOnlyThere) {
  const ExampleTrial t = example_trial(600);
  const Json series = report_json(report_of(t))["series"];
  EXPECT_TRUE(series["coordinates"][0]["undetermined"].is_null());
  EXPECT_TRUE(series["coordinates"][11]["sd"].is_null()) << "a locked coordinate has no SD";
  const auto flags = unpack_codes(series["coordinates"][19]["undetermined"]);
  ASSERT_EQ(flags.size(), 600U);
  EXPECT_EQ(flags[214], 0);
  EXPECT_EQ(flags[215], 1);
  EXPECT_EQ(flags[289], 1);
  EXPECT_EQ(flags[290], 0);
}

TEST(ReportJson, GapMapTellsStatesApart) {
  const ExampleTrial t = example_trial(600);
  const Json gaps = report_json(report_of(t))["series"]["gaps"];
  ASSERT_EQ(gaps.size(), 31U);
  EXPECT_EQ(unpack_codes(gaps[28])[250], 2) << "missing";
  EXPECT_EQ(unpack_codes(gaps[5])[130], 1) << "interpolated";
  EXPECT_EQ(unpack_codes(gaps[12])[358], 3) << "rejected";
  EXPECT_EQ(unpack_codes(gaps[12])[100], 0) << "measured";
  EXPECT_EQ(unpack_codes(gaps[30])[0], 0) << "the marker that was left out is there too";
}

TEST(ReportJson, WithoutStatesTheErrorsTellWhatWasSeen) {
  const ExampleTrial t = example_trial(600);
  const Json gaps = report_json(report_of(t, false))["series"]["gaps"];
  ASSERT_EQ(gaps.size(), 31U);
  EXPECT_EQ(unpack_codes(gaps[28])[250], 2);
  EXPECT_EQ(unpack_codes(gaps[28])[200], 0);
  EXPECT_TRUE(gaps[30].is_null());
}

TEST(ReportJson, ErrorsAreDistancesInMillimetres) {
  ExampleTrial t = example_trial(100);
  for (double& e : t.motion.marker_error) e = kNaN;
  const std::size_t at = 3 * 30 * 7;  // frame 7, marker 0
  t.motion.marker_error[at] = 0.002;
  t.motion.marker_error[at + 1] = -0.003;
  t.motion.marker_error[at + 2] = 0.006;
  const Json series = report_json(report_of(t))["series"];
  EXPECT_NEAR(unpack_curve(series["marker_error_mm"][0])[7], 7.0, 1e-9);
  EXPECT_NEAR(unpack_curve(series["rms_error_mm"])[7], 7.0, 1e-9);
  EXPECT_TRUE(std::isnan(unpack_curve(series["marker_error_mm"][1])[7]));
  EXPECT_TRUE(std::isnan(unpack_curve(series["rms_error_mm"])[8]));
}

TEST(ReportJson, StatusIsRankedByHowBadItIs) {
  ExampleTrial t = example_trial(100);
  t.motion.status[1] = data::FrameStatus::underdetermined;
  t.motion.status[2] = data::FrameStatus::not_converged;
  t.motion.status[3] = data::FrameStatus::no_markers;
  const auto status = unpack_codes(report_json(report_of(t))["series"]["status"]);
  EXPECT_EQ((std::vector<std::uint8_t>{status.begin(), status.begin() + 4}),
            (std::vector<std::uint8_t>{0, 1, 2, 3}));
}

TEST(ReportJson, ThinningKeepsPeaksGapsAndTheWidestBand) {
  ExampleTrial t = example_trial(5000);
  t.motion.q[t.motion.index(3217, 0)] = 1.5;
  t.motion.q_sd[t.motion.index(3218, 0)] = 0.7;
  t.motion.determined[t.motion.index(4100, 2)] = 0;
  t.motion.status[4444] = data::FrameStatus::no_markers;
  t.markers.set_missing(4999, 0);
  const Json series = report_json(report_of(t), {.max_points = 200})["series"];
  EXPECT_EQ(series["points"], 200);
  EXPECT_EQ(series["frame_step"], 25);
  const auto most = [](const auto& v) {
    return *std::ranges::max_element(v, {}, [](auto x) { return std::isnan(x) ? -1e9 : x; });
  };
  EXPECT_NEAR(most(unpack_curve(series["coordinates"][0]["value"])), 1.5 * kDegPerRad, 5.1e-3);
  EXPECT_NEAR(most(unpack_curve(series["coordinates"][0]["sd"])), 0.7 * kDegPerRad, 1e-2);
  EXPECT_EQ(unpack_codes(series["coordinates"][2]["undetermined"])[164], 1);
  EXPECT_EQ(unpack_codes(series["status"])[177], 3);
  EXPECT_EQ(unpack_codes(series["gaps"][0])[199], 2);
}

TEST(ReportHtml, SizeIsBoundedWhateverTheLength) {
  const ExampleTrial t = example_trial(30000);
  const IkReport report = report_of(t);
  const std::size_t bare = report_html(report, {.max_data_bytes = 2000}).size();
  EXPECT_LT(report_html(report).size(), bare + 2'000'000U);
  EXPECT_LT(report_html(report, {.max_data_bytes = 300'000}).size(), bare + 300'000U);
}

TEST(ReportHtml, IsDeterministicAndHoldsItsJson) {
  const ExampleTrial a = example_trial(300), b = example_trial(300);
  const std::string page = report_html(report_of(a));
  EXPECT_EQ(page, report_html(report_of(b)));
  const std::string open = R"(id="kinemark-data">)";
  const std::size_t at = page.find(open) + open.size();
  EXPECT_EQ(Json::parse(page.substr(at, page.find("</script>", at) - at)), report_json(report_of(a)));
}

TEST(ReportHtml, NamesFromFilesCannotBecomeMarkup) {
  ExampleTrial t = example_trial(100);
  t.run.trial = "</script><script>alert(1)</script>";
  t.run.warnings = {"<img src=x onerror=alert(2)>", "not UTF-8: \xff\xfe"};
  t.motion.coordinates[0] = "<b>\"hip\"</b>";
  const std::string page = report_html(report_of(t));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
}

TEST(ReportHtml, AnEmptyTrialIsStillAPage) {
  data::JointMotion m;
  m.time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = 0};
  const IkReport report{.summary = summarize({}, m, nullptr).value(), .motion = &m};
  EXPECT_THAT(report_html(report), HasSubstr("\"points\":0"));
}

TEST(ReportJson, RefusesArraysThatAreNotItsSummarys) {
  const ExampleTrial t = example_trial(100), other = example_trial(101);
  IkReport report = report_of(t);
  report.motion = &other.motion;
  EXPECT_THROW((void)report_json(report), ContractError);
  report.motion = nullptr;
  EXPECT_THROW((void)report_json(report), ContractError);
  report = report_of(t);
  report.markers = &other.markers;
  EXPECT_THROW((void)report_json(report), ContractError);
  EXPECT_THROW((void)report_json(report_of(t), {.max_points = 1}), ContractError);
  EXPECT_FALSE(ReportOptions{.max_data_bytes = 10}.check());
}

}  // namespace
}  // namespace kinemark::report
