// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/model_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/turn.h"
#include "kinemark/pipeline/files/vertical.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kNamed = 6;

Result<TimeBase> even_time(const data::Table& table) {
  const auto rows = table.rows();
  if (rows < 2)
    return fail(Code::bad_input, fmt::format("holds {}; a motion needs two rows", counted(rows, "row")));
  const double span_s = table.time_s.back() - table.time_s.front();
  const TimeBase time{
      .rate_hz = static_cast<double>(rows - 1) / span_s, .t0_s = table.time_s.front(), .frames = rows};
  for (std::int64_t r = 0; r < rows; ++r)
    if (std::abs(table.time_s[at(r)] - time.time_s(r)) * time.rate_hz > 0.01)
      return fail(Code::bad_input,
                  fmt::format("row {} is at {:.9g} s; rows that are evenly spaced, here by {:.6g} s, "
                              "are needed, and the first that is not is this one",
                              r + 1, table.time_s[at(r)], 1.0 / time.rate_hz));
  return time;
}

/// Cells without a number get one from those around them; how many they were, or -1 when none has one.
std::int64_t fill(std::vector<double>& column) {
  const auto is_number = [](double v) { return std::isfinite(v); };
  std::int64_t filled = 0;
  auto before = column.end();
  for (auto here = column.begin(); here != column.end();) {
    if (is_number(*here)) {
      before = here++;
      continue;
    }
    const auto after = std::find_if(here, column.end(), is_number);
    if (before == column.end() && after == column.end()) return -1;
    filled += after - here;
    for (; here != after; ++here) {
      const auto span = static_cast<double>(after - before);
      *here = before == column.end() ? *after
              : after == column.end()
                  ? *before
                  : *before + (*after - *before) * static_cast<double>(here - before) / span;
    }
  }
  return filled;
}

/// Coordinates of all frames, rad and m: F x n, frame first.
struct Coordinates {
  std::vector<Eigen::VectorXd> q;
  std::vector<std::string> notes;
};

Result<Coordinates> read_coordinates(const model::Model& model, const data::Table& table) {
  const auto& description = model.description();
  Coordinates out;
  Eigen::VectorXd q(model.coordinate_count());
  for (int c = 0; c < model.coordinate_count(); ++c) q[c] = description.coordinates[at(c)].default_value;
  out.q.assign(at(table.rows()), q);
  std::vector<std::string> absent;
  std::int64_t filled = 0;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const std::string& name = description.coordinates[at(c)].name;
    const auto column = table.find(name);
    if (model.coordinates()[at(c)].source >= 0) continue;
    if (column < 0) {
      absent.push_back(name);
      continue;
    }
    std::vector<double> values;
    for (std::int64_t r = 0; r < table.rows(); ++r) values.push_back(table(r, column));
    const auto n = fill(values);
    if (n < 0) return fail(Code::bad_input, fmt::format("coordinate '{}' has no number in any row", name));
    filled += n;
    const double unit = column_unit(table, description, c);
    for (std::size_t r = 0; r < values.size(); ++r) out.q[r][c] = unit * values[r];
  }
  if (std::ssize(absent) == model.coordinate_count())
    return fail(Code::bad_input,
                fmt::format("none of its columns is a coordinate of model '{}'", description.name));
  if (!absent.empty())
    out.notes.push_back(fmt::format("{} of the model {} no column and {} the default value: {}",
                                    counted(std::ssize(absent), "coordinate"),
                                    absent.size() == 1 ? "has" : "have",
                                    absent.size() == 1 ? "keeps" : "keep", join_some(absent, kNamed)));
  if (filled > 0)
    out.notes.push_back(fmt::format("{} without a number {} filled from those around them",
                                    counted(filled, "cell"), filled == 1 ? "was" : "were"));
  return out;
}

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
  const auto up = up_of(model);
  if (!up || (*up - Vector3d::UnitY()).norm() < 1e-6) return Eigen::Matrix3d::Identity();
  notes.push_back(fmt::format("the motion was turned: the model's up ({}) became y", name_of_direction(*up)));
  return rotation_between(*up, Vector3d::UnitY());
}

}  // namespace

Result<ModelMotion> move_model(data::ModelDescription description, const data::Table& table) {
  const auto time = even_time(table);
  if (!time) return std::unexpected(time.error());
  const auto model = model::Model::compile(std::move(description));
  if (!model) return std::unexpected(model.error());
  auto coordinates = read_coordinates(*model, table);
  if (!coordinates) return std::unexpected(coordinates.error());
  ModelMotion out{.poses = {.time = *time}, .notes = std::move(coordinates->notes)};
  for (const auto& body : model->bodies())
    out.poses.bodies.push_back({.name = model->description().bodies[at(body.description_idx)].name,
                                .parent = body.parent,
                                .end_in_body = end_of(model->description(), body.description_idx)});
  const Eigen::Matrix3d turned = y_up(*model, out.notes);
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
  return motion;
}

}  // namespace kinemark::pipeline
