// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;
using Eigen::Vector3d;

constexpr int kBeside = 4;  // samples on each side
constexpr int kMostSamples = 3;
constexpr double kLeastRatio = 20.0;

/// Weights of the least-squares cubic through the samples beside a gap of `width`: rows
/// are the samples in the gap, then the eight beside it.
struct Cubic {
  Eigen::Matrix<double, kMostSamples, 2 * kBeside> inside;
  Eigen::Matrix<double, 2 * kBeside, 2 * kBeside> beside;

  explicit Cubic(int width) {
    Eigen::Matrix<double, 2 * kBeside, 4> a;
    const auto powers = [](double x) { return Eigen::RowVector4d(1.0, x, x * x, x * x * x); };
    for (int i = 0; i < 2 * kBeside; ++i) a.row(i) = powers(i < kBeside ? i - kBeside : i - kBeside + width);
    const Eigen::Matrix<double, 4, 2 * kBeside> fit = a.completeOrthogonalDecomposition().pseudoInverse();
    inside.setZero();
    for (int i = 0; i < width; ++i) inside.row(i) = powers(i) * fit;
    beside = a * fit;
  }
};

struct Spike {
  double ratio = 0.0;
  double height = 0.0;  // m, of the smallest of its samples
};

/// How far the samples [first, first + width) lie from the cubic through four on each side, against how far
/// those lie from it themselves. Zero where some are not seen.
Spike measure(const Trajectories& t, std::int64_t m, std::int64_t first, int width, const Cubic& cubic,
              double rounding) {
  if (first < kBeside || first + width + kBeside > t.frames()) return {};
  Eigen::Matrix<double, 2 * kBeside, 3> beside;
  for (std::int64_t f = first - kBeside; f < first + width + kBeside; ++f)
    if (!t.present(f, m)) return {};
  for (int i = 0; i < 2 * kBeside; ++i)
    beside.row(i) = t.x(i < kBeside ? first - kBeside + i : first - kBeside + width + i, m).transpose();
  const double left = std::sqrt((beside - cubic.beside * beside).squaredNorm() / (2.0 * kBeside - 4.0));
  Spike s{.ratio = 0.0, .height = HUGE_VAL};
  for (int i = 0; i < width; ++i)
    s.height = std::min(s.height, (t.x(first + i, m).transpose() - cubic.inside.row(i) * beside).norm());
  s.ratio = s.height / std::max({left, 2.0 * rounding, 1e-4});
  return s;
}

/// Cheap first look: the cubic through two samples on each side misses by a third of a spike's height at
/// least.
bool may_be_spike(const Trajectories& t, std::int64_t m, std::int64_t f, double least) {
  for (std::int64_t k = f - 2; k <= f + 2; ++k)
    if (!t.present(k, m)) return false;
  const Vector3d missed =
      t.x(f, m) - (4.0 * (t.x(f - 1, m) + t.x(f + 1, m)) - t.x(f - 2, m) - t.x(f + 2, m)) / 6.0;
  return missed.norm() > 0.25 * least;
}

}  // namespace

void find_spikes(const Trajectories& t, const ScreenOptions& options, Defects& out) {
  const std::array<Cubic, kMostSamples> cubics{Cubic(1), Cubic(2), Cubic(3)};
  const Defects swaps = out;
  const auto swapped = [&](std::int64_t m, std::int64_t first, std::int64_t last) {
    return std::ranges::any_of(swaps, [&](const Defect& s) {
      const bool mine = s.marker == m || (s.kind == FindingKind::label_swap && s.other_marker == m);
      return mine && s.first_frame <= last + 1 && s.last_frame + 1 >= first;
    });
  };
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    const double rounding = rounding_of(t, m);
    for (std::int64_t f = kBeside; f + kBeside < t.frames(); ++f) {
      if (!may_be_spike(t, m, f, options.min_spike_m)) continue;
      // The narrowest that explains it, beginning at this frame.
      for (int width = 1; width <= kMostSamples; ++width) {
        const Spike s = measure(t, m, f, width, cubics[static_cast<std::size_t>(width - 1)], rounding);
        if (!(s.ratio > kLeastRatio) || !(s.height > options.min_spike_m)) continue;
        const std::int64_t last = f + width - 1;
        if (!swapped(m, f, last))
          out.push_back({.kind = FindingKind::spike,
                         .marker = m,
                         .first_frame = f,
                         .last_frame = last,
                         .size = s.height,
                         .confidence = confidence_of(s.ratio, 0.25 * kLeastRatio),
                         .description = fmt::format(
                             "marker '{}' leaves its path by {:.1f} mm in {}, at least {:.0f} times "
                             "what the samples beside leave it by",
                             t.names[static_cast<std::size_t>(m)], 1e3 * s.height,
                             describe_frames(t.time, f, last), std::floor(s.ratio))});
        f = last;
        break;
      }
    }
  }
}

}  // namespace kinemark::trajectory::internal
