// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinemark/core/parallel.h"
#include "kinemark/stages/trajectory/gaps/internal/filler.h"

namespace kinemark::trajectory {
namespace {

using internal::Filled;
using internal::Filler;
using internal::FillKind;
using internal::GapSpan;
using internal::Index;
using internal::Neighbour;

constexpr Index kMaxGapFrames = 4000;  // operators are dense, frames of the gap by samples beside it
constexpr Index kGapsPerReport = 64;

/// A gap, its account, and what to write when it is filled.
struct Work {
  GapSpan span;
  GapAccount account;
  Eigen::MatrixXd x_in_world;  // L x 3
  Eigen::VectorXd sd_m;        // L
  bool temporal = false;       // made from the marker's own path alone
};

std::vector<GapSpan> find_gaps(const data::Trajectories& in) {
  std::vector<GapSpan> gaps;
  for (Index m = 0; m < in.markers(); ++m)
    for (Index f = 0; f < in.frames();) {
      if (in.present(f, m)) {
        ++f;
        continue;
      }
      Index end = f + 1;
      while (end < in.frames() && !in.present(end, m)) ++end;
      gaps.push_back({.marker = m, .first = f, .end = end});
      f = end;
    }
  return gaps;
}

/// How far a marker roams: per axis, RMS about its mean. The bar of last resort.
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

void describe(const data::Trajectories& in, const Filled& filled, GapAccount& account) {
  const auto name = [&](Index m) { return in.names[static_cast<std::size_t>(m)]; };
  for (const Index m : filled.problem.predictors) account.predictors.push_back(name(m));
  for (const Index m : filled.problem.dropped) account.dropped.push_back(name(m));
  account.windows = static_cast<int>(filled.problem.windows());
  account.window_s = static_cast<double>(filled.problem.window.length) / in.time.rate_hz;
  for (std::size_t k = 0; k < filled.fills.size(); ++k) {
    const double rms = filled.fills[k].rms_m();
    account.candidates.push_back(
        {.name = std::string(to_string(filled.fills[k].kind)),
         .weight = filled.combination.weights[k],
         .rms_m = std::isfinite(rms) ? rms : std::numeric_limits<double>::quiet_NaN(),
         .guarded = filled.combination.guarded[k]});
  }
  std::ranges::stable_sort(account.candidates, std::ranges::greater{}, &CandidateWeight::weight);
}

/// Why a fill is not good enough to be used, or "".
std::string why_not_used(const Filled& filled, const GapAccount& account, const GapOptions& options,
                         double rate_hz) {
  const double length_s = static_cast<double>(account.frames()) / rate_hz;
  if (filled.problem.predictors.empty() &&
      (filled.problem.shape.left == 0 || filled.problem.shape.right == 0) &&
      length_s > options.max_extrapolation_s * (1.0 + 1e-9))
    return fmt::format("no sample on one side and no complete neighbours; at most {:.3g} s are extrapolated",
                       options.max_extrapolation_s);
  if (std::isinf(options.max_sd_m)) return {};
  if (std::isnan(account.sd_m))
    return "too few complete stretches to learn from, so that its standard deviation is unknown";
  if (account.sd_m > options.max_sd_m)
    return fmt::format("its standard deviation would be {:.1f} mm; at most {:.1f} mm is allowed",
                       1e3 * account.sd_m, 1e3 * options.max_sd_m);
  return {};
}

void fill_one(const data::Trajectories& in, const Filler& filler, const std::vector<Neighbour>& neighbours,
              const GapOptions& options, Work& work) {
  GapAccount& account = work.account;
  account.why_open = why_not_tried(filler, work.span, options);
  if (!account.why_open.empty()) return;
  Filled filled = filler.fill(work.span, neighbours);
  describe(in, filled, account);
  if (filled.fills.empty()) {
    account.why_open = account.windows == 0 ? "too few complete stretches to learn from"
                                            : "no complete neighbour and no sample to predict from";
    return;
  }
  account.sd_m = std::sqrt(filled.combination.sd_m.squaredNorm() / static_cast<double>(account.frames()));
  account.max_sd_m = filled.combination.sd_m.maxCoeff();
  account.why_open = why_not_used(filled, account, options, in.time.rate_hz);
  if (!account.why_open.empty()) return;
  account.filled = true;
  account.method = options.method == GapMethod::automatic ? "auto" : account.candidates.front().name;
  work.temporal = true;
  for (std::size_t k = 0; k < filled.fills.size(); ++k)
    if (filled.combination.weights[k] > 0.0 && !is_temporal(filled.fills[k].kind)) work.temporal = false;
  work.x_in_world = std::move(filled.combination.gap);
  work.sd_m = std::move(filled.combination.sd_m);
  if (std::isnan(account.sd_m))
    work.sd_m.setConstant(
        std::hypot(roaming_m(filler.recording(), work.span.marker), filler.noise_m(work.span.marker)));
}

/// Covariance of what is there already, so that every sample has one.
void set_noise(const Filler& filler, data::Trajectories& out) {
  out.covariance.assign(6 * static_cast<std::size_t>(out.frames() * out.markers()),
                        std::numeric_limits<double>::quiet_NaN());
  for (Index m = 0; m < out.markers(); ++m) {
    const double variance = filler.noise_m(m) * filler.noise_m(m);
    for (Index f = 0; f < out.frames(); ++f)
      if (out.present(f, m))
        for (const std::size_t c : {0U, 1U, 2U, 3U, 4U, 5U})
          out.covariance[6 * out.index(f, m) + c] = c == 0 || c == 3 || c == 5 ? variance : 0.0;
  }
}

void write(const Work& work, data::Trajectories& out) {
  const data::SampleState state =
      work.temporal ? data::SampleState::interpolated : data::SampleState::model_filled;
  for (Index i = 0; i < work.x_in_world.rows(); ++i) {
    const Index f = work.span.first + i;
    out.x(f, work.span.marker) = work.x_in_world.row(i).transpose();
    out.state[out.index(f, work.span.marker)] = state;
    out.set_method(f, work.span.marker, work.account.method);
    const double variance = work.sd_m(i) * work.sd_m(i);
    for (const std::size_t c : {0U, 1U, 2U, 3U, 4U, 5U})
      out.covariance[6 * out.index(f, work.span.marker) + c] = c == 0 || c == 3 || c == 5 ? variance : 0.0;
  }
}

SwapFinding describe(const data::Trajectories& in, const internal::Swap& s) {
  return {.first_marker = s.first_marker,
          .second_marker = s.second_marker,
          .first_frame = s.first,
          .last_frame = s.end - 1,
          .distance_m = s.distance_m,
          .sentence = fmt::format(
              "markers '{}' and '{}' sit in each other's place in frames {} to {}, {:.0f} mm apart",
              in.names[static_cast<std::size_t>(s.first_marker)],
              in.names[static_cast<std::size_t>(s.second_marker)], s.first, s.end - 1, 1e3 * s.distance_m)};
}

}  // namespace

std::int64_t GapResult::filled_frames() const {
  std::int64_t sum = 0;
  for (const GapAccount& gap : gaps) sum += gap.filled ? gap.frames() : 0;
  return sum;
}

Result<GapResult> fill_gaps(const data::Trajectories& in, const GapOptions& options) {
  if (const Status s = options.check(); !s) return std::unexpected(s.error());
  if (const Status s = in.validate(); !s) return std::unexpected(s.error());
  const Filler filler(in, options);
  std::vector<Work> work;
  for (const GapSpan& gap : find_gaps(in)) {
    Work w{.span = filler.span(gap.marker, gap.first, gap.end)};
    w.account = {.marker = gap.marker,
                 .first_frame = gap.first,
                 .last_frame = gap.end - 1,
                 .at_edge = gap.first == 0 || gap.end == in.frames(),
                 .sd_m = std::numeric_limits<double>::quiet_NaN(),
                 .max_sd_m = std::numeric_limits<double>::quiet_NaN()};
    work.push_back(std::move(w));
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
  if (in.covariance.empty()) set_noise(filler, result.trajectories);
  for (Work& w : work) {
    if (w.account.filled) write(w, result.trajectories);
    result.gaps.push_back(std::move(w.account));
  }
  for (const internal::Swap& s : filler.swaps()) result.swaps.push_back(describe(in, s));
  if (options.progress && !options.progress(total, total))
    return fail(Code::cancelled, "filling gaps was stopped");
  return result;
}

}  // namespace kinemark::trajectory
