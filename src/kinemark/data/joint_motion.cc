// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/joint_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/enum_names.h"

namespace kinemark::data {

std::string_view to_string(FrameStatus status) {
  static constexpr EnumNames<FrameStatus::no_markers> kNames{"converged", "not_converged", "underdetermined",
                                                             "no_markers"};
  return kNames[status];
}

std::int64_t JointMotion::find(std::string_view coordinate) const {
  const auto it = std::ranges::find(coordinates, coordinate);
  return it == coordinates.end() ? -1 : it - coordinates.begin();
}

Status JointMotion::validate() const {
  const auto F = static_cast<std::size_t>(std::max<std::int64_t>(0, frames()));
  const std::size_t n = coordinates.size(), M = markers.size();
  const auto wrong = [](std::string_view what, std::size_t has, std::size_t needs) {
    return fail(Code::bad_input,
                fmt::format("joint motion holds {} numbers of {}; need {}", has, what, needs));
  };
  if (frames() < 0) return fail(Code::bad_input, fmt::format("joint motion has {} frames", frames()));
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz) || !std::isfinite(time.t0_s))
    return fail(Code::bad_input,
                fmt::format("joint motion has a rate of {} Hz from {} s on", time.rate_hz, time.t0_s));
  if (is_rotation.size() != n) return wrong("is_rotation", is_rotation.size(), n);
  if (!keeps_radians.empty() && keeps_radians.size() != n)
    return wrong("keeps_radians", keeps_radians.size(), n);
  if (!open_frames.empty() && open_frames.size() != n) return wrong("open_frames", open_frames.size(), n);
  if (q.size() != F * n) return wrong("q", q.size(), F * n);
  if (!q_sd.empty() && q_sd.size() != F * n) return wrong("q_sd", q_sd.size(), F * n);
  const std::pair<std::string_view, const Array<double>*> optional[] = {
      {"qd", &qd}, {"qdd", &qdd}, {"tau", &tau}, {"tau_sd", &tau_sd}, {"q_bound", &q_bound}};
  for (const auto& [name, numbers] : optional)
    if (!numbers->empty() && numbers->size() != F * n) return wrong(name, numbers->size(), F * n);
  if (!determined.empty() && determined.size() != F * n) return wrong("determined", determined.size(), F * n);
  if (!marker_error.empty() && marker_error.size() != 3 * F * M)
    return wrong("marker_error", marker_error.size(), 3 * F * M);
  if (!marker_state.empty() && marker_state.size() != F * M)
    return wrong("marker_state", marker_state.size(), F * M);
  if (!status.empty() && status.size() != F) return wrong("status", status.size(), F);
  const auto bad = std::ranges::find_if(q, [](double v) { return !std::isfinite(v); });
  if (bad != q.end()) {
    const auto i = static_cast<std::size_t>(bad - q.begin());
    return fail(Code::bad_input,
                fmt::format("coordinate '{}' of frame {} is not a finite number", coordinates[i % n], i / n));
  }
  return {};
}

}  // namespace kinemark::data
