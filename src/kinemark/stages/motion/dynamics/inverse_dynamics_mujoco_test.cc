// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Torques of a whole-body motion against MuJoCo's inverse dynamics.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>

#include "kinemark/core/index.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/mjcf.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::motion {
namespace {

using Eigen::VectorXd;

/// Three seconds of brisk motion of all coordinates with its exact rates, 20 frames.
data::JointMotion swing(const model::Model& model) {
  data::JointMotion motion;
  motion.time = {.rate_hz = 7.0, .frames = 20};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  for (std::int64_t f = 0; f < 20; ++f)
    for (int c = 0; c < model.coordinate_count(); ++c) {
      const double omega = 2.0 + 0.2 * c, phase = omega * motion.time.time_s(f) + 0.7 * c;
      motion.q.push_back(0.6 * std::sin(phase));
      motion.qd.push_back(0.6 * omega * std::cos(phase));
      motion.qdd.push_back(-0.6 * omega * omega * std::sin(phase));
    }
  return motion;
}

TEST(InverseDynamicsJudge, AgreesOnAWholeBodyWithAndWithoutAPush) {
  const auto model = model::Model::compile(
                         io::read_osim(testing_support::project_folder() / "models" / "human.osim").value())
                         .value();
  const testing_support::ScratchFolder scratch;
  const std::string path = (scratch / "human.xml").string();
  std::ofstream(path) << model::testing::mjcf(model);
  std::array<char, 1000> error{};
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> judge(
      mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size())), mj_deleteModel);
  ASSERT_NE(judge, nullptr) << error.data();
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(judge.get()), mj_deleteData);
  ASSERT_EQ(model.free_joints().size(), 1u);
  const auto& free = model.free_joints()[0];

  double worst = 0.0, largest = 0.0;
  for (const bool pushed : {false, true}) {
    auto motion = swing(model);
    data::Wrenches wrenches{.time = motion.time};
    const auto& hand = model.bodies().back();
    const std::string hand_name = model.description().bodies[at(hand.description_idx)].name;
    wrenches.items.push_back({.name = "push", .body = hand_name});
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto frame = static_cast<double>(f);
      for (const double x : {80.0, -30.0 + 9.0 * frame, 55.0}) wrenches.items[0].force.push_back(x);
      for (const double x : {1.0, 2.0 - 0.4 * frame, -3.0}) wrenches.items[0].moment.push_back(x);
      for (const double x : {0.3, 1.0, 0.02 * frame}) wrenches.items[0].point.push_back(x);
    }
    (void)inverse_dynamics(model, motion, {.error_bars = false}, pushed ? &wrenches : nullptr).value();

    model::Workspace w(model);
    Eigen::MatrixXd E;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto row = [&](const Array<double>& values) {
        return VectorXd(Eigen::Map<const VectorXd>(values.data() + motion.index(f, 0), motion.size()));
      };
      const VectorXd q = row(motion.q), tau = row(motion.tau), x = model::state_from_coordinates(model, q);
      VectorXd v, vdot;
      model::speeds_from_rates(model, q, row(motion.qd), row(motion.qdd), v, vdot);
      for (int i = 0; i < 7; ++i) data->qpos[i] = x[free.state_idx + i];
      for (int i = 0; i < 6; ++i) {
        data->qvel[i] = v[free.speed_idx + i];
        data->qacc[i] = vdot[free.speed_idx + i];
      }
      std::vector<int> dof(at(model.coordinate_count()), -1);
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& coordinate = model.coordinates()[at(c)];
        if (coordinate.state_idx < 0) continue;
        const int joint = mj_name2id(judge.get(), mjOBJ_JOINT, fmt::format("c{}", c).c_str());
        ASSERT_GE(joint, 0);
        dof[at(c)] = judge->jnt_dofadr[joint];
        data->qpos[judge->jnt_qposadr[joint]] = x[coordinate.state_idx];
        data->qvel[dof[at(c)]] = v[coordinate.speed_idx];
        data->qacc[dof[at(c)]] = vdot[coordinate.speed_idx];
      }
      mj_inverse(judge.get(), data.get());
      VectorXd theirs = Eigen::Map<const VectorXd>(data->qfrc_inverse, judge->nv);
      if (pushed) {
        // Bodies are written in another order there; this one is found by its place.
        model::kinematics(model, w, x);
        const int ours = static_cast<int>(model.bodies().size()) - 1;
        int body = -1;
        for (int b = 1; b < judge->nbody; ++b)
          if ((Eigen::Map<const Eigen::Vector3d>(data->xipos + 3 * b) -
               model::point_in_world(w, ours, hand.com_in_body))
                  .norm() < 1e-9)
            body = b;
        ASSERT_GE(body, 0);
        VectorXd outside = VectorXd::Zero(judge->nv);
        mj_applyFT(judge.get(), data.get(), wrenches.items[0].force.data() + 3 * f,
                   wrenches.items[0].moment.data() + 3 * f, wrenches.items[0].point.data() + 3 * f, body,
                   outside.data());
        theirs -= outside;
      }
      // The root: forces along the axes of the coordinates, moments by the Euler rates.
      model::kinematics(model, w, x);
      model::coordinate_jacobian(model, w, q, E);
      Eigen::Matrix3d rates;
      Eigen::Vector3d ours_rotation, ours_slide;
      for (int i = 0; i < 3; ++i) {
        rates.row(i) = E.block<1, 3>(free.rotation_coordinate[i], free.speed_idx + 3);
        ours_rotation[i] = tau[free.rotation_coordinate[i]];
        ours_slide[i] = tau[free.translation_coordinate[i]];
      }
      const double scale = theirs.cwiseAbs().maxCoeff();
      largest = std::max(largest, scale);
      worst = std::max({worst, (rates.transpose() * ours_rotation - theirs.segment<3>(3)).norm() / scale,
                        (free.translation_axes * ours_slide - theirs.head<3>()).norm() / scale});
      for (int c = 0; c < model.coordinate_count(); ++c)
        if (dof[at(c)] >= 0) worst = std::max(worst, std::abs(tau[c] - theirs[dof[at(c)]]) / scale);
    }
  }
  // MuJoCo transforms every inertia to its principal axes on loading, which costs digits.
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(largest, 500.0);
  RecordProperty("measured", fmt::format("{:.2e}", worst));
}

}  // namespace
}  // namespace kinemark::motion
