// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/plates.h"

#include <utility>

#include "kinemark/io/c3d/plate_forces.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

std::optional<data::Wrenches> plates_of(const std::filesystem::path& path, const data::Trial& trial) {
  if (trial.force_plates.empty() || ending_of(path) != ".c3d") return std::nullopt;
  auto forces = io::read_plate_forces(path, {.contact_force_n = 0.0});
  if (!forces) return std::nullopt;  // the reader of markers has told what is wrong with them
  auto& all = forces->wrenches;
  const auto& time = trial.markers.time;
  const auto skipped = all.time.nearest_frame(time.t0_s);
  if (skipped < 0 || skipped + time.frames > all.frames()) return std::nullopt;
  for (auto& wrench : all.items)
    for (auto* values : {&wrench.force, &wrench.moment, &wrench.point}) {
      values->erase(values->begin() + 3 * (skipped + time.frames), values->end());
      values->erase(values->begin(), values->begin() + 3 * skipped);
    }
  all.time = time;
  return std::move(all);
}

}  // namespace kinemark::pipeline
