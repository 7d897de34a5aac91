// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/torques.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/dynamics/masses.h"
#include "kinemark/workflow/motion/gates.h"
#include "kinemark/workflow/prepare/turn.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;

bool known(const data::Wrench& wrench, std::int64_t f) {
  return Eigen::Map<const Vector3d>(wrench.force.data() + 3 * f).allFinite() &&
         Eigen::Map<const Vector3d>(wrench.moment.data() + 3 * f).allFinite();
}

std::string length(std::int64_t frames, const TimeBase& time) {
  return fmt::format("{:.3f} s ({} of {} frames)", static_cast<double>(frames) / time.rate_hz, frames,
                     time.frames);
}

/// "foot_r 0.400 to 1.050 s, foot_l 1.600 to 2.100 s".
std::string contacts_of(const std::string& wrench, const std::vector<motion::Contact>& contacts,
                        const TimeBase& time) {
  constexpr int kMost = 20;
  std::string text;
  int count = 0;
  for (const auto& contact : contacts) {
    if (contact.wrench != wrench) continue;
    if (++count > kMost) continue;
    text += fmt::format("{}{} {:.3f} to {:.3f} s", text.empty() ? "" : ", ", contact.body,
                        time.time_s(contact.first_frame), time.time_s(contact.last_frame));
  }
  if (count > kMost) text += fmt::format(" and {} more", count - kMost);
  return text.empty() ? "on nothing" : "on " + text;
}

/// From where a force acts to the mass centre of the body that it was given to, along the floor: the mean,
/// weighted with the force. 0 for a force that is small all the time, whose place is not known well.
double distance_m(const model::Model& model, const data::JointMotion& motion, const data::Wrench& wrench,
                  const motion::Contact& contact, double small_n) {
  const auto& bodies = model.bodies();
  const auto body = std::ranges::find(bodies, contact.body, [&](const auto& one) {
    return model.description().bodies[at(one.description_idx)].name;
  });
  const Vector3d up = up_of(model).value_or(Vector3d::Zero());
  model::Workspace w(model);
  double sum = 0.0, force_n = 0.0, most_n = 0.0;
  const std::int64_t stride = 1 + (contact.last_frame - contact.first_frame) / 20;
  for (std::int64_t f = contact.first_frame; f <= contact.last_frame; f += stride) {
    const Eigen::Map<const Eigen::VectorXd> q(motion.q.data() + motion.index(f, 0), motion.size());
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    const Vector3d apart =
        model::point_in_world(w, static_cast<int>(body - bodies.begin()), body->com_in_body) -
        Eigen::Map<const Vector3d>(wrench.point.data() + 3 * f);
    const double size_n = Eigen::Map<const Vector3d>(wrench.force.data() + 3 * f).norm();
    sum += size_n * (apart - apart.dot(up) * up).norm();
    force_n += size_n;
    most_n = std::max(most_n, size_n);
  }
  return most_n > small_n ? sum / force_n : 0.0;
}

/// A plate's force is given to the foot nearest to it, however far that is.
void check_nearness(const model::Model& model, const data::JointMotion& motion,
                    const data::Wrenches& wrenches, const motion::DynamicsSummary& dynamics,
                    TorqueAccount& account) {
  constexpr double kFar_m = 0.5;  // a foot that bears a force has its mass centre nearer
  constexpr double kSmall = 0.1;  // of the body weight
  for (const auto& wrench : wrenches.items) {
    if (!wrench.body.empty()) continue;
    const motion::Contact* farthest = nullptr;
    double most_m = kFar_m;
    for (const auto& contact : dynamics.contacts) {
      if (contact.wrench != wrench.name) continue;
      const double apart_m = distance_m(model, motion, wrench, contact, kSmall * dynamics.body_weight_n);
      if (apart_m > most_m) most_m = apart_m, farthest = &contact;
    }
    if (farthest != nullptr)
      account.warnings.push_back(fmt::format(
          "the force of '{}' acts {:.2f} m beside '{}', the body nearest to it, from {:.3f} to {:.3f} s: "
          "somebody "
          "else on the plate, or a plate that lies elsewhere; the torques hold it as if that body bore it",
          wrench.name, most_m, farthest->body, wrenches.time.time_s(farthest->first_frame),
          wrenches.time.time_s(farthest->last_frame)));
  }
}

void tell_forces(const data::Wrenches& wrenches, const motion::DynamicsSummary& dynamics,
                 TorqueAccount& account) {
  std::int64_t unknown = 0;
  for (std::int64_t f = 0; f < wrenches.frames(); ++f) {
    bool all = true;
    for (const auto& wrench : wrenches.items) all = all && known(wrench, f);
    unknown += !all;
  }
  for (const auto& wrench : wrenches.items)
    account.facts.emplace_back("force of " + wrench.name,
                               contacts_of(wrench.name, dynamics.contacts, wrenches.time));
  account.facts.emplace_back("forces not known for", length(unknown, wrenches.time));
}

/// Feet that bear load beside the plates: the torques of their limbs are not determined there.
void tell_unmeasured(const motion::DynamicsSummary& dynamics, const TimeBase& time, TorqueAccount& account) {
  std::vector<std::string> bodies;
  for (const auto& contact : dynamics.unmeasured)
    if (std::ranges::find(bodies, contact.body) == bodies.end()) bodies.push_back(contact.body);
  for (const auto& body : bodies) {
    std::int64_t frames = 0;
    double most_n = 0.0;
    std::string when;
    for (const auto& contact : dynamics.unmeasured) {
      if (contact.body != body) continue;
      frames += contact.last_frame - contact.first_frame + 1;
      most_n = std::max(most_n, contact.force_max_n);
      when += fmt::format("{}{:.3f} to {:.3f} s", when.empty() ? "" : ", ", time.time_s(contact.first_frame),
                          time.time_s(contact.last_frame));
    }
    account.facts.emplace_back("load on '" + body + "' that no plate measures", when);
    account.warnings.push_back(fmt::format(
        "'{}' bears up to {:.0f} N that no plate measures for {}: the torques of its limb are not "
        "determined there and stand as nan",
        body, most_n, length(frames, time)));
  }
}

/// Where no force says what is up, the body does: its mass centre lies above its feet, unless it lies down.
void check_posture(const model::Model& model, const motion::DynamicsSummary& dynamics,
                   TorqueAccount& account) {
  if (dynamics.feet_to_centre.isZero()) return;
  const auto up = up_of(model);
  const Vector3d body = dynamics.feet_to_centre.normalized();
  if (!up || body.dot(*up) > std::cos(45.0 * kRadPerDeg)) return;
  account.warnings.push_back(fmt::format(
      "the body stands along {} on average, from its feet to its mass centre, and up in the model is {}: "
      "either it lies, or markers and model have different axes (--up) and the torques a wrong gravity",
      name_of_direction(body), name_of_direction(*up)));
}

void tell_roots(const motion::DynamicsSummary& dynamics, bool with_forces, TorqueAccount& account) {
  for (const auto& root : dynamics.roots) {
    const auto carried = fmt::format("{:.0f} N and {:.0f} N m RMS (body weight {:.0f} N)", root.force_rms_n,
                                     root.moment_rms_nm, dynamics.body_weight_n);
    account.facts.emplace_back(fmt::format("left to the root '{}'", root.body), carried);
    if (!with_forces)
      account.warnings.push_back(
          fmt::format("torques are without force plates: '{}' is carried by {}, so that the torques of limbs "
                      "on the ground lack "
                      "the ground reaction",
                      root.body, carried));
    else if (root.force_rms_n > 0.1 * dynamics.body_weight_n)
      account.warnings.push_back(fmt::format(
          "with the given forces '{}' has a residual of {}: contact that no plate measures, or a misfit "
          "of model, motion "
          "and plates",
          root.body, carried));
  }
}

/// Torques are no better than the masses behind them.
void judge_masses(const model::Model& model, TorqueAccount& account) {
  std::int64_t matter = 0;
  for (const auto& fault : motion::find_mass_faults(model)) {
    account.warnings.push_back(fault.sentence() +
                               (fault.matters ? "" : "; it is too small to show in the torques"));
    matter += fault.matters;
  }
  add_gate(account.gates, "masses", static_cast<double>(matter), 0.0, "",
           matter == 0
               ? "Masses and inertias of the model are those that bodies of its size can have."
               : fmt::format("{} of the model's masses and inertias cannot be so (see the notes): its "
                             "torques are not those of a body.",
                             matter));
}

}  // namespace

Result<TorqueAccount> add_torques(const model::Model& model, data::JointMotion& motion,
                                  const data::Wrenches* forces, const motion::DynamicsOptions& options,
                                  const motion::RateErrors* errors) {
  TorqueAccount account;
  const auto dynamics = motion::inverse_dynamics(model, motion, options, forces, errors);
  if (!dynamics) return std::unexpected(dynamics.error());
  account.warnings.insert(account.warnings.end(), dynamics->warnings.begin(), dynamics->warnings.end());
  if (forces != nullptr) {
    tell_forces(*forces, *dynamics, account);
    check_nearness(model, motion, *forces, *dynamics, account);
    tell_unmeasured(*dynamics, motion.time, account);
  } else {
    check_posture(model, *dynamics, account);
  }
  tell_roots(*dynamics, forces != nullptr, account);
  judge_masses(model, account);
  return account;
}

}  // namespace kinemark::workflow
