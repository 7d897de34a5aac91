// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/edit_changes.h"

#include <algorithm>
#include <utility>

namespace kinemark::trajectory {
namespace {

using data::Trajectories;
using data::Trial;

/// Frames that both have, as numbers; none when the last is below the first.
struct Common {
  std::int64_t first, last;
};

Common common_frames(const Trial& a, const Trial& b) {
  return {std::max(a.first_frame, b.first_frame), std::min(a.last_frame(), b.last_frame())};
}

void note(MarkerChange& change, std::int64_t number, std::int64_t& count) {
  if (change.moved + change.came + change.went + change.restated == 0) change.first_frame = number;
  change.last_frame = number;
  ++count;
}

/// One marker on the frames that both have; an index of -1 stands for a marker that is absent throughout.
MarkerChange change_of(const Trial& before, std::int64_t was, const Trial& after, std::int64_t is) {
  MarkerChange change;
  const auto& a = before.markers;
  const auto& b = after.markers;
  const auto [first, last] = common_frames(before, after);
  for (auto number = first; number <= last; ++number) {
    const auto f = number - before.first_frame, g = number - after.first_frame;
    const bool there = was >= 0 && a.present(f, was), here = is >= 0 && b.present(g, is);
    if (there && !here) {
      note(change, number, change.went);
    } else if (here && !there) {
      note(change, number, change.came);
    } else if (here && a.x(f, was) != b.x(g, is)) {
      note(change, number, change.moved);
      change.largest_m = std::max(change.largest_m, (b.x(g, is) - a.x(f, was)).norm());
    } else if (was >= 0 && is >= 0 && a.state[a.index(f, was)] != b.state[b.index(g, is)]) {
      note(change, number, change.restated);
    }
  }
  return change;
}

}  // namespace

std::vector<MarkerChange> changes_between(const Trial& before, const Trial& after) {
  std::vector<MarkerChange> changes;
  const auto keep = [&](const std::string& marker, std::int64_t was, std::int64_t is) {
    auto change = change_of(before, was, after, is);
    if (change.moved + change.came + change.went + change.restated == 0) return;
    change.marker = marker;
    changes.push_back(std::move(change));
  };
  for (std::int64_t m = 0; m < after.markers.markers(); ++m) {
    const auto& name = after.markers.names[static_cast<std::size_t>(m)];
    keep(name, before.markers.find(name), m);
  }
  for (std::int64_t m = 0; m < before.markers.markers(); ++m) {
    const auto& name = before.markers.names[static_cast<std::size_t>(m)];
    if (after.markers.find(name) < 0) keep(name, m, -1);
  }
  return changes;
}

Trajectories aligned_to(const Trial& before, const Trial& after) {
  auto out = Trajectories::all_missing(after.markers.names, after.markers.time);
  const auto [first, last] = common_frames(before, after);
  for (std::int64_t m = 0; m < out.markers(); ++m) {
    const auto was = before.markers.find(out.names[static_cast<std::size_t>(m)]);
    if (was < 0) continue;
    for (auto number = first; number <= last; ++number) {
      const auto f = number - before.first_frame, g = number - after.first_frame;
      out.state[out.index(g, m)] = before.markers.state[before.markers.index(f, was)];
      out.x(g, m) = before.markers.x(f, was);
    }
  }
  return out;
}

}  // namespace kinemark::trajectory
