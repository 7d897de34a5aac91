// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/gaps/internal/filler.h"

namespace kinemark::trajectory {
namespace {

using internal::Combination;
using internal::Filled;
using internal::Filler;
using internal::GapSpan;
using internal::Index;
using internal::Neighbour;

constexpr Index kMaxGapFrames = 4000;  // operators are dense, frames of the gap by samples beside it
constexpr Index kGapsPerReport = 64;

/// A gap, its accounts, and its fill.
struct Work {
  GapSpan span;
  std::vector<data::GapAccount> accounts;  // one per piece
  std::vector<Combination> pieces;         // as many when the gap is filled, else none
};

std::vector<GapSpan> find_gaps(const data::Trajectories& in, const GapOptions& options) {
  const auto& only = options.only;
  std::vector<GapSpan> gaps;
  for (Index m = 0; m < in.markers(); ++m) {
    if (only.marker >= 0 && m != only.marker) continue;
    if (std::ranges::find(options.leave, m) != options.leave.end()) continue;
    for (Index f = 0; f < in.frames();) {
      if (in.present(f, m)) {
        ++f;
        continue;
      }
      Index end = f + 1;
      while (end < in.frames() && !in.present(end, m)) ++end;
      if (end > only.first_frame && f <= only.last_frame)
        gaps.push_back({.marker = m, .first = f, .end = end});
      f = end;
    }
  }
  return gaps;
}

/// RMS of a marker's position about its mean, per axis: the error bar when there is no better one.
double roaming_m(const internal::Recording& r, Index marker) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double square = 0.0;
  double n = 0.0;
  for (Index f = 0; f < r.frames(); ++f) {
    if (!r.usable(marker, f)) continue;
    sum += r.x(marker, f);
    square += r.x(marker, f).squaredNorm();
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(std::max(0.0, square / n - (sum / n).squaredNorm()) / 3.0) : 0.0;
}

/// Why a gap is not even tried, or "".
std::string why_not_tried(const Filler& filler, const GapSpan& span, const GapOptions& options) {
  const double rate = filler.recording().rate_hz();
  const Index frames = span.end - span.first;
  if (options.method == GapMethod::none) return "filling was not asked for";
  if (filler.recording().usable_frames(span.marker) == 0) return "the marker was never measured";
  if (static_cast<double>(frames) > options.max_gap_s * rate * (1.0 + 1e-9))
    return fmt::format("{:.3g} s long; at most {:.3g} s are filled", static_cast<double>(frames) / rate,
                       options.max_gap_s);
  if (frames > kMaxGapFrames)
    return fmt::format("{} frames long; at most {} are filled", frames, kMaxGapFrames);
  return {};
}

void describe(const data::Trajectories& in, const Filled& filled, data::GapAccount& account) {
  const auto name = [&](Index m) { return in.names[static_cast<std::size_t>(m)]; };
  for (const Index m : filled.problem.predictors) account.predictors.push_back(name(m));
  for (const Index m : filled.problem.dropped) account.dropped.push_back(name(m));
  account.windows = static_cast<int>(filled.problem.windows());
  account.window_s = static_cast<double>(filled.problem.window.length) / in.time.rate_hz;
  for (std::size_t k = 0; k < filled.fills.size(); ++k) {
    const double rms = filled.fills[k].rms_m();
    account.weights.push_back({.name = std::string(to_string(filled.fills[k].kind)),
                               .weight = filled.combination.weights[k],
                               .rms_m = std::isfinite(rms) ? rms : std::numeric_limits<double>::quiet_NaN(),
                               .guarded = filled.combination.guarded[k]});
  }
  std::ranges::stable_sort(account.weights, std::ranges::greater{}, &data::GapWeight::weight);
}

/// Why nothing could be made of a gap at all.
std::string why_no_fill(const Filler& filler, const Filled& filled, const GapOptions& options) {
  if (!filler.uses_neighbours()) return "no sample beside it to predict from";
  if (filled.problem.windows() == 0) return "too few complete spans to learn from";
  return options.method == GapMethod::automatic
             ? "no neighbours to learn from and no sample beside it to predict from"
             : "no neighbours to learn from";
}

/// Why a fill is not good enough to be used, or "".
std::string why_not_used(const Filler& filler, const Filled& filled, const GapSpan& gap, double sd_m,
                         const GapOptions& options) {
  const double rate_hz = filler.recording().rate_hz();
  const double length_s = static_cast<double>(gap.end - gap.first) / rate_hz;
  if (filled.problem.predictors.empty() && (gap.left == 0 || gap.right == 0) &&
      length_s > options.max_extrapolation_s * (1.0 + 1e-9))
    return filler.uses_neighbours()
               ? fmt::format(
                     "no sample on one side and no neighbours to learn from; at most {:.3g} s are "
                     "extrapolated",
                     options.max_extrapolation_s)
               : fmt::format(
                     "no sample on one side, and the method uses no neighbours; at most {:.3g} s are "
                     "extrapolated",
                     options.max_extrapolation_s);
  if (std::isinf(options.max_sd_m)) return {};
  if (std::isnan(sd_m))
    return filled.problem.windows() == 0
               ? "too few complete spans to learn from, so that its standard deviation is unknown"
               : "its standard deviation is unknown";
  if (sd_m > options.max_sd_m)
    return fmt::format("its standard deviation would be {:.1f} mm; at most {:.1f} mm is allowed", 1e3 * sd_m,
                       1e3 * options.max_sd_m);
  return {};
}

double mean_square_sd(std::span<const Filled> pieces) {
  double sum = 0.0;
  Index frames = 0;
  for (const Filled& p : pieces) {
    if (p.fills.empty()) return std::numeric_limits<double>::quiet_NaN();
    sum += p.combination.sd_m.squaredNorm();
    frames += p.combination.sd_m.size();
  }
  return sum / static_cast<double>(frames);
}

/// The gap as a whole or, where that is more certain, in pieces.
std::vector<Filled> fill_or_split(const Filler& filler, const std::vector<Neighbour>& neighbours,
                                  const GapSpan& gap) {
  std::vector<Filled> whole;
  whole.push_back(filler.fill(gap, neighbours));
  const std::vector<GapSpan> spans =
      filler.uses_neighbours() ? split_gap(filler.recording(), neighbours, gap) : std::vector<GapSpan>{gap};
  if (spans.size() == 1) return whole;
  std::vector<Filled> pieces;
  for (const GapSpan& span : spans) pieces.push_back(filler.fill(span, neighbours));
  const double split_square = mean_square_sd(pieces);
  const double whole_square = mean_square_sd(whole);
  if (std::isnan(split_square) || split_square >= whole_square) return whole;
  join_pieces(pieces);
  return pieces;
}

/// True when the fill uses the marker's own path only.
bool is_temporal(const Filled& piece) {
  for (std::size_t k = 0; k < piece.fills.size(); ++k)
    if (piece.combination.weights[k] > 0.0 && !internal::is_temporal(piece.fills[k].kind)) return false;
  return true;
}

data::GapAccount blank_account(const data::Trajectories& in, const GapSpan& span) {
  return {.marker = span.marker,
          .first_frame = span.first,
          .last_frame = span.end - 1,
          .at_edge = span.first == 0 || span.end == in.frames()};
}

void fill_one(const data::Trajectories& in, const Filler& filler, const std::vector<Neighbour>& neighbours,
              const GapOptions& options, Work& work) {
  std::string why = why_not_tried(filler, work.span, options);
  if (!why.empty()) {
    work.accounts = {blank_account(in, work.span)};
    work.accounts.front().why_open = std::move(why);
    return;
  }
  std::vector<Filled> pieces = fill_or_split(filler, neighbours, work.span);
  const double sd_m = std::sqrt(mean_square_sd(pieces));
  for (const Filled& piece : pieces) {
    data::GapAccount account = blank_account(in, piece.problem.span);
    describe(in, piece, account);
    if (piece.fills.empty()) {
      why = why_no_fill(filler, piece, options);
    } else {
      account.sd_m = std::sqrt(piece.combination.sd_m.squaredNorm() / static_cast<double>(account.frames()));
      account.max_sd_m = piece.combination.sd_m.maxCoeff();
      if (!piece.combination.gap.allFinite()) why = "the predicted path is not finite";
      if (why.empty()) why = why_not_used(filler, piece, work.span, sd_m, options);
    }
    work.accounts.push_back(std::move(account));
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    data::GapAccount& account = work.accounts[k];
    account.filled = why.empty();
    account.why_open = why;
    if (!account.filled) continue;
    account.method = options.method == GapMethod::automatic ? "auto" : account.weights.front().name;
    account.temporal = is_temporal(pieces[k]);
    work.pieces.push_back(std::move(pieces[k].combination));
  }
}

void set_isotropic(data::Trajectories& out, Index frame, Index marker, double variance_m2) {
  math::pack_isotropic3(variance_m2, out.covariance.data() + 6 * out.index(frame, marker));
}

/// Covariance of the present samples, so that every sample of a marker that is not left alone has one.
void set_noise(const Filler& filler, std::span<const Index> left, data::Trajectories& out) {
  out.covariance.assign(2 * out.x_in_world.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index m = 0; m < out.markers(); ++m) {
    if (std::ranges::find(left, m) != left.end()) continue;  // nobody says how they err
    const double noise = filler.noise_m(m);
    for (Index f = 0; f < out.frames(); ++f)
      if (out.present(f, m)) set_isotropic(out, f, m, noise * noise);
  }
}

void write(const Filler& filler, const data::GapAccount& account, const Combination& fill,
           data::Trajectories& out) {
  const Index m = account.marker;
  const double unknown =
      fill.sd_m.hasNaN() ? std::hypot(roaming_m(filler.recording(), m), filler.noise_m(m)) : 0.0;
  for (Index i = 0; i < fill.gap.rows(); ++i) {
    const Index f = account.first_frame + i;
    out.x(f, m) = fill.gap.row(i).transpose();
    out.state[out.index(f, m)] =
        account.temporal ? data::SampleState::interpolated : data::SampleState::model_filled;
    out.set_method(f, m, account.method);
    const double sd = std::isnan(fill.sd_m(i)) ? unknown : fill.sd_m(i);
    set_isotropic(out, f, m, sd * sd);
  }
}

data::Finding tell(const data::Trajectories& in, const internal::Swap& s) {
  data::Finding swap{.kind = data::FindingKind::label_swap,
                     .subject = in.names[static_cast<std::size_t>(s.first_marker)],
                     .partner = in.names[static_cast<std::size_t>(s.second_marker)],
                     .first_frame = s.first,
                     .last_frame = s.end - 1,
                     .size = s.distance_m};
  swap.description = fmt::format(
      "markers '{}' and '{}' have exchanged labels in frames {} to {}, {:.0f} mm apart", swap.subject,
      swap.partner, in.time.number(s.first), in.time.number(s.end - 1), 1e3 * s.distance_m);
  return swap;
}

}  // namespace

std::int64_t GapResult::filled_frames() const {
  std::int64_t sum = 0;
  for (const data::GapAccount& gap : gaps) sum += gap.filled ? gap.frames() : 0;
  return sum;
}

Result<GapResult> fill_gaps(const data::Trajectories& in, const GapOptions& options) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = in.validate(); !s) return std::unexpected(s.error());
  const Filler filler(in, options);
  std::vector<Work> work;
  for (const GapSpan& gap : find_gaps(in, options)) {
    work.push_back({.span = filler.span(gap.marker, gap.first, gap.end)});
  }
  // Neighbours once per marker, found when its first gap is reached by a batch.
  std::vector<std::optional<std::vector<Neighbour>>> neighbours(static_cast<std::size_t>(in.markers()));
  const auto total = static_cast<Index>(work.size());
  for (Index first = 0; first < total; first += kGapsPerReport) {
    if (options.progress && !options.progress(first, total))
      return fail(Code::cancelled, "filling gaps was stopped");
    const Index end = std::min(total, first + kGapsPerReport);
    std::vector<Index> markers;
    for (Index k = first; k < end; ++k) {
      const Index m = work[static_cast<std::size_t>(k)].span.marker;
      if (options.method != GapMethod::none && !neighbours[static_cast<std::size_t>(m)] &&
          (markers.empty() || markers.back() != m))
        markers.push_back(m);
    }
    parallel_for(static_cast<Index>(markers.size()), 1, options.threads, [&](Index a, Index b) {
      for (Index k = a; k < b; ++k) {
        const Index m = markers[static_cast<std::size_t>(k)];
        neighbours[static_cast<std::size_t>(m)] = find_rigid_neighbours(filler.recording(), m);
      }
    });
    parallel_for(end - first, 1, options.threads, [&](Index a, Index b) {
      for (Index k = first + a; k < first + b; ++k) {
        Work& w = work[static_cast<std::size_t>(k)];
        fill_one(in, filler,
                 neighbours[static_cast<std::size_t>(w.span.marker)].value_or(std::vector<Neighbour>()),
                 options, w);
      }
    });
  }
  GapResult result{.trajectories = in};
  if (in.covariance.empty()) set_noise(filler, options.leave, result.trajectories);
  for (Work& w : work) {
    for (std::size_t k = 0; k < w.pieces.size(); ++k)
      write(filler, w.accounts[k], w.pieces[k], result.trajectories);
    std::ranges::move(w.accounts, std::back_inserter(result.gaps));
  }
  for (const internal::Swap& s : filler.swaps()) result.swaps.push_back(tell(in, s));
  if (options.progress && !options.progress(total, total))
    return fail(Code::cancelled, "filling gaps was stopped");
  return result;
}

}  // namespace kinemark::trajectory
