// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// MuJoCo as an unrelated judge of the dynamics, on the tree of models/human.osim.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <string>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/mjcf.h"
#include "kinemark/model/testing/random_tree.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::model {
namespace {

using Eigen::MatrixXd;
using testing::random_vector;
using testing::relative_error;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Judge : public ::testing::Test {
 protected:
  Model model =
      Model::compile(io::read_osim(testing_support::project_folder() / "models" / "human.osim").value())
          .value();
  Workspace w{model};
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> judge{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data{nullptr, mj_deleteData};
  std::vector<int> qpos_of_state, dof_of_speed;

  void SetUp() override {
    const testing_support::ScratchFolder scratch;
    const std::string path = (scratch / "human.xml").string();
    std::ofstream(path) << testing::mjcf(model);
    std::array<char, 1000> error{};
    judge.reset(mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    ASSERT_NE(judge, nullptr) << error.data();
    data.reset(mj_makeData(judge.get()));
    ASSERT_EQ(judge->nq, model.state_count());
    ASSERT_EQ(judge->nv, model.speed_count());

    // Both have a position and a quaternion w x y z first; speeds linear in the world, angular in the body.
    ASSERT_EQ(model.free_joints().size(), 1u);
    const auto& free = model.free_joints()[0];
    qpos_of_state.resize(static_cast<std::size_t>(model.state_count()));
    dof_of_speed.resize(static_cast<std::size_t>(model.speed_count()));
    for (int i = 0; i < 7; ++i) qpos_of_state[static_cast<std::size_t>(free.state_idx + i)] = i;
    for (int i = 0; i < 6; ++i) dof_of_speed[static_cast<std::size_t>(free.speed_idx + i)] = i;
    for (int c = 0; c < model.coordinate_count(); ++c) {
      const auto& coordinate = model.coordinates()[static_cast<std::size_t>(c)];
      if (coordinate.state_idx < 0) continue;
      const int joint = mj_name2id(judge.get(), mjOBJ_JOINT, fmt::format("c{}", c).c_str());
      ASSERT_GE(joint, 0);
      qpos_of_state[static_cast<std::size_t>(coordinate.state_idx)] = judge->jnt_qposadr[joint];
      dof_of_speed[static_cast<std::size_t>(coordinate.speed_idx)] = judge->jnt_dofadr[joint];
    }
  }

  void set(const VectorXd& x, const VectorXd& v) {
    for (int i = 0; i < model.state_count(); ++i)
      data->qpos[qpos_of_state[static_cast<std::size_t>(i)]] = x[i];
    for (int i = 0; i < model.speed_count(); ++i)
      data->qvel[dof_of_speed[static_cast<std::size_t>(i)]] = v[i];
    mj_forward(judge.get(), data.get());
    kinematics(model, w, x);
    velocities(model, w, v);
  }
};

TEST_F(Judge, AgreesOnMarkersJacobianMassMatrixAndForces) {
  const int n = model.speed_count();
  double worst_positions = 0.0, worst_dynamics = 0.0;
  for (int trial = 0; trial < 8; ++trial) {
    Random random(static_cast<std::uint64_t>(trial), 77);
    VectorXd x = testing::random_state(model, random), v = random_vector(n, 2.0, random);
    set(x, v);

    MatrixXd J, J_judge(3 * model.marker_count(), n), markers(3, model.marker_count());
    marker_jacobian(model, w, J);
    RowMajor site(3, n);
    for (int m = 0; m < model.marker_count(); ++m) {
      const int id = mj_name2id(judge.get(), mjOBJ_SITE, fmt::format("m{}", m).c_str());
      ASSERT_GE(id, 0);
      markers.col(m) = Eigen::Map<const Vector3d>(data->site_xpos + 3 * id);
      mj_jacSite(judge.get(), data.get(), site.data(), nullptr, id);
      for (int i = 0; i < n; ++i)
        J_judge.block<3, 1>(3 * m, i) = site.col(dof_of_speed[static_cast<std::size_t>(i)]);
    }
    worst_positions =
        std::max({worst_positions, relative_error(w.marker, markers), relative_error(J, J_judge)});

    MatrixXd M, M_judge(n, n);
    RowMajor full(n, n);
    mass_matrix(model, w, M);
    mj_fullM(judge.get(), full.data(), data->qM);
    VectorXd b, g, force(n);
    bias_forces(model, w, b);
    gravity_forces(model, w, g);
    for (int i = 0; i < n; ++i) {
      force[i] = data->qfrc_bias[dof_of_speed[static_cast<std::size_t>(i)]];
      for (int j = 0; j < n; ++j)
        M_judge(i, j) =
            full(dof_of_speed[static_cast<std::size_t>(i)], dof_of_speed[static_cast<std::size_t>(j)]);
    }
    // MuJoCo transforms every inertia to its principal axes on loading, which costs digits.
    worst_dynamics = std::max({worst_dynamics, relative_error(M, M_judge), relative_error(b + g, force)});
    EXPECT_GT(force.norm(), 100.0);
  }
  EXPECT_LT(worst_positions, 1e-9);
  EXPECT_LT(worst_dynamics, 1e-5);
  RecordProperty("measured", fmt::format("{:.2e}", std::max(worst_positions, worst_dynamics)));
}

}  // namespace
}  // namespace kinemark::model
