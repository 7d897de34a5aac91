// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/marker_samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/trajectory/smoothing/internal/choose.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kEvenTimes = 1e-6;     ///< of the interval: offsets that differ less are the same
constexpr double kSameVariance = 1e-9;  ///< relative

bool usable(double variance) { return std::isfinite(variance) && variance > 0.0; }

Status take_times(const data::Trajectories& in, std::int64_t marker, MarkerSamples& out) {
  if (in.sample_offset_s.size() == in.names.size()) {
    if (!std::isfinite(in.sample_offset_s[static_cast<std::size_t>(marker)]))
      return fail(Code::bad_input, fmt::format("marker '{}' has a sample time that is not a number",
                                               in.names[static_cast<std::size_t>(marker)]));
    return {};
  }
  if (in.sample_offset_s.empty()) return {};
  bool even = true;
  double earlier = -INFINITY;
  std::int64_t earlier_frame = -1;
  out.time_s.resize(static_cast<std::size_t>(out.frames));
  for (std::int64_t f = 0; f < out.frames; ++f) {
    const double offset = in.sample_offset_s[in.index(f, marker)];
    const double t = static_cast<double>(f) * out.interval_s + offset;
    out.time_s[static_cast<std::size_t>(f)] = t;
    even = even && std::abs(offset - in.sample_offset_s[in.index(0, marker)]) <= kEvenTimes * out.interval_s;
    if (out.present[static_cast<std::size_t>(f)] == 0) continue;
    if (!(t > earlier) || !std::isfinite(t))
      return fail(
          Code::bad_input,
          fmt::format(
              "marker '{}' was seen at {} s in frame {} and at {} s in frame {}; sample times must rise",
              in.names[static_cast<std::size_t>(marker)], in.time.t0_s + earlier,
              in.time.number(earlier_frame), in.time.t0_s + t, in.time.number(f)));
    earlier = t;
    earlier_frame = f;
  }
  if (even) {
    out.time_s.clear();
    return {};
  }
  // Frames without a sample need a time too: their offset is a guess that must keep the times rising.
  for (std::int64_t f = 0; f < out.frames;) {
    if (out.present[static_cast<std::size_t>(f)] != 0) {
      ++f;
      continue;
    }
    std::int64_t end = f;
    while (end < out.frames && out.present[static_cast<std::size_t>(end)] == 0) ++end;
    for (std::int64_t k = f; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (f == 0 || end == out.frames)
        out.time_s[i] = static_cast<double>(k) * out.interval_s;
      else
        out.time_s[i] =
            out.time_s[static_cast<std::size_t>(f - 1)] +
            (out.time_s[static_cast<std::size_t>(end)] - out.time_s[static_cast<std::size_t>(f - 1)]) *
                static_cast<double>(k - f + 1) / static_cast<double>(end - f + 1);
    }
    f = end;
  }
  return {};
}

void take_variances(const data::Trajectories& in, std::int64_t marker, MarkerSamples& out) {
  Array<double> known;
  for (std::int64_t f = 0; f < out.frames; ++f) {
    if (out.present[static_cast<std::size_t>(f)] == 0) continue;
    for (const std::size_t d : math::kSymmetric3Diagonal)
      if (const double v = in.covariance[6 * in.index(f, marker) + d]; usable(v)) known.push_back(v);
  }
  if (known.empty()) return;
  out.has_covariance = true;
  const double median = math::upper_median(known);
  out.typical_sd_m = std::sqrt(median);
  out.variance.assign(static_cast<std::size_t>(3 * out.frames), 1.0);
  bool all_one = true;
  for (std::int64_t f = 0; f < out.frames; ++f) {
    if (out.present[static_cast<std::size_t>(f)] == 0) continue;
    bool bad = false;
    for (int axis = 0; axis < 3; ++axis) {
      const double v = in.covariance[6 * in.index(f, marker) + math::kSymmetric3Diagonal[at(axis)]];
      bad = bad || !usable(v);
      double& relative = out.variance[static_cast<std::size_t>(axis * out.frames + f)];
      relative = usable(v) ? v / median : 1.0;
      all_one = all_one && std::abs(relative - 1.0) <= kSameVariance;
      if (std::abs(relative - out.variance[static_cast<std::size_t>(f)]) > kSameVariance * relative)
        out.same_for_all_axes = false;
    }
    out.bad_variances += bad ? 1 : 0;
  }
  if (all_one) out.variance.clear();
}

constexpr std::int64_t kSample = 16384;

}  // namespace

std::vector<Series> MarkerSamples::series(const Array<std::uint8_t>& seen,
                                          std::vector<Array<double>>& y) const {
  Series whole;
  whole.frames = frames;
  whole.interval_s = interval_s;
  whole.seen = seen.data();
  whole.time_s = time_s.empty() ? nullptr : time_s.data();
  whole.variance = variance.empty() ? nullptr : variance.data();
  if (same_for_all_axes) {
    whole.axes = 3;
    whole.y = x.data();
    return {whole};
  }
  std::vector<Series> apart;
  y.resize(3);
  for (int axis = 0; axis < 3; ++axis) {
    auto& column = y[static_cast<std::size_t>(axis)];
    column.resize(static_cast<std::size_t>(frames));
    for (std::int64_t f = 0; f < frames; ++f)
      column[static_cast<std::size_t>(f)] = x[static_cast<std::size_t>(3 * f + axis)];
    Series s = whole;
    s.y = column.data();
    s.variance = variance.data() + axis * frames;
    apart.push_back(s);
  }
  return apart;
}

Result<MarkerSamples> marker_samples(const data::Trajectories& in, std::int64_t marker) {
  MarkerSamples out;
  out.frames = in.frames();
  out.interval_s = 1.0 / in.time.rate_hz;
  const auto n = static_cast<std::size_t>(out.frames);
  out.x.resize(3 * n);
  out.present.assign(n, 0);
  out.judged.assign(n, 0);
  for (std::int64_t f = 0; f < out.frames; ++f) {
    const auto p = in.x(f, marker);
    for (int axis = 0; axis < 3; ++axis) out.x[static_cast<std::size_t>(3 * f + axis)] = p[axis];
    if (!in.present(f, marker)) continue;
    out.present[static_cast<std::size_t>(f)] = 1;
    if (in.state[in.index(f, marker)] != data::SampleState::measured) continue;
    out.judged[static_cast<std::size_t>(f)] = 1;
    ++out.measured;
  }
  if (const auto status = take_times(in, marker, out); !status) return std::unexpected(status.error());
  if (!in.covariance.empty()) take_variances(in, marker, out);

  for (std::int64_t f = 0; f < out.frames;) {
    std::int64_t end = f;
    while (end < out.frames && out.present[static_cast<std::size_t>(end)] != 0 &&
           out.judged[static_cast<std::size_t>(end)] == 0)
      ++end;
    if (end - f > 1) {
      if (out.variance.empty()) out.variance.assign(3 * n, 1.0);
      for (int axis = 0; axis < 3; ++axis)
        for (std::int64_t k = f; k < end; ++k)
          out.variance[static_cast<std::size_t>(axis * out.frames + k)] *= static_cast<double>(end - f);
    }
    f = std::max(f + 1, end);
  }
  if (out.measured < kFewestSamples) out.judged = out.present;
  return out;
}

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
