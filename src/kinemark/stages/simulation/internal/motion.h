// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/subject_options.h"

namespace kinemark::simulation::internal {

/// centre + sum of amplitude sin(2 pi f t + phase).
struct Wave {
  struct Sine {
    double amplitude = 0.0, frequency_hz = 0.0, phase = 0.0;
  };
  double centre = 0.0;
  std::vector<Sine> sines;
  [[nodiscard]] double operator()(double t_s) const;
};

/// A seeded motion of a model: its state at any time.
class Motion {
 public:
  Motion(const model::Model& model, const SubjectOptions& options);

  /// State (state_count() numbers) at a time from 0 to options.duration_s.
  [[nodiscard]] Eigen::VectorXd state(double t_s) const;

  [[nodiscard]] double stride_hz() const { return stride_hz_; }

 private:
  void draw_coordinate(int coordinate);
  void draw_root(std::size_t which);
  [[nodiscard]] Wave::Sine sine(double amplitude, double low_hz, double high_hz, Random& random) const;

  // Motion of one free joint: walking and turning, with oscillations added.
  struct Root {
    Wave shift[3];  // forward, up, right of the body, m
    Wave sway[3];   // rotation vector, rad
  };

  const model::Model& model_;
  SubjectOptions options_;
  double stride_hz_ = 0.0;
  double circle_radius_m_ = 0.0;
  Eigen::VectorXd default_state_;
  std::vector<Wave> waves_;  // per coordinate; empty sines for those without a state of their own
  std::vector<Root> roots_;  // per free joint
};

}  // namespace kinemark::simulation::internal
