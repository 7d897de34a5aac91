// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/recorded_source.h"

#include <span>
#include <utility>

namespace kinemark::stream {
namespace {

std::optional<std::array<Eigen::Vector3d, 2>> extent_of(const data::Trajectories& markers) {
  std::optional<std::array<Eigen::Vector3d, 2>> out;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      if (!markers.present(f, m)) continue;
      const Eigen::Vector3d x = markers.x(f, m);
      if (!out) out = {x, x};
      (*out)[0] = (*out)[0].cwiseMin(x);
      (*out)[1] = (*out)[1].cwiseMax(x);
    }
  return out;
}

SourceFacts with_recording(SourceFacts facts, const data::Trajectories& markers) {
  facts.markers = markers.names;
  facts.rate_hz = markers.time.rate_hz;
  facts.t0_s = markers.time.t0_s;
  facts.frames = markers.frames();
  facts.extent_m = extent_of(markers);
  return facts;
}

}  // namespace

RecordedSource::RecordedSource(data::Trajectories markers, SourceFacts facts)
    : Source(with_recording(std::move(facts), markers)), markers_(std::move(markers)) {}

Result<bool> RecordedSource::next(Frame& frame) {
  if (next_ == markers_.frames()) return false;
  const auto first = markers_.index(next_, 0), count = markers_.names.size();
  const auto x = std::span(markers_.x_in_world).subspan(3 * first, 3 * count);
  const auto state = std::span(markers_.state).subspan(first, count);
  frame.number = next_;
  frame.time_s = markers_.time.time_s(next_);
  frame.x_in_world.assign(x.begin(), x.end());
  frame.state.assign(state.begin(), state.end());
  ++next_;
  return true;
}

}  // namespace kinemark::stream
