// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/label_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "kinemark/math/statistics.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kCrossed = 0.5;    // steps with exchanged labels to steps as labelled
constexpr double kLeapM = 0.008;    // a jump is at least so far from the predicted position, and
constexpr double kLeapUsual = 6.0;  // so many times the median of that
constexpr std::size_t kMaxLeaps = 40;

/// Predicted position: linear continuation of the two frames before.
Eigen::Vector3d ahead(const Recording& r, Index m, Index frame) {
  if (frame < 2 || !r.usable(m, frame - 2)) return r.x(m, frame - 1);
  return 2.0 * r.x(m, frame - 1) - r.x(m, frame - 2);
}

/// Frames of leaps and the markers that make them.
std::map<Index, std::vector<Index>> find_leaps(const Recording& r) {
  std::map<Index, std::vector<Index>> leaps;
  std::vector<double> off;
  std::vector<Index> frames;
  for (Index m = 0; m < r.markers(); ++m) {
    off.clear();
    frames.clear();
    for (Index f = 1; f < r.frames(); ++f) {
      if (!r.complete(m, f - 1, f + 1)) continue;
      off.push_back((r.x(m, f) - ahead(r, m, f)).norm());
      frames.push_back(f);
    }
    if (off.empty()) continue;
    const double least = std::max(kLeapM, kLeapUsual * math::upper_median(off));
    for (std::size_t i = 0; i < off.size(); ++i)
      if (off[i] > least) leaps[frames[i]].push_back(m);
  }
  return leaps;
}

constexpr Index kMaxMarkers = 1000;  // beyond, the table of pairs would take minutes
constexpr Index kCheckedFrames = 120;
constexpr std::size_t kPartners = 8;
constexpr std::size_t kVotes = 5;  // partners that decide whether a marker is out of place
constexpr std::size_t kLeastVotes = 3;
constexpr double kOutRange = 2.5;  // of the 20 to 80 % range, and
constexpr double kOutM = 0.015;
constexpr double kNormalRange = 1.683;  // 20 to 80 % of a normal distribution, in SD
constexpr double kLabelSlackM = 0.003;
constexpr double kCap = 25.0;     // of a squared deviate, so that one distance cannot decide alone
constexpr double kSuspect = 4.0;  // mean squared deviate of a marker that may be swapped
constexpr double kMisfit = 6.0;   // ... of a swapped pair as labelled
constexpr double kCured = 0.25;   // ... and what of it remains after the exchange
constexpr std::size_t kMaxSuspects = 16;
constexpr Index kMergeFrames = 3;
constexpr std::size_t kLeastCheckedFrames = 3;

/// A marker whose distance to another one stays about the same.
struct Partner {
  Index marker = 0;
  double median_m = 0.0;
  double range_m = 0.0;  // 20 to 80 %
};
using Partners = std::vector<std::vector<Partner>>;  // per marker, steadiest first
using Flags = std::vector<std::vector<std::uint8_t>>;

void keep_steadiest(std::vector<Partner>& list, const Partner& p) {
  const auto at = std::ranges::upper_bound(list, p.range_m, {}, &Partner::range_m);
  if (at == list.end() && list.size() >= kPartners) return;
  list.insert(at, p);
  if (list.size() > kPartners) list.pop_back();
}

Partners find_partners(const Recording& r) {
  Partners partners(static_cast<std::size_t>(r.markers()));
  const Index sampled = std::min(r.frames(), kCheckedFrames);
  std::vector<double> d;
  for (Index a = 0; a < r.markers(); ++a)
    for (Index b = a + 1; b < r.markers(); ++b) {
      d.clear();
      for (Index i = 0; i < sampled; ++i) {
        const Index f = sampled == 1 ? 0 : i * (r.frames() - 1) / (sampled - 1);
        if (r.usable(a, f) && r.usable(b, f)) d.push_back((r.x(a, f) - r.x(b, f)).norm());
      }
      if (d.size() < 8 || 10 * static_cast<Index>(d.size()) < 3 * sampled) continue;
      const double range = math::quantile(d, 0.8) - math::quantile(d, 0.2);
      const double median = math::quantile(d, 0.5);
      keep_steadiest(partners[static_cast<std::size_t>(a)], {b, median, range});
      keep_steadiest(partners[static_cast<std::size_t>(b)], {a, median, range});
    }
  return partners;
}

double squared_deviate(const Partner& p, double distance_m) {
  const double z = (distance_m - p.median_m) / (p.range_m / kNormalRange + kLabelSlackM);
  return std::min(z * z, kCap);
}

/// One frame of the check.
class FrameCheck {
 public:
  FrameCheck(const Recording& r, const Partners& partners) : r_(r), partners_(partners) {}

  /// Mean squared deviate of the distances that marker `of` would have at the position of `at`, without
  /// `without`.
  [[nodiscard]] double misfit(Index of, Index at, Index without, Index frame) const {
    double sum = 0.0;
    int n = 0;
    for (const Partner& p : partners_[static_cast<std::size_t>(of)]) {
      if (p.marker == at || p.marker == without || !r_.usable(p.marker, frame)) continue;
      sum += squared_deviate(p, (r_.x(at, frame) - r_.x(p.marker, frame)).norm());
      ++n;
    }
    return n >= 2 ? sum / n : 0.0;
  }

  /// Pairs that fit far better the other way round, each marker in at most one of them.
  [[nodiscard]] std::vector<std::pair<Index, Index>> find_swaps(Index frame) const {
    std::vector<std::pair<double, Index>> suspects;
    for (Index m = 0; m < r_.markers(); ++m) {
      if (!r_.usable(m, frame)) continue;
      const double u = misfit(m, m, m, frame);
      if (u > kSuspect) suspects.emplace_back(-u, m);
    }
    if (suspects.size() < 2) return {};
    std::ranges::sort(suspects);
    if (suspects.size() > kMaxSuspects) suspects.resize(kMaxSuspects);
    std::vector<std::pair<double, std::pair<Index, Index>>> found;
    for (std::size_t i = 0; i < suspects.size(); ++i)
      for (std::size_t k = i + 1; k < suspects.size(); ++k) {
        const Index a = std::min(suspects[i].second, suspects[k].second);
        const Index b = std::max(suspects[i].second, suspects[k].second);
        const double as_labelled = 0.5 * (misfit(a, a, b, frame) + misfit(b, b, a, frame));
        if (as_labelled < kMisfit) continue;
        const double exchanged = 0.5 * (misfit(a, b, b, frame) + misfit(b, a, a, frame));
        if (exchanged < kCured * as_labelled) found.push_back({exchanged / as_labelled, {a, b}});
      }
    std::ranges::sort(found);
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& [quality, pair] : found)
      if (std::ranges::none_of(pairs, [&pair = pair](const auto& p) {
            return p.first == pair.first || p.first == pair.second || p.second == pair.first ||
                   p.second == pair.second;
          }))
        pairs.push_back(pair);
    return pairs;
  }

  /// Markers at least half of whose partners are at the wrong distance; the worst is removed first and no
  /// longer used as a partner.
  [[nodiscard]] std::vector<Index> find_out_of_place(Index frame) const {
    std::vector<Index> out;
    const auto is_out = [&](Index m) { return std::ranges::find(out, m) != out.end(); };
    while (out.size() < kMaxSuspects) {
      std::pair<double, double> worst{0.5, 0.0};  // share of bad distances, then by how much
      Index who = -1;
      for (Index m = 0; m < r_.markers(); ++m) {
        if (!r_.usable(m, frame) || is_out(m)) continue;
        std::size_t votes = 0;
        std::size_t bad = 0;
        double excess = 0.0;
        for (const Partner& p : partners_[static_cast<std::size_t>(m)]) {
          if (votes == kVotes) break;
          if (!r_.usable(p.marker, frame) || is_out(p.marker)) continue;
          const double off = std::abs((r_.x(m, frame) - r_.x(p.marker, frame)).norm() - p.median_m);
          ++votes;
          if (off > kOutRange * p.range_m + kOutM) ++bad;
          excess += off / (kOutRange * p.range_m + kOutM);
        }
        if (votes < kLeastVotes) continue;
        const std::pair<double, double> share{static_cast<double>(bad) / static_cast<double>(votes), excess};
        if (share > worst) {
          worst = share;
          who = m;
        }
      }
      if (who < 0) break;
      out.push_back(who);
    }
    return out;
  }

 private:
  const Recording& r_;
  const Partners& partners_;
};

/// Frame in [border - 2, border + 2] from which the two markers have exchanged their paths, or -1. Also where
/// a sample is missing there, during which the exchange can have happened unseen.
Index find_exchange(const Recording& r, Index a, Index b, Index border) {
  for (const Index shift : {0, -1, 1, -2, 2}) {
    const Index f = border + shift;
    if (f <= 0 || f >= r.frames()) return border;
    for (const Index m : {a, b})
      if (!r.usable(m, f - 1) || !r.usable(m, f)) return border;
    if (paths_cross(r, a, b, f)) return f;
  }
  return -1;
}

/// Frames of each pair to stretches: short interruptions bridged, single frames left out, and those left out
/// that begin or end in the middle of undisturbed paths: that is a posture, not a swap.
std::vector<Swap> join_frames(const Recording& r,
                              const std::map<std::pair<Index, Index>, std::vector<Index>>& hits) {
  std::vector<Swap> swaps;
  for (const auto& [pair, frames] : hits) {
    for (std::size_t i = 0; i < frames.size();) {
      std::size_t k = i + 1;
      while (k < frames.size() && frames[k] - frames[k - 1] <= kMergeFrames) ++k;
      const Index first = find_exchange(r, pair.first, pair.second, frames[i]);
      const Index end = find_exchange(r, pair.first, pair.second, frames[k - 1] + 1);
      if (k - i >= kLeastCheckedFrames && first >= 0 && end > first) {
        swaps.push_back({.first_marker = pair.first,
                         .second_marker = pair.second,
                         .first = first,
                         .end = end,
                         .distance_m = median_distance(r, pair.first, pair.second, first, end)});
      }
      i = k;
    }
  }
  return swaps;
}

void undo(const std::vector<Swap>& swaps, Recording& recording) {
  for (const Swap& s : swaps)
    for (Index f = s.first; f < s.end; ++f)
      if (recording.usable(s.first_marker, f) && recording.usable(s.second_marker, f))
        recording.exchange(s.first_marker, s.second_marker, f);
}

}  // namespace

bool paths_cross(const Recording& r, Index a, Index b, Index f) {
  const Eigen::Vector3d pa = ahead(r, a, f);
  const Eigen::Vector3d pb = ahead(r, b, f);
  const double stay = (r.x(a, f) - pa).norm() + (r.x(b, f) - pb).norm();
  const double cross = (r.x(a, f) - pb).norm() + (r.x(b, f) - pa).norm();
  return cross < kCrossed * stay;
}

double median_distance(const Recording& r, Index a, Index b, Index first, Index end) {
  std::vector<double> d;
  for (Index f = first; f < end; ++f)
    if (r.usable(a, f) && r.usable(b, f)) d.push_back((r.x(a, f) - r.x(b, f)).norm());
  return d.empty() ? 0.0 : math::upper_median(d);
}

std::vector<Swap> find_crossings(const Recording& r) {
  std::map<std::pair<Index, Index>, std::vector<Index>> events;
  for (const auto& [f, markers] : find_leaps(r)) {
    if (markers.size() < 2 || markers.size() > kMaxLeaps) continue;  // all together: a jump of the clock
    for (std::size_t i = 0; i < markers.size(); ++i)
      for (std::size_t k = i + 1; k < markers.size(); ++k)
        if (paths_cross(r, markers[i], markers[k], f)) events[{markers[i], markers[k]}].push_back(f);
  }
  std::vector<Swap> swaps;
  for (const auto& [pair, frames] : events)
    for (std::size_t i = 0; i + 1 < frames.size();) {
      const bool seen = r.complete(pair.first, frames[i], frames[i + 1]) &&
                        r.complete(pair.second, frames[i], frames[i + 1]);
      if (!seen || 2 * (frames[i + 1] - frames[i]) > r.frames()) {
        ++i;
        continue;
      }
      swaps.push_back({.first_marker = pair.first,
                       .second_marker = pair.second,
                       .first = frames[i],
                       .end = frames[i + 1],
                       .distance_m = median_distance(r, pair.first, pair.second, frames[i], frames[i + 1])});
      i += 2;
    }
  return swaps;
}

std::vector<Swap> check_labels(Recording& recording) {
  if (recording.markers() < 4 || recording.markers() > kMaxMarkers) return {};
  const Partners partners = find_partners(recording);
  std::vector<Swap> swaps = find_crossings(recording);
  undo(swaps, recording);
  const FrameCheck check(recording, partners);
  std::map<std::pair<Index, Index>, std::vector<Index>> hits;
  for (Index f = 0; f < recording.frames(); ++f)
    for (const auto& pair : check.find_swaps(f)) hits[pair].push_back(f);
  const std::vector<Swap> by_distance = join_frames(recording, hits);
  undo(by_distance, recording);
  swaps.insert(swaps.end(), by_distance.begin(), by_distance.end());
  std::ranges::stable_sort(swaps, {}, [](const Swap& s) { return s.first; });
  Flags doubtful(static_cast<std::size_t>(recording.markers()),
                 std::vector<std::uint8_t>(static_cast<std::size_t>(recording.frames()), 0));
  for (Index f = 0; f < recording.frames(); ++f)
    for (const Index m : check.find_out_of_place(f))
      doubtful[static_cast<std::size_t>(m)][static_cast<std::size_t>(f)] = 1;
  recording.set_doubtful(doubtful);
  return swaps;
}

}  // namespace kinemark::trajectory::internal
