// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/internal/robot_xml.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <sstream>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"

namespace kinemark::io::robot {

namespace {
constexpr std::size_t kNamed = 8;
constexpr double kLeastMoment = 1e-9, kLeastShare = 1e-6;

/// Whether a rigid body can have it: principal moments above 0, none above the sum of the others.
bool is_inertia(const Eigen::Matrix3d& inertia_about_com) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia_about_com, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& moments = eigen.eigenvalues();  // increasing
  return moments(0) > 0.0 && moments(2) <= (moments(0) + moments(1)) * (1.0 + 1e-9);
}
}  // namespace

std::string number(double value) { return fmt::format("{}", value); }

std::string numbers(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, "  ");
  return out.str();
}

Eigen::Matrix3d positive_inertia(const data::BodyDescription& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(body.inertia_about_com);
  if (eigen.eigenvalues()(0) > 0.0) return body.inertia_about_com;
  const double least = std::max(kLeastMoment, kLeastShare * eigen.eigenvalues()(2));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least).asDiagonal() *
         eigen.eigenvectors().transpose();
}

void set_bounds(pugi::xml_node compiler, const data::ModelDescription& model,
                std::vector<std::string>& lost) {
  std::vector<std::string> odd, light;
  for (const auto& body : model.bodies) {
    if (!(body.mass > 0.0))
      light.push_back(body.name);
    else if (!is_inertia(body.inertia_about_com))
      odd.push_back(body.name);
  }
  set(compiler, "balanceinertia", odd.empty() ? "false" : "true");
  set(compiler, "boundmass", "1e-9");
  set(compiler, "boundinertia", "1e-12");
  if (!odd.empty())
    lost.push_back(
        fmt::format("the inertia of {}, which no rigid body can have, is changed to one that it can: {}",
                    counted(std::ssize(odd), "body", "bodies"), join_some(odd, kNamed)));
  if (!light.empty())
    lost.push_back(fmt::format("{} without mass {} 1e-9 kg in MuJoCo: {}",
                               counted(std::ssize(light), "body", "bodies"),
                               light.size() == 1 ? "gets" : "get", join_some(light, kNamed)));
}

}  // namespace kinemark::io::robot
