// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/name_pattern.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/result.h"
#include "kinemark/core/text.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/analysis/body/body_measures.h"
#include "kinemark/stages/analysis/body/body_series.h"
#include "kinemark/stages/motion/dynamics/contacts.h"
#include "kinemark/stages/motion/dynamics/whole_body.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/internal/held_motion.h"
#include "kinemark/workflow/motion/internal/rated_motion.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::workflow {
namespace {

// A motion and its model as analysis::measure_body() takes them.

/// A motion with everything that its measures need. Refers to the model, which must outlive it.
struct BodyInput {
  analysis::BodyRecord record;     ///< what does not depend on noise
  analysis::Mechanics mechanics;   ///< torques, mass centre, momentum and feet of one version
  std::vector<std::string> notes;  ///< a sentence each
};

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kContact_n = 20.0;

bool is_foot(const std::string& name) {
  for (const char* part : {"calcn", "foot", "toes"})
    if (name.find(part) != std::string::npos) return true;
  return false;
}

/// Which side a body of the tree is of, if it is a foot.
std::optional<data::Side> foot_side(const model::Model& model, int body) {
  if (body < 0) return std::nullopt;
  const auto& name = model.description().bodies[at(model.bodies()[at(body)].description_idx)].name;
  if (!is_foot(name)) return std::nullopt;
  const auto side = analysis::side_of_name(name);
  if (side.empty()) return std::nullopt;
  return side == data::to_string(data::Side::left) ? data::Side::left : data::Side::right;
}

Eigen::MatrixXd matrix_of(const Array<double>& values, std::int64_t frames, std::int64_t n) {
  return Eigen::Map<const RowMajor>(values.data(), frames, n);
}

void put(const Eigen::MatrixXd& values, Array<double>& out) {
  out.resize(static_cast<std::size_t>(values.size()));
  Eigen::Map<RowMajor>(out.data(), values.rows(), values.cols()) = values;
}

/// Coordinates of joints that carry the whole body and let it travel.
std::vector<bool> root_coordinates(const data::ModelDescription& model) {
  std::vector<bool> out(model.coordinates.size(), false);
  for (const auto& joint : model.joints) {
    if (joint.parent_body_idx != data::kGround) continue;
    bool travels = false;
    for (const auto& axis : joint.axes) travels = travels || (!axis.is_rotation && axis.coordinate_idx >= 0);
    for (const auto& axis : joint.axes)
      if (travels && axis.coordinate_idx >= 0) out[at(axis.coordinate_idx)] = true;
  }
  return out;
}

analysis::BodyRecord record_of(const model::Model& model, const data::JointMotion& motion) {
  analysis::BodyRecord out{
      .time = motion.time, .names = motion.coordinates, .is_rotation = motion.is_rotation};
  const auto frames = motion.frames(), n = motion.size();
  out.is_root = root_coordinates(model.description());
  for (std::int64_t c = 0; c < n; ++c) {
    const bool moves =
        model.coordinates()[at(c)].source < 0 && !model.description().coordinates[at(c)].held();
    out.measured.push_back(moves);
    out.driven.push_back(moves && !out.is_root[at(c)]);
  }
  out.q = matrix_of(motion.q, frames, n);
  if (!motion.q_sd.empty()) out.q_sd = matrix_of(motion.q_sd, frames, n);
  out.determined.resize(frames, n);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t c = 0; c < n; ++c) out.determined(f, c) = motion.determined[motion.index(f, c)] != 0;
  if (const auto up = up_of(model)) out.up = *up;
  if (model.gravity().norm() > 0.0) out.gravity = model.gravity().norm();
  for (const auto& body : model.bodies()) out.mass_kg += body.mass;
  return out;
}

/// Everything that a version of the motion is computed with.
struct Mechanism {
  const model::Model& model;
  data::JointMotion shape;               // names, clock, determined
  std::optional<data::Wrenches> forces;  // on the motion's clock
  bool torques = false, has_mass = false;
  std::vector<motion::PointOnBody> points;  // of both feet
  std::vector<data::Side> sides;            // of each point

  Status operator()(analysis::BodySeries& series) const {
    data::JointMotion moved = shape;
    put(series.q, moved.q);
    put(series.v, moved.qd);
    put(series.a, moved.qdd);
    couple(moved);
    if (torques) {
      const auto dynamics = motion::inverse_dynamics(
          model, moved, {.error_bars = false, .contact_force_n = kContact_n}, forces ? &*forces : nullptr);
      if (!dynamics) return std::unexpected(dynamics.error());
      series.tau = matrix_of(moved.tau, moved.frames(), moved.size());
    }
    if (!has_mass) return {};
    auto body = motion::whole_body(model, moved, points);
    if (!body) return std::unexpected(body.error());
    series.centre = std::move(body->centre);
    series.centre_velocity = std::move(body->centre_velocity);
    series.momentum = std::move(body->momentum);
    for (std::size_t p = 0; p < points.size(); ++p)
      series.outline[data::index_of(sides[p])].push_back(std::move(body->points[p]));
    return {};
  }

 private:
  // Coupled coordinates and their rates follow those that drive them.
  void couple(data::JointMotion& moved) const {
    for (const int c : model.coordinate_order()) {
      const auto& coordinate = model.coordinates()[at(c)];
      if (coordinate.source < 0) continue;
      for (std::int64_t f = 0; f < moved.frames(); ++f) {
        const auto to = moved.index(f, c), from = moved.index(f, coordinate.source);
        const auto at_q = coordinate.coupling(moved.q[from]);
        moved.q[to] = at_q.f;
        moved.qd[to] = at_q.df * moved.qd[from];
        moved.qdd[to] = at_q.df * moved.qdd[from] + at_q.ddf * moved.qd[from] * moved.qd[from];
      }
    }
  }
};

/// Torques with their deviations, once: which are known, and what is to be said of them.
Status put_torques(const GivenMotion& given, RatedMotion& rated, int threads, Mechanism& mechanism,
                   BodyInput& out) {
  auto& motion = rated.motion;
  auto torques =
      find_torques(mechanism.model, given, rated,
                   {.error_bars = !motion.q_sd.empty(), .contact_force_n = kContact_n, .threads = threads});
  if (!torques) return std::unexpected(torques.error());
  std::ranges::move(torques->account.warnings, std::back_inserter(out.notes));
  auto& record = out.record;
  record.torque_known.resize(motion.frames(), motion.size());
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      record.torque_known(f, c) = std::isfinite(motion.tau[i]) && record.determined(f, c) &&
                                  (motion.tau_sd.empty() || std::isfinite(motion.tau_sd[i]));
    }
  if (!torques->forces) return {};
  const auto feet = motion::find_feet(mechanism.model, {});
  if (!feet) return std::unexpected(feet.error());
  const auto plan = motion::plan_contacts(mechanism.model, motion, *torques->forces, *feet, kContact_n);
  if (!plan) return std::unexpected(plan.error());
  record.contact = Eigen::MatrixX<bool>::Constant(motion.frames(), 2, false);
  for (const auto& wrench : plan->body)
    for (std::int64_t f = 0; f < motion.frames(); ++f)
      if (const auto side = foot_side(mechanism.model, wrench[at(f)]))
        record.contact(f, static_cast<Eigen::Index>(data::index_of(*side))) = true;
  mechanism.forces = std::move(torques->forces);
  return {};
}

/// Feet as measure_motion() has them; they stand where a plate sees them and where
/// analysis::feet_on_ground() says so.
/// @param rated    gets torques, with deviations where it has some itself
/// @param torques  inverse dynamics without forces too
/// Fails as find_torques().
Result<BodyInput> body_input(const model::Model& model, const GivenMotion& given, RatedMotion& rated,
                             bool torques, int threads) {
  BodyInput out{.record = record_of(model, rated.motion)};
  const auto mechanism = std::make_shared<Mechanism>(Mechanism{.model = model, .shape = rated.motion});
  auto& shape = mechanism->shape;
  for (auto* values : {&shape.q_sd, &shape.marker_error}) values->clear();
  mechanism->torques = torques || given.forces;
  mechanism->has_mass = out.record.mass_kg > 0.0;
  if (!mechanism->has_mass)
    out.notes.push_back(
        fmt::format("model '{}' has no masses: neither the mass centre nor angular momentum is "
                    "measured",
                    model.description().name));
  for (const auto& marker : model.markers())
    if (const auto side = foot_side(model, marker.body)) {
      mechanism->points.push_back({marker.body, marker.x_in_body});
      mechanism->sides.push_back(*side);
    }
  if (mechanism->points.empty() && mechanism->has_mass)
    out.notes.emplace_back(
        "no marker of the model is on a foot of a side (calcn_r, foot_l, toes_r): there are "
        "no margins of stability");
  if (mechanism->torques)
    if (auto s = put_torques(given, rated, threads, *mechanism, out); !s) return std::unexpected(s.error());
  out.mechanics = [mechanism](analysis::BodySeries& series) { return (*mechanism)(series); };
  return out;
}

Status unknown_coordinate(const std::string& name, const std::vector<std::string>& names) {
  const auto nearest = nearest_names(name, names);
  return fail(Code::usage, fmt::format("the model has no coordinate '{}' that moves by itself{}", name,
                                       nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
}

/// Coordinates that a name or a pattern stands for, among those that are measured.
Result<std::vector<Eigen::Index>> coordinates_of(const std::string& text,
                                                 const analysis::BodyRecord& record) {
  std::vector<Eigen::Index> out;
  std::vector<std::string> names;
  for (Eigen::Index c = 0; c < record.size(); ++c) {
    if (!record.measured[at(c)]) continue;
    names.push_back(record.names[at(c)]);
    if (matches_name_pattern(text, names.back())) out.push_back(c);
  }
  if (!out.empty()) return out;
  return std::unexpected(unknown_coordinate(text, names).error());
}

Status choose(const MotionMeasureOptions& asked, const analysis::BodyRecord& record,
              analysis::BodyMeasureOptions& options) {
  for (const auto& text : asked.select) {
    const auto some = coordinates_of(text, record);
    if (!some) return std::unexpected(some.error());
    options.coordinates.insert(options.coordinates.end(), some->begin(), some->end());
  }
  for (const auto& text : asked.couple) {
    const auto comma = text.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not two coordinates: hip_flexion_r,knee_angle_r", text));
    const auto a = coordinates_of(text.substr(0, comma), record);
    if (!a) return std::unexpected(a.error());
    const auto b = coordinates_of(text.substr(comma + 1), record);
    if (!b) return std::unexpected(b.error());
    if (a->size() != 1 || b->size() != 1 || a->front() == b->front())
      return fail(Code::usage, fmt::format("'{}' is not two coordinates, one and another", text));
    options.pairs.emplace_back(a->front(), b->front());
  }
  return {};
}

/// No refits where the errors are not known, and what intervals do not hold.
void settle_intervals(const MotionMeasureOptions& asked, const GivenMotion& given,
                      const data::JointMotion& motion, analysis::BodyMeasureOptions& options,
                      std::vector<std::string>& warnings) {
  if (asked.cutoff_hz > 0.0 && asked.refits > 0) {
    options.refits = 0;
    warnings.push_back(
        fmt::format("coordinates were low-passed at {:g} Hz: what that leaves of their noise "
                    "is not known, and there are no intervals",
                    asked.cutoff_hz));
  }
  if (options.refits > 0 && std::ranges::none_of(motion.q_sd, [](double sd) { return std::isfinite(sd); }))
    warnings.push_back(
        fmt::format("{}: intervals hold the errors that its samples show, not those of skin and markers",
                    given.names.no_deviations));
}

}  // namespace

Result<MotionMeasured> measure_motion(const model::Model& model, const GivenMotion& given,
                                      const MotionMeasureOptions& asked) {
  auto rated = internal::rate_motion(model, given, asked.cutoff_hz);
  if (!rated) return std::unexpected(rated.error());
  auto input = body_input(model, given, *rated, asked.torques, asked.threads);
  if (!input) return std::unexpected(input.error());
  MotionMeasured found;
  found.remarks.warnings = std::move(input->notes);
  internal::hold_motion(model, given, !asked.torques && !given.forces, found.remarks);
  analysis::BodyMeasureOptions options{.measures = asked.measures,
                                       .stretches = asked.stretches,
                                       .normalized = asked.normalized,
                                       .refits = asked.refits,
                                       .level = asked.level,
                                       .seed = asked.seed,
                                       .threads = asked.threads};
  settle_intervals(asked, given, rated->motion, options, found.remarks.warnings);
  if (auto s = choose(asked, input->record, options); !s) return std::unexpected(s.error());
  auto measured = analysis::measure_body(input->record, input->mechanics, options);
  if (!measured)
    return measured.error().code == Code::usage ? std::unexpected(measured.error())
                                                : fail_at(given.names.motion, measured.error());
  if (measured->measures.empty())
    return fail(Code::bad_input, fmt::format("{}: nothing of what is asked for can be measured; torques need "
                                             "--forces or --torques, coupling needs --couple",
                                             given.names.motion));
  found.measures = std::move(measured->measures);
  found.left_out = std::move(measured->notes);
  found.motion = std::move(rated->motion);
  found.record = std::move(input->record);
  return found;
}

}  // namespace kinemark::workflow
