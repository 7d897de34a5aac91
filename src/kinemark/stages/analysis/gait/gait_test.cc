// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::EventSource;
using data::FootEvent;
using data::Side;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

double value_of(const Gait& gait, std::string_view id, std::string_view context = "") {
  for (const auto& m : gait.measures)
    if (m.id == id && m.context == context) return m.value;
  return kNaN;
}

Gait measured(const KnownWalk& walk, const GaitOptions& options = {.refits = 0}) {
  return analyze_gait(walk.markers(0.0005, 3), {}, options).value();
}

// A plate under a step of each foot.
data::Wrenches two_plates(const KnownWalk& walk, const TimeBase& time) {
  return {.time = time,
          .items = {walk.plate("plate 1", Side::left, 2), walk.plate("plate 2", Side::right, 2)}};
}

TEST(Gait, MeasuresAreThoseOfTheWalker) {
  KnownWalk walk;
  walk.right_later = 0.51;
  for (const bool treadmill : {false, true}) {
    walk.treadmill = treadmill;
    const auto gait = measured(walk);
    EXPECT_EQ(gait.treadmill, treadmill);
    EXPECT_NEAR(gait.belt_speed_m_per_s, treadmill ? 1.3 : 0.0, 0.005);
    EXPECT_NEAR(value_of(gait, "gait_speed"), 1.3, 0.006);
    EXPECT_NEAR(value_of(gait, "cadence"), 2.0 / 1.08, 0.01);
    EXPECT_NEAR(value_of(gait, "step_width"), 0.1, 0.002);
    EXPECT_NEAR(value_of(gait, "stride_time", "Left"), 1.08, 0.005);
    EXPECT_NEAR(value_of(gait, "stride_length", "Right"), 1.404, 0.006);
    EXPECT_NEAR(value_of(gait, "step_time", "Right"), 0.51 * 1.08, 0.006);
    EXPECT_NEAR(value_of(gait, "step_time", "Left"), 0.49 * 1.08, 0.006);
    EXPECT_NEAR(value_of(gait, "step_length", "Right"), 0.51 * 1.404, 0.006);
    EXPECT_NEAR(value_of(gait, "stance_share", "Left"), 0.62, 0.03);
    EXPECT_NEAR(value_of(gait, "swing_time", "Left") + value_of(gait, "stance_time", "Left"),
                value_of(gait, "stride_time", "Left"), 1e-3);
    EXPECT_LT(value_of(gait, "stride_time_sd", "Left"), 0.004);
  }
}

const data::Measure& measure_of(const Gait& gait, std::string_view id, std::string_view context = "") {
  return *std::ranges::find_if(gait.measures,
                               [&](const auto& m) { return m.id == id && m.context == context; });
}

TEST(Gait, ASpreadBetweenStridesThatErrorsHideIsAtMostSoMuch) {
  KnownWalk walk;
  walk.duration_s = 10.0;
  const GaitOptions options{.measures = {"stride_time_sd", "step_width_sd"}, .refits = 99};
  const auto even = measured(walk, options);
  const auto& hidden = measure_of(even, "stride_time_sd", "Left");
  EXPECT_EQ(hidden.interval.kind, data::IntervalKind::at_most);
  EXPECT_TRUE(std::isnan(hidden.interval.low));
  EXPECT_GT(hidden.interval.high, hidden.value);
  EXPECT_EQ(hidden.remark, "not distinguishable from 0");

  // Every second step of the left foot 60 mm farther out: widths of both feet's strides differ by that.
  auto markers = walk.markers(0.0005, 3);
  const Eigen::Vector3d left(-std::sin(walk.heading_rad), std::cos(walk.heading_rad), 0.0);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double t = markers.time.time_s(f);
    double out_m = 0.0;
    for (std::int64_t step = 0; walk.off_s(Side::left, step) < t; ++step) {
      const double off = walk.off_s(Side::left, step), strike = walk.strike_s(Side::left, step + 1);
      const double share = std::clamp((t - off) / (strike - off), 0.0, 1.0);
      out_m += (step % 2 == 0 ? 0.06 : -0.06) * share * share * (3.0 - 2.0 * share);
    }
    for (const std::int64_t m : {0, 1}) markers.x(f, m) += out_m * left;
  }
  const auto uneven = analyze_gait(markers, {}, options).value();
  const auto& seen = measure_of(uneven, "step_width_sd");
  EXPECT_EQ(seen.interval.kind, data::IntervalKind::two_sided);
  EXPECT_TRUE(seen.interval.low > 0.015 && seen.interval.high < 0.06)
      << seen.interval.low << " " << seen.interval.high;
  EXPECT_FALSE(seen.remark.contains("not distinguishable from 0"));
}

TEST(Gait, OneWalkHasOneSpeed) {
  KnownWalk walk;
  const auto gait = measured(walk);
  EXPECT_EQ(gait.kind.speed_m_per_s, value_of(gait, "gait_speed"));
  EXPECT_NEAR(gait.kind.stride_s, 2.0 / value_of(gait, "cadence"), 1e-12);
  EXPECT_EQ(gait.notes.front(), gait.kind.sentence());
  walk.duration_s = 1.3;  // no whole stride: the pelvis tells about how fast
  const auto brief = measured(walk);
  ASSERT_TRUE(brief.cycles.empty());
  EXPECT_TRUE(std::isnan(value_of(brief, "gait_speed")));
  EXPECT_NEAR(brief.kind.speed_m_per_s, 1.3, 0.1);
}

TEST(Gait, StepsAddUpToStrides) {
  const auto gait = measured({.right_later = 0.52});
  for (const auto& cycle : gait.cycles) {
    if (!std::isfinite(cycle.other_strike_s)) continue;
    EXPECT_LT(cycle.other_off_s, cycle.other_strike_s);
    EXPECT_LT(cycle.start_s, cycle.other_off_s);
    EXPECT_NEAR(cycle.stride_length(), 1.404, 0.01);
  }
  EXPECT_NEAR(value_of(gait, "step_length", "Left") + value_of(gait, "step_length", "Right"), 1.404, 0.01);
}

TEST(Gait, IntervalsHoldTheTruthAndDoNotDependOnThreads) {
  const KnownWalk walk;
  const auto one = measured(walk, {.refits = 39, .seed = 5, .threads = 1}),
             two = measured(walk, {.refits = 39, .seed = 5, .threads = 2});
  ASSERT_EQ(one.measures.size(), two.measures.size());
  for (std::size_t i = 0; i < one.measures.size(); ++i) {
    EXPECT_EQ(one.measures[i].value, two.measures[i].value);
    EXPECT_EQ(one.measures[i].interval.high, two.measures[i].interval.high);
    EXPECT_TRUE(one.measures[i].validate());
    EXPECT_EQ(one.measures[i].interval.kind, one.measures[i].id.ends_with("_sd")
                                                 ? data::IntervalKind::at_most
                                                 : data::IntervalKind::two_sided)
        << one.measures[i].id;
  }
  for (const auto& m : one.measures)
    if (m.id == "stride_time") {
      EXPECT_LT(m.interval.low, 1.08);
      EXPECT_GT(m.interval.high, 1.08);
      EXPECT_LT(m.sd, 0.008);
    }
  for (const auto& event : one.events) EXPECT_TRUE(event.sd_s > 0.014 && event.sd_s < 0.06) << event.sd_s;
}

TEST(Gait, PlatesReplaceAndCorrectWhatMarkersTell) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.0003, 3);
  const auto plates = two_plates(walk, markers.time);
  const auto with = analyze_gait(markers, {.plates = &plates}, {.refits = 0}).value();
  const auto without = analyze_gait(markers, {}, {.refits = 0}).value();
  int by_plate = 0;
  double worst_with = 0.0, worst_without = 0.0;
  for (const auto& truth : walk.events()) {
    for (const auto& event : with.events)
      if (event.side == truth.side && event.what == truth.what &&
          std::abs(event.time_s - truth.time_s) < 0.1) {
        by_plate += event.source == EventSource::plate;
        worst_with = std::max(worst_with, std::abs(event.time_s - truth.time_s));
      }
    for (const auto& event : without.events)
      if (event.side == truth.side && event.what == truth.what && std::abs(event.time_s - truth.time_s) < 0.1)
        worst_without = std::max(worst_without, std::abs(event.time_s - truth.time_s));
  }
  EXPECT_EQ(by_plate, 4);
  EXPECT_LT(worst_with, 0.01);
  EXPECT_GT(worst_without, worst_with);
  const auto alone =
      analyze_gait(markers, {.plates = &plates}, {.choice = EventChoice::plates, .refits = 0}).value();
  EXPECT_EQ(alone.events.size(), 4u);
}

TEST(Gait, TheFilesEventsAreComparedOrTaken) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.0003, 3);
  GaitEvidence evidence;
  for (const auto& event : walk.events())
    evidence.events.push_back(
        {std::string(data::to_string(event.what)), std::string(data::to_string(event.side)), event.time_s});
  const auto compared = analyze_gait(markers, evidence, {.refits = 0}).value();
  EXPECT_TRUE(std::ranges::any_of(
      compared.agreement, [](const auto& a) { return a.what == "Foot Strike: markers and the file's"; }));
  const auto taken = analyze_gait(markers, evidence, {.choice = EventChoice::file, .refits = 0}).value();
  EXPECT_EQ(taken.events.size(), walk.events().size());
  EXPECT_NEAR(value_of(taken, "double_support", "Left"), 0.12 * 1.08, 1e-9);
}

TEST(Gait, EventsThatTheMarkersContradictAreNamedWithoutMeasuring) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.0003, 3);
  const auto events = [&](bool exchanged) {
    std::vector<data::Event> out;
    for (const auto& event : walk.events()) {
      const bool left = (event.side == Side::left) != exchanged;
      out.push_back({std::string(data::to_string(event.what)), left ? "Left" : "Right", event.time_s});
    }
    return out;
  };
  EXPECT_TRUE(contradictions_of(markers, {.events = events(false)}).labels.empty());
  EXPECT_TRUE(contradictions_of(markers, {}).labels.empty());
  const auto found = contradictions_of(markers, {.events = events(true)});
  EXPECT_TRUE(found.names.empty() && found.plates.empty());
  const auto& said = found.labels;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said[0], HasSubstr("left and right of the file's events are exchanged"));
  const auto gait = analyze_gait(markers, {.events = events(true)}, {.refits = 0}).value();
  EXPECT_THAT(gait.notes, Contains(said[0])) << "the words of a measured gait";
  // Who stands still contradicts nobody.
  auto still = markers;
  for (std::int64_t f = 1; f < still.frames(); ++f)
    for (std::int64_t m = 0; m < still.markers(); ++m) still.x(f, m) = markers.x(0, m);
  EXPECT_TRUE(contradictions_of(still, {.events = events(true)}).labels.empty());
}

// A stored event errs like any other: 40 ms late against plates, stances are uncertain by as much, and
// strides, in which what all have in common cancels, are not.
TEST(Gait, WhatTheFilesEventsErrByReachesEveryMeasure) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.0003, 3);
  const auto plates = two_plates(walk, markers.time);
  GaitEvidence evidence{.plates = &plates, .events = {}};
  for (const auto& event : walk.events())
    evidence.events.push_back({std::string(data::to_string(event.what)),
                               std::string(data::to_string(event.side)),
                               event.time_s + (event.what == FootEvent::strike ? 0.04 : 0.0)});
  const auto gait = analyze_gait(markers, evidence, {.choice = EventChoice::file, .refits = 39}).value();
  for (const auto& event : gait.events)
    EXPECT_TRUE(event.what == FootEvent::strike ? event.sd_s > 0.03 && event.sd_s < 0.05
                                                : event.sd_s > 0.002 && event.sd_s < 0.015)
        << event.sd_s;
  for (const auto& m : gait.measures) {
    if (m.id.ends_with("_sd")) continue;  // what differs between these strides is nothing
    EXPECT_GT(m.sd, 0.0) << m.id;
    EXPECT_LT(m.interval.low, m.interval.high) << m.id;
    if (m.id == "stance_time") {
      EXPECT_GT(m.sd, 0.02);
      EXPECT_GT(m.interval.high, 0.62 * 1.08) << "true";
    }
    if (m.id == "stride_time") {
      EXPECT_LT(m.sd, 0.01);
    }
  }
}

TEST(Gait, AStrikeThatIsMissingIsSaidWhereOneIs) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  EXPECT_THAT(analyze_gait(markers, {}, {.refits = 0})->notes,
              Not(Contains(HasSubstr("times the usual stride; that is no stride"))));
  for (std::int64_t f = 200; f < 330; ++f)
    for (const std::int64_t m : {0, 1}) markers.set_missing(f, m);
  const auto notes = analyze_gait(markers, {}, {.refits = 0})->notes;
  EXPECT_THAT(notes, Contains(AllOf(HasSubstr("left foot: no strike is found between"),
                                    HasSubstr("times the usual stride; that is no stride"))));
  EXPECT_THAT(notes, Not(Contains(HasSubstr("right foot: no strike is found between"))));
}

TEST(Gait, AnAxisThatIsStatedToPointUpIsHeldAgainstThePelvis) {
  const auto markers = KnownWalk{}.markers(0.0005, 3);
  const auto with_up = [&](const Eigen::Vector3d& up) {
    return analyze_gait(markers, {}, {.refits = 0, .up = up});
  };
  const auto stated = with_up({0, 0, 1}), found = analyze_gait(markers, {}, {.refits = 0});
  ASSERT_TRUE(stated);
  EXPECT_EQ(value_of(*stated, "step_width"), value_of(*found, "step_width"));
  for (const auto& [up, name] : {std::pair{Eigen::Vector3d(0, 1, 0), "y"},
                                 {Eigen::Vector3d(-1, 0, 0), "-x"},
                                 {Eigen::Vector3d(0, 0, -1), "-z"}}) {
    const auto refused = with_up(up);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Code::bad_input);
    EXPECT_EQ(refused.error().message,
              std::string(name) + " is stated to point up, the pelvis stands above the feet along z");
  }
}

TEST(Gait, RegionsHoldWholeCycles) {
  GaitOptions options{.measures = {"stride_time"}, .refits = 0};
  options.regions = {{"early", 0, 300}, {"none", 400, 420}};
  const auto gait = measured({}, options);
  ASSERT_EQ(gait.measures.size(), 4u);
  EXPECT_EQ(gait.measures[0].region, "early");
  EXPECT_LE(gait.measures[0].end_s, 3.0);
  EXPECT_TRUE(std::isnan(gait.measures[2].value));
  EXPECT_EQ(gait.measures[2].remark, "no stride was seen from strike to strike");
  EXPECT_FALSE(gait.measures[0].remark.contains("no stride was seen from strike to strike"));
}

std::string remark_of(const Gait& gait, std::string_view id, std::string_view context) {
  for (const auto& m : gait.measures)
    if (m.id == id && m.context == context) return m.remark;
  return "none";
}

TEST(Gait, AStrideWithoutWhatAMeasureNeedsSaysSo) {
  // The left leg alone: strides, and no step of the other foot within them.
  auto markers = KnownWalk{}.markers(0.0005, 3);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (const std::int64_t m : {2, 3}) markers.set_missing(f, m);
  GaitOptions options{.measures = {"stride_time", "step_time", "stride_time_sd"}, .refits = 0};
  const auto one = analyze_gait(markers, {}, options).value();
  EXPECT_EQ(remark_of(one, "step_time", "Right"), "what it needs was not seen in any stride");
  EXPECT_EQ(remark_of(one, "step_time", "Left"), "no stride of the other foot was seen whole");
  EXPECT_FALSE(remark_of(one, "step_time", "Left").contains("no stride was seen from strike to strike"));
  EXPECT_FALSE(remark_of(one, "step_time", "Right").contains("no stride of the other foot was seen"));
  EXPECT_FALSE(remark_of(one, "stride_time", "Left").contains("what it needs was not seen in any stride"));
  EXPECT_FALSE(remark_of(one, "stride_time_sd", "Left").contains("too few strides show what it needs"));
  options.regions = {{"one stride", 0, 200}};
  const auto few = measured({}, options);
  EXPECT_EQ(remark_of(few, "stride_time_sd", "Left"), "too few strides show what it needs");
  EXPECT_FALSE(remark_of(few, "stride_time_sd", "Left").contains("what it needs was not seen in any"));
}

// The region ends where the stride does: as often as not a refit's stride ends beyond it.
TEST(Gait, NoIntervalWhereRefitsLoseTheStride) {
  GaitOptions options{.measures = {"stride_time"}, .refits = 39};
  const auto whole = measured({}, options);
  EXPECT_FALSE(remark_of(whole, "stride_time", "Left").contains("more than a tenth of the refits do not"));
  const auto first = std::ranges::find(whole.cycles, Side::left, &GaitCycle::side);
  options.regions = {{"tight", 0, static_cast<std::int64_t>(std::ceil(100.0 * first->end_s))}};
  EXPECT_EQ(remark_of(measured({}, options), "stride_time", "Left"),
            "no interval: more than a tenth of the refits do not determine it");
}

TEST(Gait, AnEventThatARefitDoesNotFindIsNoneThatDidNotMove) {
  std::vector<double> moved(40, 0.01);
  for (std::size_t i = 0; i < 20; ++i) moved[i] = -0.01;
  EXPECT_NEAR(event_noise(moved), 0.01, 1e-12);
  moved[3] = moved[4] = moved[5] = moved[39] = kNaN;  // a tenth
  EXPECT_NEAR(event_noise(moved), 0.01, 1e-12);
  moved[6] = kNaN;
  EXPECT_TRUE(std::isnan(event_noise(moved)));
  EXPECT_TRUE(std::isnan(event_noise({})));
  EXPECT_EQ(event_noise(std::vector(40, 0.0)), 0.0);  // of a plate, which marker noise does not move
}

TEST(Gait, WhoStandsHasNone) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 1; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      markers.x(f, m) = markers.x(0, m) + 1e-4 * (markers.x(f, m) - markers.x(0, m));
  const auto gait = analyze_gait(markers, {}, {.refits = 0});
  ASSERT_FALSE(gait);
  EXPECT_EQ(gait.error().message, "not locomotion: no foot swings: none moves by 80 mm over the ground");
}

TEST(EventsOfFile, AreReadUnderTheirNames) {
  const TimeBase time{.rate_hz = 100.0, .t0_s = 1.0, .frames = 300};
  const std::vector<data::Event> events{{"Foot Strike", "Left", 1.5},   {"RTO", "", 1.6},
                                        {"Foot Off", "Left", 2.1},      {"LHS", "", 2.5},
                                        {"jump", "Left", 1.7},          {"Toe Off", "Right", 2.7},
                                        {"Foot Strike", "General", 2.0}};
  const auto found = events_of_file(events, time);
  ASSERT_EQ(found.events.size(), 5u);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("no Right Foot Strike is labelled between")))
      << "a file that labels strikes of the left foot lacks that of the right one";
  EXPECT_EQ(found.events[1].side, Side::right);
  EXPECT_EQ(found.events[1].what, FootEvent::off);
}

TEST(EventsOfFile, OutsideAndInTheWrongOrderAreLeftOut) {
  const TimeBase time{.rate_hz = 100.0, .t0_s = 1.0, .frames = 300};
  const std::vector<data::Event> events{{"Foot Strike", "Left", 0.5},
                                        {"Foot Strike", "Left", 1.5},
                                        {"Foot Strike", "Left", 1.7},
                                        {"Foot Off", "Left", 2.1}};
  const auto found = events_of_file(events, time);
  EXPECT_EQ(found.events.size(), 2u);
  ASSERT_EQ(found.notes.size(), 2u);
  EXPECT_EQ(found.notes[0],
            "the file's event Left Foot Strike at 0.500 s lies outside the recording, 1.000 to 3.990 s, and "
            "is left out");
  EXPECT_NE(found.notes[1].find("follows another of its kind, with no Foot Off between"), std::string::npos);
}

TEST(GaitDefinitions, HaveNamesOfTheirOwn) {
  for (const auto& definition : gait_definitions()) {
    EXPECT_EQ(find_gait_definition(definition.what.id), &definition);
    EXPECT_FALSE(definition.what.formula.empty() || definition.what.source.empty());
    EXPECT_TRUE(std::isnan(definition.value({})) || definition.is_deviation());
  }
  EXPECT_EQ(find_gait_definition("stride"), nullptr);
}

}  // namespace
}  // namespace kinemark::analysis
