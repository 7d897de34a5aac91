// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/motion/dynamics/contacts.h"
#include "kinemark/stages/motion/dynamics/internal/frame_dynamics.h"
#include "kinemark/stages/motion/dynamics/internal/unmeasured_load.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using internal::AppliedForce;
using internal::FrameDynamics;
using internal::RootFrame;

constexpr double kGuessedSd = 0.5;  // rad or m, of a coordinate that is never determined

Vector3d of_frame(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

Status check_input(const model::Model& model, const data::JointMotion& motion,
                   const data::Wrenches* wrenches) {
  if (auto status = motion.validate(); !status) return status;
  if (motion.size() != model.coordinate_count())
    return fail(Code::bad_input, fmt::format("the motion has {} coordinates, the model {}", motion.size(),
                                             model.coordinate_count()));
  if (!model.point_constraints().empty())
    return fail(
        Code::not_supported,
        "the model has closed loops, whose inner forces do not follow from the motion; inverse dynamics "
        "needs a tree");
  if (std::ranges::all_of(model.bodies(), [](const auto& body) { return body.mass == 0.0; }))
    return fail(Code::bad_input, "no body of the model has a mass; torques need masses and inertias");
  for (const auto* rates : {&motion.qd, &motion.qdd})
    if (std::ranges::any_of(*rates, [](double r) { return !std::isfinite(r); }))
      return fail(Code::bad_input, "speeds or accelerations of the motion are not all finite numbers");
  if (!wrenches) return {};
  if (auto status = wrenches->validate(); !status) return status;
  if (wrenches->frames() != motion.frames() ||
      std::abs(wrenches->time.rate_hz - motion.time.rate_hz) > 1e-6 * motion.time.rate_hz)
    return fail(
        Code::bad_input,
        fmt::format("wrenches have {} frames at {} Hz, the motion {} frames at {} Hz; need the same",
                    wrenches->frames(), wrenches->time.rate_hz, motion.frames(), motion.time.rate_hz));
  return {};
}

/// Everything one thread needs to do a frame.
class Worker {
 public:
  Worker(const model::Model& model, const data::JointMotion& motion, const data::Wrenches* wrenches,
         const ContactPlan& plan)
      : motion_(motion), wrenches_(wrenches), plan_(plan), frame_(model) {
    for (auto* v : {&q_, &qd_, &qdd_}) v->setZero(model.coordinate_count());
  }

  /// False when something unknown acts in this frame.
  bool visit(std::int64_t f) {
    for (int c = 0; c < q_.size(); ++c) {
      const auto i = motion_.index(f, c);
      q_[c] = motion_.q[i];
      qd_[c] = motion_.qd[i];
      qdd_[c] = motion_.qdd[i];
    }
    std::vector<AppliedForce> applied;
    for (std::size_t k = 0; wrenches_ && k < wrenches_->items.size(); ++k) {
      const auto& wrench = wrenches_->items[k];
      const Vector3d force = of_frame(wrench.force, f), moment = of_frame(wrench.moment, f);
      if (!force.allFinite() || !moment.allFinite()) return false;
      if (plan_.body[k][at(f)] >= 0)
        applied.push_back({plan_.body[k][at(f)], force, moment, of_frame(wrench.point, f)});
    }
    frame_.set(q_, qd_, qdd_, std::move(applied));
    return true;
  }

  /// The residual of a root, and its feet, of the frame visited last.
  [[nodiscard]] RootFrame root_frame(std::int64_t f, const model::Model::FreeJoint& root,
                                     const std::vector<int>& feet) const {
    RootFrame out = frame_.root_frame(root, feet);
    for (const int foot : feet)
      out.on_plate.push_back(
          std::ranges::any_of(plan_.body, [&](const auto& of) { return of[at(f)] == foot; }));
    return out;
  }

  /// Variance of every coordinate's tau from the covariances (n x 6) of this frame.
  void propagate(const double* covariance, const double* q_sd, VectorXd& variance) {
    variance.setZero(q_.size());
    for (int c = 0; c < q_.size(); ++c) {
      const double* own = covariance + 6 * c;
      const bool never = std::isnan(own[0]);
      if (!never && std::all_of(own, own + 6, [](double x) { return x == 0.0; })) continue;
      if (!frame_.derivatives(c, by_q_, by_v_, by_a_)) continue;
      frame_.to_coordinates(by_q_, tau_by_q_);
      frame_.to_coordinates(by_v_, tau_by_v_);
      frame_.to_coordinates(by_a_, tau_by_a_);
      double qq = never ? kGuessedSd * kGuessedSd : own[0];
      if (q_sd && q_sd[c] * q_sd[c] > qq) qq = q_sd[c] * q_sd[c];
      variance.array() += qq * tau_by_q_.array().square();
      if (never) continue;
      variance.array() +=
          2.0 * tau_by_q_.array() * (own[1] * tau_by_v_.array() + own[2] * tau_by_a_.array()) +
          own[3] * tau_by_v_.array().square() + 2.0 * own[4] * tau_by_v_.array() * tau_by_a_.array() +
          own[5] * tau_by_a_.array().square();
    }
  }

  [[nodiscard]] const FrameDynamics& frame() const { return frame_; }

 private:
  const data::JointMotion& motion_;
  const data::Wrenches* wrenches_;
  const ContactPlan& plan_;
  FrameDynamics frame_;
  VectorXd q_, qd_, qdd_, by_q_, by_v_, by_a_, tau_by_q_, tau_by_v_, tau_by_a_;
};

std::string name_of(const model::Model& model, int body) {
  return model.description().bodies[at(model.bodies()[at(body)].description_idx)].name;
}

/// One free root: its body, the feet that hang from it, and its residual in every frame.
struct Root {
  const model::Model::FreeJoint* joint = nullptr;
  std::vector<int> feet;  ///< tree indices
  std::vector<RootFrame> frames;
};

std::vector<Root> make_roots(const model::Model& model, const std::vector<int>& feet, std::int64_t frames) {
  std::vector<Root> out;
  for (const auto& joint : model.free_joints()) {
    Root root{.joint = &joint};
    for (const int foot : feet) {
      int b = foot;
      while (b >= 0 && b != joint.body) b = model.bodies()[at(b)].parent;
      if (b >= 0) root.feet.push_back(foot);
    }
    const Vector3d unknown = Vector3d::Constant(kNaN);
    root.frames.assign(at(frames), {.force = unknown,
                                    .moment = unknown,
                                    .origin = unknown,
                                    .centre = unknown,
                                    .feet = std::vector<Vector3d>(root.feet.size(), unknown),
                                    .on_plate = std::vector<std::uint8_t>(root.feet.size(), 0)});
    out.push_back(std::move(root));
  }
  return out;
}

double total_mass_kg(const model::Model& model) {
  double mass = 0.0;
  for (const auto& body : model.bodies()) mass += body.mass;
  return mass;
}

RootResidual residual_of(const model::Model& model, const Root& root) {
  RootResidual out{.body = name_of(model, root.joint->body)};
  std::int64_t known = 0;
  for (const auto& frame : root.frames) {
    if (!frame.force.allFinite()) continue;
    ++known;
    out.force_rms_n += frame.force.squaredNorm();
    out.moment_rms_nm += frame.moment.squaredNorm();
    out.force_max_n = std::max(out.force_max_n, frame.force.norm());
    out.moment_max_nm = std::max(out.moment_max_nm, frame.moment.norm());
  }
  const auto count = static_cast<double>(std::max<std::int64_t>(1, known));
  out.force_rms_n = std::sqrt(out.force_rms_n / count);
  out.moment_rms_nm = std::sqrt(out.moment_rms_nm / count);
  return out;
}

Vector3d mean_feet_to_centre(const Root& root) {
  Vector3d sum = Vector3d::Zero();
  std::int64_t known = 0;
  for (const auto& frame : root.frames) {
    if (!frame.centre.allFinite()) continue;
    ++known;
    sum += frame.centre;
    for (const auto& foot : frame.feet) sum -= foot / static_cast<double>(frame.feet.size());
  }
  return known > 0 ? Vector3d(sum / static_cast<double>(known)) : Vector3d::Zero();
}

/// Finds feet that bear load without a measured force and takes the torques of their limbs back.
void withdraw_unmeasured(const model::Model& model, const Root& root, double contact_force_n,
                         data::JointMotion& motion, DynamicsSummary& summary) {
  for (const auto& load : internal::find_unmeasured_load(root.frames, model.gravity(), total_mass_kg(model),
                                                         contact_force_n, motion.time.rate_hz)) {
    const int foot = root.feet[at(load.foot)];
    summary.unmeasured.push_back({name_of(model, foot), load.first_frame, load.last_frame, load.force_max_n});
    for (const int c : internal::limb_coordinates(model, foot))
      for (std::int64_t f = load.first_frame; f <= load.last_frame; ++f) {
        motion.tau[motion.index(f, c)] = kNaN;
        if (!motion.tau_sd.empty()) motion.tau_sd[motion.index(f, c)] = kNaN;
      }
  }
}

}  // namespace

Status DynamicsOptions::check() const {
  if (!std::isfinite(contact_force_n) || contact_force_n < 0.0)
    return fail(Code::usage, fmt::format("contact force is {} N; need 0 or more", contact_force_n));
  if (threads < 0)
    return fail(Code::usage, fmt::format("number of threads is {}; need 0 (all cores) or more", threads));
  return {};
}

Result<DynamicsSummary> inverse_dynamics(const model::Model& model, data::JointMotion& motion,
                                         const DynamicsOptions& options, const data::Wrenches* wrenches,
                                         const RateErrors* errors) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (auto status = check_input(model, motion, wrenches); !status) return std::unexpected(status.error());
  DynamicsSummary summary;
  RateErrors estimated;
  const bool bars = options.error_bars;
  summary.rates_estimated = motion.qd.empty() || motion.qdd.empty();
  if (summary.rates_estimated || (bars && !errors)) {
    auto rates = estimate_rates(model, motion);
    if (!rates) return std::unexpected(rates.error());
    estimated = std::move(*rates);
    if (summary.rates_estimated || !errors) errors = &estimated;
  }
  kinemark::check(!bars || errors->covariance.size() == 6 * motion.q.size(),
                  "errors must hold 6 numbers per coordinate and frame");
  const auto feet = find_feet(model, options.feet);
  if (!feet) return std::unexpected(feet.error());
  ContactPlan plan;
  if (wrenches) {
    auto planned = plan_contacts(model, motion, *wrenches, *feet, options.contact_force_n);
    if (!planned) return std::unexpected(planned.error());
    plan = std::move(*planned);
    summary.contacts = plan.contacts;
  }

  const std::int64_t F = motion.frames(), n = motion.size();
  Array<double> tau(at(F * n), kNaN), tau_sd(bars ? at(F * n) : 0, kNaN);
  auto roots = make_roots(model, *feet, F);
  std::vector<std::uint8_t> known(at(F), 0);
  parallel_for(F, 16, options.threads, [&](std::int64_t begin, std::int64_t end) {
    Worker worker(model, motion, wrenches, plan);
    VectorXd out, variance;
    for (std::int64_t f = begin; f < end; ++f) {
      if (!worker.visit(f)) continue;
      known[at(f)] = 1;
      worker.frame().to_coordinates(worker.frame().tau(), out);
      std::copy(out.data(), out.data() + n, tau.data() + motion.index(f, 0));
      for (auto& root : roots) root.frames[at(f)] = worker.root_frame(f, *root.joint, root.feet);
      if (!bars) continue;
      worker.propagate(errors->covariance.data() + 6 * motion.index(f, 0),
                       motion.q_sd.empty() ? nullptr : motion.q_sd.data() + motion.index(f, 0), variance);
      for (int c = 0; c < n; ++c)
        if (!std::isnan(out[c]) && !std::isnan(errors->covariance[6 * motion.index(f, c)]))
          tau_sd[motion.index(f, c)] = std::sqrt(std::max(0.0, variance[c]));
    }
  });
  motion.tau = std::move(tau);
  motion.tau_sd = std::move(tau_sd);

  for (const auto& root : roots) {
    summary.roots.push_back(residual_of(model, root));
    if (!root.feet.empty()) summary.feet_to_centre = mean_feet_to_centre(root);
    if (wrenches) withdraw_unmeasured(model, root, options.contact_force_n, motion, summary);
  }
  summary.body_weight_n = total_mass_kg(model) * model.gravity().norm();
  const auto counted = std::ranges::count(known, std::uint8_t{1});
  if (counted < F)
    summary.warnings.push_back(
        fmt::format("{} of {} frames have no torques: a force was not measured there", F - counted, F));
  return summary;
}

}  // namespace kinemark::motion
