// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/hand_on.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/filtering.h"

namespace kinemark::trajectory {
namespace {

/// Where the samples from before a marker's filter are; null: nowhere.
const double* before_filter(const data::Trajectories& from, std::int64_t frame, std::int64_t marker,
                            bool filtered) {
  const std::size_t i = from.index(frame, marker);
  if (!from.unfiltered_in_world.empty() && data::was_filtered(from, marker))
    return from.unfiltered_in_world.data() + 3 * i;
  const bool raw = filtered && !data::was_filtered(from, marker);
  return raw && from.state[i] == data::SampleState::measured ? from.x_in_world.data() + 3 * i : nullptr;
}

}  // namespace

void hand_on(const data::Trajectories& from, std::int64_t marker, const data::FilterUsed& used,
             data::Trajectories& to, std::int64_t place) {
  const bool filtered = data::is_filter(used);
  const data::FilterUsed before = from.filters.empty() ? data::FilterUsed{} : from.filters[at(marker)];
  const data::FilterUsed all = data::one_after_other(before, used);
  if (!data::is_filter(all)) return;
  const data::FilterUsed none{.method = "none", .order = 0, .cutoff_hz = kNaN, .noise_sd_m = kNaN};
  if (to.filters.empty()) to.filters.assign(to.names.size(), none);
  to.filters[at(place)] = all;
  for (std::int64_t f = 0; f < from.frames(); ++f) {
    const double* x = before_filter(from, f, marker, filtered);
    if (x == nullptr) continue;
    if (to.unfiltered_in_world.empty()) to.unfiltered_in_world.assign(to.x_in_world.size(), kNaN);
    std::copy_n(x, 3, to.unfiltered_in_world.data() + 3 * to.index(f, place));
  }
  if (filtered) data::mark_smoothed(to, place, used.method);
}

}  // namespace kinemark::trajectory
