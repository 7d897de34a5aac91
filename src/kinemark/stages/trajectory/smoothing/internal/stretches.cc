// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/stretches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinemark::trajectory::smoothing {
namespace {

constexpr std::int64_t kSample = 16384;

}  // namespace

std::vector<Stretch> stretches(const Array<std::uint8_t>& present) {
  std::vector<Stretch> found;
  const std::int64_t n = std::ssize(present);
  for (std::int64_t f = 0; f < n;) {
    std::int64_t end = f;
    while (end < n && present[static_cast<std::size_t>(end)] != 0) ++end;
    if (end > f) found.push_back({f, end});
    f = std::max(f + 1, end);
  }
  return found;
}

std::vector<Stretch> sample_of(const std::vector<Stretch>& all) {
  constexpr std::int64_t kPiece = 2048;
  std::vector<Stretch> pieces;
  for (const Stretch& s : all)
    for (std::int64_t at = s.begin; at < s.end; at += kPiece)
      pieces.push_back({at, std::min(s.end, at + kPiece)});
  std::int64_t total = 0;
  for (const Stretch& s : all) total += s.length();
  if (total <= kSample) return all;
  std::vector<Stretch> chosen;
  std::int64_t passed = 0, taken = 0;
  for (const Stretch& piece : pieces) {
    passed += piece.length();
    if (taken * total > passed * kSample) continue;
    chosen.push_back(piece);
    taken += piece.length();
  }
  return chosen;
}

std::vector<double> column(const Array<double>& x, const Stretch& stretch, int axis) {
  std::vector<double> values(static_cast<std::size_t>(stretch.length()));
  for (std::int64_t f = stretch.begin; f < stretch.end; ++f)
    values[static_cast<std::size_t>(f - stretch.begin)] = x[static_cast<std::size_t>(3 * f + axis)];
  return values;
}

std::vector<double> differences(const std::vector<double>& x, double interval_s) {
  const std::size_t n = x.size();
  std::vector<double> v(n, std::numeric_limits<double>::quiet_NaN());
  if (n < 2) return v;
  for (std::size_t i = 1; i + 1 < n; ++i) v[i] = (x[i + 1] - x[i - 1]) / (2.0 * interval_s);
  v.front() = (x[1] - x[0]) / interval_s;
  v.back() = (x[n - 1] - x[n - 2]) / interval_s;
  return v;
}

double difference_power(double frequency, double interval_s) {
  const double slope = std::sin(2.0 * M_PI * frequency) / interval_s;
  return slope * slope;
}

}  // namespace kinemark::trajectory::smoothing
