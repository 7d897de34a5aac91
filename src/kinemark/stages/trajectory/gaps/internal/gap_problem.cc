// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr std::size_t kMaxCandidates = 24;
constexpr std::size_t kMaxPredictors = 12;
constexpr std::size_t kFewPredictors = 4;
constexpr std::size_t kMinPredictors = 3;  // the gate leaves that many
constexpr Index kMinChosen = 32;           // windows, of those there are; more of them
constexpr Index kMaxChosen = 64;           // when they are short, so that there are
constexpr Index kWantedRows = 768;         // so many rows to learn from
constexpr Index kMinWindows = 8;
constexpr Index kMaxPositions = 20'000;
constexpr Index kMaxRows = 24;
constexpr Index kSampledFrames = 300;

/// n numbers spread evenly over 0 to last, both included, without repeats.
Eigen::VectorX<Index> spread_rows(Index last, Index n) {
  std::vector<Index> rows;
  for (Index i = 0; i < n; ++i) {
    const Index row =
        n == 1 ? 0
               : static_cast<Index>(std::llround(static_cast<double>(i) * static_cast<double>(last) /
                                                 static_cast<double>(n - 1)));
    if (rows.empty() || rows.back() != row) rows.push_back(row);
  }
  return Eigen::Map<Eigen::VectorX<Index>>(rows.data(), static_cast<Index>(rows.size()));
}

/// Every start at which such a window fits; in long recordings every second, third, ...
std::vector<Index> find_positions(const Recording& recording, Index target, std::span<const Index> predictors,
                                  const GapShape& window) {
  std::vector<Index> positions;
  const Index step = 1 + recording.frames() / kMaxPositions;
  for (Index s = window.left; s + window.length + window.right <= recording.frames(); s += step) {
    const Index first = s - window.left;
    const Index end = s + window.length + window.right;
    if (recording.complete(target, first, end) &&
        std::ranges::all_of(predictors, [&](Index k) { return recording.complete(k, first, end); }))
      positions.push_back(s);
  }
  return positions;
}

/// One random window out of each of n equal parts of the list.
std::vector<Index> choose_windows(const std::vector<Index>& positions, Index n, Random random) {
  const auto count = static_cast<Index>(positions.size());
  if (count <= n) return positions;
  std::vector<Index> chosen;
  for (Index i = 0; i < n; ++i) {
    const double u = random.uniform();
    const double at = (static_cast<double>(i) + u) * static_cast<double>(count) / static_cast<double>(n);
    chosen.push_back(positions[static_cast<std::size_t>(std::min(count - 1, static_cast<Index>(at)))]);
  }
  return chosen;
}

bool enough(const std::vector<Index>& positions, Index length) {
  return static_cast<Index>(positions.size()) >= kMinWindows &&
         positions.back() - positions.front() >= length;
}

/// Leave out windows where the target is in doubt, if that leaves enough of them.
void drop_doubtful_windows(const Recording& recording, GapProblem& p) {
  std::vector<Index> sure;
  for (const Index s : p.starts)
    if (recording.doubtful(p.span.marker, s - p.window.left, s + p.window.length + p.window.right) == 0)
      sure.push_back(s);
  if (sure.size() >= 4 && static_cast<double>(sure.size()) >= 0.4 * static_cast<double>(p.starts.size()))
    p.starts = std::move(sure);
}

void choose_candidates(const Recording& recording, const std::vector<Neighbour>& neighbours, GapProblem& p) {
  const Index first = p.span.first - p.span.left;
  const Index end = p.span.end + p.span.right;
  std::vector<Neighbour> complete;
  for (const Neighbour& n : neighbours)
    if (complete.size() < kMaxCandidates && recording.complete(n.marker, first, end)) complete.push_back(n);
  const auto doubtful = [&](const Neighbour& n) {
    return 2 * recording.doubtful(n.marker, p.span.first, p.span.end) >= p.shape.length;
  };
  auto good = static_cast<std::size_t>(
      std::ranges::count_if(complete, [&](const Neighbour& n) { return !doubtful(n); }));
  const bool gate = good >= std::min(kMinPredictors, complete.size());
  for (const Neighbour& n : complete) {
    if (gate && doubtful(n)) {
      p.dropped.push_back(n.marker);
      continue;
    }
    p.candidates.push_back(n.marker);
    if (p.predictors.size() == kMaxPredictors) continue;
    p.predictors.push_back(n.marker);
    p.sd_m.push_back(n.sd_m);
  }
}

}  // namespace

Index support_frames(double rate_hz) {
  return static_cast<Index>(std::clamp(std::round(0.3 * rate_hz), 6.0, 60.0));
}

std::vector<Neighbour> find_rigid_neighbours(const Recording& recording, Index target) {
  std::vector<Index> frames;
  for (Index f = 0; f < recording.frames(); ++f)
    if (recording.usable(target, f)) frames.push_back(f);
  const auto seen = static_cast<Index>(frames.size());
  std::vector<Index> sampled;
  if (seen > 0)
    for (const Index i : spread_rows(seen - 1, std::min(seen, kSampledFrames)))
      sampled.push_back(frames[static_cast<std::size_t>(i)]);
  std::vector<Neighbour> found;
  std::vector<double> d;
  for (Index k = 0; k < recording.markers(); ++k) {
    if (k == target) continue;
    d.clear();
    for (const Index f : sampled)
      if (recording.usable(k, f)) d.push_back((recording.x(target, f) - recording.x(k, f)).norm());
    if (d.size() < 8 || 2 * d.size() < sampled.size()) continue;
    std::ranges::sort(d);
    const auto trim = static_cast<std::size_t>(std::lround(0.02 * static_cast<double>(d.size() - 1)));
    const double low = d[trim];
    const double high = d[d.size() - 1 - trim];
    for (double& v : d) v = std::clamp(v, low, high);
    const double mean = std::accumulate(d.begin(), d.end(), 0.0) / static_cast<double>(d.size());
    double square = 0.0;
    for (const double v : d) square += (v - mean) * (v - mean);
    found.push_back({k, std::sqrt(square / static_cast<double>(d.size()))});
  }
  std::ranges::sort(found, [](const Neighbour& a, const Neighbour& b) { return a.sd_m < b.sd_m; });
  return found;
}

GapProblem pose_gap(const Recording& recording, const std::vector<Neighbour>& neighbours, const GapSpan& span,
                    bool use_neighbours, std::uint64_t seed) {
  GapProblem p;
  p.span = span;
  p.shape = {.length = span.end - span.first, .left = span.left, .right = span.right};
  p.window = p.shape;
  p.all_rows = Eigen::VectorX<Index>::LinSpaced(p.shape.length, 0, p.shape.length - 1);
  if (use_neighbours) choose_candidates(recording, neighbours, p);
  const Random random(seed, static_cast<std::uint64_t>(span.first));
  // As many predictors and as long windows as the recording allows; the length is reduced first, then the
  // number of predictors.
  const auto try_with = [&](std::size_t predictors) {
    for (const double part : {1.0, 0.7, 0.5, 0.35, 0.25}) {
      GapShape window = p.shape;
      window.length = std::max<Index>(1, std::lround(part * static_cast<double>(p.shape.length)));
      for (const std::size_t most : {predictors, std::min(predictors, kFewPredictors)}) {
        const std::size_t n = std::min(most, p.predictors.size());
        const auto positions =
            find_positions(recording, span.marker, std::span(p.predictors).first(n), window);
        if (!enough(positions, window.length)) continue;
        p.window = window;
        p.predictors.resize(n);
        p.sd_m.resize(n);
        p.starts = choose_windows(
            positions, std::clamp(kWantedRows / std::min(window.length, kMaxRows), kMinChosen, kMaxChosen),
            random);
        return true;
      }
    }
    return false;
  };
  if (!try_with(kMaxPredictors)) {
    if (!p.predictors.empty() && try_with(0)) p.candidates.clear();
  }
  p.rows = spread_rows(p.window.length - 1, std::min(p.window.length, kMaxRows));
  if (p.predictors.size() >= kMinPredictors) drop_doubtful_windows(recording, p);
  return p;
}

}  // namespace kinemark::trajectory::internal
