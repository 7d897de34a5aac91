// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <mutex>

#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/math/wiener_smoother.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

namespace kinemark::skeleton::articulated {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLongestGap_s = 1.0;  // without a frame that holds a position
// Standard deviations of the first frame: m about the first position found, m/s (limbs stay far below),
// m/s^2.
constexpr std::array<double, 5> kPriorSd{1.0, 10.0, 1000.0};

/// Frames [begin, end) without a gap too long to cross; the first position in them.
struct Piece {
  std::int64_t begin = 0, end = 0;
  Vector3d first_position = Vector3d::Zero();
};

std::vector<Piece> cut(std::span<const PathPoint> points, double rate_hz) {
  const auto F = static_cast<std::int64_t>(points.size());
  const auto longest = static_cast<std::int64_t>(kLongestGap_s * rate_hz);
  std::vector<Piece> pieces;
  std::int64_t last = 0;
  for (std::int64_t f = 0; f < F; ++f) {
    const PathPoint& point = points[static_cast<std::size_t>(f)];
    if (!holds_a_position(point)) continue;
    if (pieces.empty() || f - last > longest) {
      if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
      const std::int64_t earliest = pieces.empty() ? 0 : pieces.back().end;
      pieces.push_back(
          {.begin = std::max(f - longest / 2, earliest), .end = F, .first_position = point.position});
    }
    last = f;
  }
  if (!pieces.empty()) pieces.back().end = std::min(last + longest / 2 + 1, F);
  return pieces;
}

std::vector<math::PositionObservation<3>> observe(std::span<const PathPoint> points, const Piece& piece,
                                                  double rate_hz) {
  std::vector<math::PositionObservation<3>> out;
  out.reserve(static_cast<std::size_t>(piece.end - piece.begin));
  for (std::int64_t f = piece.begin; f < piece.end; ++f) {
    const PathPoint& point = points[static_cast<std::size_t>(f)];
    out.push_back({.time_s = static_cast<double>(f - piece.begin) / rate_hz,
                   .information = point.information,
                   .position = point.position});
  }
  return out;
}

/// Log likelihood when every frame draws its position anew from one normal distribution.
double likelihood_of_unrelated(std::span<const PathPoint> points) {
  Vector3d mean = Vector3d::Zero();
  Matrix3d spread = Matrix3d::Zero();
  double n = 0.0;
  for (const PathPoint& p : points)
    if (holds_a_position(p)) mean += p.position, n += 1.0;
  if (n == 0.0) return 0.0;
  mean /= n;
  for (const PathPoint& p : points)
    if (holds_a_position(p)) spread += (p.position - mean) * (p.position - mean).transpose() / n;
  double sum = 0.0;
  for (const PathPoint& p : points) {
    if (!holds_a_position(p)) continue;
    const Matrix3d m = Matrix3d::Identity() + p.information * spread;
    const Vector3d z = p.position - mean;
    sum -= 0.5 * (z.dot(m.inverse() * p.information * z) + std::log(m.determinant()));
  }
  return sum;
}

constexpr std::int64_t kChunk = 256;     // frames that one thread follows from a cold start
constexpr std::int64_t kSampled = 4000;  // poses kept
constexpr std::size_t kModesKept = 6;    // of a flagged frame
constexpr double kLightest = 1e-12;      // share of probability below which a mode is dropped

/// What one chunk found beside the arrays that all share.
struct Chunk {
  std::vector<FlaggedFrame> flagged;
  std::vector<SampledPose> sampled;
  std::vector<SampledPose> first;  ///< that determine a joint, between those that are sampled
  std::vector<std::int64_t> misfits;
};

FlaggedFrame flag(std::int64_t f, const ChainFrame& frame) {
  FlaggedFrame out{.frame = f};
  for (const Gathered g : frame.gathered) out.gathered.push_back(g == Gathered::positions ? 1 : 0);
  const auto count = std::min(static_cast<std::size_t>(frame.mode_count), kModesKept);
  for (std::size_t i = 0; i < count; ++i)
    if (frame.modes[i].weight > kLightest)
      out.modes.push_back({.centre = frame.modes[i].centre, .log_weight = std::log(frame.modes[i].weight)});
  return out;
}

/// No joint that some frame determines goes without a pose because its frames lie between the sampled ones.
void show_every_joint(std::vector<Chunk>& chunks, std::size_t joints, RecordingPass& pass) {
  std::vector<bool> shown(joints, false);
  const auto show = [&](const SampledPose& pose) {
    bool fresh = false;
    for (std::size_t j = 0; j < joints; ++j) {
      fresh = fresh || (pose.known[j] != 0 && !shown[j]);
      shown[j] = shown[j] || pose.known[j] != 0;
    }
    return fresh;
  };
  for (const SampledPose& pose : pass.sampled) (void)show(pose);
  for (Chunk& chunk : chunks)
    for (SampledPose& pose : chunk.first)
      if (show(pose)) pass.sampled.push_back(std::move(pose));
  std::ranges::stable_sort(pass.sampled, {}, &SampledPose::frame);
}

}  // namespace

bool holds_a_position(const PathPoint& point) {
  const double mean = point.information.trace() / 3.0;
  return mean > 0.0 && point.information.determinant() > 1e-9 * mean * mean * mean;
}

Eigen::Matrix3d SmoothedPath::covariance_at(std::size_t frame) const {
  return math::unpack_symmetric3(covariance.data() + 6 * frame);
}

SmoothedPath smooth_path(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  SmoothedPath path;
  path.position.assign(points.size(), Vector3d::Constant(kNaN));
  path.covariance.assign(6 * points.size(), kNaN);
  math::WienerOptions<3> options;
  options.covariance = math::WienerCovariance::position;
  for (const Piece& piece : cut(points, rate_hz)) {
    options.prior = math::WienerPrior<3>{.position = piece.first_position, .sd = kPriorSd};
    math::smooth_wiener<3>({.order = 3, .spectral_density = white_jerk}, observe(points, piece, rate_hz),
                           options, [&](std::size_t k, const math::WienerEstimate<3>& at) {
                             const std::size_t f = static_cast<std::size_t>(piece.begin) + k;
                             path.position[f] = at.derivative(0);
                             math::pack_symmetric3(at.covariance_of(0), path.covariance.data() + 6 * f);
                           });
  }
  return path;
}

double calc_path_likelihood(std::span<const PathPoint> points, double rate_hz, double white_jerk) {
  double sum = 0.0;  // pieces are independent: each begins afresh
  for (const Piece& piece : cut(points, rate_hz))
    sum += math::wiener_log_likelihood<3>({.order = 3, .spectral_density = white_jerk},
                                          observe(points, piece, rate_hz),
                                          {.position = piece.first_position, .sd = kPriorSd});
  return sum;
}

PathPrior find_path_prior(std::span<const PathPoint> points, double rate_hz, std::int64_t max_frames) {
  // Windows over the recording: a likelihood of the whole would cost a pass for each density tried.
  const auto F = static_cast<std::int64_t>(points.size());
  std::vector<std::span<const PathPoint>> windows;
  if (F <= max_frames) windows.push_back(points);
  for (int w = 0; F > max_frames && w < 4; ++w)
    windows.push_back(points.subspan(static_cast<std::size_t>((F - max_frames / 4) * w / 3),
                                     static_cast<std::size_t>(max_frames / 4)));
  const auto total = [&](double exponent) {
    double sum = 0.0;
    for (const auto& window : windows) sum += calc_path_likelihood(window, rate_hz, std::pow(10.0, exponent));
    return sum;
  };
  double best = -4.0, best_value = total(best);
  for (double exponent = -3.0; exponent <= 12.0; exponent += 1.0)
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  for (const double exponent : {best - 0.5, best + 0.5})
    if (const double value = total(exponent); value > best_value) best = exponent, best_value = value;
  double unrelated = 0.0;
  for (const auto& window : windows) unrelated += likelihood_of_unrelated(window);
  return {.white_jerk = std::pow(10.0, best), .follows = best_value > unrelated};
}

void store_symmetric(double* to, const Matrix3d& C) { math::pack_symmetric3(0.5 * (C + C.transpose()), to); }

Matrix3d load_symmetric(const double* c) { return math::unpack_symmetric3(c); }

bool is_misfit(const Chain& chain, double cost_m2, double noise_sd_m, int seen) {
  const double free = std::max(3.0 * seen - chain.frame_parameters(), 1.0);
  return cost_m2 > noise_sd_m * noise_sd_m * (free + 6.0 * std::sqrt(2.0 * free) + 6.0);
}

Result<RecordingPass> pass_over(const FittedChain& fit, const ChainSamples& samples, int threads,
                                const Progress& progress) {
  using data::CentreState;
  const auto F = static_cast<std::size_t>(samples.frames);
  const auto J = static_cast<std::size_t>(fit.chain.joints());
  RecordingPass pass;
  pass.points.assign(J, std::vector<PathPoint>(F));
  pass.state.assign(J, std::vector<CentreState>(F, CentreState::undetermined));
  pass.covariance.assign(J, Array<double>(6 * F, kNaN));
  pass.common.assign(J, Array<double>(6 * F, kNaN));
  const std::int64_t stride = std::max<std::int64_t>(1, (samples.frames + kSampled - 1) / kSampled);
  std::vector<Chunk> chunks(static_cast<std::size_t>((samples.frames + kChunk - 1) / kChunk));
  std::atomic<bool> stop = false;
  std::mutex telling;
  std::int64_t done = 0;
  const auto solve_chunk = [&](std::int64_t begin, std::int64_t end) {
    Chunk& chunk = chunks[static_cast<std::size_t>(begin / kChunk)];
    ChainSolver solver(fit);
    ChainFrame frame;
    ChainPose before;
    bool warm = false;
    std::vector<bool> shown(J, false);
    for (std::int64_t f = begin; f < end && !stop; ++f) {
      solver.solve(samples.frame(f), warm ? &before : nullptr, frame);
      bool all = true, any = false, fresh = false;
      for (std::size_t j = 0; j < J; ++j) {
        const bool alone = frame.state[j] == CentreState::determined;
        const auto k = static_cast<std::size_t>(f);
        all = all && alone;
        any = any || alone;
        fresh = fresh || (alone && !shown[j]);
        pass.state[j][k] = frame.state[j];
        if (frame.state[j] == CentreState::undetermined) continue;
        pass.points[j][k].position = frame.centre[j];
        if (alone) pass.points[j][k].information = frame.information[j];
        store_symmetric(pass.covariance[j].data() + 6 * k, frame.covariance[j]);
        store_symmetric(pass.common[j].data() + 6 * k, frame.covariance[j] - frame.own_covariance[j]);
      }
      const bool gathered = std::ranges::find(frame.gathered, Gathered::positions) != frame.gathered.end();
      if (!all || gathered) chunk.flagged.push_back(flag(f, frame));
      // A pose with an undetermined joint is no start for the next frame.
      warm = all && frame.mode_count > 0;
      if (warm) before = frame.modes.front().pose;
      if (frame.mode_count == 0) continue;
      const ChainMode& best = frame.modes.front();
      if (fresh || (any && f % stride == 0)) {
        SampledPose kept{.frame = f, .pose = best.pose, .cost = best.cost};
        for (std::size_t j = 0; j < J; ++j) {
          kept.known.push_back(frame.state[j] == CentreState::determined);
          shown[j] = shown[j] || kept.known.back() != 0;
        }
        (f % stride == 0 ? chunk.sampled : chunk.first).push_back(std::move(kept));
      }
      if (is_misfit(fit.chain, best.cost, fit.noise_sd_m, frame.seen)) chunk.misfits.push_back(f);
    }
    if (!progress) return;
    const std::scoped_lock lock(telling);
    done += end - begin;
    if (!progress(done, samples.frames)) stop = true;
  };
  parallel_for(samples.frames, kChunk, threads, solve_chunk);
  if (stop) return fail(Code::cancelled, "stopped while solving frames");
  for (Chunk& chunk : chunks) {
    std::ranges::move(chunk.flagged, std::back_inserter(pass.flagged));
    std::ranges::move(chunk.sampled, std::back_inserter(pass.sampled));
    std::ranges::move(chunk.misfits, std::back_inserter(pass.misfits));
  }
  show_every_joint(chunks, J, pass);
  return pass;
}

}  // namespace kinemark::skeleton::articulated
