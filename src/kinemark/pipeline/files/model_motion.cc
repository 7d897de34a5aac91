// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/model_motion.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/files/coordinate_rows.h"
#include "kinemark/stages/analysis/consistency/table_facts.h"
#include "kinemark/workflow/prepare/turn.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;

/// Where a body that carries no other ends.
Vector3d end_of(const data::ModelDescription& description, int body) {
  Vector3d end = 2.0 * description.bodies[at(body)].com_in_body;
  double farthest = 0.0;
  for (const auto& marker : description.markers)
    if (marker.body_idx == body && marker.x_in_body.norm() > farthest) {
      farthest = marker.x_in_body.norm();
      end = marker.x_in_body;
    }
  return end;
}

/// To a world whose y points up.
Eigen::Matrix3d y_up(const model::Model& model, std::vector<std::string>& notes) {
  const auto up = workflow::up_of(model);
  if (!up || (*up - Vector3d::UnitY()).norm() < 1e-6) return Eigen::Matrix3d::Identity();
  notes.push_back(
      fmt::format("the motion was turned: the model's up ({}) became y", workflow::name_of_direction(*up)));
  return workflow::rotation_between(*up, Vector3d::UnitY());
}

}  // namespace

Result<ModelMotion> move_model(data::ModelDescription description, const data::Table& table) {
  const auto model = model::Model::compile(std::move(description));
  if (!model) return std::unexpected(model.error());
  auto coordinates = coordinate_rows(*model, table);
  if (!coordinates) return std::unexpected(coordinates.error());
  ModelMotion out{.poses = {.time = coordinates->time}, .notes = std::move(coordinates->notes)};
  for (const auto& body : model->bodies())
    out.poses.bodies.push_back({.name = model->description().bodies[at(body.description_idx)].name,
                                .parent = body.parent,
                                .end_in_body = end_of(model->description(), body.description_idx)});
  const Eigen::Matrix3d turned = y_up(*model, out.notes);
  out.y_is_up = workflow::up_of(*model).has_value();
  out.poses.world_from_body.reserve(coordinates->q.size() * out.poses.bodies.size());
  model::Workspace w(*model);
  for (const auto& q : coordinates->q) {
    model::kinematics(*model, w, model::state_from_coordinates(*model, q));
    for (std::size_t b = 0; b < out.poses.bodies.size(); ++b)
      out.poses.world_from_body.push_back({turned * w.rotation[b], turned * w.position[b]});
  }
  return out;
}

Result<ModelMotion> read_model_motion(const std::filesystem::path& model,
                                      const std::filesystem::path& table) {
  auto description = io::read_osim(model);
  if (!description) return std::unexpected(description.error());
  const auto read = io::read_table(table);
  if (!read) return std::unexpected(read.error());
  auto motion = move_model(std::move(*description), *read);
  if (!motion) return fail_at(table.string(), motion.error());
  motion->notes.insert(motion->notes.begin(), read->warnings.begin(), read->warnings.end());
  motion->contradicted = analysis::contradicted_values(*read, table.filename().string());
  return motion;
}

}  // namespace kinemark::pipeline
