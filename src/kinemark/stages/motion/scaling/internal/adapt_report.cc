// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/adapt_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kDeterminedShare =
    0.5;  // share of its prior that a determined parameter's deviation stays below

/// Derivative of a length by every parameter.
VectorXd slope(const std::vector<GeometryParameter>& parameters, const SegmentLength& length,
               const Eigen::Vector3d& span) {
  VectorXd gradient = VectorXd::Zero(static_cast<Index>(parameters.size()));
  for (Index k = 0; k < gradient.size(); ++k)
    for (const auto& term : parameters[at(k)].terms) {
      const bool far = term.moves == GeometryTerm::Moves::parent_frame && term.idx == length.second_joint;
      const bool near = term.moves == GeometryTerm::Moves::child_frame && term.idx == length.first_joint;
      if (far || near) gradient[k] += (far ? 1.0 : -1.0) * span.dot(term.direction) / span.norm();
    }
  return gradient;
}

}  // namespace

void describe(const data::ModelDescription& model, const std::vector<GeometryParameter>& parameters,
              const VectorXd& change, const Eigen::MatrixXd& data_covariance, AdaptResult& result) {
  result.model = apply_geometry(model, parameters, change);
  for (Index k = 0; k < change.size(); ++k) {
    const auto& parameter = parameters[at(k)];
    AdaptedParameter out{.name = parameter.name,
                         .kind = parameter.kind,
                         .initial = parameter.initial,
                         .value = parameter.initial + change[k],
                         .prior_sd = parameter.prior_sd,
                         .sd = std::sqrt(std::max(0.0, result.covariance(k, k))),
                         .data_sd = std::sqrt(std::max(0.0, data_covariance(k, k)))};
    const bool position = parameter.kind == ParameterKind::marker_position;
    out.determined = (position ? out.sd : out.data_sd) < kDeterminedShare * parameter.prior_sd;
    if (!out.determined && !position) result.not_determined.push_back(parameter.name);
    result.parameters.push_back(std::move(out));
  }
  for (const auto& length : segment_lengths(model)) {
    const auto& own = result.model.joints[at(length.first_joint)].child_from_joint.translation;
    const auto& next = result.model.joints[at(length.second_joint)].parent_from_joint.translation;
    const Eigen::Vector3d span = next - own;
    const VectorXd gradient = slope(parameters, length, span);
    if (gradient.norm() == 0.0) continue;  // not adapted
    double prior = 0.0;
    for (Index k = 0; k < gradient.size(); ++k)
      prior += std::pow(gradient[k] * parameters[at(k)].prior_sd, 2);
    const double share = std::sqrt(gradient.dot(data_covariance * gradient) / prior);
    AdaptedLength out{.name = length.name,
                      .initial_m = length.length_m,
                      .length_m = span.norm(),
                      .sd_m = std::sqrt(gradient.dot(result.covariance * gradient)),
                      .determined = share < kDeterminedShare};
    if (!out.determined) result.not_determined.push_back(length.name);
    result.lengths.push_back(std::move(out));
  }
}

}  // namespace kinemark::motion::internal
