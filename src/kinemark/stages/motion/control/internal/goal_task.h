// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tasks whose goals are made of the goals of markers, so that they are filtered, judged, faded and eased in
// as these are, and are the same numbers live.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/task.h"

namespace kinemark::motion::internal {

class GoalTask : public Task {
 public:
  /// Markers that the goal is made of, indices in the model that it was bound to.
  [[nodiscard]] const std::vector<int>& markers() const { return markers_; }
  /// How many markers it counts like: 1 / of the sum of its weighted squares is a mean square, m^2.
  [[nodiscard]] virtual double points() const = 0;

  /// Fill rows as evaluate() does, from goals of the markers at that instant.
  /// @param full   M, weight of each marker in `goal` where it is fully seen
  /// @param gains  if given: what an error of the markers' goals changes the goal by (rows x 3 K, in
  ///               the order of markers())
  virtual void follow(const model::Model& model, const model::Workspace& w, const GoalValues& goal,
                      const Eigen::VectorXd& full, TaskRows& out, Eigen::MatrixXd* gains) const = 0;

  /// Without goals of markers there is nothing to follow.
  void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                TaskRows& out) const final;

 protected:
  std::vector<int> markers_;
};

/// Orientation of a body as its own markers show it: the rigid turn that takes their places in the model to
/// their goals (Kabsch). 3 rows about the principal axes of these markers, each weighted by what the markers
/// know of it, sum w |distance from the axis|^2, so that the task counts like the turn of its markers. It
/// fades where those seen lie in one line.
/// @param weights  M, of each marker
[[nodiscard]] std::shared_ptr<GoalTask> orientation_of_markers(std::string body, Eigen::VectorXd weights);

/// Distance of two markers as their goals have it: 1 row, m.
[[nodiscard]] std::shared_ptr<GoalTask> distance_of_markers(std::string a, std::string b);

}  // namespace kinemark::motion::internal
