// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion {
namespace {

using data::kGround;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSmallest = 0.2, kLargest = 5.0;  // factors beyond are mistakes

/// Inertia of a body whose points x become D x: its second moments become D A D.
Matrix3d stretched_inertia(const Matrix3d& inertia, const Vector3d& factors) {
  const Matrix3d second = 0.5 * inertia.trace() * Matrix3d::Identity() - inertia;
  const Matrix3d after = factors.asDiagonal() * second * factors.asDiagonal();
  return after.trace() * Matrix3d::Identity() - after;
}

/// Marker positions of the model in its default pose, world.
Result<Eigen::Matrix3Xd> default_positions(const data::ModelDescription& model) {
  const auto compiled = model::Model::compile(model);
  if (!compiled) return std::unexpected(compiled.error());
  model::Workspace w(*compiled);
  model::kinematics(*compiled, w, compiled->default_state());
  return w.marker;
}

struct Scaler {
  const data::ModelDescription& model;
  const data::Trajectories* recording;
  const data::ScaleRecipe& recipe;
  ScaleResult result;

  Status set(const std::string& owner, const std::string& body, const Vector3d& factors,
             const Vector3d& axes) {
    const int b = model.find_body(body);
    if (b == kGround) return {};  // OpenSim writes the ground into its sets
    if (b < 0)
      return fail(Code::bad_input,
                  fmt::format("{} names body '{}', which the model does not have", owner, body));
    for (int a = 0; a < 3; ++a) {
      if (axes[a] == 0.0) continue;
      if (!(factors[a] >= kSmallest && factors[a] <= kLargest))
        return fail(Code::bad_input,
                    fmt::format("{} scales body '{}' by {:.4g}; need {} to {}, more looks like "
                                "swapped markers or a wrong unit",
                                owner, body, factors[a], kSmallest, kLargest));
      result.factors[at(b)].factors[a] = factors[a];
    }
    return {};
  }

  [[nodiscard]] std::vector<std::string> marker_names() const {
    std::vector<std::string> names;
    for (const auto& marker : model.markers) names.push_back(marker.name);
    return names;
  }

  Result<MeasuredPair> measure(const data::ScaleMeasurement& measurement, const data::MarkerPair& pair,
                               const Eigen::Matrix3Xd& positions) const {
    MeasuredPair out{.first = pair.first, .second = pair.second};
    const data::NameIndex index(recording->names);
    std::int64_t recorded[2];
    int modelled[2];
    for (int i = 0; i < 2; ++i) {
      const std::string& name = i == 0 ? pair.first : pair.second;
      recorded[i] = index.find(name);
      modelled[i] = model.find_marker(name);
      if (modelled[i] < 0)
        return fail(Code::bad_input,
                    fmt::format("measurement '{}' needs marker '{}', which the model does not have",
                                measurement.name, name));
      if (recorded[i] < 0)
        return fail(
            Code::bad_input,
            fmt::format("measurement '{}' needs marker '{}', which the recording does not have; it has {}{}",
                        measurement.name, name, index.instead_of(name),
                        data::rename_proposal(marker_names(), recording->names)));
    }
    out.model_m = (positions.col(modelled[0]) - positions.col(modelled[1])).norm();
    if (out.model_m < 1e-6)
      return fail(Code::bad_input,
                  fmt::format("measurement '{}': '{}' and '{}' are at one place in the model",
                              measurement.name, pair.first, pair.second));
    double sum = 0.0, squares = 0.0, count = 0.0;
    const double slack = kTimeSlack / recording->time.rate_hz;
    for (std::int64_t f = 0; f < recording->frames(); ++f) {
      const double t = recording->time.time_s(f);
      if (t < recipe.first_time_s - slack || t > recipe.last_time_s + slack) continue;
      if (!recording->present(f, recorded[0]) || !recording->present(f, recorded[1])) continue;
      const double d = (recording->x(f, recorded[0]) - recording->x(f, recorded[1])).norm();
      sum += d;
      squares += d * d;
      count += 1.0;
    }
    if (count == 0.0)
      return fail(Code::bad_input,
                  fmt::format("measurement '{}': no frame of the time range shows both '{}' and '{}'",
                              measurement.name, pair.first, pair.second));
    out.measured_m = sum / count;
    out.measured_sd_m = std::sqrt(std::max(0.0, squares / count - out.measured_m * out.measured_m));
    return out;
  }

  Status measure_all() {
    if (recipe.measurements.empty()) return {};
    if (recording == nullptr)
      return fail(Code::usage, "measurements need a static trial; give one or leave them out");
    const auto positions = default_positions(model);
    if (!positions) return std::unexpected(positions.error());
    for (const auto& measurement : recipe.measurements) {
      if (measurement.pairs.empty())
        return fail(Code::bad_input, fmt::format("measurement '{}' has no marker pair", measurement.name));
      MeasurementResult out{.name = measurement.name, .factor = 0.0};
      for (const auto& pair : measurement.pairs) {
        auto measured = measure(measurement, pair, *positions);
        if (!measured) return std::unexpected(measured.error());
        out.factor +=
            measured->measured_m / measured->model_m / static_cast<double>(measurement.pairs.size());
        out.pairs.push_back(std::move(*measured));
      }
      // OpenSim passes over bodies that the model lacks (its own setups name patellae); but not all of them.
      const auto missing = [&](const auto& part) {
        const int b = model.find_body(part.body);
        return b < 0 && b != kGround;
      };
      const bool some = !std::ranges::all_of(measurement.bodies, missing);
      for (const auto& part : measurement.bodies) {
        if (some && missing(part)) continue;
        if (auto s = set(fmt::format("measurement '{}'", measurement.name), part.body,
                         Vector3d::Constant(out.factor), part.axes);
            !s)
          return s;
      }
      result.measurements.push_back(std::move(out));
    }
    return {};
  }

  Status set_manual() {
    for (const auto& manual : recipe.manual)
      if (auto s = set("a manual scale", manual.body, manual.factors, Vector3d::Ones()); !s) return s;
    return {};
  }
};

/// A massless body between two others belongs to the one that hangs on it.
void fill_between(const data::ModelDescription& model, std::vector<data::BodyFactors>& factors) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!model.bodies[b].name.ends_with("_intermediate") || factors[b].factors != Vector3d::Ones()) continue;
    for (const auto& joint : model.joints)
      if (joint.parent_body_idx == static_cast<int>(b))
        factors[b].factors = factors[at(joint.child_body_idx)].factors;
  }
}

}  // namespace

void apply_factors(data::ModelDescription& model, std::span<const Vector3d> factors, bool scale_mass) {
  const auto of = [&](int body) -> Vector3d {
    if (body == kGround) return Vector3d::Ones();
    return factors[at(body)];
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    auto& body = model.bodies[b];
    body.com_in_body = body.com_in_body.cwiseProduct(factors[b]);
    body.inertia_about_com = stretched_inertia(body.inertia_about_com, factors[b]);
    if (!scale_mass) continue;
    body.mass *= factors[b].prod();
    body.inertia_about_com *= factors[b].prod();
  }
  for (auto& joint : model.joints) {
    const Vector3d parent = of(joint.parent_body_idx), child = of(joint.child_body_idx);
    for (auto& axis : joint.axes) {
      if (axis.is_rotation || (axis.function.is_identity() && axis.second_coordinate_idx < 0)) continue;
      // The parent's factors count along the axes of the joint's frame, also where that is turned: OpenSim's
      // rule.
      const Vector3d along = axis.axis.normalized();
      const double factor = along.cwiseAbs2().dot(parent);
      if (factor != 1.0) axis.function = axis.function.scaled(factor);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(3, joint.parameters.size()); ++i)
      joint.parameters[i] *= parent[static_cast<Eigen::Index>(i)];
    joint.parent_from_joint.translation = joint.parent_from_joint.translation.cwiseProduct(parent);
    joint.child_from_joint.translation = joint.child_from_joint.translation.cwiseProduct(child);
  }
  for (auto& marker : model.markers) marker.x_in_body = marker.x_in_body.cwiseProduct(of(marker.body_idx));
  for (auto& loop : model.point_constraints) {
    loop.point_in_a = loop.point_in_a.cwiseProduct(of(loop.body_a_idx));
    loop.point_in_b = loop.point_in_b.cwiseProduct(of(loop.body_b_idx));
  }
}

Result<double> find_overall_size(const data::ModelDescription& model, const data::Trajectories& recording) {
  constexpr std::int64_t kFrames = 500;
  double measured = 0.0, modelled = 0.0;
  const auto& markers = model.markers;
  const data::NameIndex index(recording.names);
  for (std::size_t i = 0; i < markers.size(); ++i)
    for (std::size_t j = i + 1; j < markers.size(); ++j) {
      if (markers[i].body_idx != markers[j].body_idx) continue;
      const auto a = index.find(markers[i].name), b = index.find(markers[j].name);
      if (a < 0 || b < 0) continue;
      double sum = 0.0, count = 0.0;
      for (std::int64_t f = 0; f < recording.frames(); f += 1 + recording.frames() / kFrames) {
        if (!recording.present(f, a) || !recording.present(f, b)) continue;
        sum += (recording.x(f, a) - recording.x(f, b)).norm();
        count += 1.0;
      }
      if (count == 0.0) continue;
      measured += sum / count;
      modelled += (markers[i].x_in_body - markers[j].x_in_body).norm();
    }
  if (measured == 0.0 || modelled == 0.0) return 1.0;
  const double size = measured / modelled;
  if (!(size > kSmallest && size < kLargest))
    return fail(Code::bad_input,
                fmt::format("markers lie {:.3g} times as far apart as in the model; that looks like "
                            "a wrong unit or a wrong model",
                            size));
  return size;
}

Status set_total_mass(data::ModelDescription& model, double mass_kg) {
  double total = 0.0;
  for (const auto& body : model.bodies) total += body.mass;
  if (!(mass_kg > 0.0) || !std::isfinite(mass_kg))
    return fail(Code::usage, fmt::format("a subject's mass of {} kg; need a number above 0", mass_kg));
  if (total <= 0.0)
    return fail(Code::bad_input,
                fmt::format("model '{}' has no mass that could be scaled to {} kg", model.name, mass_kg));
  for (auto& body : model.bodies) {
    body.mass *= mass_kg / total;
    body.inertia_about_com *= mass_kg / total;
  }
  return {};
}

Result<ScaleResult> scale_model(const data::ModelDescription& model, const data::Trajectories* recording,
                                const data::ScaleRecipe& recipe) {
  if (auto s = model.validate(); !s) return std::unexpected(s.error());
  Scaler scaler{.model = model, .recording = recording, .recipe = recipe, .result = {}};
  for (const auto& body : model.bodies) scaler.result.factors.push_back({.body = body.name});
  for (const data::ScaleStep step : recipe.order)
    if (auto s = step == data::ScaleStep::measurements ? scaler.measure_all() : scaler.set_manual(); !s)
      return std::unexpected(s.error());
  ScaleResult& result = scaler.result;
  fill_between(model, result.factors);
  std::vector<Vector3d> factors;
  for (const auto& body : result.factors) factors.push_back(body.factors);
  result.model = model;
  apply_factors(result.model, factors, !recipe.preserve_mass_distribution);
  if (recipe.mass_kg != 0.0)
    if (auto s = set_total_mass(result.model, recipe.mass_kg); !s) return std::unexpected(s.error());
  return std::move(result);
}

}  // namespace kinemark::motion
