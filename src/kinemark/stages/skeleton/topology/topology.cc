// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/topology.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/core/text.h"
#include "kinemark/stages/skeleton/topology/internal/edges.h"
#include "kinemark/stages/skeleton/topology/internal/pairs.h"

namespace kinemark::skeleton {
namespace {

constexpr double kMostWork = 1e9;         ///< largest number of pair samples
constexpr std::int64_t kFewFrames = 200;  ///< fewest frames, even if that limit is exceeded
constexpr std::size_t kNamesListed = 8;

std::vector<std::int64_t> draw_frames(const data::Trajectories& t, const TopologyOptions& options) {
  const double pairs = std::max(1.0, static_cast<double>(t.markers()) * static_cast<double>(t.markers()));
  const auto affordable = std::max(kFewFrames, static_cast<std::int64_t>(std::min(1e9, kMostWork / pairs)));
  const std::int64_t n = std::min({t.frames(), options.most_frames, affordable});
  return internal::draw_evenly(t.frames(), n);
}

/// Markers used, in the order of the matrices, and the segment of each.
struct Clusters {
  std::vector<int> markers, segment;
  Eigen::MatrixXd odds;
  internal::PairSpread pairs;
};

void judge_markers(const Clusters& clusters, const std::vector<std::string>& names,
                   const TopologyOptions& options, Topology& out) {
  const int S = static_cast<int>(out.layout.segments.size());
  std::vector<std::string> doubtful;
  for (std::size_t i = 0; i < clusters.markers.size(); ++i) {
    const auto odds_to = [&](int s) {
      return internal::mean_odds(clusters.odds, clusters.pairs, clusters.segment, i, s);
    };
    const auto marker = static_cast<std::size_t>(clusters.markers[i]);
    MarkerEvidence& evidence = out.markers[marker];
    double best = -std::numeric_limits<double>::infinity();
    for (int s = 0; s < S; ++s) {
      if (s == clusters.segment[i]) continue;
      const double other = odds_to(s);
      if (std::isnan(other) || other <= best) continue;
      best = other;
      evidence.second_segment = s;
    }
    const double own = odds_to(clusters.segment[i]);
    evidence.nats = (std::isnan(own) ? 0.0 : own) - (evidence.second_segment < 0 ? 0.0 : best);
    // Motion against one marker of its own segment is as much evidence as another segment that fits.
    const bool moves =
        internal::least_odds(clusters.odds, clusters.pairs, clusters.segment, i) < -options.doubtful_nats;
    evidence.doubtful = evidence.second_segment >= 0 && (moves || evidence.nats < options.doubtful_nats);
    if (!evidence.doubtful) continue;
    const auto& segments = out.layout.segments;
    doubtful.push_back(fmt::format(
        "'{}' on {} ({})", names[marker], segments[static_cast<std::size_t>(clusters.segment[i])].name,
        evidence.nats < options.doubtful_nats
            ? fmt::format("{} fits nearly as well",
                          segments[static_cast<std::size_t>(evidence.second_segment)].name)
            : "it moves against others there"));
  }
  if (!doubtful.empty())
    out.warnings.push_back(fmt::format("Segment of {} of {} markers doubtful: {}.", doubtful.size(),
                                       clusters.markers.size(), join_some(doubtful, kNamesListed)));
}

/// Tree edges as joints that lead away from the first segment of each tree.
void add_joints(const std::vector<internal::TreeEdge>& tree, const TopologyOptions& options, Topology& out) {
  auto& layout = out.layout;
  std::vector<std::uint8_t> reached(layout.segments.size(), 0);
  std::vector<std::string> roots, doubtful;
  for (std::size_t root = 0; root < reached.size(); ++root) {
    if (reached[root]) continue;
    reached[root] = 1;
    roots.push_back(layout.segments[root].name);
    std::vector<int> queue{static_cast<int>(root)};
    for (std::size_t at = 0; at < queue.size(); ++at)
      for (const internal::TreeEdge& t : tree) {
        const int here = queue[at];
        if (t.edge.a != here && t.edge.b != here) continue;
        const int there = t.edge.a == here ? t.edge.b : t.edge.a;
        if (reached[static_cast<std::size_t>(there)]) continue;
        reached[static_cast<std::size_t>(there)] = 1;
        queue.push_back(there);
        const std::string name = layout.segments[static_cast<std::size_t>(here)].name + "-" +
                                 layout.segments[static_cast<std::size_t>(there)].name;
        layout.joints.push_back({name, here, there});
        out.joints.push_back({.residual_m = std::isnan(t.edge.residual_m) ? t.edge.cost_m : t.edge.residual_m,
                              .margin = t.margin,
                              .doubtful = t.margin < options.doubtful_margin});
        if (out.joints.back().doubtful) doubtful.push_back(fmt::format("{} ({:.2f})", name, t.margin));
      }
  }
  if (!doubtful.empty())
    out.warnings.push_back(fmt::format("Another joint would do nearly as well (times worse) in place of: {}.",
                                       join_some(doubtful, kNamesListed)));
  if (roots.size() > 1)
    out.warnings.push_back(
        fmt::format("The segments make {} groups that were never seen together, beginning with: {}.",
                    roots.size(), join_some(roots, kNamesListed)));
}

void warn_of_unseen(const Clusters& clusters, const std::vector<std::string>& names, Topology& out) {
  std::vector<std::string> pairs, lost;
  for (std::size_t i = 0; i < clusters.markers.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (!std::isnan(clusters.pairs.variance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))))
        continue;
      const int a = clusters.markers[j], b = clusters.markers[i];
      out.never_together.emplace_back(a, b);
      pairs.push_back(names[static_cast<std::size_t>(a)] + "-" + names[static_cast<std::size_t>(b)]);
    }
  for (const int m : out.left_out) lost.push_back(names[static_cast<std::size_t>(m)]);
  if (!pairs.empty())
    out.warnings.push_back(fmt::format("{} pairs of markers were hardly ever seen together: {}.",
                                       pairs.size(), join_some(pairs, kNamesListed)));
  if (!lost.empty())
    out.warnings.push_back(fmt::format("{} markers were hardly ever seen and are on no segment: {}.",
                                       lost.size(), join_some(lost, kNamesListed)));
}

Clusters find_clusters(const Samples& samples, const std::vector<std::int64_t>& frames,
                       const TopologyOptions& options, Topology& out) {
  Clusters clusters;
  for (int m = 0; m < static_cast<int>(samples.trajectories.markers()); ++m) {
    const auto seen = std::ranges::count_if(frames, [&](std::int64_t f) { return samples.seen(f, m); });
    (seen >= options.least_frames ? clusters.markers : out.left_out).push_back(m);
  }
  clusters.pairs = internal::measure_pairs(samples, clusters.markers, frames, options.least_frames);
  auto same =
      internal::describe_same_segment(clusters.pairs, options.noise_sd_m, 0.5 * options.least_motion_m);
  const internal::OddsOptions range{.least_motion_m = options.least_motion_m,
                                    .most_motion_m = options.most_motion_m};
  const bool known = options.noise_sd_m > 0.0 || same.soft_sd_m > 0.0;
  for (int round = 0; round < (known ? 1 : 2); ++round) {
    if (round > 0)
      if (const double within = internal::noise_within(clusters.pairs, clusters.segment); !std::isnan(within))
        same.noise_variance = within;
    clusters.odds = internal::log_odds(clusters.pairs, same, range);
    clusters.segment = internal::cluster(clusters.odds, clusters.pairs);
  }
  out.noise_sd_m = std::sqrt(same.noise_variance);
  out.soft_sd_m = same.soft_sd_m;
  out.independent = same.independent;
  return clusters;
}

}  // namespace

Status TopologyOptions::check() const {
  const auto bad = [](std::string text) { return fail(Code::usage, std::move(text)); };
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return bad(fmt::format("marker noise of {} m; need 0 or more", noise_sd_m));
  if (!(least_motion_m > 0.0) || !(most_motion_m > least_motion_m))
    return bad(fmt::format("motion between segments from {} to {} m; need more than 0, then more",
                           least_motion_m, most_motion_m));
  if (least_frames < 6) return bad(fmt::format("pairs seen in {} frames; need 6 or more", least_frames));
  if (most_frames < 100) return bad(fmt::format("{} frames are used; need 100 or more", most_frames));
  if (!(doubtful_nats >= 0.0) || !(doubtful_margin >= 1.0))
    return bad(fmt::format("doubt below {} nats and {} times; need 0 and 1 or more", doubtful_nats,
                           doubtful_margin));
  return {};
}

Result<Topology> find_topology(const data::Trajectories& trajectories, const TopologyOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = trajectories.validate(); !s) return std::unexpected(s.error());
  if (!options.mask.empty() && options.mask.size() != trajectories.state.size())
    return fail(Code::usage,
                fmt::format("mask of {} samples for {}", options.mask.size(), trajectories.state.size()));
  const data::Trajectories drawn =
      internal::cut(trajectories, draw_frames(trajectories, options), options.mask);
  const Samples samples{drawn, {}};
  std::vector<std::int64_t> frames(static_cast<std::size_t>(drawn.frames()));
  std::iota(frames.begin(), frames.end(), 0);

  Topology out;
  out.markers.resize(static_cast<std::size_t>(trajectories.markers()));
  const Clusters clusters = find_clusters(samples, frames, options, out);
  if (clusters.markers.size() < 2)
    return fail(Code::bad_input,
                fmt::format("{} of {} markers were seen in {} frames or more; two at least are needed to "
                            "distinguish segments",
                            clusters.markers.size(), trajectories.markers(), options.least_frames));
  const int S = 1 + *std::ranges::max_element(clusters.segment);
  out.layout.segments.resize(static_cast<std::size_t>(S));
  std::vector<SegmentPoses> poses;
  for (int s = 0; s < S; ++s) {
    auto& segment = out.layout.segments[static_cast<std::size_t>(s)];
    segment.name = fmt::format("segment{}", s + 1);
    for (std::size_t i = 0; i < clusters.markers.size(); ++i)
      if (clusters.segment[i] == s) segment.markers.push_back(clusters.markers[i]);
    poses.push_back(find_segment_poses(samples, segment.name, segment.markers));
  }
  judge_markers(clusters, trajectories.names, options, out);
  warn_of_unseen(clusters, trajectories.names, out);
  if (S == 1) {
    out.warnings.push_back(fmt::format(
        "All {} markers keep their distances: one segment, or nothing moved, so no joint can be found.",
        clusters.markers.size()));
    return out;
  }
  add_joints(
      internal::spanning_tree(internal::find_edges(samples, poses, clusters.segment, clusters.pairs), S),
      options, out);
  return out;
}

}  // namespace kinemark::skeleton
