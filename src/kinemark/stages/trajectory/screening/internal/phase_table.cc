// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/internal/phase_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/math/statistics.h"

namespace kinemark::trajectory::internal {
namespace {

using data::InterpolationKernel;

// All kernels but hold, linear and Lagrange are cubics between two knots, given by the slopes there (knots
// one apart). Those at the ends only need to exist: they are not used.

/// Twice differentiable: s(i-1) + 4 s(i) + s(i+1) = 3 (v(i+1) - v(i-1)), natural ends.
void spline_slopes(Knots& k) {
  const std::vector<double>& v = k.value;
  const std::size_t n = v.size();
  k.scratch.resize(n);
  double pivot = 2.0;
  k.slope[0] = 3.0 * (v[1] - v[0]) / pivot;
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    k.scratch[i] = 1.0 / pivot;
    pivot = (last ? 2.0 : 4.0) - k.scratch[i];
    const double right = last ? 3.0 * (v[i] - v[i - 1]) : 3.0 * (v[i + 1] - v[i - 1]);
    k.slope[i] = (right - k.slope[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i > 0; --i) k.slope[i - 1] -= k.scratch[i] * k.slope[i];
}

void catmull_rom_slopes(Knots& k) {
  for (std::size_t i = 1; i + 1 < k.value.size(); ++i) k.slope[i] = 0.5 * (k.value[i + 1] - k.value[i - 1]);
}

/// Harmonic mean of both chords, flat at an extreme (Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput.
/// 5:300).
void pchip_slopes(Knots& k) {
  for (std::size_t i = 1; i + 1 < k.value.size(); ++i) {
    const double left = k.value[i] - k.value[i - 1];
    const double right = k.value[i + 1] - k.value[i];
    k.slope[i] = left * right > 0.0 ? 2.0 * left * right / (left + right) : 0.0;
  }
}

/// Chords weighted by the change of slope on the other side (Akima 1970, J. ACM 17:589).
void akima_slopes(Knots& k) {
  const std::vector<double>& v = k.value;
  for (std::size_t i = 2; i + 2 < v.size(); ++i) {
    const double a = v[i - 1] - v[i - 2];
    const double b = v[i] - v[i - 1];
    const double c = v[i + 1] - v[i];
    const double d = v[i + 2] - v[i + 1];
    const double weight_b = std::abs(d - c);
    const double weight_c = std::abs(b - a);
    const double sum = weight_b + weight_c;
    k.slope[i] = sum > 0.0 ? (weight_b * b + weight_c * c) / sum : 0.5 * (b + c);
  }
}

/// Weights of four knots i - 1 to i + 2, or of two knots and two slopes, at u between knots i and i + 1.
using Weights = std::array<double, 4>;

Weights lagrange_weights(double u) {
  return {-u * (u - 1.0) * (u - 2.0) / 6.0, (u * u - 1.0) * (u - 2.0) / 2.0, -u * (u + 1.0) * (u - 2.0) / 2.0,
          u * (u * u - 1.0) / 6.0};
}

Weights hermite_weights(double u) {
  const double w = 1.0 - u;
  return {(1.0 + 2.0 * u) * w * w, u * u * (3.0 - 2.0 * u), u * w * w, -u * u * w};
}

using data::InterpolationKernel;

constexpr std::int64_t kBlockKnots = 16;
constexpr std::int64_t kPieceFrames = 2048;
constexpr std::int64_t kMinBlocks = 6;
constexpr float kChangeCost = 8.0F;
constexpr float kMostCost = 2.0F;  // of one contradicting block, so that an outlier cannot force a change

std::vector<std::size_t> rows_in_time(const PhaseTable& table) {
  std::vector<std::size_t> order(table.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t r) { return table.frame[r]; });
  return order;
}

/// The phase of each row on the cheapest path, rows in the order given.
std::vector<int> path_of(const PhaseTable& table, const std::vector<std::size_t>& order) {
  const auto f = static_cast<std::size_t>(table.factor);
  std::vector<float> cost(f, 0.0F);
  std::vector<std::uint8_t> from(order.size() * f);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const float* row = table.log_residual.data() + order[i] * f;
    const float least = *std::min_element(row, row + f);
    const auto cheapest = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
    const float change = cost[cheapest] + kChangeCost;
    for (std::size_t p = 0; p < f; ++p) {
      const bool stay = i == 0 || cost[p] <= change;
      from[i * f + p] = static_cast<std::uint8_t>(stay ? p : cheapest);
      cost[p] = (stay ? cost[p] : change) + std::min(row[p] - least, kMostCost);
    }
  }
  std::vector<int> path(order.size());
  auto p = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
  for (std::size_t i = order.size(); i-- > 0;) {
    path[i] = static_cast<int>(p);
    p = from[i * f + p];
  }
  return path;
}

/// Evidence for one phase per row.
Candidate weigh(const PhaseTable& table, InterpolationKernel kernel, const std::vector<std::size_t>& order,
                const std::vector<int>& path) {
  const auto f = static_cast<std::size_t>(table.factor);
  std::vector<double> ratio;
  std::vector<double> residual;
  std::vector<double> rounding;
  std::vector<std::int64_t> share(f, 0);
  std::int64_t won = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const float* row = table.log_residual.data() + order[i] * f;
    const auto p = static_cast<std::size_t>(path[i]);
    float other = std::numeric_limits<float>::max();
    for (std::size_t q = 0; q < f; ++q)
      if (q != p) other = std::min(other, row[q]);
    won += row[p] < other ? 1 : 0;
    ++share[p];
    ratio.push_back(row[p] - other);
    residual.push_back(row[p]);
    rounding.push_back(table.log_rounding[order[i]]);
  }
  Candidate c;
  c.factor = table.factor;
  c.kernel = kernel;
  c.phase = static_cast<int>(std::ranges::max_element(share) - share.begin());
  c.blocks = static_cast<std::int64_t>(order.size());
  c.agreement = static_cast<double>(won) / static_cast<double>(order.size());
  c.ratio = std::exp(math::median(ratio));
  c.residual_m = std::exp(math::median(residual));
  c.rounding_m = std::exp(math::median(rounding));
  return c;
}

}  // namespace

bool residuals(std::span<const double> y, int factor, int phase, InterpolationKernel kernel, Knots& knots,
               std::span<double> out) {
  std::ranges::fill(out, kNotPredicted);
  const auto f = static_cast<std::size_t>(factor);
  const auto p = static_cast<std::size_t>(phase);
  const auto edge = static_cast<std::size_t>(edge_knots(kernel));
  const std::size_t count = y.size() > p ? (y.size() - p - 1) / f + 1 : 0;
  if (count < 2 * edge + 6) return false;
  knots.value.resize(count);
  knots.slope.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) knots.value[i] = y[p + i * f];
  if (kernel == InterpolationKernel::spline) spline_slopes(knots);
  if (kernel == InterpolationKernel::catmull_rom) catmull_rom_slopes(knots);
  if (kernel == InterpolationKernel::pchip) pchip_slopes(knots);
  if (kernel == InterpolationKernel::akima) akima_slopes(knots);
  const double* v = knots.value.data();
  const double* s = knots.slope.data();
  for (std::size_t j = 1; j < f; ++j) {
    const double u = static_cast<double>(j) / static_cast<double>(f);
    const Weights w = kernel == InterpolationKernel::lagrange ? lagrange_weights(u) : hermite_weights(u);
    for (std::size_t i = edge; i + edge + 1 < count; ++i) {
      double made = v[i];
      if (kernel == InterpolationKernel::linear)
        made = (1.0 - u) * v[i] + u * v[i + 1];
      else if (kernel == InterpolationKernel::lagrange)
        made = w[0] * v[i - 1] + w[1] * v[i] + w[2] * v[i + 1] + w[3] * v[i + 2];
      else if (kernel != InterpolationKernel::hold)
        made = w[0] * v[i] + w[1] * v[i + 1] + w[2] * s[i] + w[3] * s[i + 1];
      const std::size_t at = p + i * f + j;
      out[at] = y[at] - made;
    }
  }
  return true;
}

double rounding_step_m(std::span<const double> y) {
  double largest = 0.0;
  for (const double v : y) largest = std::max(largest, std::abs(v));
  const double single = std::max(6e-8 * largest, 1e-12);
  std::vector<double> steps;
  std::vector<double> difference(y.begin(), y.end());
  for (int order = 1; order <= 3 && difference.size() > 1; ++order) {
    for (std::size_t i = 0; i + 1 < difference.size(); ++i) {
      difference[i] = difference[i + 1] - difference[i];
      if (std::abs(difference[i]) > 8.0 * single) steps.push_back(std::abs(difference[i]));
    }
    difference.pop_back();
  }
  if (steps.empty()) return std::min(single, 1e-3);
  const double low = math::nth_smallest(steps, steps.size() / 100);
  return std::clamp(low, std::min(single, 1e-3), 1e-3);
}

std::vector<Piece> pieces_of(const data::Trajectories& t, std::int64_t marker, std::int64_t max_frames) {
  std::vector<std::pair<std::int64_t, std::int64_t>> spans;
  std::int64_t total = 0;
  for (std::int64_t f = 0; f < t.frames();) {
    if (!t.present(f, marker)) {
      ++f;
      continue;
    }
    std::int64_t end = f + 1;
    while (end < t.frames() && end - f < kPieceFrames && t.present(end, marker)) ++end;
    if (end - f >= min_stretch(2, InterpolationKernel::linear)) {
      spans.emplace_back(f, end);
      total += end - f;
    }
    f = end;
  }
  const auto count = static_cast<std::int64_t>(spans.size());
  const std::int64_t take =
      max_frames > 0 && total > max_frames ? std::max<std::int64_t>(1, count * max_frames / total) : count;
  std::vector<Piece> pieces;
  for (std::int64_t k = 0; k < take; ++k) {
    const auto& [first, end] = spans[static_cast<std::size_t>((2 * k + 1) * count / (2 * take))];
    for (int axis = 0; axis < 3; ++axis) {
      Piece piece;
      piece.first_frame = first;
      for (std::int64_t f = first; f < end; ++f) piece.y.push_back(t.x(f, marker)(axis));
      piece.step_m = rounding_step_m(piece.y);
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

void PhaseTable::append(const PhaseTable& other) {
  log_residual.insert(log_residual.end(), other.log_residual.begin(), other.log_residual.end());
  log_rounding.insert(log_rounding.end(), other.log_rounding.begin(), other.log_rounding.end());
  frame.insert(frame.end(), other.frame.begin(), other.frame.end());
}

void add_rows(const Piece& piece, InterpolationKernel kernel, Knots& knots, PhaseTable& table) {
  const int f = table.factor;
  const auto n = static_cast<std::int64_t>(piece.y.size());
  if (n < min_stretch(f, kernel)) return;
  const std::int64_t blocks = std::max<std::int64_t>(1, n / (kBlockKnots * f));
  std::vector<double> residual(piece.y.size());
  std::vector<double> sum(static_cast<std::size_t>(blocks * f), 0.0);
  std::vector<std::int64_t> count(sum.size(), 0);
  for (int p = 0; p < f; ++p) {
    if (!residuals(piece.y, f, p, kernel, knots, residual)) return;
    for (std::int64_t i = 0; i < n; ++i) {
      const double e = residual[static_cast<std::size_t>(i)];
      if (e == kNotPredicted) continue;
      const auto at = static_cast<std::size_t>(i * blocks / n * f + (piece.first_frame + p) % f);
      sum[at] += e * e;
      ++count[at];
    }
  }
  const double rounding = piece.step_m / std::sqrt(12.0);
  const auto width = static_cast<std::size_t>(f);
  for (std::int64_t b = 0; b < blocks; ++b) {
    const std::size_t first = static_cast<std::size_t>(b) * width;
    double least = std::numeric_limits<double>::max();
    double second = least;
    bool complete = true;
    for (std::size_t p = first; p < first + width; ++p) {
      complete &= count[p] >= 3 * (f - 1) && std::isfinite(sum[p]);
      sum[p] = std::sqrt(sum[p] / static_cast<double>(std::max<std::int64_t>(1, count[p])));
      second = std::min(second, std::max(least, sum[p]));
      least = std::min(least, sum[p]);
    }
    if (!complete || !(second > 2.0 * rounding)) continue;
    for (std::size_t p = first; p < first + width; ++p)
      table.log_residual.push_back(static_cast<float>(std::log(std::max(sum[p], 0.3 * rounding))));
    table.log_rounding.push_back(static_cast<float>(std::log(rounding)));
    table.frame.push_back(piece.first_frame + (2 * b + 1) * n / (2 * blocks));
  }
}

Candidate judge(const PhaseTable& table, InterpolationKernel kernel) {
  const auto f = static_cast<std::size_t>(table.factor);
  Candidate none;
  none.blocks = static_cast<std::int64_t>(table.rows());
  if (none.blocks < kMinBlocks) return none;
  std::vector<std::size_t> order = rows_in_time(table);
  std::vector<std::int64_t> wins(f, 0);
  for (const std::size_t r : order) {
    const float* row = table.log_residual.data() + r * f;
    ++wins[static_cast<std::size_t>(std::min_element(row, row + f) - row)];
  }
  const auto phase = static_cast<int>(std::ranges::max_element(wins) - wins.begin());
  Candidate c = weigh(table, kernel, order, std::vector<int>(order.size(), phase));
  // Chance of one phase winning every block by accident: factor^-blocks.
  const double certainty = static_cast<double>(c.blocks) * std::log(static_cast<double>(f));
  c.fires = (c.ratio < 0.5 && c.agreement >= 0.9 && certainty > 10.0) ||
            (c.ratio < 0.88 && c.agreement >= 0.97 && c.above_rounding() < 1.8 && certainty > 14.0);
  if (c.fires) return c;
  const std::vector<int> path = path_of(table, order);
  std::int64_t changes = 0;
  for (std::size_t i = 1; i < path.size(); ++i) changes += path[i] != path[i - 1] ? 1 : 0;
  if (changes == 0) return c;
  Candidate s = weigh(table, kernel, order, path);
  // The times of changes are free parameters: each change must gain several times its cost.
  const double paid = static_cast<double>(s.blocks - 12 * changes) * std::log(static_cast<double>(f));
  s.fires = s.ratio < 0.5 && s.agreement >= 0.9 && paid > 14.0;
  s.slips = true;
  return s.fires ? s : c;
}

std::vector<data::PhaseRun> follow_phase(const PhaseTable& table) {
  const std::vector<std::size_t> order = rows_in_time(table);
  const std::vector<int> path = path_of(table, order);
  std::vector<data::PhaseRun> runs;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!runs.empty() && runs.back().phase == path[i]) continue;
    const std::int64_t start = i == 0 ? 0 : (table.frame[order[i - 1]] + table.frame[order[i]]) / 2;
    runs.push_back({.first_frame = start, .phase = path[i]});
  }
  if (runs.empty()) runs.push_back({});
  return runs;
}

}  // namespace kinemark::trajectory::internal
