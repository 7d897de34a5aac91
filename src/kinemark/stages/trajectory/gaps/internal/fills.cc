// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/fills.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinemark/stages/trajectory/gaps/internal/spatial_fills.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr std::array kCutoffsHz = {1.0, 1.6, 2.5, 4.0, 6.3, 10.0, 16.0, 25.0, 45.0};
constexpr double kHighestOfRate = 0.45;
constexpr double kWorstCondition = 1e13;  // of the normal matrix; beyond it the solution is rounding

struct Traits {
  std::string_view name;
  bool temporal;
  bool untied;
  double growth;
};

// In the order of FillKind. Growth: measured on real recordings, docs/theory/gaps.md.
constexpr std::array<Traits, kFillKinds> kTraits = {{
    {"linear", true, false, 2.0},
    {"cubic", true, false, 3.0},
    {"pchip", true, false, 2.0},
    {"walk", true, false, 2.0},
    {"walk, stiff", true, false, 3.0},
    {"rigid, untied", false, true, 0.0},
    {"rigid, chord", false, false, 1.0},
    {"rigid", false, false, 1.0},
    {"regression, untied", false, true, 0.0},
    {"regression, chord", false, false, 0.5},
    {"regression", false, false, 0.5},
    {"regression, stiff", false, false, 1.0},
    {"pca, untied", false, true, 0.0},
    {"pca", false, false, 0.5},
}};

constexpr double kLeastStretch = 1e-12;  // m^2

const Traits& traits(FillKind kind) { return kTraits[static_cast<std::size_t>(kind)]; }

/// The same method on the neighbours z, whose paths in the gap are known, tells how hard the gap is for it.
Fill linear_fill(FillKind kind, const Signal& x, const Signal& z, const Eigen::MatrixXd& A_rows,
                 const Eigen::MatrixXd& A_gap) {
  return {.kind = kind,
          .gap = A_gap * x.gap_near,
          .errors = x.rows - A_rows * x.near,
          .stretch = stretch_of(z.rows - A_rows * z.near, z.gap - A_gap * z.gap_near)};
}

Fill pchip(const GapProblem& p, const Signal& x, const Signal& z) {
  return {.kind = FillKind::pchip,
          .gap = pchip_fill(p.shape, x.gap_near, p.all_rows),
          .errors = x.rows - pchip_fill(p.window, x.near, p.rows),
          .stretch = stretch_of(z.rows - pchip_fill(p.window, z.near, p.rows),
                                z.gap - pchip_fill(p.shape, z.gap_near, p.all_rows))};
}

void temporal_fills(const Recording& recording, const GapProblem& p, GapMethod method, WalkCache& cache,
                    std::vector<Fill>& fills) {
  const bool all = method == GapMethod::automatic;
  if (p.shape.near() == 0) return;
  const bool both = p.shape.left > 0 && p.shape.right > 0;
  const Signal x = gather(
      p, 3, false, [&](Index frame, auto out) { out = recording.x(p.span.marker, frame).transpose(); });
  const auto neighbours = static_cast<Index>(p.predictors.size());
  const Signal z = gather(p, 3 * neighbours, true, [&](Index frame, auto out) {
    for (Index k = 0; k < neighbours; ++k)
      out.segment(3 * k, 3) = recording.x(p.predictors[static_cast<std::size_t>(k)], frame).transpose();
  });
  const auto rows_of = [&](const Eigen::MatrixXd& A) {
    return Eigen::MatrixXd(A(p.rows, Eigen::indexing::all));
  };
  if (all || method == GapMethod::linear || !both)
    fills.push_back(
        linear_fill(FillKind::chord, x, z, rows_of(chord_operator(p.window)), chord_operator(p.shape)));
  if (both && (all || method == GapMethod::cubic))
    fills.push_back(
        linear_fill(FillKind::spline, x, z, rows_of(spline_operator(p.window)), spline_operator(p.shape)));
  if (both && (all || method == GapMethod::pchip || p.windows() == 0)) fills.push_back(pchip(p, x, z));
  if (p.windows() == 0 || (!all && method != GapMethod::walk)) return;
  const WalkChooser walks(p, recording.rate_hz(), cache);
  if (const auto walk = walks.best(x, 1, p.shortened() ? 1 : 2))
    fills.push_back(linear_fill(FillKind::walk, x, z, *walk->rows, *walk->gap));
  if (both && !p.shortened())
    if (const auto walk = walks.best(x, 3, 4))
      fills.push_back(linear_fill(FillKind::walk_stiff, x, z, *walk->rows, *walk->gap));
}

}  // namespace

std::optional<Walk> WalkChooser::best(const Signal& target, int lowest_order, int highest_order) const {
  const GapProblem& p = *problem_;
  double least = std::numeric_limits<double>::infinity();
  int order = 0;
  double lambda = 0.0;
  Walk walk;
  for (int m = lowest_order; m <= highest_order; ++m) {
    if (p.shape.near() < 2 * m) continue;
    for (const double cutoff : kCutoffsHz) {
      if (cutoff > kCutoffsHz.front() && cutoff >= kHighestOfRate * rate_hz_) continue;
      const double l = walk_lambda(m, std::min(cutoff, kHighestOfRate * rate_hz_), rate_hz_);
      if (l * std::pow(4.0, m) > kWorstCondition) continue;
      const auto A = cache_->get(p.window, m, l, p.rows);
      const double error = (target.rows - *A * target.near).squaredNorm();
      if (error >= least) continue;
      least = error;
      order = m;
      lambda = l;
      walk.rows = A;
    }
  }
  if (!walk.rows) return std::nullopt;
  walk.gap = cache_->get(p.shape, order, lambda, p.all_rows);
  return walk;
}

std::string_view to_string(FillKind kind) { return traits(kind).name; }
bool is_temporal(FillKind kind) { return traits(kind).temporal; }
bool is_untied(FillKind kind) { return traits(kind).untied; }
double error_growth(FillKind kind) { return traits(kind).growth; }

double stretch_of(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& gap) {
  if (rows.size() == 0 || gap.size() == 0) return 1.0;
  return std::sqrt((gap.squaredNorm() / static_cast<double>(gap.size()) + kLeastStretch) /
                   (rows.squaredNorm() / static_cast<double>(rows.size()) + kLeastStretch));
}

double Fill::rms_m() const {
  if (errors.size() == 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(3.0 * errors.squaredNorm() / static_cast<double>(errors.size()));
}

std::vector<Fill> make_fills(const Recording& recording, const GapProblem& problem, GapMethod method,
                             WalkCache& cache) {
  std::vector<Fill> fills;
  const bool spatial =
      method == GapMethod::rigid || method == GapMethod::regression || method == GapMethod::pca;
  if (!spatial) temporal_fills(recording, problem, method, cache, fills);
  if ((spatial || method == GapMethod::automatic) && problem.windows() > 0 && !problem.predictors.empty())
    spatial_fills(recording, problem, method, cache, fills);
  return fills;
}

}  // namespace kinemark::trajectory::internal
