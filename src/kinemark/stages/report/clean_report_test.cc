// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/clean_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/report/internal/example_clean.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report {
namespace {

using data::SampleState;
using internal::example_clean;
using internal::ExampleClean;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::ordered_json;

constexpr std::int64_t kUlna = 8, kFinger = 11;

/// One marker of the example on its own, as a smoother that works marker by marker hands it over.
struct Alone {
  data::Trajectories after;
  data::Derivatives derivatives;
};
Alone alone(const ExampleClean& e, std::int64_t marker) {
  Alone out{data::Trajectories::all_missing({e.after.names[static_cast<std::size_t>(marker)]}, e.report.time),
            {}};
  out.after.covariance.resize(static_cast<std::size_t>(6 * e.report.time.frames));
  data::Derivatives& d = out.derivatives;
  for (std::int64_t f = 0; f < e.report.time.frames; ++f) {
    const std::size_t i = e.after.index(f, marker), o = static_cast<std::size_t>(f);
    out.after.state[o] = e.after.state[i];
    for (std::size_t k = 0; k < 6; ++k) out.after.covariance[6 * o + k] = e.after.covariance[6 * i + k];
    for (std::size_t k = 0; k < 3; ++k) {
      out.after.x_in_world[3 * o + k] = e.after.x_in_world[3 * i + k];
      d.velocity.push_back(e.derivatives.velocity[3 * i + k]);
      d.velocity_sd.push_back(e.derivatives.velocity_sd[3 * i + k]);
      d.acceleration.push_back(e.derivatives.acceleration[3 * i + k]);
      d.acceleration_sd.push_back(e.derivatives.acceleration_sd[3 * i + k]);
    }
  }
  return out;
}

TEST(ExampleClean, IsARecordingThatAStageCouldHaveMade) {
  const ExampleClean e = example_clean(300);
  for (const data::Trajectories* t : {&e.before, &e.after}) {
    const auto ok = t->validate();
    EXPECT_TRUE(ok) << ok.error().message;
  }
  const auto ok = e.derivatives.validate(e.after);
  EXPECT_TRUE(ok) << ok.error().message;
  const auto account = e.report.account.validate();
  EXPECT_TRUE(account) << account.error().message;
  for (const data::GapAccount& g : e.report.account.gaps) {
    for (std::int64_t f = g.first_frame; f <= g.last_frame; ++f) {
      EXPECT_FALSE(e.before.present(f, g.marker));
      EXPECT_EQ(e.after.present(f, g.marker), g.filled);
    }
  }
}

TEST(AddMarker, WhatIsNotThereHasNoErrorBarEither) {
  const ExampleClean e = example_clean(1200);
  const CleanSeries s = e.finished().series[kFinger];
  for (const std::size_t f : {180U, 720U, 1000U}) {
    EXPECT_GE(s.after[f], 4);
    for (const auto* axes : {&s.position, &s.position_sd, &s.velocity, &s.velocity_sd, &s.acceleration_sd})
      for (const auto& axis : *axes) EXPECT_TRUE(std::isnan(axis[f])) << f;
  }
}

TEST(AddMarker, HoldsEverySampleOfAShortRecording) {
  const ExampleClean e = example_clean(300);
  const CleanReport r = e.finished();
  ASSERT_EQ(r.series.size(), 12U);
  const CleanSeries& s = r.series[kUlna];
  EXPECT_EQ(s.points, 300);
  EXPECT_EQ(s.frame_step, 1);
  for (std::int64_t f = 0; f < 300; f += 11) {
    const auto p = static_cast<std::size_t>(f);
    const std::size_t i = e.after.index(f, kUlna);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = e.after.x_in_world[3 * i + axis];
      EXPECT_NEAR(s.position[axis][p], x, 1e-6);
      EXPECT_NEAR(s.position_sd[axis][p], std::sqrt(e.after.covariance[6 * i]), 1e-9);
      EXPECT_NEAR(s.velocity[axis][p], e.derivatives.velocity[3 * i + axis], 1e-5);
      EXPECT_NEAR(s.acceleration_sd[axis][p], e.derivatives.acceleration_sd[3 * i + axis], 1e-5);
      if (e.before.present(f, kUlna)) {
        EXPECT_NEAR(s.raw[axis][p], e.before.x_in_world[3 * i + axis], 1e-6);
        EXPECT_NEAR(s.change[axis][p], e.before.x_in_world[3 * i + axis] - x, 1e-9);
      } else {
        EXPECT_TRUE(std::isnan(s.raw[axis][p])) << "never a number that nobody measured";
        EXPECT_TRUE(std::isnan(s.change[axis][p]));
      }
    }
  }
}

TEST(AddMarker, CountsAndCodesTheStates) {
  const ExampleClean e = example_clean(1200);
  const CleanReport r = e.finished();
  const auto at = [](SampleState s) { return static_cast<std::size_t>(s); };
  EXPECT_EQ(r.counts[kUlna].before[at(SampleState::missing)], 132);
  EXPECT_EQ(r.counts[kUlna].after[at(SampleState::missing)], 0);
  EXPECT_EQ(r.counts[kUlna].after[at(SampleState::model_filled)], 132);
  EXPECT_EQ(r.series[kUlna].before[600], 4);
  EXPECT_EQ(r.series[kUlna].after[600], 3);
  EXPECT_EQ(r.series[kFinger].after[180], 5) << "the spike";
  EXPECT_EQ(r.series[kFinger].before[180], 0) << "which came in as a measurement";
}

TEST(AddMarker, MarkerByMarkerGivesTheSameBytesAsAllTogether) {
  const ExampleClean e = example_clean(500);
  CleanReport one_by_one = e.report;
  for (std::int64_t m = 0; m < 12; ++m) {
    const Alone a = alone(e, m);
    add_marker(one_by_one, e.accounts[static_cast<std::size_t>(m)],
               {.before = &e.before, .before_marker = m, .after = &a.after, .derivatives = &a.derivatives},
               {.max_points = 64});
  }
  EXPECT_EQ(clean_report_json(one_by_one), clean_report_json(e.finished({.max_points = 64})));
}

TEST(AddMarker, WhatTheResultDoesNotHaveIsLeftOut) {
  ExampleClean e = example_clean(200);
  e.after.covariance.clear();
  CleanReport r = e.report;
  add_marker(r, e.accounts[0], {.before = &e.before, .after = &e.after});
  EXPECT_THAT(r.series[0].position_sd, Each(IsEmpty()));
  EXPECT_THAT(r.series[0].velocity, Each(IsEmpty()));
  EXPECT_THAT(r.series[0].position, Each(Not(IsEmpty())));
  const Json marker = clean_report_json(r)["series"]["markers"][0];
  EXPECT_EQ(marker["velocity"].dump(), "[null,null,null]");
  EXPECT_EQ(marker["position_mm"][0]["kind"], "rounded");
}

TEST(AddMarker, ThinningKeepsPeaksAndTheWidestBand) {
  ExampleClean e = example_clean(5000);
  e.before.x(3217, 0)(1) += 0.5;
  e.after.covariance[6 * e.after.index(4100, 0) + 3] = 0.09;
  e.after.set_missing(4444, 0);
  CleanReport r = e.report;
  add_marker(r, e.accounts[0], {.before = &e.before, .after = &e.after}, {.max_points = 100});
  const CleanSeries& s = r.series[0];
  EXPECT_EQ(s.points, 100);
  EXPECT_EQ(s.frame_step, 50);
  const std::size_t peak = 3217 / 100 * 2;
  EXPECT_NEAR(std::max(s.change[1][peak], s.change[1][peak + 1]), 0.5, 0.003);
  EXPECT_NEAR(std::max(s.raw[1][peak], s.raw[1][peak + 1]), e.before.x(3217, 0)(1), 1e-5);
  EXPECT_NEAR(s.position_sd[1][82], 0.3, 1e-6);
  EXPECT_EQ(s.after[88], 4);
  EXPECT_EQ(s.after[89], 0);
}

TEST(AddMarker, RefusesArraysThatDoNotFit) {
  const ExampleClean e = example_clean(200);
  const data::Trajectories other = data::Trajectories::all_missing({"A"}, {.rate_hz = 120.0, .frames = 100});
  data::Derivatives wrong;
  wrong.velocity.resize(7);
  CleanReport r = e.report;
  EXPECT_ANY_THROW(add_marker(r, {}, {.before = nullptr, .after = &e.after}));
  EXPECT_ANY_THROW(add_marker(r, {}, {.before = &other, .after = &e.after}));
  EXPECT_ANY_THROW(add_marker(r, {}, {.before = &e.before, .after = &e.after, .after_marker = 12}));
  EXPECT_ANY_THROW(add_marker(r, {}, {.before = &e.before, .after = &e.after, .derivatives = &wrong}));
  EXPECT_ANY_THROW(add_marker(r, {}, {.before = &e.before, .after = &e.after}, {.max_points = 1}));
  EXPECT_THAT(r.account.markers, IsEmpty());
}

TEST(CleanReportJson, SeriesAreInMillimetresAndOnePerMarker) {
  const ExampleClean e = example_clean(200);
  const CleanReport r = e.finished();
  const Json json = clean_report_json(r);
  EXPECT_EQ(json["summary"], clean_summary_json(r));
  ASSERT_EQ(json["series"]["markers"].size(), 12U);
  EXPECT_EQ(json["series"]["points"], 200);
  const Json& marker = json["series"]["markers"][2];
  const auto position = internal::unpack_curve(marker["position_mm"][0]);
  const auto change = internal::unpack_curve(marker["change_mm"][0]);
  ASSERT_EQ(position.size(), 200U);
  EXPECT_EQ(marker["raw_mm"][0]["kind"], "sum") << "no number is written twice";
  for (std::size_t f = 0; f < position.size(); ++f) {
    EXPECT_NEAR(position[f], 1e3 * double{r.series[2].position[0][f]}, 0.0026);
    EXPECT_NEAR(position[f] + change[f], 1e3 * double{r.series[2].raw[0][f]}, 0.0052);
  }
  // A sample that came in and was thrown out has no sum.
  const auto raw = internal::unpack_curve(json["series"]["markers"][kFinger]["raw_mm"][1]);
  EXPECT_NEAR(raw[30], 1e3 * double{r.series[kFinger].raw[1][30]}, 0.0026);
  EXPECT_EQ(internal::unpack_codes(marker["before"]), r.series[2].before);
}

TEST(CleanReportJson, APageListsTheLongestGapsOnly) {
  CleanReport r = example_clean(200).report;
  r.account.gaps.clear();
  for (int i = 0; i < 5000; ++i)
    r.account.gaps.push_back({.marker = 0, .first_frame = i, .last_frame = i + (i % 5 == 0 ? 9 : 0)});
  const Json page = clean_report_json(r)["summary"];
  EXPECT_EQ(clean_summary_json(r)["gaps"].size(), 5000U);
  EXPECT_EQ(page["gap_count"], 5000);
  ASSERT_EQ(page["gaps"].size(), 3000U);
  int tens = 0;
  std::int64_t before = -1;
  for (const Json& g : page["gaps"]) {
    tens += g["last_frame"].get<std::int64_t>() - g["first_frame"].get<std::int64_t>() == 9 ? 1 : 0;
    EXPECT_GT(g["first_frame"], before) << "in the order in which they come";
    before = g["first_frame"];
  }
  EXPECT_EQ(tens, 1000);
}

TEST(CleanReportJson, RefusesMarkersWithoutSeriesOrOfDifferentGrids) {
  const ExampleClean e = example_clean(200);
  CleanReport r = e.report;
  r.account.markers.resize(1);
  EXPECT_ANY_THROW((void)clean_report_json(r));
  r.account.markers.clear();
  add_marker(r, e.accounts[0], {.before = &e.before, .after = &e.after});
  add_marker(r, e.accounts[1],
             {.before = &e.before, .before_marker = 1, .after = &e.after, .after_marker = 1},
             {.max_points = 50});
  EXPECT_ANY_THROW((void)clean_report_json(r));
}

TEST(CleanReportJson, AThinnedPageHoldsTheResultInSpaceAsItIs) {
  const ExampleClean e = example_clean(30'000);
  const Json json = clean_report_json(e.finished());
  const Json& scene = json["scene"];
  ASSERT_GT(json["series"]["frame_step"].get<std::int64_t>(), 1);
  const auto step = scene["frame_step"].get<std::int64_t>(), points = scene["points"].get<std::int64_t>();
  EXPECT_GE(points, 300);
  EXPECT_EQ(points, (30'000 + step - 1) / step);
  EXPECT_LE(scene.dump().size(), 260'000U);
  EXPECT_EQ(static_cast<std::int64_t>(scene["names"].size()), e.after.markers());
  EXPECT_TRUE(scene["worst"].is_null() && scene["before"].is_null());
  const auto positions = internal::unpack_series(scene["markers"]["positions_m"]);
  const auto states = internal::inflate_base64(scene["markers"]["states"].get<std::string>());
  std::int64_t compared = 0;
  for (std::int64_t m = 0; m < e.after.markers(); ++m)
    for (std::int64_t p = 0; p < points; p += 7) {
      if (!e.after.present(p * step, m)) continue;
      ++compared;
      for (std::int64_t k = 0; k < 3; ++k)
        EXPECT_NEAR(positions[static_cast<std::size_t>((3 * m + k) * points + p)], e.after.x(p * step, m)[k],
                    3e-4);
      EXPECT_LT(states[static_cast<std::size_t>(m * points + p)], 4) << "there";
    }
  EXPECT_GT(compared, 400);
}

TEST(CleanReportJson, AShortPageTakesItsSpaceViewFromTheCurves) {
  EXPECT_TRUE(clean_report_json(example_clean(300).finished())["scene"].is_null());
}

TEST(CleanReportHtml, SizeIsBoundedWhateverTheLength) {
  const ExampleClean e = example_clean(12000);
  const std::size_t bare =
      clean_report_html(e.finished({.max_points = 2}), {.max_points = 2, .max_data_bytes = 10'000}).size();
  EXPECT_LT(bare, 1'000'000U) << "the bundle";
  EXPECT_LT(clean_report_html(e.finished(), {.max_data_bytes = 500'000}).size(), bare + 500'000U);
}

TEST(CleanReportHtml, IsDeterministicAndHoldsItsJson) {
  const std::string page = clean_report_html(example_clean(150).finished());
  EXPECT_EQ(page, clean_report_html(example_clean(150).finished()));
  const std::string open = R"(id="kinemark-data">)";
  const std::size_t from = page.find(open) + open.size();
  const Json json = Json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(json["summary"]["schema"], "kinemark.clean_report");
}

TEST(CleanReportHtml, NamesCannotEndTheData) {
  ExampleClean e = example_clean(100);
  const std::string hostile = "</script><script>alert(1)</script>\xff";
  e.report.run.trial = hostile;
  e.accounts[0].name = hostile;
  e.report.account.gaps[0].why_open = hostile;
  e.report.account.defects[0].finding.description = hostile;
  EXPECT_THAT(clean_report_html(e.finished()), Not(HasSubstr("<script>alert(1)")));
}

}  // namespace
}  // namespace kinemark::report
