// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How fast direct marker control is, beside MuJoCo's forward kinematics, mass matrix and bias on the same
// tree.
#include <fmt/core.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <string>

#include "acceptance/track_subject.h"
#include "kinemark/model/testing/mjcf.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_row;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class Mujoco {
 public:
  explicit Mujoco(const model::Model& model) {
    const testing_support::ScratchSpace scratch("accept_track_speed");
    const std::string path = (scratch.path() / "human.xml").string();
    std::ofstream(path) << model::testing::mjcf(model);
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(path.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    if (model_ != nullptr) data_.reset(mj_makeData(model_.get()));
  }
  [[nodiscard]] bool works() const { return data_ != nullptr; }

  /// Seconds of forward kinematics, mass matrix and bias, the mean over many poses.
  double time() {
    constexpr int kCalls = 5000;
    const auto begin = Clock::now();
    for (int i = 0; i < kCalls; ++i) {
      for (int k = 7; k < model_->nq; ++k) data_->qpos[k] = 0.3 * std::sin(0.1 * i + k);
      for (int k = 0; k < model_->nv; ++k) data_->qvel[k] = std::cos(0.1 * i + k);
      mj_kinematics(model_.get(), data_.get());
      mj_comPos(model_.get(), data_.get());
      mj_crb(model_.get(), data_.get());
      mj_comVel(model_.get(), data_.get());
      mj_rne(model_.get(), data_.get(), 0, data_->qfrc_bias);
    }
    return seconds_since(begin) / kCalls;
  }

 private:
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data_{nullptr, mj_deleteData};
};

int run_check(int /*argc*/, char** /*argv*/) {
  const auto model = human();
  Mujoco judge(model);
  if (!judge.works()) {
    print_row(false, "MuJoCo reads the human model", "it does", "it does not");
    return testing_support::exit_status();
  }
  const auto s = subject(model, 1e-3, 60.0, 10.0, 1);
  // Other programs come and go: the best of several rounds on both sides.
  double ours = 1e9, coarse = 1e9, theirs = 1e9, slow = 1e9;
  std::int64_t steps = 0;
  for (int round = 0; round < 5; ++round) {
    theirs = std::min(theirs, judge.time());
    const auto fine = motion::track_markers(model, s.markers, {.step_s = 1e-3, .error_bars = false}).value();
    steps = fine.steps;
    ours = std::min(ours, fine.solve_seconds / static_cast<double>(fine.steps));
    slow = std::min(slow, fine.solve_seconds / 10.0);
    const auto at_60 = motion::track_markers(model, s.markers,
                                             {.omega_rad_s = 30.0, .step_s = 1.0 / 60.0, .error_bars = false})
                           .value();
    coarse = std::min(coarse, at_60.solve_seconds / 10.0);
  }
  print_row(1.0 / slow >= 8.0, "40 coordinates, 40 markers, one thread, 1 ms steps", ">= 8 times real time",
            fmt::format("{:.1f} times, {} steps", 1.0 / slow, steps));
  print_row(1.0 / coarse >= 100.0, "the same at 60 Hz", ">= 100 times real time",
            fmt::format("{:.0f} times", 1.0 / coarse));
  print_row(
      ours <= 12.0 * theirs, "a step against MuJoCo's kinematics, mass matrix and bias", "<= 12 times",
      fmt::format("{:.1f} times: {:.1f} us against {:.2f} us", ours / theirs, 1e6 * ours, 1e6 * theirs));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_speed", run_check);

}  // namespace
