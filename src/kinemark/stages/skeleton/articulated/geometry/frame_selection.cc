// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

constexpr std::size_t kEnoughFrames = 40;
constexpr std::int64_t kFirstFollowed = 64;  // frames that one thread follows from a cold start

}  // namespace

ChainSamples thin_out(const ChainSamples& samples, int most, std::vector<std::int64_t>& kept) {
  std::vector<std::int64_t> useful;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    int seen = 0;
    for (int k = 0; k < samples.markers && seen < 2; ++k) seen += samples.seen(f, k) ? 1 : 0;
    if (seen >= 2) useful.push_back(f);
  }
  kept.clear();
  const auto n = static_cast<std::int64_t>(useful.size());
  const std::int64_t take = std::min<std::int64_t>(n, most);
  ChainSamples out;
  out.markers = samples.markers;
  out.frames = take;
  out.x.resize(static_cast<std::size_t>(3 * take * samples.markers));
  for (std::int64_t i = 0; i < take; ++i) {
    kept.push_back(useful[i * n / take]);
    std::copy_n(samples.frame(kept.back()), 3 * samples.markers, out.x.data() + 3 * i * samples.markers);
  }
  return out;
}

std::vector<std::int64_t> first_frames(const ChainSamples& samples, const Chain& chain) {
  std::vector<int> have(chain.segments(), 0);
  for (const int s : chain.layout.segment_of_marker) ++have[s];
  std::vector<std::int64_t> full;
  std::vector<std::int64_t> some;
  std::vector<std::int64_t> few;
  const bool lines =
      chain.segments() == 2 && chain.kind[0] == SegmentKind::line && chain.kind[1] == SegmentKind::line;
  std::vector<int> seen(chain.segments());
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    std::fill(seen.begin(), seen.end(), 0);
    for (int k = 0; k < samples.markers; ++k)
      seen[chain.layout.segment_of_marker[k]] += samples.seen(f, k) ? 1 : 0;
    bool all_whole = true;
    bool all_two = true;
    bool all_one = true;
    bool one_whole = false;
    for (int s = 0; s < chain.segments(); ++s) {
      const bool whole = seen[s] >= std::min(chain.kind[s] == SegmentKind::line ? 2 : 3, have[s]);
      all_whole = all_whole && whole;
      all_two = all_two && seen[s] >= std::min(2, have[s]);
      all_one = all_one && seen[s] >= 1;
      one_whole = one_whole || (whole && have[s] > 1);
    }
    if (all_whole) full.push_back(f);
    if (one_whole && all_two) some.push_back(f);
    if (one_whole && (all_one || lines)) few.push_back(f);
  }
  if (lines) return few;
  if (full.size() >= kEnoughFrames) return full;
  return some.size() >= kEnoughFrames / 2 ? some : few;
}

PosedFrames first_poses(const ChainSamples& samples, const Chain& chain,
                        const std::vector<std::int64_t>& frames, const std::vector<double>& marker_weight,
                        double sigma_m, int iterations, int threads) {
  std::vector<std::optional<ChainPose>> poses(frames.size());
  parallel_for(std::ssize(frames), kFirstFollowed, threads, [&](std::int64_t begin, std::int64_t end) {
    PoseSolver solver(chain);
    ModeFinder finder(chain);
    std::vector<ChainMode> modes;
    const auto follow = [&](const ChainPose& near, ChainPose& pose) {
      if (!solver.shows_all_joints(sigma_m)) return false;
      pose = near;
      double cost = solver.refine(pose, {}, iterations);
      return finder.confirm(solver, sigma_m, iterations, pose, cost);
    };
    ChainPose pose;
    const ChainPose* before = nullptr;
    for (std::int64_t i = begin; i < end; ++i) {
      const double* x = samples.frame(frames[at(i)]);
      solver.set(x, marker_weight);
      if (before != nullptr && follow(*before, pose))
        poses[at(i)] = pose;
      else if (finder.find(solver, x, sigma_m, nullptr, iterations, modes) > 0)
        poses[at(i)] = modes[0].pose;
      if (poses[at(i)]) before = &*poses[at(i)];
    }
  });
  PosedFrames out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!poses[i]) continue;
    out.frame.push_back(frames[i]);
    out.pose.push_back(std::move(*poses[i]));
    out.weight.push_back(marker_weight);
  }
  return out;
}

}  // namespace kinemark::skeleton::articulated
