// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/internal/grow.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/motion/scaling/masses.h"
#include "kinemark/stages/motion/scaling/muscles.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;

/// Sizes, then positions of markers, then of measured joints.
Result<std::vector<motion::GeometryParameter>> parameters_of(const ScaleMethod& method,
                                                             const std::vector<motion::ScaleGroup>& groups,
                                                             const ScaleFound& found) {
  auto parameters = motion::scale_parameters(found.model, groups, method.size_prior_sd);
  if (!parameters) return parameters;
  const auto positions = motion::marker_parameters(found.model, {}, method.position_prior_sd_m);
  if (!positions) return positions;
  parameters->insert(parameters->end(), positions->begin(), positions->end());
  if (found.joints.empty()) return parameters;
  const auto joints = motion::joint_parameters(found.model, found.joints, method.joint_prior_sd_m);
  if (!joints) return joints;
  parameters->insert(parameters->end(), joints->begin(), joints->end());
  return parameters;
}

/// Factor of each body by the sizes that were found; other parameters carry other names.
std::vector<Vector3d> factors_of(const motion::AdaptResult& adapted,
                                 const std::vector<motion::ScaleGroup>& groups,
                                 const data::ModelDescription& model) {
  std::vector<Vector3d> factors(model.bodies.size(), Vector3d::Ones());
  for (const auto& parameter : adapted.parameters)
    for (const auto& group : groups)
      for (const auto& part : group.parts)
        if (parameter.kind == motion::ParameterKind::body_scale && group.name == parameter.name)
          factors[at(model.find_body(part.body))] += (parameter.value - parameter.initial) * part.axes;
  return factors;
}

}  // namespace

Status take_overall_size(const data::Trajectories& markers, ScaleFound& found) {
  const auto size = motion::find_overall_size(found.model, markers);
  if (!size) return std::unexpected(size.error());
  const std::vector<Vector3d> factors(found.model.bodies.size(), Vector3d::Constant(*size));
  motion::apply_factors(found.model, factors, true);
  for (auto& factor : found.factors) factor.factors *= *size;
  return {};
}

Result<motion::AdaptResult> adapt_to(const data::Trajectories& markers, const ScaleMethod& method,
                                     const motion::AdaptOptions& options, const Progress& progress,
                                     ScaleFound& found) {
  const auto groups = motion::default_scale_groups(found.model, method.symmetric);
  const auto parameters = parameters_of(method, groups, found);
  if (!parameters) return std::unexpected(parameters.error());
  auto adapted = motion::adapt_model(found.model, markers, *parameters, options, progress);
  if (!adapted) return adapted;
  const auto factors = factors_of(*adapted, groups, found.model);
  motion::apply_factors(found.model, factors, true);
  auto bodies = std::move(found.model.bodies);
  found.model = adapted->model;
  found.model.bodies = std::move(bodies);
  for (std::size_t b = 0; b < factors.size(); ++b)
    found.factors[b].factors = found.factors[b].factors.cwiseProduct(factors[b]);
  return adapted;
}

Status weigh(double mass_kg, bool dempster, data::ModelDescription& model) {
  if (mass_kg == 0.0) return {};
  return dempster ? motion::distribute_mass(model, mass_kg) : motion::set_total_mass(model, mass_kg);
}

Status scale_muscles(const data::ModelDescription& before, const ScaleInputs& inputs, ScaleFound& found) {
  auto& warnings = found.remarks.warnings;
  if (!inputs.paths_fault.empty()) {
    warnings.push_back(
        fmt::format("The lengths of muscles at rest stay as they are, because their paths cannot be read: {}",
                    inputs.paths_fault));
    return {};
  }
  std::vector<Vector3d> factors;
  for (std::size_t b = 0; b < before.bodies.size(); ++b) factors.push_back(found.factors[b].factors);
  auto scales = motion::scale_paths(before, found.model, inputs.paths, factors);
  if (!scales) return std::unexpected(scales.error());
  found.muscles = std::move(*scales);
  std::vector<std::string> wrapped;
  for (const auto& muscle : found.muscles)
    if (muscle.wraps) wrapped.push_back(muscle.name);
  if (!wrapped.empty())
    warnings.push_back(
        fmt::format("Lengths at rest follow paths that bend around cylinders only; these may also meet "
                    "other surfaces: {}",
                    join(wrapped)));
  return {};
}

}  // namespace kinemark::workflow
