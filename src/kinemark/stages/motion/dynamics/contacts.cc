// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/contacts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

Vector3d of_frame(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

Result<int> find_body(const model::Model& model, const std::string& name, const std::string& who) {
  const auto& bodies = model.description().bodies;
  const auto it = std::ranges::find(bodies, name, [](const auto& body) { return body.name; });
  if (it == bodies.end())
    return fail(Code::bad_input, fmt::format("{} names body '{}', which the model does not have", who, name));
  return model.body_of(static_cast<int>(it - bodies.begin()));
}

/// Where the mass centres of the feet are in one frame.
class Feet {
 public:
  Feet(const model::Model& model, const data::JointMotion& motion, std::vector<int> bodies)
      : model_(model), motion_(motion), bodies_(std::move(bodies)), w_(model) {}

  [[nodiscard]] int nearest(const data::Wrench& wrench, std::int64_t first, std::int64_t last) {
    Eigen::VectorXd distance = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bodies_.size()));
    const std::int64_t stride = 1 + (last - first) / 20;
    for (std::int64_t f = first; f <= last; f += stride) {
      const Eigen::Map<const Eigen::VectorXd> q(motion_.q.data() + motion_.index(f, 0), motion_.size());
      model::kinematics(model_, w_, model::state_from_coordinates(model_, q));
      for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const auto& body = model_.bodies()[at(bodies_[b])];
        distance[static_cast<Eigen::Index>(b)] +=
            (model::point_in_world(w_, bodies_[b], body.com_in_body) - of_frame(wrench.point, f)).norm();
      }
    }
    Eigen::Index best = 0;
    distance.minCoeff(&best);
    return bodies_[at(best)];
  }

 private:
  const model::Model& model_;
  const data::JointMotion& motion_;
  std::vector<int> bodies_;
  model::Workspace w_;
};

}  // namespace

Result<std::vector<int>> find_feet(const model::Model& model, const std::vector<std::string>& named) {
  std::vector<int> feet;
  for (const auto& name : named) {
    const auto body = find_body(model, name, "the list of feet");
    if (!body) return std::unexpected(body.error());
    feet.push_back(*body);
  }
  if (!feet.empty()) return feet;
  const auto& bodies = model.description().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::string name = bodies[b].name;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.find("calcn") != std::string::npos || name.find("foot") != std::string::npos)
      feet.push_back(model.body_of(static_cast<int>(b)));
  }
  return feet;
}

Result<ContactPlan> plan_contacts(const model::Model& model, const data::JointMotion& motion,
                                  const data::Wrenches& wrenches, std::vector<int> feet,
                                  double contact_force_n) {
  if (feet.empty())  // any body may touch a plate
    for (int b = 0; b < static_cast<int>(model.bodies().size()); ++b) feet.push_back(b);
  Feet paths(model, motion, std::move(feet));
  ContactPlan plan;
  const std::int64_t F = wrenches.frames();
  for (const auto& wrench : wrenches.items) {
    int given = data::kGround;
    if (!wrench.body.empty()) {
      const auto body = find_body(model, wrench.body, fmt::format("wrench '{}'", wrench.name));
      if (!body) return std::unexpected(body.error());
      given = *body;
    }
    auto& of_wrench = plan.body.emplace_back(at(F), data::kGround);
    // Unknown forces count as acting, so that they are not taken for none.
    const auto acts = [&](std::int64_t f) {
      return !(of_frame(wrench.force, f).norm() <= (wrench.body.empty() ? contact_force_n : 0.0)) ||
             (!wrench.body.empty() && of_frame(wrench.moment, f).norm() > 0.0);
    };
    const auto known = [&](std::int64_t f) { return of_frame(wrench.force, f).allFinite(); };
    for (std::int64_t f = 0; f < F; ++f) {
      if (!acts(f) || !known(f)) continue;
      std::int64_t last = f;
      while (last + 1 < F && acts(last + 1) && known(last + 1)) ++last;
      const int body = given >= 0 ? given : paths.nearest(wrench, f, last);
      std::fill(of_wrench.begin() + f, of_wrench.begin() + last + 1, body);
      plan.contacts.push_back({wrench.name,
                               model.description().bodies[at(model.bodies()[at(body)].description_idx)].name,
                               f, last});
      f = last;
    }
  }
  return plan;
}

}  // namespace kinemark::motion
