// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::EventSource;
using data::FootEvent;
using data::GaitEvent;
using data::Side;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

MarkerEvents markers_of(const data::Trajectories& markers) {
  const auto which = find_gait_markers(markers).value();
  auto smoother = GaitSmoother::create(markers, which, 0.0).value();
  return find_marker_events(smoother, which).value();
}
EventsFound found_in(const data::Trajectories& markers) {
  return find_gait_events(markers_of(markers), {}, {}, EventChoice::kinematics);
}
const Agreement* agreement_called(const EventsFound& found, std::string_view what) {
  const auto it = std::ranges::find(found.agreement, what, &Agreement::what);
  return it == found.agreement.end() ? nullptr : &*it;
}

class GaitEventsTest : public ::testing::Test {
 protected:
  // The first events that markers tell, as somebody else who is always late by `late_s` tells them.
  [[nodiscard]] std::vector<GaitEvent> others(EventSource source, std::size_t count, double late_s,
                                              FootEvent what = FootEvent::strike) const {
    std::vector<GaitEvent> out;
    for (const auto& event : alone_.events)
      if (event.what == what && out.size() < count) {
        out.push_back(event);
        out.back().time_s += late_s;
        out.back().sd_s = 0.003;
        out.back().source = source;
        out.back().method = "another";
      }
    return out;
  }
  [[nodiscard]] std::ptrdiff_t count_of(const EventsFound& found, EventSource source) const {
    return std::ranges::count(found.events, source, &GaitEvent::source);
  }

  KnownWalk walk_;
  MarkerEvents of_markers_ = markers_of(walk_.markers(0.0003, 3));
  EventsFound alone_ = find_gait_events(of_markers_, {}, {}, EventChoice::kinematics);
};

TEST(EventChoices, HaveNames) {
  for (const auto choice :
       {EventChoice::best, EventChoice::plates, EventChoice::kinematics, EventChoice::file})
    EXPECT_EQ(parse_event_choice(to_string(choice)).value(), choice);
  const auto none = parse_event_choice("Plates");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::usage);
  EXPECT_EQ(none.error().message,
            "there is no choice of events 'Plates'; there are best, plates, kinematics and file");
}

TEST(AgreementSentence, TellsTheSpreadOfSeveralAlone) {
  EXPECT_EQ(sentence_of(
                {.what = "Foot Off: A and B", .count = 6, .mean_s = -0.008, .sd_s = 0.005, .most_s = 0.014}),
            "Foot Off: A and B differ by -8 +- 5 ms in 6 events, by 14 ms at most");
  EXPECT_EQ(sentence_of({.what = "Foot Off: A and B", .count = 1, .mean_s = 0.012, .most_s = 0.012}),
            "Foot Off: A and B differ by 12 ms in one event");
  EXPECT_THAT(sentence_of({.what = "Foot Off: A and B", .count = 6, .mean_s = -0.008, .most_s = 0.014}),
              Not(HasSubstr(" ms in one event")));
  EXPECT_THAT(sentence_of({.what = "Foot Off: A and B", .count = 1, .mean_s = 0.012, .most_s = 0.012}),
              Not(HasSubstr(" events, by ")));
}

TEST_F(GaitEventsTest, AscendAndAlternate) {
  ASSERT_EQ(alone_.edge.size(), alone_.events.size());
  EXPECT_TRUE(std::ranges::is_sorted(alone_.events, {}, &GaitEvent::time_s));
  for (const Side side : data::kBothSides) {
    std::vector<FootEvent> kinds;
    for (const auto& event : alone_.events)
      if (event.side == side) kinds.push_back(event.what);
    EXPECT_GE(kinds.size(), 8u);
    EXPECT_EQ(std::ranges::adjacent_find(kinds), kinds.end());
  }
  EXPECT_TRUE(alone_.agreement.empty() && alone_.notes.empty() && !alone_.out_of_step);
}

TEST_F(GaitEventsTest, KinematicsNeverSeesPlates) {
  auto plates = others(EventSource::plate, 4, -0.02);
  const auto found =
      find_gait_events(of_markers_, plates, others(EventSource::file, 3, 0.03), EventChoice::kinematics);
  ASSERT_EQ(found.events.size(), alone_.events.size());
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    EXPECT_EQ(found.events[i].time_s, alone_.events[i].time_s);
    EXPECT_EQ(found.events[i].sd_s, alone_.events[i].sd_s);
  }
  // They are compared all the same.
  const auto* with_plates = agreement_called(found, "Foot Strike: markers and the plates");
  ASSERT_NE(with_plates, nullptr);
  EXPECT_EQ(with_plates->count, 4);
  EXPECT_NEAR(with_plates->mean_s, 0.02, 1e-9);
  EXPECT_EQ(agreement_called(found, "Foot Off: markers and the plates"), nullptr);
  EXPECT_TRUE(found.notes.empty());
}

TEST_F(GaitEventsTest, AnOffsetToPlatesIsShrunkByItsVariance) {
  double before = 0.0;
  for (const std::size_t n : {1, 2, 4}) {
    const auto plates = others(EventSource::plate, n, -0.01);
    const auto found = find_gait_events(of_markers_, plates, {}, EventChoice::best);
    const auto& offset = found.offset[0];
    EXPECT_EQ(offset.compared, static_cast<int>(n));
    EXPECT_TRUE(offset.offset_s > before && offset.offset_s < 0.01) << offset.offset_s;
    EXPECT_LT(offset.share, 1.0);
    before = offset.offset_s;
    // One event: common SD 16.6 ms against its own of some 8 and the plate's 3.
    if (n == 1) {
      const auto first = std::ranges::find(of_markers_.events, plates[0].time_s + 0.01, &GaitEvent::time_s);
      const auto& fused = of_markers_.fused[static_cast<std::size_t>(first - of_markers_.events.begin())];
      const double each =
                       fused.error.own_s * fused.error.own_s + fused.error.foot_s * fused.error.foot_s + 9e-6,
                   common = fused.error.kind_s * fused.error.kind_s;
      EXPECT_NEAR(offset.offset_s, 0.01 * common / (common + each), 1e-9);
      EXPECT_NEAR(offset.share, std::sqrt(each / (common + each)), 1e-9);
    }
    // Strikes that no plate saw are moved by it and better known, leavings are not.
    for (std::size_t i = 0; i < found.events.size(); ++i) {
      if (found.events[i].source == EventSource::plate) continue;
      const auto& alone = of_markers_.events[static_cast<std::size_t>(found.edge[i])];
      const bool strike = alone.what == FootEvent::strike;
      EXPECT_NEAR(found.events[i].time_s, alone.time_s - (strike ? offset.offset_s : 0.0), 1e-12);
      if (strike) {
        EXPECT_LT(found.events[i].sd_s, alone.sd_s);
      }
    }
    EXPECT_TRUE(std::ranges::any_of(
        found.notes, [](const auto& note) { return note.find("ms were taken off") != note.npos; }));
  }
}

TEST_F(GaitEventsTest, PlatesOutOfStepAreNamedAndNotTaken) {
  auto plates = others(EventSource::plate, 3, -0.045);
  const auto offs = others(EventSource::plate, 3, -0.05, FootEvent::off);
  plates.insert(plates.end(), offs.begin(), offs.end());
  const auto found = find_gait_events(of_markers_, plates, {}, EventChoice::best);
  EXPECT_TRUE(found.out_of_step);
  EXPECT_EQ(count_of(found, EventSource::plate), 0);
  ASSERT_FALSE(found.notes.empty());
  EXPECT_NE(
      found.notes[0].find("out of step: the plates' strikes come 45 ms and their foot offs 50 ms before"),
      std::string::npos)
      << found.notes[0];
  EXPECT_THAT(found.notes[0], HasSubstr("forces of this recording belong to other frames"));
  EXPECT_EQ(count_of(find_gait_events(of_markers_, plates, {}, EventChoice::plates), EventSource::plate), 6);
  // Opposite ways is a threshold or a filter, one kind alone tells nothing, and 20 ms are no clock.
  auto opposite = others(EventSource::plate, 3, -0.045);
  const auto late = others(EventSource::plate, 3, 0.05, FootEvent::off);
  opposite.insert(opposite.end(), late.begin(), late.end());
  EXPECT_FALSE(find_gait_events(of_markers_, opposite, {}, EventChoice::best).out_of_step);
  EXPECT_FALSE(find_gait_events(of_markers_, others(EventSource::plate, 3, -0.045), {}, EventChoice::best)
                   .out_of_step);
  auto small = others(EventSource::plate, 3, -0.02);
  const auto small_offs = others(EventSource::plate, 3, -0.02, FootEvent::off);
  small.insert(small.end(), small_offs.begin(), small_offs.end());
  const auto in_step = find_gait_events(of_markers_, small, {}, EventChoice::best);
  EXPECT_FALSE(in_step.out_of_step);
  EXPECT_THAT(in_step.notes, Not(Contains(HasSubstr("forces of this recording belong to other frames"))));
}

TEST_F(GaitEventsTest, WhatPlatesChangeIsSaidWhereTheyDo) {
  auto late = others(EventSource::plate, 3, -0.045);
  const auto offs = others(EventSource::plate, 3, -0.05, FootEvent::off);
  late.insert(late.end(), offs.begin(), offs.end());
  const auto out_of_step = find_gait_events(of_markers_, late, {}, EventChoice::best).notes,
             moved =
                 find_gait_events(of_markers_, others(EventSource::plate, 4, -0.02), {}, EventChoice::best)
                     .notes;
  EXPECT_THAT(out_of_step, Contains("events are those of the markers, as plates are out of step"));
  EXPECT_THAT(out_of_step, Not(Contains(HasSubstr(" ms were taken off the events of markers, as "))));
  EXPECT_THAT(moved, Contains(HasSubstr(" ms were taken off the events of markers, as 4 of plates show")));
  EXPECT_THAT(moved, Not(Contains(HasSubstr("events are those of the markers, as plates are out of step"))));
}

TEST_F(GaitEventsTest, TheBestIsThatOfPlatesAndKeepsOthers) {
  const auto plates = others(EventSource::plate, 2, 0.004);
  const auto found = find_gait_events(of_markers_, plates, {}, EventChoice::best);
  EXPECT_EQ(found.events.size(), alone_.events.size());
  EXPECT_EQ(count_of(found, EventSource::plate), 2);
  for (const auto& plate : plates) {
    const auto it = std::ranges::find(found.events, plate.time_s, &GaitEvent::time_s);
    ASSERT_NE(it, found.events.end());
    EXPECT_EQ(it->source, EventSource::plate);
    EXPECT_EQ(found.edge[static_cast<std::size_t>(it - found.events.begin())], -1);
  }
}

TEST_F(GaitEventsTest, AnInstantThatMarkersDoNotTellComesBeside) {
  const auto plates = others(EventSource::plate, 1, 0.3);
  const auto found = find_gait_events(of_markers_, plates, {}, EventChoice::best);
  EXPECT_EQ(found.events.size(), alone_.events.size() + 1);
  EXPECT_TRUE(std::ranges::is_sorted(found.events, {}, &GaitEvent::time_s));
  EXPECT_EQ(found.offset[0].compared, 0);
  EXPECT_EQ(agreement_called(found, "Foot Strike: markers and the plates"), nullptr);
}

TEST_F(GaitEventsTest, AChoiceTakesItsSourceAlone) {
  const auto plates = others(EventSource::plate, 3, 0.002), file = others(EventSource::file, 4, -0.010);
  const auto by_plates = find_gait_events(of_markers_, plates, file, EventChoice::plates);
  EXPECT_EQ(by_plates.events.size(), 3u);
  EXPECT_EQ(count_of(by_plates, EventSource::plate), 3);
  const auto by_file = find_gait_events(of_markers_, plates, file, EventChoice::file);
  EXPECT_EQ(by_file.events.size(), 4u);
  EXPECT_EQ(count_of(by_file, EventSource::file), 4);
  EXPECT_NE(agreement_called(by_file, "Foot Strike: the plates and the file's"), nullptr);
  const auto by_markers = find_gait_events(of_markers_, {}, file, EventChoice::kinematics);
  EXPECT_EQ(count_of(by_markers, EventSource::kinematics), std::ssize(by_markers.events));
  const auto* with_file = agreement_called(by_markers, "Foot Strike: markers and the file's");
  ASSERT_NE(with_file, nullptr);
  EXPECT_EQ(with_file->count, 4);
  EXPECT_NEAR(with_file->mean_s, 0.010, 1e-9);
  EXPECT_NEAR(with_file->sd_s, 0.0, 1e-9);
  EXPECT_EQ(agreement_called(by_markers, "Foot Off: markers and the file's"), nullptr);
}

TEST_F(GaitEventsTest, WhereMarkersTellNothingTheFileIsTheLastToTell) {
  const MarkerEvents nobody;
  for (const auto choice :
       {EventChoice::best, EventChoice::plates, EventChoice::kinematics, EventChoice::file}) {
    const auto nothing = find_gait_events(nobody, {}, {}, choice);
    EXPECT_TRUE(nothing.events.empty() && nothing.edge.empty());
    EXPECT_TRUE(nothing.agreement.empty());
  }
  const auto file = others(EventSource::file, 3, 0.0);
  EXPECT_EQ(find_gait_events(nobody, {}, file, EventChoice::best).events.size(), 3u);
  EXPECT_TRUE(find_gait_events(nobody, {}, file, EventChoice::kinematics).events.empty());
  EXPECT_TRUE(find_gait_events(nobody, {}, file, EventChoice::plates).events.empty());
}

class FileErrors : public GaitEventsTest {
 protected:
  [[nodiscard]] EventsFound by_file(std::span<const GaitEvent> plates, std::vector<GaitEvent> file) const {
    const double usual = std::hypot(kFileOffset_s, kFileOwn_s);
    for (auto& event : file) event.sd_s = usual;
    return find_gait_events(of_markers_, plates, file, EventChoice::file);
  }
};

TEST_F(FileErrors, AreWhatTheyDifferByFromPlates) {
  const auto plates = others(EventSource::plate, 4, -0.01), late = others(EventSource::file, 4, 0.03);
  const auto found = by_file(plates, late);
  ASSERT_EQ(found.events.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found.events[i].time_s, late[i].time_s);  // their times stay
    EXPECT_TRUE(found.events[i].sd_s > 0.035 && found.events[i].sd_s < 0.042) << found.events[i].sd_s;
    EXPECT_NEAR(found.events[i].sd_s, found.error[i].sd_s(), 1e-12);
    EXPECT_GT(found.error[i].kind_s, 4.0 * found.error[i].own_s);  // all alike: an offset
  }
  EXPECT_THAT(found.notes, Contains(HasSubstr("Foot Strike: the file's events err by 3")));
  EXPECT_THAT(found.notes, Contains(HasSubstr(" ms (SD), as 4 of plates and 4 of markers show")));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("a laboratory's usually do: nothing else tells of them"))));
  // On plates they are known better than a laboratory's usual, and where they lie to and fro, not by an
  // offset.
  const auto same = by_file(plates, others(EventSource::file, 4, -0.01));
  EXPECT_LT(same.events[0].sd_s, 0.011);
  auto to_and_fro = others(EventSource::file, 4, -0.01);
  for (std::size_t i = 0; i < 4; ++i) to_and_fro[i].time_s += i % 2 == 0 ? 0.03 : -0.03;
  const auto scattered = by_file(plates, to_and_fro);
  EXPECT_GT(scattered.error[0].own_s, 0.02);
  EXPECT_LT(scattered.error[0].kind_s, scattered.error[0].own_s);
}

TEST_F(FileErrors, AreJudgedByMarkersWherePlatesAreOutOfStep) {
  auto plates = others(EventSource::plate, 3, -0.045);
  const auto offs = others(EventSource::plate, 3, -0.05, FootEvent::off);
  plates.insert(plates.end(), offs.begin(), offs.end());
  const auto found = by_file(plates, others(EventSource::file, 4, 0.0));
  EXPECT_THAT(found.notes, Contains(HasSubstr(", as 4 of markers show")));
  EXPECT_LT(found.events[0].sd_s, 0.02);
}

TEST_F(FileErrors, AreUsualWhereNothingElseTellsOfThem) {
  const auto nowhere = others(EventSource::file, 4, 0.3);
  const auto found = by_file({}, nowhere);
  EXPECT_NEAR(found.events[0].sd_s, std::hypot(kFileOffset_s, kFileOwn_s), 1e-9);
  EXPECT_THAT(found.notes, Contains("Foot Strike: the file's events err by 19 ms (SD), as a laboratory's "
                                    "usually do: nothing else tells of them"));
  EXPECT_THAT(find_gait_events(of_markers_, {}, nowhere, EventChoice::kinematics).notes,
              Not(Contains(HasSubstr("the file's events err by"))));
}

// Laboratories whose labels err as usual, or all by 40 ms the same way, two steps of whom plates see: how
// often what is true lies within twice the SD that is stated.
TEST_F(FileErrors, HoldTheTruthAsOftenAsTheySay) {
  Random random(7, 0x6c616273);
  for (const double offset_s : {0.0, kFileOffset_s, 0.04}) {
    int within = 0, all = 0;
    for (int laboratory = 0; laboratory < 300; ++laboratory) {
      const double offset = offset_s == 0.04 ? offset_s : offset_s * random.gaussian();
      std::vector<GaitEvent> file, plates;
      for (auto event : alone_.events)
        if (event.what == FootEvent::strike) {
          const double truth = event.time_s;
          event.sd_s = 0.003, event.time_s = truth + event.sd_s * random.gaussian();
          if (plates.size() < 2) plates.push_back(event);
          event.time_s = truth + offset + kFileOwn_s * random.gaussian(), file.push_back(event);
        }
      const auto found = by_file(plates, file);
      for (const auto& event : found.events) {
        const auto truth = std::ranges::min_element(alone_.events, {}, [&](const GaitEvent& one) {
          return one.what == event.what && one.side == event.side ? std::abs(one.time_s - event.time_s) : 1.0;
        });
        within += std::abs(truth->time_s - event.time_s) < 2.0 * event.sd_s, ++all;
      }
    }
    EXPECT_GT(within, 0.92 * all) << offset_s;
  }
}

// Changes of the laboratory that change no instant.
TEST_F(GaitEventsTest, DoNotDependOnTheLaboratory) {
  const auto markers = walk_.markers(0.0003, 3);
  const double c = std::cos(2.1), s = std::sin(2.1);
  Eigen::Matrix3d turn, y_up, mirror = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  turn << c, -s, 0, s, c, 0, 0, 0, 1;
  y_up << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Eigen::Matrix3d down = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();  // z points down
  for (const auto& [matrix, move, later_s, swapped] :
       {std::tuple{turn, Eigen::Vector3d(0, 0, 0), 0.0, false},
        std::tuple{turn, Eigen::Vector3d(5, -3, 0.2), 7.5, false},
        std::tuple{y_up, Eigen::Vector3d(0, 0, 0), 0.0, false},
        std::tuple{down, Eigen::Vector3d(0, 0, 0), 0.0, false},
        std::tuple{mirror, Eigen::Vector3d(0, 0, 0), 0.0, true}}) {
    auto other = markers;
    other.time.t0_s = later_s;
    if (swapped) other.names = {"RHEE", "RTOE", "LHEE", "LTOE", "SACR"};
    for (std::int64_t f = 0; f < other.frames(); ++f)
      for (std::int64_t m = 0; m < other.markers(); ++m)
        other.x(f, m) = matrix * Eigen::Vector3d(markers.x(f, m)) + move;
    const auto found = found_in(other);
    ASSERT_EQ(found.events.size(), alone_.events.size());
    for (std::size_t i = 0; i < found.events.size(); ++i) {
      const auto &a = alone_.events[i], &b = found.events[i];
      EXPECT_EQ(b.side, swapped ? data::opposite(a.side) : a.side);
      EXPECT_EQ(b.what, a.what);
      // The ground's velocity is sought from frames in another order, to 1e-4 m/s.
      EXPECT_NEAR(b.time_s, a.time_s + later_s, 3e-6);
      EXPECT_NEAR(b.sd_s, a.sd_s, 1e-6);
    }
  }
}

}  // namespace
}  // namespace kinemark::analysis
