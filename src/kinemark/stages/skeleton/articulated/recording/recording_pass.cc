// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <mutex>

#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"

namespace kinemark::skeleton::articulated {
namespace {

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
