// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording matched with a model: correspondence of markers, fixed speeds and coordinate tasks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion::internal {

struct Problem {
  model::Model model;            ///< the given model with the used markers only
  std::vector<int> data_marker;  ///< per model marker: its index in the recording
  Eigen::VectorXd weight;        ///< per model marker, > 0
  data::MarkerFit fit;           ///< the markers, those left out, warnings; errors and noise not known yet

  struct CoordinateTarget {
    int coordinate = 0;
    double weight = 0.0;
    double value = 0.0;
    std::vector<double> values;
    [[nodiscard]] double target(std::int64_t frame) const {
      return values.empty() ? value : values[static_cast<std::size_t>(frame)];
    }
  };
  std::vector<CoordinateTarget> coordinate_tasks;
  /// A coordinate that a function of time gives: its row of the state, and its value in each frame. None that
  /// follows another one, which takes precedence, or drives nothing.
  struct Prescribed {
    std::string name;
    int state = 0;
    std::vector<double> values;
  };
  std::vector<Prescribed> prescribed;
  /// Put prescribed coordinates of a state to their values in `frame` (0: first solved).
  void prescribe(std::int64_t frame, Eigen::Ref<Eigen::VectorXd> x) const;
  /// Speed behind a plain or coupled coordinate, or -1 (free joints, coordinates that drive nothing).
  [[nodiscard]] int speed_of(int coordinate) const;
  std::vector<std::uint8_t> fixed_speed;  ///< 1: locked or prescribed
  Eigen::VectorXd lower, upper;           ///< per speed; +-infinity where unlimited
  std::int64_t first_frame = 0, frames = 0;

  /// Markers of frame f (0: first solved) and their weights, 0 where not seen. Sizes are those of the model.
  void observe(const data::Trajectories& markers, std::int64_t f, Eigen::Matrix3Xd& y,
               Eigen::VectorXd& w) const;
};

[[nodiscard]] Result<Problem> make_problem(const model::Model& model, const data::Trajectories& markers,
                                           const IkOptions& options);

}  // namespace kinemark::motion::internal
