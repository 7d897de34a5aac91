// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

namespace kinemark::skeleton::internal {

struct LbfgsOptions {
  int memory = 10;
  int iterations = 5000;
  double cost_tolerance = 1e-12;     ///< relative change at which to stop
  double gradient_tolerance = 1e-9;  ///< largest component at which to stop
};

/// Minimise a smooth function from x by limited-memory BFGS (Nocedal & Wright 2006, algorithms 7.5 and 3.5).
/// `cost` returns the value and writes the gradient. Returns the least value; x is where it was found.
double minimise_lbfgs(const std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>& cost,
                      Eigen::VectorXd& x, const LbfgsOptions& options = {});

}  // namespace kinemark::skeleton::internal
