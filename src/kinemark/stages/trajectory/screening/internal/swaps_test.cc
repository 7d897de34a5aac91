// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Exchanged labels and visits: whatever was exchanged is found, frame by frame, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Swap {
  std::int64_t one = 0, other = 0, first = 0, last = 0;
  auto operator<=>(const Swap&) const = default;
};

/// Exchange the samples, and what is missing with them, as a wrong label does.
void exchange(Trajectories& t, const Swap& s) {
  for (std::int64_t f = s.first; f <= s.last; ++f) {
    const Eigen::Vector3d x = t.x(f, s.one);
    t.x(f, s.one) = t.x(f, s.other);
    t.x(f, s.other) = x;
    std::swap(t.state[t.index(f, s.one)], t.state[t.index(f, s.other)]);
  }
}

Defects swaps_in(const Trajectories& t, const ScreenOptions& options = {}) {
  Defects out;
  find_swaps(t, options, out);
  return out;
}

std::set<Swap> exchanges_in(const Trajectories& t, const ScreenOptions& options = {}) {
  std::set<Swap> found;
  for (const Defect& d : swaps_in(t, options)) {
    EXPECT_EQ(d.kind, FindingKind::label_swap) << d.description;
    if (d.frames.empty()) {
      found.insert({d.marker, d.other_marker, d.first_frame, d.last_frame});
      continue;
    }
    EXPECT_EQ(d.frames.front(), d.first_frame);
    EXPECT_EQ(d.frames.back(), d.last_frame);
    for (std::size_t i = 0, begin = 0; i < d.frames.size(); ++i)
      if (i + 1 == d.frames.size() || d.frames[i + 1] != d.frames[i] + 1) {
        found.insert({d.marker, d.other_marker, d.frames[begin], d.frames[i]});
        begin = i + 1;
      }
  }
  return found;
}

Trajectories reversed(const Trajectories& t) {
  Trajectories out = t;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      out.x(f, m) = t.x(t.frames() - 1 - f, m);
      out.state[out.index(f, m)] = t.state[t.index(t.frames() - 1 - f, m)];
    }
  return out;
}

TEST(Swaps, EveryPairIsFoundInItsFrames) {
  const Trajectories whole = testing::walker({.frames = 160});
  Random random(3, 1);
  for (std::int64_t one = 0; one < whole.markers(); ++one)
    for (std::int64_t other = one + 1; other < whole.markers(); ++other) {
      const auto first = static_cast<std::int64_t>(random.uniform(5.0, 75.0));
      const auto last = first + static_cast<std::int64_t>(random.uniform(0.0, 75.0));
      const Swap planted{one, other, first, last};
      Trajectories t = whole;
      exchange(t, planted);
      EXPECT_EQ(exchanges_in(t), std::set{planted}) << one << " " << other << " " << first << " " << last;
    }
}

TEST(Swaps, LabelsThatFlickerAreOneFindingThatTellsTheirPattern) {
  for (const std::int64_t step : {2, 3, 4, 5}) {
    Trajectories t = testing::walker({.frames = 200});
    std::vector<std::int64_t> planted;
    for (std::int64_t f = 3; f < 120; f += step) {
      exchange(t, {1, 2, f, f});
      planted.push_back(f);
    }
    const Defects found = swaps_in(t);
    ASSERT_EQ(found.size(), 1U) << step;
    EXPECT_EQ(found[0].frames, planted);
    const char* words[] = {"every second frame from 3", "every third frame from 3",
                           "every fourth frame from 3", "every fifth frame from 3"};
    EXPECT_NE(found[0].description.find(words[step - 2]), std::string::npos) << found[0].description;
    EXPECT_GE(found[0].confidence, 0.8);
    reject(found[0], t);
    EXPECT_EQ(t.count_missing(), 2 * std::ssize(planted)) << "no sample between them is touched";
  }
}

TEST(Swaps, TheOtherSideOfTheBodyTellsWhichHalfIsWrong) {
  // Two feet of three markers; those of the right one are exchanged in every second frame.
  for (const std::int64_t first : {0, 1}) {
    auto t = Trajectories::all_missing({"LHEE", "LTOE", "LMT5", "RHEE", "RTOE", "RMT5"},
                                       {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200});
    Random random(4, 1);
    for (std::int64_t f = 0; f < 200; ++f)
      for (std::int64_t m = 0; m < 6; ++m) {
        const double s = t.time.time_s(f), side = m < 3 ? 1.0 : -1.0;
        const Eigen::Vector3d sites[] = {{0, 0, 0}, {0.20, 0.0, 0}, {0.17, 0.07 * side, 0}};
        t.x(f, m) =
            sites[m % 3] + Eigen::Vector3d(s + 0.2 * std::sin(6 * s + (m < 3 ? 0.0 : 1.0)), 0.2 * side, 0.0);
        for (double& x : t.x(f, m)) x += 0.0003 * random.gaussian();
        t.state[t.index(f, m)] = data::SampleState::measured;
      }
    std::vector<std::int64_t> planted;
    for (std::int64_t f = first; f < 200; f += 2) {
      exchange(t, {4, 5, f, f});
      planted.push_back(f);
    }
    const Defects found = swaps_in(t);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].frames, planted) << first;
    EXPECT_GE(found[0].confidence, 0.8);
  }
}

TEST(Swaps, AMarkersOwnPartnerIsNoOtherSide) {
  // Two heels that change names at 30 %: the distance of the one from its toe is that of the other,
  // exchanged.
  auto t = Trajectories::all_missing({"LHEE", "LTOE", "RHEE", "RTOE"},
                                     {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200});
  Random random(4, 1);
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < 4; ++m) {
      const double s = t.time.time_s(f), side = m < 2 ? 1.0 : -1.0;
      t.x(f, m) = Eigen::Vector3d(m % 2 == 0 ? 0.0 : 0.2, 0.1 * side, 0.0) +
                  Eigen::Vector3d(s + 0.1 * std::sin(6 * s + side), 0.0, 0.0);
      for (double& x : t.x(f, m)) x += 0.0003 * random.gaussian();
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  exchange(t, {0, 2, 60, 199});
  const Defects found = swaps_in(t);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::tuple(found[0].first_frame, found[0].last_frame),
            (std::tuple<std::int64_t, std::int64_t>(0, 59)))
      << "by number";
  EXPECT_THAT(found[0].description, HasSubstr("which side is right cannot be decided by the paths"));
}

TEST(Swaps, ABodyThatIsAskedSaysWhichSideIsRight) {
  const Trajectories whole = testing::walker({.frames = 200});
  const auto said = [&](const Swap& planted, int by_names) {
    Trajectories t = whole;
    exchange(t, planted);
    ScreenOptions options;
    int asked = 0;
    options.side = [&](const Trajectories& rest, std::int64_t one, std::int64_t other) {
      ++asked;
      EXPECT_EQ(std::tuple(one, other), std::tuple(planted.one, planted.other));
      const bool own = rest.x(100, one).isApprox(whole.x(100, one));
      return by_names == 0 ? 0 : own ? 1 : -1;
    };
    auto found = swaps_in(t, options);
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(found.size(), 1U);
    return found.front();
  };
  constexpr const char* kBody = "; the other frames are right, as a body has markers of these names there";
  for (const std::int64_t at : {20, 60, 110, 140}) {
    const auto known = said({2, 4, at, 199}, 1);
    EXPECT_EQ(std::tuple(known.first_frame, known.last_frame), std::tuple(at, std::int64_t{199})) << at;
    EXPECT_THAT(known.description, HasSubstr(kBody));
    EXPECT_GE(known.confidence, 0.8);
    const auto open = said({2, 4, at, 199}, 0);
    EXPECT_EQ(open.first_frame, at < 100 ? 0 : at) << "the fewer";
    EXPECT_THAT(open.description, Not(HasSubstr(kBody)));
  }
  const auto middle = said({2, 4, 60, 80}, 1);
  EXPECT_EQ(std::tuple(middle.first_frame, middle.last_frame),
            (std::tuple<std::int64_t, std::int64_t>(60, 80)));
  EXPECT_THAT(middle.description, Not(HasSubstr(kBody))) << "the paths have said so";
  const auto most = said({2, 4, 20, 179}, 1);
  EXPECT_EQ(std::tuple(most.first_frame, most.last_frame), (std::tuple<std::int64_t, std::int64_t>(20, 179)));
  EXPECT_THAT(most.description, HasSubstr(kBody));
}

TEST(Swaps, ExchangesThatShareAMarkerAreNotTurned) {
  Trajectories t = testing::walker({.frames = 200});
  exchange(t, {2, 4, 150, 199});
  exchange(t, {4, 6, 50, 80});
  ScreenOptions options;
  options.side = [](const Trajectories&, std::int64_t, std::int64_t) {
    ADD_FAILURE() << "their order matters";
    return -1;
  };
  EXPECT_EQ(swaps_in(t, options).size(), 2U);
}

TEST(Swaps, AnotherHabitOnTheOtherSideDoesNotMakeMostFramesWrong) {
  // The right foot has toe and MT5 the other way round; on the left one they are exchanged in every fifth
  // frame.
  auto t = Trajectories::all_missing({"LHEE", "LTOE", "LMT5", "RHEE", "RTOE", "RMT5"},
                                     {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200});
  Random random(4, 1);
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      const double s = t.time.time_s(f), side = m < 3 ? 1.0 : -1.0;
      const Eigen::Vector3d sites[] = {{0, 0, 0}, {0.25, 0.0, 0}, {0.12, 0.07 * side, 0}};
      const std::int64_t site = m < 4 ? m % 3 : 6 - m;
      t.x(f, m) =
          sites[site] + Eigen::Vector3d(s + 0.2 * std::sin(6 * s + (m < 3 ? 0.0 : 1.0)), 0.2 * side, 0.0);
      for (double& x : t.x(f, m)) x += 0.0003 * random.gaussian();
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  EXPECT_TRUE(swaps_in(t).empty()) << "nothing jumps";
  std::vector<std::int64_t> planted;
  for (std::int64_t f = 3; f < 120; f += 5) {
    exchange(t, {1, 2, f, f});
    planted.push_back(f);
  }
  const Defects found = swaps_in(t);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].frames, planted);
  EXPECT_LT(found[0].confidence, 0.8) << "distances speak against the paths: nothing is exchanged unasked";
}

TEST(Swaps, SeveralExchangesAtOnceAreKeptApart) {
  const std::set<Swap> planted{{0, 1, 40, 90}, {2, 6, 60, 120}, {3, 4, 90, 100}, {0, 1, 130, 131}};
  Trajectories t = testing::walker({.frames = 200});
  for (const Swap& s : planted) exchange(t, s);
  EXPECT_EQ(exchanges_in(t), planted);
}

TEST(Swaps, ARecordingPlayedBackwardsHasTheSameOnes) {
  Trajectories t = testing::walker({.frames = 200});
  exchange(t, {1, 5, 30, 44});
  exchange(t, {2, 3, 100, 160});
  std::set<Swap> mirrored;
  for (const Swap& s : exchanges_in(t)) mirrored.insert({s.one, s.other, 199 - s.last, 199 - s.first});
  EXPECT_EQ(mirrored.size(), 2U);
  EXPECT_EQ(exchanges_in(reversed(t)), mirrored);
}

TEST(Swaps, OneThatReachesAnEndNamesTheShorterSideAndSaysSo) {
  for (const std::int64_t at : {30, 90, 110, 170}) {
    Trajectories t = testing::walker({.frames = 200});
    exchange(t, {2, 4, at, 199});
    const Defects found = swaps_in(t);
    ASSERT_EQ(found.size(), 1U) << at;
    EXPECT_EQ(std::tuple(found[0].first_frame, found[0].last_frame),
              at < 100 ? std::tuple(std::int64_t{0}, at - 1) : std::tuple(at, std::int64_t{199}));
    // A tenth or a fifth of the frames is the wrong side; of nearly a half nobody can say.
    const bool open = at == 90 || at == 110;
    EXPECT_EQ(found[0].description.find("cannot be decided, the fewer are named") != std::string::npos, open)
        << at;
    EXPECT_EQ(found[0].confidence < 0.8, open) << at;
    Trajectories other_side = testing::walker({.frames = 200});
    exchange(other_side, {2, 4, 0, at - 1});
    EXPECT_EQ(exchanges_in(other_side), exchanges_in(t)) << "one cannot be distinguished from the other";
  }
}

TEST(Swaps, LabelsExchangedWhileBothWereLostAreFoundWhereTheyComeBack) {
  for (const std::int64_t lost : {1, 4, 8}) {
    Trajectories t = testing::walker({.frames = 200});
    for (std::int64_t f = 80 - lost; f < 80; ++f)
      for (const std::int64_t m : {1, 3}) t.set_missing(f, m);
    exchange(t, {1, 3, 80, 120});
    EXPECT_EQ(exchanges_in(t), (std::set<Swap>{{1, 3, 80, 120}})) << lost;
  }
}

TEST(Swaps, APathIsNotContinuedOverALongGap) {
  Trajectories t = testing::walker({.frames = 200});
  for (std::int64_t f = 60; f < 80; ++f)
    for (const std::int64_t m : {1, 3}) t.set_missing(f, m);
  exchange(t, {1, 3, 80, 199});
  EXPECT_TRUE(swaps_in(t).empty()) << "0.2 s: nobody knows where they went";
}

TEST(Swaps, SizesAreComparedWithTheLeastJump) {
  Trajectories t = testing::walker({.frames = 160});
  exchange(t, {1, 2, 50, 70});
  const std::set<Swap> planted{{1, 2, 50, 70}};
  EXPECT_EQ(exchanges_in(t), planted);
  EXPECT_TRUE(exchanges_in(t, {.min_jump_m = 2.0}).empty()) << "they are never two metres apart";
  for (const double scale : {0.01, 0.1, 7.0}) {
    Trajectories other = t;
    for (double& x : other.x_in_world) x *= scale;
    EXPECT_EQ(exchanges_in(other, {.min_jump_m = scale * ScreenOptions{}.min_jump_m}), planted) << scale;
  }
}

TEST(Swaps, AVisitIsFoundAndMeasuredAndALongerStayIsNot) {
  for (const std::int64_t frames : {1, 2, 6, 12}) {
    Trajectories t = testing::walker({.frames = 200});
    for (std::int64_t f = 60; f < 60 + frames; ++f) {
      t.x(f, 5) = t.x(f, 2);
      t.set_missing(f, 2);
    }
    const Defects found = swaps_in(t);
    ASSERT_EQ(found.size(), 1U) << frames;
    EXPECT_EQ(found[0].kind, FindingKind::swap_within);
    EXPECT_EQ(std::tuple(found[0].marker, found[0].other_marker),
              (std::tuple<std::int64_t, std::int64_t>(5, 2)));
    EXPECT_EQ(found[0].first_frame, 60);
    EXPECT_EQ(found[0].last_frame, 59 + frames);
    const double there = (testing::position(5, 0.6) - testing::position(2, 0.6)).norm();
    const double back = (testing::position(5, 0.6 + 0.01 * static_cast<double>(frames)) -
                         testing::position(2, 0.6 + 0.01 * static_cast<double>(frames)))
                            .norm();
    EXPECT_NEAR(found[0].size, std::min(there, back), 0.02)
        << "distance of the two, less their motion in a frame";
  }
  Trajectories longer = testing::walker({.frames = 200});
  for (std::int64_t f = 60; f < 120; ++f) longer.x(f, 5) = longer.x(f, 2);
  EXPECT_TRUE(swaps_in(longer).empty());
}

TEST(Swaps, AVisitOfAPathThatTurnsIsFound) {
  // Marker 2 circles: between its samples before and after the visit it is up to 59 mm beside their line.
  for (const std::int64_t first : {60, 67, 74, 81}) {
    Trajectories t = testing::walker({.frames = 200});
    for (std::int64_t f = 0; f < 200; ++f) {
      const double phase = 2.0 * M_PI * 2.0 * t.time.time_s(f);
      t.x(f, 2) += 0.25 * Eigen::Vector3d(std::cos(phase), std::sin(phase), 0.0);
    }
    EXPECT_TRUE(swaps_in(t).empty());
    for (std::int64_t f = first; f < first + 10; ++f) {
      t.x(f, 5) = t.x(f, 2);
      t.set_missing(f, 2);
    }
    const Defects found = swaps_in(t);
    ASSERT_EQ(found.size(), 1U) << first;
    EXPECT_EQ(found[0].kind, FindingKind::swap_within);
    EXPECT_EQ(found[0].other_marker, 2);
    // The same jump beside that path, to where nobody is.
    for (std::int64_t f = first; f < first + 10; ++f) t.x(f, 5).z() += 0.1;
    EXPECT_TRUE(swaps_in(t).empty()) << first;
  }
}

TEST(Swaps, AJumpToWhereNobodyIsIsNoVisit) {
  Trajectories t = testing::walker({.frames = 200});
  for (std::int64_t f = 60; f < 70; ++f) t.x(f, 5) += Eigen::Vector3d(0.0, 0.0, 3.0);
  EXPECT_TRUE(swaps_in(t).empty());
}

TEST(Swaps, WhatIsSaidOfTheSideFollowsFromWhatIsKnownOfIt) {
  const auto words = [](const Swap& planted) {
    Trajectories t = testing::walker({.frames = 200});
    exchange(t, planted);
    const Defects found = swaps_in(t);
    EXPECT_EQ(found.size(), 1U);
    return found.empty() ? std::string() : found.front().description;
  };
  const auto last_tenth = words({2, 4, 170, 199});
  EXPECT_THAT(last_tenth, HasSubstr("; which side is right cannot be decided by the paths, the far fewer "
                                    "frames are named"));
  EXPECT_THAT(last_tenth, Not(HasSubstr("which of these and the other frames are right cannot be decided")));
  const auto last_half = words({2, 4, 110, 199});
  EXPECT_THAT(last_half, HasSubstr("; which of these and the other frames are right cannot be decided, the "
                                   "fewer are named"));
  EXPECT_THAT(last_half, Not(HasSubstr("which side is right cannot be decided by the paths")));
  const auto middle = words({2, 4, 60, 80});
  EXPECT_THAT(middle, HasSubstr("are exchanged in frames 60 to 80: exchanged back they "
                                "continue their paths"));
  EXPECT_THAT(middle, Not(AnyOf(HasSubstr("which side is right cannot be decided by the paths"),
                                HasSubstr("which of these and the other frames are right"),
                                HasSubstr("mm from it) and back to its own"))))
      << "both ends were seen";
}

TEST(Swaps, AVisitIsNoExchangeAndSaysHowNearItWas) {
  Trajectories t = testing::walker({.frames = 200});
  for (std::int64_t f = 60; f < 66; ++f) {
    t.x(f, 5) = t.x(f, 2);
    t.set_missing(f, 2);
  }
  const Defects found = swaps_in(t);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].description, HasSubstr("mm from it) and back to its own"));
  EXPECT_THAT(found[0].description, HasSubstr("in frames 60 to 65 ("));
  EXPECT_THAT(found[0].description, Not(HasSubstr(": exchanged back they continue their paths")));
}

TEST(Swaps, NothingIsFoundWhereThereIsNothing) {
  for (const std::int64_t frames : {0, 1, 2, 3}) {
    EXPECT_TRUE(swaps_in(testing::walker({.frames = frames})).empty()) << frames;
  }
  EXPECT_TRUE(swaps_in(testing::walker({.markers = 1})).empty());
  Trajectories lost = testing::walker({.frames = 50});
  for (std::int64_t f = 0; f < 50; ++f)
    for (std::int64_t m = 0; m < lost.markers(); ++m) lost.set_missing(f, m);
  EXPECT_TRUE(swaps_in(lost).empty());
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_TRUE(swaps_in(testing::walker({.frames = 120, .noise_m = 0.002, .seed = seed})).empty()) << seed;
}

}  // namespace
}  // namespace kinemark::trajectory::internal
