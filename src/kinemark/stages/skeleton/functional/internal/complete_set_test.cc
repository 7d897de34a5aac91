// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/complete_set.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::internal {
namespace {

/// F frames in which each of K markers is seen with a chance of its own.
data::Trajectories seen_at_random(std::int64_t frames, int markers, std::uint64_t seed) {
  std::vector<std::string> names;
  for (int k = 0; k < markers; ++k) names.push_back("m" + std::to_string(k));
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 60.0, .t0_s = 0.0, .frames = frames});
  Random random(seed, 1);
  std::vector<double> chance;
  for (int k = 0; k < markers; ++k) chance.push_back(random.uniform(0.3, 0.95));
  for (std::int64_t f = 0; f < frames; ++f)
    for (int k = 0; k < markers; ++k)
      if (random.uniform() < chance[static_cast<std::size_t>(k)]) {
        out.x(f, k).setZero();
        out.state[out.index(f, k)] = data::SampleState::measured;
      }
  return out;
}

std::vector<int> numbers(int from, int to) {
  std::vector<int> out(static_cast<std::size_t>(to - from));
  std::iota(out.begin(), out.end(), from);
  return out;
}

/// The largest set by looking at all of them, marker by marker: the independent way.
std::pair<std::size_t, std::size_t> by_hand(const Samples& samples, int parents, int all, std::size_t least) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (unsigned set = 1; set < 1U << all; ++set) {
    std::vector<int> markers;
    int above = 0;
    for (int k = 0; k < all; ++k)
      if ((set >> k & 1U) != 0) {
        markers.push_back(k);
        above += k < parents;
      }
    if (above < 3 || static_cast<int>(markers.size()) - above < 3) continue;
    const auto frames = frames_that_show(samples, markers).size();
    if (frames >= least) best = std::max(best, std::pair(markers.size(), frames));
  }
  return best;
}

TEST(CompleteSet, IsTheLargestOfAll) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto markers = seen_at_random(300, 10, seed);
    const Samples samples{markers, {}};
    const auto set = find_complete_set(samples, numbers(0, 5), numbers(5, 10), 40);
    const auto [most, frames] = by_hand(samples, 5, 10, 40);
    if (most == 0) continue;
    EXPECT_EQ(set.markers.size(), most) << seed;
    EXPECT_EQ(set.frames.size(), frames) << seed;
    EXPECT_EQ(set.frames, frames_that_show(samples, set.markers));
  }
}

TEST(CompleteSet, OfManyMarkersIsGrownAndNearlyAsLarge) {
  // Twelve markers of each segment, the last two of each never seen: the first twenty by all their sets.
  auto many = seen_at_random(400, 24, 7);
  for (std::int64_t f = 0; f < 400; ++f)
    for (const int m : {10, 11, 22, 23})
      if (many.present(f, m)) many.set_missing(f, m);
  auto exact_child = numbers(12, 22), all_child = numbers(12, 24);
  const Samples samples{many, {}};
  const auto exact = find_complete_set(samples, numbers(0, 10), exact_child, 60);
  const auto grown = find_complete_set(samples, numbers(0, 12), all_child, 60);
  EXPECT_GE(grown.markers.size() + 1, exact.markers.size());
  EXPECT_LE(grown.markers.size(), exact.markers.size());
  EXPECT_GE(grown.frames.size(), 60U);
}

TEST(CompleteSet, AsksForLessWhereThereIsLess) {
  auto markers = seen_at_random(50, 6, 3);
  for (std::int64_t f = 0; f < 50; ++f)
    for (int k = 0; k < 6; ++k)
      if (markers.present(f, k)) markers.set_missing(f, k);
  const auto show = [&](std::int64_t f, std::initializer_list<int> which) {
    for (const int k : which) {
      markers.x(f, k).setZero();
      markers.state[markers.index(f, k)] = data::SampleState::measured;
    }
  };
  for (const std::int64_t f : {4, 9}) show(f, {0, 1, 3, 4});
  const Samples samples{markers, {}};
  const auto two = find_complete_set(samples, numbers(0, 3), numbers(3, 6));
  EXPECT_EQ(two.markers, (std::vector<int>{0, 1, 3, 4}));
  EXPECT_EQ(two.frames, (std::vector<std::int64_t>{4, 9}));
  markers.set_missing(9, 0);
  EXPECT_TRUE(find_complete_set(samples, numbers(0, 3), numbers(3, 6)).frames.empty());
}

}  // namespace
}  // namespace kinemark::skeleton::internal
