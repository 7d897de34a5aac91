// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/used_markers.h"

#include <algorithm>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::workflow {

data::Trajectories select_markers(const data::Trajectories& recorded, std::span<const std::int64_t> from,
                                  std::vector<std::string> names, std::int64_t first_frame,
                                  const TimeBase& time) {
  check(names.size() == from.size(), "select_markers() needs one name for each marker");
  auto selected = data::Trajectories::all_missing(std::move(names), time);
  if (!recorded.unfiltered_in_world.empty())
    selected.unfiltered_in_world.assign(selected.x_in_world.size(), kNaN);
  if (!recorded.filters.empty())
    for (const std::int64_t m : from) selected.filters.push_back(recorded.filters[at(m)]);
  for (std::int64_t m = 0; m < selected.markers(); ++m)
    for (std::int64_t f = 0; f < selected.frames(); ++f) {
      selected.x(f, m) = recorded.x(first_frame + f, from[at(m)]);
      selected.state[selected.index(f, m)] = recorded.state[recorded.index(first_frame + f, from[at(m)])];
      if (!recorded.unfiltered_in_world.empty())
        std::copy_n(recorded.unfiltered_in_world.data() + 3 * recorded.index(first_frame + f, from[at(m)]), 3,
                    selected.unfiltered_in_world.data() + 3 * selected.index(f, m));
    }
  return selected;
}

void exchange_as_found(const data::MarkerFit& fit, data::Trajectories& markers) {
  const auto exchange = [&](std::int64_t f, std::int64_t one, std::int64_t other) {
    const Eigen::Vector3d x = markers.x(f, one);
    markers.x(f, one) = markers.x(f, other);
    markers.x(f, other) = x;
    std::swap(markers.state[markers.index(f, one)], markers.state[markers.index(f, other)]);
  };
  for (const auto& finding : fit.findings) {
    if (finding.kind != data::FindingKind::label_swap) continue;
    const auto one = markers.find(finding.subject), other = markers.find(finding.partner);
    if (one < 0 || other < 0 || finding.last_frame >= markers.frames()) continue;
    for (const auto f : finding.frames) exchange(f, one, other);
    if (finding.frames.empty())
      for (auto f = finding.first_frame; f >= 0 && f <= finding.last_frame; ++f) exchange(f, one, other);
  }
}

data::Trajectories solved_markers(const data::Trajectories& recorded, const data::MarkerFit& fit,
                                  const data::JointMotion& motion) {
  std::vector<std::string> names;
  std::vector<std::int64_t> from;
  for (const auto& marker : fit.markers) {
    names.push_back(marker.name);
    from.push_back(recorded.find(marker.name_in_data));
  }
  auto markers = select_markers(recorded, from, std::move(names), fit.first_frame, motion.time);
  exchange_as_found(fit, markers);
  for (std::size_t i = 0; i < motion.marker_state.size(); ++i)
    if (motion.marker_state[i] == data::SampleState::rejected) {
      const auto M = static_cast<std::size_t>(markers.markers());
      markers.set_missing(static_cast<std::int64_t>(i / M), static_cast<std::int64_t>(i % M),
                          data::SampleState::rejected);
    }
  return markers;
}

}  // namespace kinemark::workflow
