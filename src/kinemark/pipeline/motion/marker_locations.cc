// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/marker_locations.h"

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"

namespace kinemark::pipeline {

data::Table marker_locations_table(const model::Model& model, const data::JointMotion& motion) {
  const auto n = static_cast<std::int64_t>(model.coordinate_count());
  check(std::ssize(motion.q) == motion.frames() * n, "the motion is of this model");
  data::Table table;
  table.name = "Model Marker Locations from IK";
  for (const auto& marker : model.description().markers)
    for (const char* axis : {"_tx", "_ty", "_tz"}) table.columns.push_back(marker.name + axis);
  table.values.reserve(at(motion.frames()) * table.columns.size());
  model::Workspace w(model);
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    table.time_s.push_back(motion.time.time_s(f));
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(motion.q.data() + f * n, n);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    table.values.insert(table.values.end(), w.marker.data(), w.marker.data() + w.marker.size());
  }
  return table;
}

}  // namespace kinemark::pipeline
