// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Zeros, held values and repeated frames, against what was planted.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;
using Samples = std::set<std::pair<std::int64_t, std::int64_t>>;  // frame, marker

/// What the defects cover; no sample twice.
Samples covered(const Defects& defects) {
  Samples all;
  for (const Defect& d : defects)
    for (std::int64_t f = d.first_frame; f <= d.last_frame; ++f)
      EXPECT_TRUE(all.emplace(f, d.marker).second) << d.description;
  return all;
}

Defects zeros_in(const Trajectories& t) {
  Defects out;
  find_zeros(t, out);
  return out;
}

Defects duplicates_in(const Trajectories& t) {
  Defects out;
  find_duplicated_frames(t, out);
  return out;
}

Defects stuck_in(const Trajectories& t, Defects out = {}) {
  const std::size_t before = out.size();
  find_stuck(t, {}, out);
  return {out.begin() + static_cast<std::ptrdiff_t>(before), out.end()};
}

void repeat_frames(Trajectories& t, std::int64_t first, std::int64_t last) {
  for (std::int64_t f = first; f <= last; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      t.x(f, m) = t.x(first - 1, m);
      t.state[t.index(f, m)] = t.state[t.index(first - 1, m)];
    }
}

void hold(Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last) {
  for (std::int64_t f = first + 1; f <= last; ++f) t.x(f, marker) = t.x(first, marker);
}

TEST(Zeros, AreAllFoundWhereverTheyLieAndInRunsAsLongAsTheyAre) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Trajectories t = testing::walker({.frames = 80});
    Random random(seed, 9);
    Samples planted;
    for (std::int64_t f = 0; f < t.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers(); ++m)
        if (random.uniform() < 0.3) {
          t.x(f, m).setZero();
          planted.emplace(f, m);
        }
    const Defects found = zeros_in(t);
    EXPECT_EQ(covered(found), planted) << seed;
    for (const Defect& d : found) {
      EXPECT_FALSE(planted.contains({d.first_frame - 1, d.marker})) << "a run is one defect";
      EXPECT_FALSE(planted.contains({d.last_frame + 1, d.marker}));
    }
  }
}

TEST(Zeros, ASampleOnAnAxisOrAPlaneIsNone) {
  Trajectories t = testing::walker({.frames = 40});
  t.x(10, 2).x() = 0.0;
  t.x(11, 2).tail<2>().setZero();
  t.x(12, 2) = Eigen::Vector3d(0.0, 0.0, 1e-12);
  EXPECT_TRUE(zeros_in(t).empty());
  t.x(20, 2) = Eigen::Vector3d(0.0, -0.0, 0.0);
  EXPECT_EQ(covered(zeros_in(t)), (Samples{{20, 2}})) << "minus zero is zero";
}

TEST(Zeros, AMarkerNearTheOriginMayPassThroughIt) {
  const auto confidence_at = [](double beside_m) {
    Trajectories t = testing::walker({.frames = 40});
    t.x(9, 2) = Eigen::Vector3d(beside_m, 0.0, 0.0);
    t.x(10, 2).setZero();
    const Defects found = zeros_in(t);
    return found.empty() ? 0.0 : found[0].confidence;
  };
  EXPECT_EQ(confidence_at(0.004), 0.0);
  double last = 0.5;
  for (const double beside : {0.006, 0.02, 0.1, 0.5}) {
    EXPECT_GT(confidence_at(beside), last) << "the farther it was, the surer";
    last = confidence_at(beside);
  }
}

TEST(Zeros, AMarkerThatIsNothingElseWasNeverSeen) {
  Trajectories t = testing::walker({.frames = 40});
  for (std::int64_t f = 0; f < 40; ++f) t.x(f, 2).setZero();
  for (std::int64_t f = 20; f < 25; ++f) t.set_missing(f, 2);
  const Defects found = zeros_in(t);
  ASSERT_EQ(found.size(), 2U) << "before and behind the gap";
  EXPECT_NE(found[0].description.find("never seen anywhere else"), std::string::npos);
  EXPECT_EQ(covered(found).size(), 35U);
}

TEST(DuplicatedFrames, AreFoundAndNoOthers) {
  Trajectories t = testing::walker({.frames = 300});
  Samples planted;
  for (const auto& [first, last] :
       {std::pair<std::int64_t, std::int64_t>{1, 1}, {40, 42}, {100, 100}, {250, 299}}) {
    repeat_frames(t, first, last);
    for (std::int64_t f = first; f <= last; ++f) planted.emplace(f, -1);
  }
  EXPECT_EQ(covered(duplicates_in(t)), planted);
}

TEST(DuplicatedFrames, TheSameMarkersMustBeSeen) {
  Trajectories t = testing::walker({.frames = 200});
  for (std::int64_t f = 50; f < 120; ++f) t.set_missing(f, 3);
  repeat_frames(t, 70, 72);
  EXPECT_EQ(covered(duplicates_in(t)), (Samples{{70, -1}, {71, -1}, {72, -1}})) << "the lost one repeats too";
  t.x(71, 3) = testing::position(3, 0.71);
  t.state[t.index(71, 3)] = data::SampleState::measured;
  EXPECT_FALSE(covered(duplicates_in(t)).contains({71, -1})) << "a marker that comes is news";
}

TEST(DuplicatedFrames, OneMarkerThatGoesOnIsEnoughToTellThatTimeDid) {
  Trajectories t = testing::walker({.frames = 200});
  const Eigen::Vector3d own = t.x(80, 6);
  repeat_frames(t, 80, 80);
  ASSERT_EQ(duplicates_in(t).size(), 1U);
  t.x(80, 6) = own;
  EXPECT_TRUE(duplicates_in(t).empty());
}

TEST(DuplicatedFrames, ABodyThatRestsRepeatsByItself) {
  Trajectories t = testing::walker({.frames = 200, .noise_m = 0.0});
  for (std::int64_t f = 100; f < 200; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      // It slows down to rest, as far as the last digit.
      const double time = 1.0 + 0.05 * (1.0 - std::exp(-0.2 * static_cast<double>(f - 100)));
      t.x(f, m) = (1e4 * testing::position(static_cast<int>(m), time)).array().round().matrix() / 1e4;
    }
  EXPECT_TRUE(duplicates_in(t).empty());
}

TEST(Stuck, AHeldValueIsFoundFromItsFirstSample) {
  for (std::int64_t m = 0; m < 8; ++m)
    for (const std::int64_t frames : {10, 17, 40}) {
      Trajectories t = testing::walker({.frames = 300});
      hold(t, m, 100, 99 + frames);
      const Defects found = stuck_in(t);
      ASSERT_EQ(found.size(), 1U) << m << " " << frames;
      EXPECT_EQ(found[0].marker, m);
      EXPECT_EQ(found[0].first_frame, 100);
      EXPECT_EQ(found[0].last_frame, 99 + frames);
    }
}

TEST(Stuck, NineFramesAreTooFewAndAMarkerAtRestIsNotStuck) {
  Trajectories few = testing::walker({.frames = 300});
  hold(few, 2, 100, 108);
  EXPECT_TRUE(stuck_in(few).empty()) << "0.1 s are ten frames";
  Trajectories rest = testing::walker({.frames = 300, .noise_m = 0.0});
  for (std::int64_t f = 0; f < 300; ++f) rest.x(f, 2) = Eigen::Vector3d(0.1, 0.2, 0.3);
  EXPECT_TRUE(stuck_in(rest).empty()) << "it never moves";
}

TEST(Stuck, RepeatedFramesAreNotCountedAgain) {
  Trajectories t = testing::walker({.frames = 300});
  repeat_frames(t, 100, 130);
  const Defects frames = duplicates_in(t);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(stuck_in(t, frames).empty());
  EXPECT_EQ(stuck_in(t).size(), 8U) << "unless nobody knows of them";
}

TEST(Repeats, NothingIsFoundInNothing) {
  for (const std::int64_t frames : {0, 1, 2}) {
    const Trajectories t = testing::walker({.frames = frames});
    EXPECT_TRUE(zeros_in(t).empty() && duplicates_in(t).empty() && stuck_in(t).empty()) << frames;
  }
  Trajectories lost = testing::walker({.frames = 30});
  for (std::int64_t f = 0; f < 30; ++f)
    for (std::int64_t m = 0; m < lost.markers(); ++m) lost.set_missing(f, m);
  EXPECT_TRUE(zeros_in(lost).empty() && duplicates_in(lost).empty() && stuck_in(lost).empty());
}

}  // namespace
}  // namespace kinemark::trajectory::internal
