// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr Index kMaxCachedNumbers = 4'000'000;

/// Time of a near sample in frames after the first one of the left side.
Index near_time(const GapShape& s, Index k) { return k < s.left ? k : k + s.length; }

/// Three-point slope of Fritsch and Carlson as Brodlie weighted it: 0 at a turning point.
double inner_slope(double h0, double d0, double h1, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

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

Eigen::MatrixXd chord_operator(const GapShape& s) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(s.length, s.near());
  for (Index i = 0; i < s.length; ++i) {
    const double u = s.left == 0    ? 1.0
                     : s.right == 0 ? 0.0
                                    : static_cast<double>(i + 1) / static_cast<double>(s.length + 1);
    if (s.left > 0) A(i, s.left - 1) = 1.0 - u;
    if (s.right > 0) A(i, s.left) = u;
  }
  return A;
}

Eigen::MatrixXd spline_operator(const GapShape& s) {
  const Index n = s.near();
  if (n < 3) return chord_operator(s);
  // Second derivatives M at the knots: C M = 6 D y with the usual rows inside and not-a-knot at both ends.
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  const auto h = [&](Index i) { return static_cast<double>(near_time(s, i + 1) - near_time(s, i)); };
  for (Index i = 1; i + 1 < n; ++i) {
    C(i, i - 1) = h(i - 1);
    C(i, i) = 2.0 * (h(i - 1) + h(i));
    C(i, i + 1) = h(i);
    D(i, i - 1) = 6.0 / h(i - 1);
    D(i, i) = -6.0 / h(i - 1) - 6.0 / h(i);
    D(i, i + 1) = 6.0 / h(i);
  }
  if (n == 3) {  // both end conditions coincide: one parabola
    C.row(0) << 1.0, -1.0, 0.0;
    C.row(2) << 0.0, 1.0, -1.0;
  } else {
    C(0, 0) = h(1);
    C(0, 1) = -h(0) - h(1);
    C(0, 2) = h(0);
    C(n - 1, n - 1) = h(n - 3);
    C(n - 1, n - 2) = -h(n - 3) - h(n - 2);
    C(n - 1, n - 3) = h(n - 2);
  }
  const Eigen::MatrixXd M = C.partialPivLu().solve(D);
  const Index k = s.left - 1;
  const double width = h(k);
  Eigen::MatrixXd A(s.length, n);
  for (Index i = 0; i < s.length; ++i) {
    const double b = static_cast<double>(i + 1) / width;
    const double a = 1.0 - b;
    A.row(i) = width * width / 6.0 * ((a * a * a - a) * M.row(k) + (b * b * b - b) * M.row(k + 1));
    A(i, k) += a;
    A(i, k + 1) += b;
  }
  return A;
}

double walk_lambda(int order, double cutoff_hz, double rate_hz) {
  return std::pow(2.0 * std::sin(std::numbers::pi * cutoff_hz / rate_hz), -2.0 * order);
}

Eigen::MatrixXd walk_operator(const GapShape& s, int order, double lambda) {
  const Index n = s.length + s.near();
  std::vector<double> difference = {1.0};
  for (int k = 0; k < order; ++k) {
    difference.push_back(0.0);
    for (std::size_t i = difference.size() - 1; i > 0; --i) difference[i] -= difference[i - 1];
  }
  // Band of W + lambda D'D: row d holds the d-th diagonal below the main one.
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(order + 1, n);
  for (Index k = 0; k < n; ++k) band(0, k) = k < s.left || k >= s.left + s.length ? 1.0 : 0.0;
  for (Index r = 0; r + order < n; ++r)
    for (Index p = 0; p <= order; ++p)
      for (Index q = p; q <= order; ++q)
        band(q - p, r + p) +=
            lambda * difference[static_cast<std::size_t>(p)] * difference[static_cast<std::size_t>(q)];
  // Cholesky within the band, then both substitutions for all right-hand sides at once.
  for (Index c = 0; c < n; ++c) {
    band(0, c) = std::sqrt(std::max(band(0, c), 1e-300));
    const Index last = std::min<Index>(order, n - 1 - c);
    for (Index d = 1; d <= last; ++d) band(d, c) /= band(0, c);
    for (Index d = 1; d <= last; ++d)
      for (Index e = d; e <= last; ++e) band(e - d, c + d) -= band(e, c) * band(d, c);
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor X = RowMajor::Zero(n, s.near());
  for (Index k = 0; k < s.near(); ++k) X(near_time(s, k), k) = 1.0;
  for (Index r = 0; r < n; ++r) {
    for (Index d = 1; d <= std::min<Index>(order, r); ++d) X.row(r) -= band(d, r - d) * X.row(r - d);
    X.row(r) /= band(0, r);
  }
  for (Index r = n - 1; r >= 0; --r) {
    for (Index d = 1; d <= std::min<Index>(order, n - 1 - r); ++d) X.row(r) -= band(d, r) * X.row(r + d);
    X.row(r) /= band(0, r);
  }
  return X.middleRows(s.left, s.length);
}

Eigen::MatrixXd pchip_fill(const GapShape& s, const Eigen::MatrixXd& near,
                           const Eigen::VectorX<Index>& rows) {
  Eigen::MatrixXd out(rows.size(), near.cols());
  const double width = static_cast<double>(s.length + 1);
  for (Index c = 0; c < near.cols(); ++c) {
    const double y0 = near(s.left - 1, c);
    const double y1 = near(s.left, c);
    const double slope = (y1 - y0) / width;
    const double s0 = s.left > 1 ? inner_slope(1.0, y0 - near(s.left - 2, c), width, slope) : slope;
    const double s1 = s.right > 1 ? inner_slope(width, slope, 1.0, near(s.left + 1, c) - y1) : slope;
    for (Index i = 0; i < rows.size(); ++i) {
      const double u = static_cast<double>(rows(i) + 1) / width;
      const double v = 1.0 - u;
      out(i, c) =
          v * v * (1.0 + 2.0 * u) * y0 + u * u * (1.0 + 2.0 * v) * y1 + width * u * v * (v * s0 - u * s1);
    }
  }
  return out;
}

std::shared_ptr<const Eigen::MatrixXd> WalkCache::get(const GapShape& shape, int order, double lambda,
                                                      const Eigen::VectorX<Index>& rows) {
  const Key key(shape, order, lambda, rows.size());  // rows follow from length and number
  {
    const std::scoped_lock lock(mutex_);
    const auto at = known_.find(key);
    if (at != known_.end()) return at->second;
  }
  const Eigen::MatrixXd all = walk_operator(shape, order, lambda);
  auto made = std::make_shared<const Eigen::MatrixXd>(all(rows, Eigen::indexing::all));
  const std::scoped_lock lock(mutex_);
  if (numbers_ + made->size() > kMaxCachedNumbers) {
    known_.clear();
    numbers_ = 0;
  }
  if (known_.emplace(key, made).second) numbers_ += made->size();
  return made;
}

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
