// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/event_labels.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/gait/gait_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::GaitEvent;
using data::Side;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Six strides of 1.1 s, whose stances last 62 %; cadence changes a little, as nobody is a machine.
MarkerEvents walked() {
  MarkerEvents out;
  out.kind.stride_s = 1.1;
  for (const Side side : {Side::left, Side::right}) {
    double begin = side == Side::left ? 0.5 : 1.07;
    for (int k = 0; k < 6; ++k) {
      const double stride = 1.1 + 0.04 * std::sin(1.7 * k);
      out.events.push_back({.side = side, .what = FootEvent::strike, .time_s = begin, .sd_s = 0.015});
      out.events.push_back(
          {.side = side, .what = FootEvent::off, .time_s = begin + 0.62 * stride, .sd_s = 0.015});
      begin += stride;
    }
  }
  std::ranges::sort(out.events, {}, &GaitEvent::time_s);
  return out;
}

std::vector<GaitEvent> labels(double later_s = 0.0) {
  auto out = walked().events;
  for (auto& event : out) event.time_s += later_s + 0.01 * std::sin(9.0 * event.time_s);
  return out;
}

TEST(EventLabels, ThatAreNearAreNotNamed) {
  for (const double later_s : {0.0, 0.03, -0.06, 0.12})
    EXPECT_THAT(contradicted_labels(walked(), labels(later_s)), IsEmpty());
  EXPECT_THAT(contradicted_labels(walked(), {}), IsEmpty());
}

TEST(EventLabels, SidesExchanged) {
  auto file = labels();
  for (auto& event : file) event.side = event.side == Side::left ? Side::right : Side::left;
  EXPECT_THAT(
      contradicted_labels(walked(), file),
      ElementsAre("left and right of the file's events are exchanged: 24 of 24 lie at events of the markers "
                  "of the other foot"));
  EXPECT_THAT(contradicted_labels(walked(), labels()),
              Not(Contains(HasSubstr("left and right of the file's events are exchanged"))));
}

TEST(EventLabels, StrikesForOffs) {
  auto file = labels();
  for (auto& event : file) event.what = event.what == FootEvent::strike ? FootEvent::off : FootEvent::strike;
  EXPECT_THAT(
      contradicted_labels(walked(), file),
      ElementsAre("strikes and offs of the file's events are exchanged: 24 of 24 lie at events of the "
                  "markers of the other kind"));
  EXPECT_THAT(contradicted_labels(walked(), labels()),
              Not(Contains(HasSubstr("strikes and offs of the file's events are exchanged"))));
}

TEST(EventLabels, OfAnotherClock) {
  const auto late = contradicted_labels(walked(), labels(0.3));
  ASSERT_EQ(late.size(), 1u);
  EXPECT_THAT(late[0], HasSubstr("the file's events run on another clock: "));
  EXPECT_THAT(late[0], HasSubstr(" lie at events of the markers when 299 ms are taken off"));
  const auto early = contradicted_labels(walked(), labels(-0.25));
  ASSERT_EQ(early.size(), 1u);
  EXPECT_THAT(early[0], HasSubstr(" ms are added"));
  EXPECT_THAT(contradicted_labels(walked(), labels(0.05)),
              Not(Contains(HasSubstr("the file's events run on another clock"))));
}

TEST(EventLabels, OneByItself) {
  auto file = labels();
  const auto strike = std::ranges::find_if(
      file, [](const GaitEvent& e) { return e.what == FootEvent::strike && e.time_s > 2.0; });
  strike->time_s += 0.21;
  const auto said = contradicted_labels(walked(), file);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0], HasSubstr("foot: the file's Foot Strike at "));
  EXPECT_THAT(said[0], HasSubstr(" ms after that of the markers"));
  EXPECT_THAT(contradicted_labels(walked(), labels()), Not(Contains(HasSubstr(" that of the markers"))));
  // Of a stride that markers do not tell of, nothing is said.
  auto hidden = walked();
  std::erase_if(hidden.events,
                [](const GaitEvent& e) { return e.side == Side::left && e.time_s > 2.0 && e.time_s < 3.2; });
  EXPECT_THAT(contradicted_labels(hidden, labels()), IsEmpty());
}

TEST(EventLabels, OneOfTheOtherSide) {
  for (const auto what : data::kFootEvents)
    for (const auto at : {std::size_t{0}, std::size_t{2}, std::size_t{5}}) {
      auto file = labels();
      std::vector<GaitEvent*> of_kind;
      for (auto& event : file)
        if (event.what == what) of_kind.push_back(&event);
      of_kind[at]->side = data::opposite(of_kind[at]->side);
      const auto said = contradicted_labels(walked(), file);
      ASSERT_EQ(said.size(), 1u);
      EXPECT_THAT(said[0], HasSubstr("s lies at one that the markers show of the other foot"));
    }
  EXPECT_THAT(contradicted_labels(walked(), labels()),
              Not(Contains(HasSubstr("s lies at one that the markers show of the other foot"))));
}

TEST(EventLabels, OneMoreThatLeavesNoTimeToStandOrToSwing) {
  // The left foot stands already when the markers begin to tell of it.
  auto seen = walked();
  std::erase_if(seen.events, [](const auto& one) { return one.side == Side::left && one.time_s < 1.0; });
  const auto off = *std::ranges::find_if(
      seen.events, [](const auto& one) { return one.side == Side::left && one.what == FootEvent::off; });
  auto file = seen.events;
  EXPECT_THAT(contradicted_labels(seen, file), IsEmpty());
  GaitEvent strike{.side = Side::left, .what = FootEvent::strike, .time_s = off.time_s - 0.3, .sd_s = 0.015};
  file.push_back(strike);
  EXPECT_THAT(contradicted_labels(seen, file),
              ElementsAre(fmt::format(
                  "the file's Left Foot Strike at {:.3f} s lies 300 ms before the Foot Off that the "
                  "markers show of that foot: no stance is so short",
                  strike.time_s)));
  file.back().time_s = off.time_s - 0.62 * 1.1;  // where the foot did come down
  EXPECT_THAT(contradicted_labels(seen, file),
              Not(Contains(HasSubstr("that the markers show of that foot: no stance is so short"))));
}

TEST(EventLabels, MarkersOfNoGaitContradictNobody) {
  auto none = walked();
  none.kind.not_gait = "no foot swings";
  EXPECT_THAT(contradicted_labels(none, labels(0.3)), IsEmpty());
}

}  // namespace
}  // namespace kinemark::analysis
