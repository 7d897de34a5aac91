// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::EventSource;
using data::FootEvent;
using data::GaitEvent;
using data::Side;
using testing::KnownWalk;

GaitPaths smooth(const data::Trajectories& markers) {
  return GaitSmoother::create(markers, find_gait_markers(markers.names).value(), 0.0).value().paths();
}
EventsFound found_in(const data::Trajectories& markers) {
  return find_gait_events(smooth(markers), {}, {}, EventChoice::kinematics);
}
const Agreement* agreement_called(const EventsFound& found, std::string_view what) {
  const auto it = std::ranges::find(found.agreement, what, &Agreement::what);
  return it == found.agreement.end() ? nullptr : &*it;
}

class GaitEventsTest : public ::testing::Test {
 protected:
  // The first strikes that markers tell, as somebody else who is always late by `late_s` tells them.
  [[nodiscard]] std::vector<GaitEvent> others(EventSource source, std::size_t count, double late_s) const {
    std::vector<GaitEvent> out;
    for (const auto& event : alone_.events)
      if (event.what == FootEvent::strike && out.size() < count) {
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
  GaitPaths paths_ = smooth(walk_.markers(0.0003, 3));
  EventsFound alone_ = find_gait_events(paths_, {}, {}, EventChoice::kinematics);
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
}

TEST_F(GaitEventsTest, AscendAndAlternate) {
  ASSERT_EQ(alone_.window.size(), alone_.events.size());
  EXPECT_TRUE(std::ranges::is_sorted(alone_.events, {}, &GaitEvent::time_s));
  for (const Side side : data::kBothSides) {
    std::vector<FootEvent> kinds;
    for (const auto& event : alone_.events)
      if (event.side == side) kinds.push_back(event.what);
    EXPECT_GE(kinds.size(), 8u);
    EXPECT_EQ(std::ranges::adjacent_find(kinds), kinds.end());
  }
  EXPECT_EQ(alone_.chosen[0].method, EventMethod::foot_velocity);
  EXPECT_EQ(alone_.chosen[1].method, EventMethod::coordinates);
}

TEST_F(GaitEventsTest, WithoutPlatesTwoMethodsGiveTheErrors) {
  const auto* strike = agreement_called(alone_, "Foot Strike: Ghoussayni 2004 and O'Connor 2007");
  ASSERT_NE(strike, nullptr);
  const double n = strike->count, squares = (n - 1.0) * strike->sd_s * strike->sd_s;
  const auto& error = alone_.chosen[0].error;
  EXPECT_EQ(error.offset_s, 0.0);
  EXPECT_NEAR(error.offset_sd_s, std::max(0.008, 0.5 * std::abs(strike->mean_s)), 1e-12);
  EXPECT_NEAR(error.event_sd_s, std::sqrt((6.0 * 3.6e-5 + 0.5 * squares) / (6.0 + n - 1.0)), 1e-12);
  for (const auto& event : alone_.events)
    if (event.what == FootEvent::strike)
      EXPECT_NEAR(event.sd_s, std::hypot(error.offset_sd_s, error.event_sd_s), 1e-12);
}

TEST_F(GaitEventsTest, AnOffsetToPlatesIsShrunkByItsVariance) {
  double before = 0.0;
  for (const std::size_t n : {1, 2, 5}) {
    const auto found =
        find_gait_events(paths_, others(EventSource::plate, n, -0.005), {}, EventChoice::kinematics);
    const auto& chosen = found.chosen[0];
    ASSERT_EQ(chosen.method, EventMethod::foot_velocity);
    EXPECT_EQ(chosen.compared, static_cast<int>(n));
    const auto count = static_cast<double>(n);
    const double precision = count / 3.6e-5 + 1.0 / 6.4e-5;  // 6 ms of each, 8 ms of the offset
    EXPECT_NEAR(chosen.error.offset_s, count * 0.005 / 3.6e-5 / precision, 1e-9);
    EXPECT_NEAR(chosen.error.offset_sd_s, std::sqrt(1.0 / precision), 1e-12);
    EXPECT_NEAR(chosen.error.event_sd_s, std::sqrt(6.0 * 3.6e-5 / (6.0 + count - 1.0)), 1e-9);
    EXPECT_TRUE(chosen.error.offset_s > before && chosen.error.offset_s < 0.005);
    before = chosen.error.offset_s;
    // Every strike is moved by it, also those that no plate saw.
    ASSERT_EQ(found.events.size(), alone_.events.size());
    for (std::size_t i = 0; i < found.events.size(); ++i)
      if (found.events[i].what == FootEvent::strike)
        EXPECT_NEAR(found.events[i].time_s, alone_.events[i].time_s - chosen.error.offset_s, 1e-9);
    const auto* with_plates = agreement_called(found, "Foot Strike: O'Connor 2007 and the plates");
    ASSERT_NE(with_plates, nullptr);
    EXPECT_NEAR(with_plates->mean_s, 0.005, 1e-9);
    EXPECT_NEAR(with_plates->most_s, 0.005, 1e-9);
    EXPECT_EQ(std::isnan(with_plates->sd_s), n == 1);
  }
  EXPECT_EQ(agreement_called(alone_, "Foot Strike: O'Connor 2007 and the plates"), nullptr);
}

TEST_F(GaitEventsTest, TheBestIsThatOfPlatesAndKeepsOthers) {
  const auto plates = others(EventSource::plate, 2, 0.004);
  const auto found = find_gait_events(paths_, plates, {}, EventChoice::best);
  EXPECT_EQ(found.events.size(), alone_.events.size());
  EXPECT_EQ(count_of(found, EventSource::plate), 2);
  for (const auto& plate : plates) {
    const auto it = std::ranges::find(found.events, plate.time_s, &GaitEvent::time_s);
    ASSERT_NE(it, found.events.end());
    EXPECT_EQ(it->source, EventSource::plate);
    EXPECT_EQ(found.window[static_cast<std::size_t>(it - found.events.begin())], -1);
  }
}

TEST_F(GaitEventsTest, AnInstantThatMarkersDoNotTellComesBeside) {
  auto plates = others(EventSource::plate, 1, 0.3);
  const auto found = find_gait_events(paths_, plates, {}, EventChoice::best);
  EXPECT_EQ(found.events.size(), alone_.events.size() + 1);
  EXPECT_TRUE(std::ranges::is_sorted(found.events, {}, &GaitEvent::time_s));
  EXPECT_EQ(found.chosen[0].compared, 0);
  EXPECT_EQ(agreement_called(found, "Foot Strike: O'Connor 2007 and the plates"), nullptr);
}

TEST_F(GaitEventsTest, AChoiceTakesItsSourceAlone) {
  const auto plates = others(EventSource::plate, 3, 0.002), file = others(EventSource::file, 4, -0.010);
  const auto by_plates = find_gait_events(paths_, plates, file, EventChoice::plates);
  EXPECT_EQ(by_plates.events.size(), 3u);
  EXPECT_EQ(count_of(by_plates, EventSource::plate), 3);
  const auto by_file = find_gait_events(paths_, plates, file, EventChoice::file);
  EXPECT_EQ(by_file.events.size(), 4u);
  EXPECT_EQ(count_of(by_file, EventSource::file), 4);
  EXPECT_EQ(agreement_called(by_file, "Foot Strike: these and the file's"), nullptr);
  const auto by_markers = find_gait_events(paths_, {}, file, EventChoice::kinematics);
  EXPECT_EQ(count_of(by_markers, EventSource::kinematics), std::ssize(by_markers.events));
  const auto* with_file = agreement_called(by_markers, "Foot Strike: these and the file's");
  ASSERT_NE(with_file, nullptr);
  EXPECT_EQ(with_file->count, 4);
  EXPECT_NEAR(with_file->mean_s, 0.010, 1e-9);
  EXPECT_NEAR(with_file->sd_s, 0.0, 1e-9);
  EXPECT_EQ(agreement_called(by_markers, "Foot Off: these and the file's"), nullptr);
}

TEST_F(GaitEventsTest, WithoutAPelvisTheNextMethodTellsOfLeaving) {
  auto paths = paths_;
  paths.pelvis.resize(0, 3);
  const auto found = find_gait_events(paths, {}, {}, EventChoice::best);
  EXPECT_EQ(found.chosen[1].method, EventMethod::foot_velocity);
  EXPECT_EQ(agreement_called(found, "Foot Off: O'Connor 2007 and Zeni 2008"), nullptr);
  EXPECT_NE(agreement_called(alone_, "Foot Off: O'Connor 2007 and Zeni 2008"), nullptr);
}

TEST_F(GaitEventsTest, WhereNobodyWalksTheFileIsTheLastToTell) {
  auto paths = paths_;
  for (auto& foot : paths.feet) {
    foot.heel.rowwise() = Eigen::RowVector3d(foot.heel.row(0));
    foot.toe.rowwise() = Eigen::RowVector3d(foot.toe.row(0));
  }
  for (const auto choice :
       {EventChoice::best, EventChoice::plates, EventChoice::kinematics, EventChoice::file}) {
    const auto nothing = find_gait_events(paths, {}, {}, choice);
    EXPECT_TRUE(nothing.events.empty() && nothing.window.empty());
    EXPECT_TRUE(nothing.agreement.empty());
  }
  const auto file = others(EventSource::file, 3, 0.0);
  EXPECT_EQ(find_gait_events(paths, {}, file, EventChoice::best).events.size(), 3u);
  EXPECT_TRUE(find_gait_events(paths, {}, file, EventChoice::kinematics).events.empty());
  EXPECT_TRUE(find_gait_events(paths, {}, file, EventChoice::plates).events.empty());
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
      EXPECT_NEAR(b.time_s, a.time_s + later_s, 1e-6);
      EXPECT_NEAR(b.sd_s, a.sd_s, 1e-6);
    }
  }
}

}  // namespace
}  // namespace kinemark::analysis
