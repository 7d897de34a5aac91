// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Time of one frame of a fitted chain, with the error it reaches beside it.
#include <benchmark/benchmark.h>

#include <cmath>

#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

// Arguments: segments, markers a segment, share missing in per cent, kind, warm (frames follow each other
// closely).
void solve_frames(benchmark::State& state) {
  const auto kind = static_cast<data::SegmentKind>(state.range(3));
  auto limb = testing_limbs::make_random_chain({.segments = static_cast<int>(state.range(0)),
                                                .markers_per_segment = static_cast<int>(state.range(1)),
                                                .frames = 300,
                                                .kind = kind,
                                                .missing = 0.01 * static_cast<double>(state.range(2))});
  ChainFitOptions options;
  options.kind = limb.chain.kind;
  const auto fit = fit_chain(limb.samples, limb.chain.layout, options);
  if (!fit) {
    state.SkipWithError(fit.error().message.c_str());
    return;
  }
  ChainSolver solver(*fit);
  ChainFrame frame;
  double squares = 0.0;
  double count = 0.0;
  for (auto unused : state) {
    (void)unused;
    for (int f = 0; f < 300; ++f) {
      solver.solve(limb.samples.frame(f), state.range(4) != 0 ? &limb.pose[f] : nullptr, frame);
      for (std::size_t j = 0; j < frame.state.size(); ++j) {
        if (frame.state[j] != data::CentreState::determined) continue;
        squares +=
            (frame.centre[j] - limb.chain.joint_centre(limb.pose[f], static_cast<int>(j))).squaredNorm();
        count += 1.0;
      }
    }
  }
  state.SetItemsProcessed(300 * state.iterations());
  state.counters["rms_mm"] = 1e3 * std::sqrt(squares / count);
  state.counters["determined"] =
      count / (300.0 * static_cast<double>(state.iterations()) * static_cast<double>(limb.chain.joints()));
}
BENCHMARK(solve_frames)
    ->ArgNames({"segments", "markers", "missing", "kind", "warm"})
    ->Args({2, 3, 0, 0, 0})
    ->Args({2, 3, 40, 2, 0})
    ->Args({2, 8, 40, 2, 1})
    ->Args({4, 4, 20, 2, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinemark::skeleton::articulated
