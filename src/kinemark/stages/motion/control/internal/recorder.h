// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/control/internal/walker.h"
#include "kinemark/stages/motion/control/track.h"

namespace kinemark::motion::internal {

/// State, speeds and accelerations of the tree converted to the file's coordinates, with the generalised
/// forces.
class Readout {
 public:
  /// The model must outlive the readout.
  explicit Readout(const model::Model& model);

  /// Euler angles of free roots follow those of the call before.
  void find(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& a);

  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  [[nodiscard]] const Eigen::VectorXd& rate() const { return rate_; }
  [[nodiscard]] const Eigen::VectorXd& acceleration() const { return acceleration_; }
  /// M a + b + g, so that tau . dq/dt is power; NaN for coordinates that follow others or drive nothing.
  [[nodiscard]] const Eigen::VectorXd& tau() const { return tau_; }

 private:
  const model::Model& model_;
  model::Workspace w_;
  Eigen::VectorXd near_, q_, rate_, acceleration_, tau_, force_;
  Eigen::MatrixXd E_;
};

/// What the error bars need of all frames after tracking.
struct Track {
  Eigen::MatrixXd states;    // one column per frame
  data::Trajectories goals;  // laid out like the recording
  Eigen::MatrixXd weights;   // M x F, faded
};

/// Runs the body through the recording and keeps what it does: coordinates, rates, torques, rank, errors and
/// status of `result`, and the states of `track`. All references must outlive the recorder.
class Recorder {
 public:
  /// Coordinates, markers and time of `result` must be set.
  Recorder(const Plan& plan, const data::Trajectories& markers, Walker& walker, Track& track,
           TrackResult& result);

  /// From pose x at the first frame. False when the caller stopped it.
  bool run(const Eigen::VectorXd& x, const Progress& progress);

 private:
  void store();
  void store_marker_errors(std::int64_t f);
  void store_levels(std::int64_t f);
  void store_tasks();
  void close_levels();

  const Plan& plan_;
  const data::Trajectories& markers_;
  Walker& walker_;
  Track& track_;
  TrackResult& result_;
  Readout readout_;
  TaskRows rows_;
  std::vector<double> task_squares_;
  std::vector<std::int64_t> task_frames_;
  double goal_squares_ = 0.0;
  std::int64_t goals_ = 0;
};

}  // namespace kinemark::motion::internal
