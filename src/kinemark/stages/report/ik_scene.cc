// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/ik_scene.h"

#include <algorithm>

#include "kinemark/core/missing.h"
#include "kinemark/stages/report/internal/sensor_part.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report::internal {

using data::JointMotion;
using data::Trajectories;

namespace {

/// Without markers: bodies, and the sensors on them.
nlohmann::ordered_json sensor_scene_json(const IkReport& report, const SceneOptions& options) {
  const auto points = sensor_points(*report.sensors, *report.bodies, report.motion->time);
  return scene_json({.markers = &points,
                     .bodies = report.bodies,
                     .up = report.up,
                     .up_from = report.up ? "the model's gravity" : ""},
                    options);
}

}  // namespace

nlohmann::ordered_json ik_scene_json(const IkReport& report, std::int64_t max_bytes) {
  const JointMotion& motion = *report.motion;
  SceneOptions options;
  options.max_bytes = std::min(options.max_bytes, max_bytes);
  options.max_bytes_long = std::min(options.max_bytes_long, max_bytes);
  if (report.sensors != nullptr && report.bodies != nullptr && motion.markers.empty())
    return sensor_scene_json(report, options);
  if (report.markers == nullptr || !report.in_model_axes || motion.markers.empty() ||
      motion.marker_error.empty())
    return nullptr;
  std::vector<std::int64_t> from;
  for (const auto& name : motion.markers) from.push_back(report.markers->find(name));
  if (std::ranges::find(from, -1) != from.end()) return nullptr;
  auto used = Trajectories::all_missing(motion.markers, motion.time);
  Array<double> model(motion.marker_error.size(), kNaN);
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t m = 0; m < used.markers(); ++m) {
      const std::int64_t recorded = from[static_cast<std::size_t>(m)];
      const std::size_t i = used.index(f, m);
      used.state[i] = report.markers->state[report.markers->index(f, recorded)];
      if (!report.markers->present(f, recorded)) continue;
      used.x(f, m) = report.markers->x(f, recorded);
      for (std::size_t k = 0; k < 3; ++k)
        model[3 * i + k] = used.x_in_world[3 * i + k] - motion.marker_error[3 * i + k];
    }
  return scene_json({.markers = &used,
                     .model = &model,
                     .bodies = report.bodies,
                     .up = report.up,
                     .up_from = report.up ? "the model's gravity" : ""},
                    options);
}

}  // namespace kinemark::report::internal
