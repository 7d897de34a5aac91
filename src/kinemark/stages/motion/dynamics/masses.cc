// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/masses.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using Kind = MassFault::Kind;

constexpr double kRounding = 1e-3;       // of the largest moment: digits of files
constexpr double kMatters = 0.01;        // of the largest sound moment
constexpr double kWater_kg_m3 = 1000.0;  // flesh and bone are about as dense

/// The largest distance of two joints or markers in the default posture, along the axes of a box: at most a
/// factor of 1.7 above the largest distance itself.
double span_of(const model::Model& model) {
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  Eigen::AlignedBox3d box;
  for (std::size_t b = 0; b < model.bodies().size(); ++b)
    box.extend(model::point_in_world(w, static_cast<int>(b), Vector3d::Zero()));
  for (Eigen::Index m = 0; m < w.marker.cols(); ++m) box.extend(Vector3d(w.marker.col(m)));
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

Vector3d principal_moments(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

/// Moments that no rigid body has; the worse of the two where both hold.
void judge_moments(const std::string& body, const Vector3d& moments, std::vector<MassFault>& out) {
  const double excess = moments[2] - moments[1] - moments[0];
  if (moments[0] < -kRounding * moments.cwiseAbs().maxCoeff())
    out.push_back({.kind = Kind::negative_moment, .body = body, .size = moments[0]});
  else if (excess > kRounding * moments[2])
    out.push_back({.kind = Kind::triangle, .body = body, .size = excess});
}

}  // namespace

std::string MassFault::sentence() const {
  switch (kind) {
    case Kind::negative_moment:
      return fmt::format("body '{}' has a negative moment of inertia, {:.3g} kg m^2", body, size);
    case Kind::triangle:
      return fmt::format(
          "body '{}' has a moment of inertia that exceeds the other two together, by {:.3g} kg m^2: no "
          "rigid body has",
          body, size);
    case Kind::gyration:
      return fmt::format(
          "the inertia of body '{}' is that of a mass {:.3g} m from its centre, and the whole model "
          "spans {:.3g} m",
          body, size, bound);
    case Kind::centre:
      return fmt::format(
          "the mass centre of body '{}' lies {:.3g} m from its origin, and the whole model spans "
          "{:.3g} m",
          body, size, bound);
    case Kind::mass:
      return fmt::format(
          "the bodies weigh {:.4g} kg; a ball of water twice as wide as the model weighs {:.3g} kg", size,
          bound);
  }
  return "";
}

std::vector<MassFault> find_mass_faults(const model::Model& model) {
  std::vector<MassFault> out;
  std::vector<double> weight;  // kg m^2, of each fault: what torques could show of it
  const double span = span_of(model);
  double mass = 0.0, largest = 0.0;
  for (const auto& body : model.description().bodies) {
    mass += body.mass;
    const std::size_t before = out.size();
    const Vector3d moments = principal_moments(body.inertia_about_com);
    judge_moments(body.name, moments, out);
    if (out.size() > before) weight.push_back(std::abs(out.back().size));
    if (body.mass > 0.0 && span > 0.0) {
      const double gyration = std::sqrt(std::max(0.0, moments[2]) / body.mass);
      if (gyration > span) {
        out.push_back({.kind = Kind::gyration, .body = body.name, .size = gyration, .bound = span});
        weight.push_back(moments[2]);
      }
      if (const double away = body.com_in_body.norm(); away > span) {
        out.push_back({.kind = Kind::centre, .body = body.name, .size = away, .bound = span});
        weight.push_back(body.mass * away * away);
      }
    }
    if (out.size() == before) largest = std::max(largest, moments[2]);
  }
  for (std::size_t k = 0; k < out.size(); ++k) out[k].matters = weight[k] > kMatters * largest;
  // Twice: a trunk that bears the modelled limb may have no points of its own.
  const double wide = 2.0 * span, most = kWater_kg_m3 * std::numbers::pi / 6.0 * wide * wide * wide;
  if (span > 0.0 && mass > most) out.push_back({.kind = Kind::mass, .body = "", .size = mass, .bound = most});
  return out;
}

}  // namespace kinemark::motion
