// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/filler.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/math/statistics.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr double kWorstToBest = 3.0;    // RMS
constexpr double kShrink = 0.1;         // added to the diagonal, as a part of it
constexpr double kLeastSquare = 1e-15;  // m^2
constexpr double kStrayRms = 5.0;       // from the median of the candidates
constexpr double kStrayM = 0.010;
constexpr double kLeastRmsM = 1e-6;  // 3D
constexpr double kSdScale = 0.82;    // mixture of scales: the RMS is above what covers 68 %
constexpr double kFewWindows = 2.0;  // as Student's t is wider than the normal distribution

/// Candidates by number, and their errors grown to the length of the gap.
struct Pool {
  std::vector<std::size_t> finite;  // all that are numbers
  std::vector<std::size_t> use;     // those that are combined
  std::vector<Eigen::MatrixXd> errors;
  std::vector<double> rms;   // 3D
  std::vector<double> miss;  // of the samples beside the gap, as a multiple of rms; 1 at least
};

Pool grow_errors(const GapProblem& p, const std::vector<Fill>& fills) {
  Pool pool;
  const double ratio = static_cast<double>(p.shape.length) / static_cast<double>(p.window.length);
  for (const Fill& fill : fills) {
    const double scale = p.shortened() ? std::pow(ratio, error_growth(fill.kind)) : 1.0;
    pool.errors.push_back(scale * fill.errors);
    pool.rms.push_back(scale * fill.rms_m());
    pool.miss.push_back(std::max(1.0, fill.near_rms_m / (pool.rms.back() + kLeastRmsM)));
  }
  for (std::size_t k = 0; k < fills.size(); ++k)
    if (fills[k].gap.allFinite() && std::isfinite(pool.rms[k])) pool.finite.push_back(k);
  pool.use = pool.finite;
  return pool;
}

Eigen::MatrixXd median_fill(const std::vector<Fill>& fills, const std::vector<std::size_t>& use) {
  Eigen::MatrixXd median = fills[use.front()].gap;
  std::vector<double> v(use.size());
  for (Index i = 0; i < median.size(); ++i) {
    for (std::size_t k = 0; k < use.size(); ++k) v[k] = fills[use[k]].gap(i);
    median(i) = math::median(v);
  }
  return median;
}

/// Leave out, in this order, candidates far worse than the best and those that deviate in this gap.
void guard(const std::vector<Fill>& fills, Pool& pool, std::vector<bool>& guarded) {
  const auto rms = [&](std::size_t k) { return pool.miss[k] * pool.rms[k]; };
  const double best = rms(*std::ranges::min_element(pool.use, {}, rms));
  std::erase_if(pool.use, [&](std::size_t k) { return rms(k) > kWorstToBest * best; });
  if (pool.use.size() < 2) return;
  const Eigen::MatrixXd median = median_fill(fills, pool.use);
  for (const std::size_t k : pool.use) {
    const double stray = std::sqrt((fills[k].gap - median).rowwise().squaredNorm().mean());
    guarded[k] = stray > kStrayRms * rms(k) + kStrayM;
  }
  std::vector<std::size_t> left;
  for (const std::size_t k : pool.use)
    if (!guarded[k]) left.push_back(k);
  if (!left.empty()) {
    pool.use = std::move(left);
  } else {
    guarded.assign(guarded.size(), false);
  }
}

/// SD per axis along the gap. w: weights of pool.use.
Eigen::VectorXd predict_sd(const GapProblem& p, const std::vector<Fill>& fills, const Pool& pool,
                           const Eigen::VectorXd& w, const Eigen::MatrixXd& gap) {
  const Index W = p.windows();
  const Index R = p.rows.size();
  Eigen::MatrixXd usual_errors = Eigen::MatrixXd::Zero(R, 3 * W);  // of the combination, on the windows
  Eigen::MatrixXd combined = Eigen::MatrixXd::Zero(R, 3 * W);      // as large as the ends of the gap say
  double stretch = 0.0;                                            // mean square
  for (std::size_t k = 0; k < pool.use.size(); ++k) {
    const std::size_t i = pool.use[k];
    const double weight = w(static_cast<Index>(k));
    usual_errors += weight * pool.errors[i];
    combined += weight * pool.miss[i] * pool.errors[i];
    stretch += weight * fills[i].stretch * fills[i].stretch;
  }
  // Disagreement of all candidates, those left out too, in the gap and in each window: mean square distance
  // from the combination, each in units of its own error on the windows.
  double here = 0.0;
  Eigen::VectorXd there = Eigen::VectorXd::Zero(W);
  Eigen::VectorXd square(W);
  for (Index i = 0; i < W; ++i)
    square(i) = combined.middleCols(3 * i, 3).squaredNorm() / static_cast<double>(3 * R);
  for (const std::size_t k : pool.finite) {
    const double v =
        1.0 / (static_cast<double>(pool.finite.size()) * (pool.rms[k] * pool.rms[k] + kLeastSquare));
    here += v * (fills[k].gap - gap).squaredNorm() / static_cast<double>(gap.rows());
    for (Index i = 0; i < W; ++i)
      there(i) +=
          v * (pool.errors[k] - usual_errors).middleCols(3 * i, 3).squaredNorm() / static_cast<double>(R);
  }
  // How much of the size of the errors the disagreement explains: slope of the logarithms, 0 to 1.
  const Eigen::ArrayXd le = 0.5 * (square.array() + 1e-18).log();
  const Eigen::ArrayXd ls = 0.5 * (there.array() + 1e-18).log();
  double slope = 0.5;
  if (W > 3)
    slope = std::clamp(
        ((le - le.mean()) * (ls - ls.mean())).mean() / ((ls - ls.mean()).square().mean() + 1e-6), 0.0, 1.0);
  const double floor = 0.05 * there.mean() + 1e-18;
  // Beyond what is usual on the windows errors grow in proportion, and below the least of them they do not
  // shrink: there the slope was never seen. The same holds for what the neighbours do.
  const double usual = there.mean() + std::sqrt((there.array() - there.mean()).square().mean());
  const double within = std::clamp(here, there.minCoeff(), usual);
  const double beyond = std::max({1.0, (here + floor) / (usual + floor), stretch});
  Eigen::VectorXd profile = Eigen::VectorXd::Zero(R);
  for (Index i = 0; i < W; ++i) {
    const double factor =
        beyond * std::clamp(std::pow((within + floor) / (there(i) + floor), slope), 1.0 / 16.0, 16.0);
    profile += factor * combined.middleCols(3 * i, 3).rowwise().squaredNorm() / static_cast<double>(3 * W);
  }
  if (p.shape.left > 0 && p.shape.right > 0) profile = (0.5 * (profile + profile.reverse())).eval();
  if (R >= 5) {
    const Eigen::VectorXd rough = profile;
    for (Index r = 0; r < R; ++r)
      profile(r) = (rough(std::max<Index>(0, r - 1)) + rough(r) + rough(std::min(R - 1, r + 1))) / 3.0;
  }
  // Overlapping windows carry less information than their number.
  double independent = 0.0;
  Index free = 0;
  for (const Index start : p.starts) {
    if (start < free) continue;
    independent += 1.0;
    free = start + p.window.length;
  }
  // Few windows do not show where along the gap errors are large: as many as two have the profile of a
  // Brownian bridge, or of a walk from the side that is known.
  Eigen::VectorXd bridge(R);
  for (Index r = 0; r < R; ++r) {
    const double u = static_cast<double>(p.rows(r) + 1) / static_cast<double>(p.window.length + 1);
    bridge(r) = (p.shape.left > 0 ? u : 1.0) * (p.shape.right > 0 ? 1.0 - u : 1.0);
  }
  profile = ((independent * profile + kFewWindows * profile.mean() / bridge.mean() * bridge) /
             (independent + kFewWindows))
                .eval();
  const Eigen::VectorXd sd =
      (kSdScale * (profile * (1.0 + kFewWindows / independent)).array().sqrt()).matrix();
  // Rows of the window to frames of the gap, at the same part of the way.
  Eigen::VectorXd out(p.shape.length);
  Index r = 0;
  for (Index i = 0; i < p.shape.length; ++i) {
    const double at = static_cast<double>(i + 1) / static_cast<double>(p.shape.length + 1) *
                          static_cast<double>(p.window.length + 1) -
                      1.0;
    while (r + 2 < R && static_cast<double>(p.rows(r + 1)) <= at) ++r;
    if (R == 1) {
      out(i) = sd(0);
      continue;
    }
    const double low = static_cast<double>(p.rows(r));
    const double u = std::clamp((at - low) / (static_cast<double>(p.rows(r + 1)) - low), 0.0, 1.0);
    out(i) = (1.0 - u) * sd(r) + u * sd(r + 1);
  }
  return out;
}

constexpr std::size_t kMarkersOfFrame = 3;
constexpr std::size_t kMaxPieces = 8;
constexpr Index kLeastFrames = 3;
constexpr double kWorse = 1.5;  // times the SD of the third most rigid neighbour, and
constexpr double kSlackM = 0.001;

/// SD of the third most rigid neighbour that is complete in [first, end); infinity when there are fewer.
double third_sd(const Recording& r, const std::vector<Neighbour>& neighbours, Index first, Index end) {
  std::size_t found = 0;
  for (const Neighbour& n : neighbours)
    if (r.complete(n.marker, first, end) && ++found == kMarkersOfFrame) return n.sd_m;
  return std::numeric_limits<double>::infinity();
}

bool worse(double sd, double than) { return sd > kWorse * than + kSlackM; }

}  // namespace

Eigen::VectorXd simplex_weights(const Eigen::MatrixXd& M) {
  std::vector<Index> active(static_cast<std::size_t>(M.rows()));
  std::iota(active.begin(), active.end(), Index{0});
  while (true) {
    const Eigen::MatrixXd A = M(active, active);
    const Eigen::VectorXd w = A.ldlt().solve(Eigen::VectorXd::Ones(A.rows()));
    Index worst = 0;
    if (active.size() == 1 || w.minCoeff(&worst) > 0.0) {
      Eigen::VectorXd out = Eigen::VectorXd::Zero(M.rows());
      for (std::size_t k = 0; k < active.size(); ++k)
        out(active[k]) = active.size() == 1 ? 1.0 : w(static_cast<Index>(k)) / w.sum();
      return out;
    }
    active.erase(active.begin() + worst);
  }
}

Combination combine(const GapProblem& p, const std::vector<Fill>& fills, bool only_best) {
  Combination out;
  out.weights.assign(fills.size(), 0.0);
  out.guarded.assign(fills.size(), false);
  Pool pool = grow_errors(p, fills);
  if (pool.use.empty()) {  // no windows: the most conservative candidate, if it is finite
    std::size_t k = 0;
    for (std::size_t i = 0; i < fills.size(); ++i)
      if (fills[i].gap.allFinite() && (fills[i].kind == FillKind::pchip || !fills[k].gap.allFinite())) k = i;
    out.weights[k] = 1.0;
    out.gap = fills[k].gap;
    out.sd_m = Eigen::VectorXd::Constant(p.shape.length, std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  if (only_best) {
    pool.use = {*std::ranges::min_element(
        pool.use, [&](std::size_t a, std::size_t b) { return pool.rms[a] < pool.rms[b]; })};
  } else {
    guard(fills, pool, out.guarded);
  }
  const auto n = static_cast<Index>(pool.use.size());
  const auto at = [&](Index k) { return pool.use[static_cast<std::size_t>(k)]; };
  Eigen::MatrixXd M(n, n);
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b <= a; ++b)
      M(a, b) = M(b, a) =
          pool.miss[at(a)] * pool.miss[at(b)] * pool.errors[at(a)].cwiseProduct(pool.errors[at(b)]).mean();
  M.diagonal() *= 1.0 + kShrink;
  M.diagonal().array() += kLeastSquare;
  const Eigen::VectorXd w = simplex_weights(M);
  out.gap = Eigen::MatrixXd::Zero(p.shape.length, 3);
  for (Index k = 0; k < n; ++k) {
    out.weights[pool.use[static_cast<std::size_t>(k)]] = w(k);
    out.gap += w(k) * fills[pool.use[static_cast<std::size_t>(k)]].gap;
  }
  out.sd_m = predict_sd(p, fills, pool, w, out.gap);
  return out;
}

Filler::Filler(const data::Trajectories& in, const GapOptions& options)
    : options_(options), recording_(in, options.leave) {
  for (Index m = 0; m < recording_.markers(); ++m)
    noise_m_.push_back(options.noise_sd_m > 0.0 ? options.noise_sd_m : recording_.estimate_noise(m));
  if (options.check_labels) swaps_ = check_labels(recording_);
}

GapSpan Filler::span(Index marker, Index first, Index end) const {
  GapSpan s{.marker = marker, .first = first, .end = end};
  const Index most = support_frames(recording_.rate_hz());
  while (s.left < most && first - s.left > 0 && recording_.usable(marker, first - s.left - 1)) ++s.left;
  while (s.right < most && end + s.right < recording_.frames() && recording_.usable(marker, end + s.right))
    ++s.right;
  return s;
}

bool Filler::uses_neighbours() const {
  const GapMethod m = options_.method;
  return m == GapMethod::rigid || m == GapMethod::regression || m == GapMethod::pca ||
         m == GapMethod::automatic;
}

Filled Filler::fill(const GapSpan& span, const std::vector<Neighbour>& neighbours) const {
  const GapMethod method = options_.method;
  Filled out;
  out.problem = pose_gap(recording_, neighbours, span, uses_neighbours(), options_.seed);
  out.fills = make_fills(recording_, out.problem, method, cache_);
  if (out.fills.empty()) return out;
  out.combination = combine(out.problem, out.fills, method != GapMethod::automatic);
  const double noise = noise_m(span.marker);
  out.combination.sd_m = (out.combination.sd_m.array().square() + noise * noise).sqrt().matrix();
  return out;
}

std::vector<GapSpan> split_gap(const Recording& r, const std::vector<Neighbour>& neighbours,
                               const GapSpan& gap) {
  const double whole = third_sd(r, neighbours, gap.first - gap.left, gap.end + gap.right);
  std::vector<GapSpan> pieces;
  Index first = gap.first;
  double worst_frame = 0.0;  // of the piece so far: what it could have at best
  double worst_of_all = 0.0;
  for (Index f = gap.first; f < gap.end; ++f) {
    const double here = third_sd(r, neighbours, f, f + 1);
    const Index from = first == gap.first ? gap.first - gap.left : first;
    const Index to = f + 1 == gap.end ? gap.end + gap.right : f + 1;
    const double next = std::max(worst_frame, here);
    if (f > first && worse(third_sd(r, neighbours, from, to), next)) {
      pieces.push_back({.marker = gap.marker, .first = first, .end = f});
      first = f;
      worst_frame = here;
    } else {
      worst_frame = next;
    }
    worst_of_all = std::max(worst_of_all, here);
  }
  pieces.push_back({.marker = gap.marker, .first = first, .end = gap.end});
  const bool short_piece =
      std::ranges::any_of(pieces, [](const GapSpan& p) { return p.end - p.first < kLeastFrames; });
  if (pieces.size() == 1 || pieces.size() > kMaxPieces || short_piece || !worse(whole, worst_of_all))
    return {gap};
  pieces.front().left = gap.left;
  pieces.back().right = gap.right;
  return pieces;
}

void join_pieces(std::span<Filled> pieces) {
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    Combination& a = pieces[k].combination;
    Combination& b = pieces[k + 1].combination;
    const Index na = a.gap.rows();
    const Index nb = b.gap.rows();
    Eigen::RowVector3d step = Eigen::RowVector3d::Zero();  // that the path would make across the joint
    if (na > 1) step += 0.5 * (a.gap.row(na - 1) - a.gap.row(na - 2));
    if (nb > 1) step += 0.5 * (b.gap.row(1) - b.gap.row(0));
    const Eigen::RowVector3d miss = b.gap.row(0) - a.gap.row(na - 1) - step;
    const double va = a.sd_m(na - 1) * a.sd_m(na - 1);
    const double vb = b.sd_m(0) * b.sd_m(0);
    const double share = va + vb > 0.0 ? va / (va + vb) : 0.5;
    for (Index i = 0; i < na; ++i)
      a.gap.row(i) += share * static_cast<double>(i + 1) / static_cast<double>(na) * miss;
    for (Index i = 0; i < nb; ++i)
      b.gap.row(i) -= (1.0 - share) * static_cast<double>(nb - i) / static_cast<double>(nb) * miss;
  }
}

}  // namespace kinemark::trajectory::internal
