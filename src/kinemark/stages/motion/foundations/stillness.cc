// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/stillness.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::motion {
namespace {

constexpr std::int64_t kFrames = 400;
constexpr std::size_t kTogether = 10;
constexpr double kLow = 0.05, kHigh = 0.95;

}  // namespace

std::optional<Unrest> find_unrest(const data::Trajectories& still, std::span<const std::string> names,
                                  double bound_m) {
  const std::int64_t stride = std::max<std::int64_t>(1, (still.frames() + kFrames - 1) / kFrames);
  std::optional<Unrest> out;
  double most = bound_m;
  std::vector<std::int64_t> asked;
  for (const auto& name : names)
    if (const auto m = still.find(name); m >= 0) asked.push_back(m);
  std::vector<double> apart;
  for (const auto a : asked)
    for (const auto b : asked) {
      if (b <= a) continue;
      apart.clear();
      for (std::int64_t f = 0; f < still.frames(); f += stride)
        if (still.present(f, a) && still.present(f, b))
          apart.push_back((still.x(f, a) - still.x(f, b)).norm());
      if (apart.size() < kTogether) continue;
      const double low = math::quantile(apart, kLow), high = math::quantile(apart, kHigh);
      if (!(high - low > most)) continue;
      most = high - low;
      out = {.marker = still.names[at(a)], .partner = still.names[at(b)], .least_m = low, .most_m = high};
    }
  return out;
}

std::string describe(const Unrest& unrest, const std::string& recording) {
  return fmt::format(
      "{} is not still: {} and {} are {:.0f} mm apart in some of its frames, {:.0f} mm in others", recording,
      unrest.marker, unrest.partner, 1e3 * unrest.least_m, 1e3 * unrest.most_m);
}

}  // namespace kinemark::motion
