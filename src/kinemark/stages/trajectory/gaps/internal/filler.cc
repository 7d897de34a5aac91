// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/filler.h"

#include <algorithm>
#include <cmath>

namespace kinemark::trajectory::internal {

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

}  // namespace kinemark::trajectory::internal
