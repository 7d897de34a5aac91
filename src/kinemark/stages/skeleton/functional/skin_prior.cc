// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_prior.h"

#include <fmt/core.h>

#include <cmath>

namespace kinemark::skeleton {

Status SkinPrior::check() const {
  for (const double value : {turn, turn_weight, slide_m})
    if (!(value > 0.0) || !std::isfinite(value))
      return fail(Code::usage,
                  fmt::format("skin that slides by {} m and turns by {} rad per rad with a weight of {}; "
                              "need more than 0",
                              slide_m, turn, turn_weight));
  return {};
}

}  // namespace kinemark::skeleton
