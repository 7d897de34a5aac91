// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Coverage of the smoother's error bars: five movements, two noise levels, with and without gaps.
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string>

#include "acceptance/movements.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::kMovementFrames;
using testing_support::Movement;

struct Coverage {
  double total = 0.0, one = 0.0, two = 0.0;
  void add(double error, double sd) {
    total += 1.0;
    one += std::abs(error) <= sd;
    two += std::abs(error) <= 2.0 * sd;
  }
  void add(const Coverage& other) {
    total += other.total;
    one += other.one;
    two += other.two;
  }
  [[nodiscard]] bool good() const {
    return one >= 0.60 * total && one <= 0.82 * total && two >= 0.92 * total && two <= 0.995 * total;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{:.1f}/{:.1f}", 100 * one / total, 100 * two / total);
  }
};

/// Position, velocity, acceleration.
using Three = std::array<Coverage, 3>;

struct Found {
  Three all, filled;
};

Found measure(const Movement& movement, double sigma_m, bool gaps, int markers, std::uint64_t seed,
              std::uint64_t stream) {
  const auto in = testing_support::seen_movement(movement, sigma_m, gaps, markers, seed, stream);
  trajectory::SmoothOptions options;
  options.max_bridge_s = 1.0;
  options.max_bridge_sd_m = 1.0;
  const auto result = trajectory::smooth(in, options).value();
  Found found;
  for (std::int64_t f = 0; f < kMovementFrames; ++f) {
    const auto k = static_cast<std::size_t>(f);
    for (std::int64_t m = 0; m < markers; ++m) {
      const std::size_t i = in.index(f, m);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = 3 * i + axis;
        Three one;
        one[0].add(result.trajectories.x_in_world[at] - movement.x[k],
                   std::sqrt(result.trajectories.covariance[6 * i + math::kSymmetric3Diagonal[axis]]));
        one[1].add(result.derivatives.velocity[at] - movement.velocity[k],
                   result.derivatives.velocity_sd[at]);
        one[2].add(result.derivatives.acceleration[at] - movement.acceleration[k],
                   result.derivatives.acceleration_sd[at]);
        for (std::size_t d = 0; d < 3; ++d) {
          found.all[d].add(one[d]);
          if (!in.present(f, m)) found.filled[d].add(one[d]);
        }
      }
    }
  }
  return found;
}

void row(const std::string& what, const Three& three) {
  testing_support::print_row(three[0].good() && three[1].good() && three[2].good(), what,
                             "60-82 % at 1 SD, 92-99.5 % at 2 SD",
                             fmt::format("position {}, velocity {}, acceleration {}", three[0].text(),
                                         three[1].text(), three[2].text()));
}

int run_check(int argc, char** argv) {
  const int markers = argc > 1 ? std::stoi(argv[1]) : 12;
  const auto movements = testing_support::movements();
  for (const bool gaps : {false, true}) {
    for (const double sigma_mm : {0.5, 0.1}) {
      Three pooled, filled;
      const std::string condition = fmt::format("{} mm{}", sigma_mm, gaps ? ", gaps" : "");
      for (std::size_t k = 0; k < movements.size(); ++k) {
        const Found found = measure(movements[k], 1e-3 * sigma_mm, gaps, markers, 21, 100 * k);
        for (std::size_t d = 0; d < 3; ++d) {
          pooled[d].add(found.all[d]);
          filled[d].add(found.filled[d]);
        }
        row(fmt::format("bars of the smoother, {}, {}", movements[k].name, condition), found.all);
      }
      row(fmt::format("bars of the smoother, all movements, {}", condition), pooled);
      if (gaps) row(fmt::format("bars of the smoother, filled samples alone, {}", condition), filled);
    }
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("smoothing_bars", run_check);

}  // namespace
