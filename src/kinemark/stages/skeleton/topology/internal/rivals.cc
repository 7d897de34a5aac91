// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/rivals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "kinemark/core/index.h"
#include "kinemark/stages/skeleton/topology/internal/pairs.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr std::array kThresholds_m{0.0025, 0.0035, 0.005, 0.007, 0.010, 0.014};
constexpr double kNoise = 1.2;      ///< times the SD that noise alone gives a distance
constexpr double kUnseen_m = 0.09;  ///< stands for the SD of a distance that was hardly ever seen
constexpr std::int64_t kLeastOfPairs = 20;
constexpr double kMostGap_m = 0.02;       ///< of two clusters that may have a joint
constexpr double kReach_m = 0.6;          ///< from a joint to the mean of either cluster, at most
constexpr double kSame_m = 0.03;          ///< places nearer than this are the same joint
constexpr double kNear_m = 0.25;          ///< and one within this is another that could stand for it,
constexpr double kNearGap = 2.0;          ///< with a gap below so many times its own
constexpr double kGapOfWeight_m = 0.005;  ///< a gap of which counts as half the weight
constexpr double kNoiseOfWidth =
    3.0;  ///< times the noise of a cluster's shape, as three markers hide some of it

using Clusters = std::vector<std::vector<int>>;

/// SDs of all distances in some of the frames.
Eigen::MatrixXd distance_sds(const Samples& samples, const std::vector<int>& markers, std::int64_t first,
                             std::int64_t end) {
  std::vector<std::int64_t> frames;
  for (std::int64_t f = first; f < end; ++f) frames.push_back(f);
  Eigen::MatrixXd sd = measure_pairs(samples, markers, frames, kLeastOfPairs).variance;
  for (Eigen::Index i = 0; i < sd.rows(); ++i)
    for (Eigen::Index j = 0; j < sd.cols(); ++j)
      sd(i, j) = i == j ? 0.0 : std::isnan(sd(i, j)) ? kUnseen_m : std::sqrt(sd(i, j));
  return sd;
}

std::map<Clusters, int> list_segmentations(const Samples& samples, const Topology& topology) {
  std::vector<int> markers;
  std::set<int> lost(topology.left_out.begin(), topology.left_out.end());
  for (int m = 0; m < static_cast<int>(samples.trajectories.markers()); ++m)
    if (!lost.contains(m)) markers.push_back(m);
  std::map<Clusters, int> found;
  const std::int64_t n = samples.trajectories.frames();
  const double noise = kNoise * std::sqrt(2.0) * topology.noise_sd_m;
  for (const auto& [first, end] : {std::pair{std::int64_t{0}, n}, {std::int64_t{0}, n / 2}, {n / 2, n}}) {
    const Linkage linkage(distance_sds(samples, markers, first, end));
    for (const double threshold : kThresholds_m) {
      Clusters clusters = linkage.cut(std::hypot(threshold, noise));
      for (auto& c : clusters)
        for (int& m : c) m = markers[at(m)];
      ++found[clusters];
    }
  }
  Clusters by_evidence;
  for (const auto& segment : topology.layout.segments) by_evidence.push_back(segment.markers);
  for (auto& c : by_evidence) std::ranges::sort(c);
  std::ranges::sort(by_evidence);
  ++found[by_evidence];
  return found;
}

/// Noise with which a cluster's width is judged: its own where nothing slides, else what skin hides of it.
double width_noise(const SegmentPoses& poses, const Topology& topology, const SegmentationOptions& options) {
  const double own = std::isfinite(poses.noise_sd_m) ? poses.noise_sd_m : options.skin_sd_m;
  return topology.soft_sd_m > 0.0 ? std::max(own, std::min(options.skin_sd_m, kNoiseOfWidth * own)) : own;
}

/// Joints of clusters: of all pairs that share a point the cheapest that make no circle.
std::vector<Place> spanning_joints(const std::vector<const Place*>& pairs) {
  std::vector<const Place*> sorted = pairs;
  std::ranges::stable_sort(sorted, {}, &Place::cost);
  std::map<int, int> root;  // of a cluster, by its first marker
  const auto find = [&](int c) {
    while (root.contains(c)) c = root[c];
    return c;
  };
  std::vector<Place> out;
  for (const Place* place : sorted) {
    const int a = find(place->a.front()), b = find(place->b.front());
    if (a == b) continue;
    root[a] = b;
    out.push_back(*place);
  }
  return out;
}

}  // namespace

Linkage::Linkage(Eigen::MatrixXd distances) : items_(static_cast<int>(distances.rows())) {
  std::vector<int> alive(at(items_));
  std::iota(alive.begin(), alive.end(), 0);
  std::vector<double> size(at(items_), 1.0);
  while (alive.size() > 1) {
    Merge merge{.keep = 0, .drop = 0, .height = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < alive.size(); ++i)
      for (std::size_t j = i + 1; j < alive.size(); ++j)
        if (const double d = distances(alive[i], alive[j]); d < merge.height)
          merge = {.keep = alive[i], .drop = alive[j], .height = d};
    if (merge.keep == merge.drop) break;
    const double a = size[at(merge.keep)], b = size[at(merge.drop)];
    for (const int k : alive) {
      const double d = (a * distances(merge.keep, k) + b * distances(merge.drop, k)) / (a + b);
      distances(merge.keep, k) = distances(k, merge.keep) = d;
    }
    size[at(merge.keep)] += b;
    std::erase(alive, merge.drop);
    merges_.push_back(merge);
  }
}

std::vector<std::vector<int>> Linkage::cut(double most) const {
  std::vector<std::vector<int>> clusters(at(items_));
  for (int i = 0; i < items_; ++i) clusters[at(i)].push_back(i);
  // Mean distances never shrink from one merge to the next.
  for (const Merge& merge : merges_) {
    if (merge.height > most) break;
    auto &to = clusters[at(merge.keep)], &from = clusters[at(merge.drop)];
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
  }
  std::erase_if(clusters, [](const auto& c) { return c.empty(); });
  for (auto& c : clusters) std::ranges::sort(c);
  std::ranges::sort(clusters);
  return clusters;
}

std::vector<Rival> find_rivals(const Samples& samples, const Topology& topology,
                               const SegmentationOptions& options) {
  PoseStore store(samples);
  std::map<std::pair<std::vector<int>, std::vector<int>>, std::optional<Place>> sites;
  const auto segmentations = list_segmentations(samples, topology);
  const double all = std::accumulate(segmentations.begin(), segmentations.end(), 0.0,
                                     [](double sum, const auto& s) { return sum + s.second; });
  std::vector<Rival> rivals;
  for (const auto& [clusters, count] : segmentations) {
    Clusters wide;
    for (const auto& c : clusters) {
      if (c.size() < 3) continue;
      const SegmentPoses& poses = store.of(c);
      if (is_wide(poses.x_in_segment, width_noise(poses, topology, options))) wide.push_back(c);
    }
    std::vector<const Place*> pairs;
    for (std::size_t i = 0; i < wide.size(); ++i)
      for (std::size_t j = i + 1; j < wide.size(); ++j) {
        const std::pair key{wide[i], wide[j]};
        auto found = sites.find(key);
        if (found == sites.end())
          found = sites.emplace(key, find_place(store.of(wide[i]), store.of(wide[j]))).first;
        const auto& place = found->second;
        if (place && place->turn_rad[0] >= options.least_turn_rad && place->gap_m <= kMostGap_m &&
            std::max(place->reach_a_m, place->reach_b_m) <= kReach_m)
          pairs.push_back(&*place);
      }
    rivals.push_back({.clusters = clusters, .weight = count / all, .joints = spanning_joints(pairs)});
  }
  return rivals;
}

std::vector<Agreement> find_agreements(const std::vector<Rival>& rivals) {
  std::vector<RivalPlace> all;
  for (std::size_t r = 0; r < rivals.size(); ++r)
    for (const auto& place : rivals[r].joints) all.push_back({r, &place});
  std::vector<RivalPlace> waiting = all;
  std::ranges::stable_sort(waiting, std::greater{}, [&](const RivalPlace& p) {
    return rivals[p.rival].weight / (1.0 + p.place->gap_m / kGapOfWeight_m);
  });
  std::vector<Agreement> out;
  while (!waiting.empty()) {
    const Place& first = *waiting.front().place;
    Agreement agreement;
    double squares = 0.0, weight = 0.0;
    std::set<std::size_t> have;
    std::erase_if(waiting, [&](const RivalPlace& p) {
      const double d = p.place == &first ? 0.0 : distance(first, *p.place);
      if (!(d < kSame_m)) return false;
      agreement.members.push_back(p);
      squares += rivals[p.rival].weight * d * d;
      weight += rivals[p.rival].weight;
      have.insert(p.rival);
      return true;
    });
    for (const std::size_t r : have) agreement.weight += rivals[r].weight;
    agreement.spread_m = std::sqrt(squares / weight);
    std::set<std::size_t> other;
    for (const RivalPlace& p : all) {
      if (have.contains(p.rival) || p.place->gap_m >= kNearGap * first.gap_m) continue;
      if (const double d = distance(first, *p.place); d < kSame_m || d >= kNear_m) continue;
      other.insert(p.rival);
      agreement.others.push_back(p);
    }
    for (const std::size_t r : other) agreement.rival_weight += rivals[r].weight;
    out.push_back(std::move(agreement));
  }
  return out;
}

}  // namespace kinemark::skeleton::internal
