// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Eight families of simulated movements of one point, with exact derivatives: reaches, submovements,
// ellipses, figures of eight, signs, wheels, tremor, a walking ankle.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::acceptance {

inline constexpr std::array kFamilies{"reach", "submovements", "ellipse", "eight",
                                      "sign",  "wheel",        "tremor",  "walk"};

/// A value and its first three derivatives in time.
struct Jet {
  double f = 0.0, d1 = 0.0, d2 = 0.0, d3 = 0.0;
};

/// A movement in mm and s.
struct PathMovement {
  std::string family;
  double duration_s = 0.0;
  std::function<std::array<Jet, 3>(double t)> at;
};

/// A movement of a family, its sizes, rhythm and orientation drawn.
[[nodiscard]] PathMovement draw_movement(const std::string& family, Random& random);

/// Sampled without noise, m; derivatives are exact.
[[nodiscard]] analysis::PathSamples sample_movement(const PathMovement& movement, double rate_hz);

}  // namespace kinemark::acceptance
