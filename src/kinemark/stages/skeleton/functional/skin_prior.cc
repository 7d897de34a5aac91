// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_prior.h"

#include <fmt/core.h>

#include <cmath>

namespace kinemark::skeleton {

Status SkinPrior::check() const {
  for (const double value : {ball, hinge, misfit})
    if (!(value > 0.0) || !std::isfinite(value))
      return fail(Code::usage,
                  fmt::format("skin that slides as one body by {} (ball) and {} (hinge) times its "
                              "own slide, with a misfit of {}; need more than 0",
                              ball, hinge, misfit));
  for (const double factor : {ball_factor, hinge_factor})
    if (!(factor > 1.0) || !std::isfinite(factor))
      return fail(Code::usage, fmt::format("skin that differs by a factor of {}; need more than 1", factor));
  if (!(anywhere > 0.0 && anywhere < 1.0))
    return fail(Code::usage, fmt::format("a probability of {}; need one between 0 and 1", anywhere));
  return {};
}

}  // namespace kinemark::skeleton
