// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/monomials.h"

#include <array>

#include "kinemark/core/check.h"

namespace kinemark::camera {

Monomials::Monomials(double x, double y, int lowest, int highest) {
  check(lowest >= 0 && highest <= data::kHighestDegree, "monomials of degree 0 to kHighestDegree");
  std::array<double, data::kHighestDegree + 1> px{}, py{};
  px[0] = py[0] = 1.0;
  for (int k = 1; k <= highest; ++k) {
    px[static_cast<std::size_t>(k)] = x * px[static_cast<std::size_t>(k - 1)];
    py[static_cast<std::size_t>(k)] = y * py[static_cast<std::size_t>(k - 1)];
  }
  for (int k = lowest; k <= highest; ++k)
    for (int j = 0; j <= k; ++j, ++size_) {
      const auto a = static_cast<std::size_t>(k - j);
      const auto b = static_cast<std::size_t>(j);
      value_[size_] = px[a] * py[b];
      d_x_[size_] = a == 0 ? 0.0 : static_cast<double>(a) * px[a - 1] * py[b];
      d_y_[size_] = b == 0 ? 0.0 : static_cast<double>(b) * px[a] * py[b - 1];
    }
}

}  // namespace kinemark::camera
