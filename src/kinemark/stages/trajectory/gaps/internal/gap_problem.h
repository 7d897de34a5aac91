// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/recording.h"

namespace kinemark::trajectory::internal {

using Eigen::Index;

/// A gap and the samples next to it: `left` before, `length` missing, `right` after. Either side may be 0.
struct GapShape {
  Index length = 0;
  Index left = 0;
  Index right = 0;
  [[nodiscard]] Index near() const { return left + right; }
  auto operator<=>(const GapShape&) const = default;
};

/// Fills that are linear in the samples next to the gap: x_gap = A x_near, A is length x near().
/// Straight line between the two sides; with one side its nearest sample.
[[nodiscard]] Eigen::MatrixXd chord_operator(const GapShape& shape);
/// Interpolating cubic spline, not-a-knot. Needs both sides.
[[nodiscard]] Eigen::MatrixXd spline_operator(const GapShape& shape);
/// Posterior mean of an order-fold integrated random walk: sum_near (y - x)^2 + lambda sum |D^order x|^2 is
/// least. Needs near() >= order. O((length + near) near order).
[[nodiscard]] Eigen::MatrixXd walk_operator(const GapShape& shape, int order, double lambda);
/// lambda for a cut-off: (2 sin(pi f / rate))^(-2 order).
[[nodiscard]] double walk_lambda(int order, double cutoff_hz, double rate_hz);

/// Monotone cubic through the two samples nearest on either side (all that it depends on), at given rows of
/// the gap. near is near() x C; needs both sides.
[[nodiscard]] Eigen::MatrixXd pchip_fill(const GapShape& shape, const Eigen::MatrixXd& near,
                                         const Eigen::VectorX<Index>& rows);

/// Matrices of the walk at a few rows, remembered. Safe to share between threads; values never depend on what
/// was asked before.
class WalkCache {
 public:
  /// Rows of walk_operator().
  std::shared_ptr<const Eigen::MatrixXd> get(const GapShape& shape, int order, double lambda,
                                             const Eigen::VectorX<Index>& rows);

 private:
  using Key = std::tuple<GapShape, int, double, Index>;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Eigen::MatrixXd>> known_;
  Index numbers_ = 0;
};

/// A marker beside the target and the SD of the distance between them (trimmed at 2 and 98 %).
struct Neighbour {
  Index marker = 0;
  double sd_m = 0.0;
};

/// The markers that keep their distance best, most rigid first; those that are seen with the target in fewer
/// than half of (up to 300) frames are left out. O(markers).
[[nodiscard]] std::vector<Neighbour> find_rigid_neighbours(const Recording& recording, Index target);

/// Frames [first, end) of a marker, with `left` and `right` usable samples next to them as support.
struct GapSpan {
  Index marker = 0;
  Index first = 0;
  Index end = 0;
  Index left = 0;
  Index right = 0;
};

/// Number of supporting samples on each side: 0.3 s, 6 to 60 frames.
[[nodiscard]] Index support_frames(double rate_hz);

/// The gap to be filled, its predictors, and the artificial gaps ("windows") from which errors are estimated:
/// stretches of the same recording in which target and predictors are complete.
struct GapProblem {
  GapSpan span;
  GapShape shape;
  GapShape window;                 ///< as shape, but shorter where the recording has too few such stretches
  std::vector<Index> candidates;   ///< complete over gap and support, not doubtful; at most 24
  std::vector<Index> predictors;   ///< the most rigid of them, at most 12
  std::vector<double> sd_m;        ///< of predictors
  std::vector<Index> dropped;      ///< would have been a candidate, but is at the wrong position
  std::vector<Index> starts;       ///< W first frames of windows, rising
  Eigen::VectorX<Index> rows;      ///< R rows of a window at which errors are taken
  Eigen::VectorX<Index> all_rows;  ///< 0 to shape.length - 1

  [[nodiscard]] Index windows() const { return static_cast<Index>(starts.size()); }
  [[nodiscard]] bool shortened() const { return window.length < shape.length; }
  [[nodiscard]] Index start(Index w) const { return starts[static_cast<std::size_t>(w)]; }
  /// Frame of a near sample of a gap of that shape that begins at `start`.
  [[nodiscard]] static Index near_frame(const GapShape& s, Index start, Index k) {
    return k < s.left ? start - s.left + k : start + s.length + k - s.left;
  }
};

[[nodiscard]] GapProblem pose_gap(const Recording& recording, const std::vector<Neighbour>& neighbours,
                                  const GapSpan& span, bool use_neighbours, std::uint64_t seed);

/// One quantity of P numbers at the frames that matter.
struct Signal {
  Index width = 0;           ///< P
  Eigen::MatrixXd rows;      ///< R x W P, inside the windows
  Eigen::MatrixXd near;      ///< H x W P, beside the windows
  Eigen::MatrixXd gap;       ///< L x P, inside the gap; empty for the target
  Eigen::MatrixXd gap_near;  ///< H x P, beside the gap
};

/// Evaluate `value(frame, out)`, out a row of P numbers that can be written; inside the gap only if `in_gap`.
template <class Value>
Signal gather(const GapProblem& p, Index width, bool in_gap, Value value) {
  Signal s;
  s.width = width;
  s.rows.resize(p.rows.size(), p.windows() * width);
  s.near.resize(p.window.near(), p.windows() * width);
  s.gap.resize(in_gap ? p.shape.length : 0, width);
  s.gap_near.resize(p.shape.near(), width);
  if (width == 0) return s;  // no neighbours: matrices without columns have no rows to write
  for (Index w = 0; w < p.windows(); ++w) {
    for (Index r = 0; r < p.rows.size(); ++r)
      value(p.start(w) + p.rows(r), s.rows.row(r).segment(w * width, width));
    for (Index k = 0; k < p.window.near(); ++k)
      value(GapProblem::near_frame(p.window, p.start(w), k), s.near.row(k).segment(w * width, width));
  }
  for (Index i = 0; i < s.gap.rows(); ++i) value(p.span.first + i, s.gap.row(i).segment(0, width));
  for (Index k = 0; k < p.shape.near(); ++k)
    value(GapProblem::near_frame(p.shape, p.span.first, k), s.gap_near.row(k).segment(0, width));
  return s;
}

}  // namespace kinemark::trajectory::internal
