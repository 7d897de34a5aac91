// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/complete_set.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr std::size_t kExact = 20;  ///< markers whose sets are all looked at
constexpr std::int64_t kFewer = 30, kFewest = 2;

using Frames = std::vector<std::int64_t>;

/// What a set of markers must have.
struct Need {
  std::int64_t frames = 0;
  std::size_t of_each = 0;
};

/// Which markers each frame shows: F of K.
std::vector<std::vector<char>> sight_of(const Samples& samples, const std::vector<int>& markers) {
  std::vector<std::vector<char>> out;
  for (std::int64_t f = 0; f < samples.trajectories.frames(); ++f) {
    out.emplace_back();
    for (const int m : markers) out.back().push_back(samples.seen(f, m) ? 1 : 0);
  }
  return out;
}

/// Every set of markers as a number, bit k for marker k, and how many frames show all of it.
std::vector<std::int32_t> count_supersets(const std::vector<std::vector<char>>& sight, std::size_t K) {
  std::vector<std::int32_t> count(std::size_t{1} << K, 0);
  for (const auto& frame : sight) {
    std::size_t set = 0;
    for (std::size_t k = 0; k < K; ++k) set |= static_cast<std::size_t>(frame[k]) << k;
    ++count[set];
  }
  for (std::size_t k = 0; k < K; ++k) {
    const std::size_t bit = std::size_t{1} << k;
    for (std::size_t set = 0; set < count.size(); ++set)
      if ((set & bit) == 0) count[set] += count[set | bit];
  }
  return count;
}

std::vector<std::size_t> best_exact(const std::vector<std::int32_t>& count, std::size_t parents,
                                    const Need& need) {
  const std::size_t of_parent = (std::size_t{1} << parents) - 1;
  std::pair<int, std::int32_t> best{0, 0};
  std::size_t found = 0;
  for (std::size_t set = 1; set < count.size(); ++set) {
    const auto above = static_cast<std::size_t>(std::popcount(set & of_parent)),
               below = static_cast<std::size_t>(std::popcount(set & ~of_parent));
    if (count[set] < need.frames || above < need.of_each || below < need.of_each) continue;
    if (const std::pair now{std::popcount(set), count[set]}; now > best) {
      best = now;
      found = set;
    }
  }
  std::vector<std::size_t> out;
  for (std::size_t k = 0; found >> k != 0; ++k)
    if ((found >> k & 1) != 0) out.push_back(k);
  return out;
}

/// From one marker of each segment on, as long as enough frames stay.
std::vector<std::size_t> grow(const std::vector<std::vector<char>>& sight, std::vector<std::size_t> set,
                              std::size_t parents, std::size_t K, const Need& need, std::int64_t& frames) {
  const auto shows = [&](std::size_t f) {
    return std::ranges::all_of(set, [&](std::size_t k) { return sight[f][k] != 0; });
  };
  std::vector<std::size_t> left;
  for (std::size_t f = 0; f < sight.size(); ++f)
    if (shows(f)) left.push_back(f);
  while (true) {
    const auto above = at(std::ranges::count_if(set, [&](std::size_t k) { return k < parents; }));
    const bool short_above = above < need.of_each, short_below = set.size() - above < need.of_each;
    std::int64_t most = need.frames - 1;
    std::size_t next = K;
    for (std::size_t k = 0; k < K; ++k) {
      if (std::ranges::find(set, k) != set.end()) continue;
      if (short_above != short_below && (k < parents) != short_above) continue;
      const auto n = std::ranges::count_if(left, [&](std::size_t f) { return sight[f][k] != 0; });
      if (n > most) {
        most = n;
        next = k;
      }
    }
    frames = std::ssize(left);
    if (next == K)
      return short_above || short_below || frames < need.frames ? std::vector<std::size_t>() : set;
    set.push_back(next);
    std::erase_if(left, [&](std::size_t f) { return sight[f][next] == 0; });
  }
}

std::vector<std::size_t> best_grown(const std::vector<std::vector<char>>& sight, std::size_t parents,
                                    std::size_t K, const Need& need) {
  std::vector<std::size_t> best;
  std::int64_t most = 0;
  for (std::size_t a = 0; a < parents; ++a)
    for (std::size_t b = parents; b < K; ++b) {
      std::int64_t frames = 0;
      auto set = grow(sight, {a, b}, parents, K, need, frames);
      if (std::pair(set.size(), frames) <= std::pair(best.size(), most)) continue;
      best = std::move(set);
      most = frames;
    }
  std::ranges::sort(best);
  return best;
}

}  // namespace

Frames frames_that_show(const Samples& samples, const std::vector<int>& markers) {
  Frames out;
  for (std::int64_t f = 0; f < samples.trajectories.frames(); ++f)
    if (std::ranges::all_of(markers, [&](int m) { return samples.seen(f, m); })) out.push_back(f);
  return out;
}

CompleteSet find_complete_set(const Samples& samples, const std::vector<int>& parent,
                              const std::vector<int>& child, std::int64_t least_frames) {
  std::vector<int> markers = parent;
  markers.insert(markers.end(), child.begin(), child.end());
  const std::size_t K = markers.size();
  const auto sight = sight_of(samples, markers);
  const auto count = K <= kExact ? count_supersets(sight, K) : std::vector<std::int32_t>();
  for (const std::int64_t frames : std::array{least_frames, kFewer, kFewest})
    for (const std::size_t of_each : {std::size_t{3}, std::size_t{2}}) {
      const Need need{.frames = frames, .of_each = of_each};
      const auto set =
          K <= kExact ? best_exact(count, parent.size(), need) : best_grown(sight, parent.size(), K, need);
      if (set.empty()) continue;
      CompleteSet out;
      for (const std::size_t k : set) out.markers.push_back(markers[k]);
      out.frames = frames_that_show(samples, out.markers);
      return out;
    }
  return {};
}

}  // namespace kinemark::skeleton::internal
