// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/example_trial.h"

namespace kinemark::report {
namespace {

using internal::example_trial;
using internal::ExampleTrial;
using testing::HasSubstr;
using testing::Not;

using Json = nlohmann::ordered_json;

IkReport report_of(const ExampleTrial& t, bool with_markers = true) {
  const data::Trajectories* markers = with_markers ? &t.markers : nullptr;
  return {.summary = summarize(t.run, t.motion, markers).value(), .motion = &t.motion, .markers = markers};
}

std::vector<std::uint8_t> decode_bytes(const std::string& text) {
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> out;
  unsigned bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    have += 6;
    if (have < 8) continue;
    have -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> have));
  }
  return out;
}

std::vector<float> decode_floats(const std::string& text) {
  const auto bytes = decode_bytes(text);
  std::vector<float> out(bytes.size() / 4);
  std::memcpy(out.data(), bytes.data(), 4 * out.size());
  return out;
}

TEST(ReportJson, HoldsEveryFrameOfAShortTrial) {
  const ExampleTrial t = example_trial(600);
  const Json series = report_json(report_of(t))["series"];
  EXPECT_EQ(series["frame_step"], 1);
  EXPECT_EQ(series["points"], 600);
  ASSERT_EQ(series["coordinates"].size(), 20U);
  for (const std::int64_t j : {0, 3, 19}) {
    const Json& c = series["coordinates"][static_cast<std::size_t>(j)];
    const auto value = decode_floats(c["value"]);
    const auto sd = decode_floats(c["sd"]);
    ASSERT_EQ(value.size(), 600U);
    const double unit = t.motion.is_rotation[static_cast<std::size_t>(j)] ? kDegPerRad : 1.0;
    for (std::int64_t f = 0; f < 600; f += 7) {
      const std::size_t i = t.motion.index(f, j);
      if (t.motion.determined[i] == 0) {
        EXPECT_TRUE(std::isnan(value[static_cast<std::size_t>(f)])) << "never a number that no marker fixes";
        EXPECT_TRUE(std::isnan(sd[static_cast<std::size_t>(f)]));
      } else {
        EXPECT_NEAR(value[static_cast<std::size_t>(f)], unit * t.motion.q[i], 1e-4);
        EXPECT_NEAR(sd[static_cast<std::size_t>(f)], unit * t.motion.q_sd[i], 1e-5);
      }
    }
  }
}

TEST(ReportJson, SaysWhereCoordinatesAreUndeterminedAndOnlyThere) {
  const ExampleTrial t = example_trial(600);
  const Json series = report_json(report_of(t))["series"];
  EXPECT_TRUE(series["coordinates"][0]["undetermined"].is_null());
  EXPECT_TRUE(series["coordinates"][11]["sd"].is_null()) << "a locked coordinate has no SD";
  const auto flags = decode_bytes(series["coordinates"][19]["undetermined"]);
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
  EXPECT_EQ(decode_bytes(gaps[28])[250], 2) << "missing";
  EXPECT_EQ(decode_bytes(gaps[5])[130], 1) << "interpolated";
  EXPECT_EQ(decode_bytes(gaps[12])[358], 3) << "rejected";
  EXPECT_EQ(decode_bytes(gaps[12])[100], 0) << "measured";
  EXPECT_EQ(decode_bytes(gaps[30])[0], 0) << "the marker that was left out is there too";
}

TEST(ReportJson, WithoutStatesTheErrorsTellWhatWasSeen) {
  const ExampleTrial t = example_trial(600);
  const Json gaps = report_json(report_of(t, false))["series"]["gaps"];
  ASSERT_EQ(gaps.size(), 31U);
  EXPECT_EQ(decode_bytes(gaps[28])[250], 2);
  EXPECT_EQ(decode_bytes(gaps[28])[200], 0);
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
  EXPECT_FLOAT_EQ(decode_floats(series["marker_error_mm"][0])[7], 7.0F);
  EXPECT_FLOAT_EQ(decode_floats(series["rms_error_mm"])[7], 7.0F);
  EXPECT_TRUE(std::isnan(decode_floats(series["marker_error_mm"][1])[7]));
  EXPECT_TRUE(std::isnan(decode_floats(series["rms_error_mm"])[8]));
}

TEST(ReportJson, StatusIsRankedByHowBadItIs) {
  ExampleTrial t = example_trial(100);
  t.motion.status[1] = data::FrameStatus::underdetermined;
  t.motion.status[2] = data::FrameStatus::not_converged;
  t.motion.status[3] = data::FrameStatus::no_markers;
  const auto status = decode_bytes(report_json(report_of(t))["series"]["status"]);
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
  EXPECT_NEAR(most(decode_floats(series["coordinates"][0]["value"])), 1.5 * kDegPerRad, 1e-4);
  EXPECT_NEAR(most(decode_floats(series["coordinates"][0]["sd"])), 0.7 * kDegPerRad, 1e-4);
  EXPECT_EQ(decode_bytes(series["coordinates"][2]["undetermined"])[164], 1);
  EXPECT_EQ(decode_bytes(series["status"])[177], 3);
  EXPECT_EQ(decode_bytes(series["gaps"][0])[199], 2);
}

TEST(ReportHtml, SizeIsBoundedWhateverTheLength) {
  const ExampleTrial t = example_trial(30000);
  const IkReport report = report_of(t);
  EXPECT_LT(report_html(report).size(), 9'000'000U);
  const std::size_t template_and_tables = report_html(report, {.max_points = 2}).size();
  EXPECT_LT(template_and_tables, 3'000'000U) << "the bundle and the space view";
  EXPECT_LT(report_html(report, {.max_series_bytes = 300'000}).size(), template_and_tables + 300'000U);
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
  EXPECT_FALSE(ReportOptions{.max_series_bytes = 10}.check());
}

}  // namespace
}  // namespace kinemark::report
