// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/coordinate_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/files/motion_tables.h"
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

constexpr std::size_t kNamed = 6;
constexpr double kMost = 1e6;              // rad or m
constexpr double kManyTurns = 4.0 * M_PI;  // rad

/// The row whose step from the one before is farthest from the usual one.
std::string uneven_rows(const data::Table& table) {
  std::vector<double> steps;
  for (std::int64_t r = 1; r < table.rows(); ++r)
    steps.push_back(table.time_s[at(r)] - table.time_s[at(r - 1)]);
  const double usual = math::median(steps);
  const auto far = std::ranges::max_element(steps, {}, [&](double step) { return std::abs(step - usual); });
  return fmt::format(
      "row {} is at {:.9g} s, {:.6g} s after the one before; rows that are evenly spaced are needed, "
      "here by {:.6g} s",
      far - steps.begin() + 2, table.time_s[at(far - steps.begin() + 1)], *far, usual);
}

/// How far a time may be from where it belongs: a hundredth of a step, or what printing it with so few digits
/// costs.
double time_slack_s(const data::Table& table, double step_s) {
  for (const double unit : {1e-2, 1e-3, 1e-4, 1e-5})
    if (std::ranges::all_of(table.time_s, [&](double t) { return std::abs(std::remainder(t, unit)) < 1e-9; }))
      return std::min(std::max(0.01 * step_s, 1.01 * unit), 0.1 * step_s);
  return 0.01 * step_s;
}

Result<TimeBase> even_time(const data::Table& table) {
  const auto rows = table.rows();
  if (rows < 2)
    return fail(Code::bad_input, fmt::format("holds {}; a motion needs two rows", counted(rows, "row")));
  const double span_s = table.time_s.back() - table.time_s.front();
  const TimeBase time{
      .rate_hz = static_cast<double>(rows - 1) / span_s, .t0_s = table.time_s.front(), .frames = rows};
  const double slack_s = time_slack_s(table, 1.0 / time.rate_hz);
  for (std::int64_t r = 0; r < rows; ++r)
    if (std::abs(table.time_s[at(r)] - time.time_s(r)) > slack_s)
      return fail(Code::bad_input, uneven_rows(table));
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

/// Columns of coupled coordinates that do not follow their couplings, to 1e-3 rad or m.
void note_couplings(const model::Model& model, const data::Table& table, CoordinateRows& out) {
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    const auto& name = model.description().coordinates[at(c)].name;
    const auto column = coordinate.source < 0 ? -1 : table.find(name);
    if (column < 0) continue;
    const double unit = column_unit(table, model.description(), c);
    double furthest = 0.0;
    for (std::int64_t r = 0; r < table.rows(); ++r) {
      const double stated = unit * table(r, column);
      if (std::isfinite(stated))
        furthest =
            std::max(furthest, std::abs(stated - coordinate.coupling(out.q[at(r)][coordinate.source]).f));
    }
    if (furthest > 1e-3)
      out.notes.push_back(
          fmt::format("'{}' is coupled to '{}' and follows it; its own column is up to {:.3g} {} from that",
                      name, model.description().coordinates[at(coordinate.source)].name, furthest,
                      model.description().coordinates[at(c)].is_rotation ? "rad" : "m"));
  }
}

/// How far a coordinate turns.
struct Turned {
  std::string name;
  double farthest = 0.0;    ///< rad
  bool is_limited = false;  ///< the model says how far it turns, less than once
};

/// Coordinates that turn a turn and more beyond what the model lets them, or beyond one turn where it does
/// not say, and would not if their radians were degrees.
std::vector<Turned> turned_too_far(const model::Model& model, const data::Table& table) {
  constexpr double kTurn = 2.0 * M_PI;
  constexpr double kSlack = 0.5;  // rad; people pass the limits of their models
  std::vector<Turned> out;
  for (const auto& coordinate : model.description().coordinates) {
    const auto column = table.find(coordinate.name);
    if (column < 0 || !coordinate.is_rotation) continue;
    double least = kNaN, most = kNaN;
    for (std::int64_t r = 0; r < table.rows(); ++r) {
      least = std::fmin(least, table(r, column));
      most = std::fmax(most, table(r, column));
    }
    const bool is_limited = coordinate.range_max - coordinate.range_min <= kTurn;
    const double low = is_limited ? coordinate.range_min : -0.5 * kTurn;
    const double high = is_limited ? coordinate.range_max : 0.5 * kTurn;
    const double beyond = is_limited ? kTurn : 0.5 * kTurn;
    if (least > low - beyond && most < high + beyond) continue;
    if (kRadPerDeg * least > low - kSlack && kRadPerDeg * most < high + kSlack)
      out.push_back({coordinate.name, std::abs(least) > std::abs(most) ? least : most, is_limited});
  }
  return out;
}

/// A body may turn round and round about three axes; two joints that do so are no body's.
Status refuse_degrees_called_radians(const model::Model& model, const data::Table& table) {
  if (!table.degrees_stated || table.in_degrees) return {};
  const auto turned = turned_too_far(model, table);
  if (turned.size() < 4 && std::ranges::count(turned, true, &Turned::is_limited) < 2) return {};
  return fail(
      Code::bad_input,
      fmt::format("says inDegrees=no, but {} coordinates turn further than a body can, '{}' to {:.4g} rad; "
                  "as degrees all of them are within reach. If they are degrees, write inDegrees=yes "
                  "above endheader",
                  turned.size(), turned.front().name, turned.front().farthest));
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

Result<CoordinateRows> coordinate_rows(const model::Model& model, const data::Table& table) {
  const auto time = even_time(table);
  if (!time) return std::unexpected(time.error());
  const auto& description = model.description();
  if (auto s = refuse_degrees_called_radians(model, table); !s) return std::unexpected(s.error());
  CoordinateRows out{.time = *time};
  out.is_filled.assign(at(table.rows() * model.coordinate_count()), 0);
  Eigen::VectorXd q(model.coordinate_count());
  for (int c = 0; c < model.coordinate_count(); ++c) q[c] = description.coordinates[at(c)].default_value;
  out.is_assumed.assign(at(model.coordinate_count()), false);
  out.q.assign(at(table.rows()), q);
  std::vector<std::string> absent;
  bool turns = false;
  std::int64_t filled = 0;
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const std::string& name = description.coordinates[at(c)].name;
    const auto column = table.find(name);
    if (model.coordinates()[at(c)].source >= 0) continue;
    if (const auto& prescribed = description.coordinates[at(c)].prescribed; column < 0 && prescribed) {
      for (std::int64_t r = 0; r < table.rows(); ++r) out.q[at(r)][c] = (*prescribed)(time->time_s(r)).f;
      continue;
    }
    if (column < 0) {
      out.is_assumed[at(c)] = !description.coordinates[at(c)].locked;
      absent.push_back(name);
      continue;
    }
    std::vector<double> values;
    for (std::int64_t r = 0; r < table.rows(); ++r) {
      values.push_back(table(r, column));
      out.is_filled[at(r * model.coordinate_count() + c)] = !std::isfinite(values.back());
    }
    const auto n = fill(values);
    if (n < 0) return fail(Code::bad_input, fmt::format("coordinate '{}' has no number in any row", name));
    filled += n;
    const double unit = column_unit(table, description, c);
    for (std::size_t r = 0; r < values.size(); ++r) {
      out.q[r][c] = unit * values[r];
      if (std::abs(out.q[r][c]) > kMost)
        return fail(Code::bad_input, fmt::format("row {}, column '{}': {:g} is no value of a coordinate",
                                                 r + 1, name, values[r]));
    }
    turns =
        turns || (description.coordinates[at(c)].is_rotation && unit == 1.0 &&
                  *std::ranges::max_element(values, {}, [](double v) { return std::abs(v); }) > kManyTurns);
  }
  if (std::ranges::none_of(description.coordinates,
                           [&](const auto& coordinate) { return table.find(coordinate.name) >= 0; }))
    return fail(Code::bad_input,
                fmt::format("none of its columns is a coordinate of model '{}'", description.name));
  note_couplings(model, table, out);
  if (turns && !table.degrees_stated)
    out.notes.push_back(
        "the file does not say inDegrees, and its angles were taken for radians; they are several turns "
        "large: if "
        "they are degrees, write inDegrees=yes above endheader");
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

}  // namespace kinemark::pipeline
