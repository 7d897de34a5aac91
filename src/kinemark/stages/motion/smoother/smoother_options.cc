// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/smoother_options.h"

#include <fmt/core.h>

#include <cmath>

namespace kinemark::motion {

Status SmootherOptions::check() const {
  if (auto status = ik.check(); !status) return status;
  if (!ik.coordinate_tasks.empty())
    return fail(Code::usage, fmt::format("the smoother takes no coordinate tasks, but one names '{}'",
                                         ik.coordinate_tasks.front().coordinate));
  if (ik.loss != Loss::square)
    return fail(Code::usage, "the smoother has its own robust loss; need the square loss");
  if (!std::isfinite(huber_sd) || huber_sd < 0.0)
    return fail(Code::usage, fmt::format("the Huber threshold is {} SD; need 0 (never) or more", huber_sd));
  if (max_iterations < 1)
    return fail(Code::usage, fmt::format("iteration limit is {}; need 1 or more", max_iterations));
  return {};
}

}  // namespace kinemark::motion
