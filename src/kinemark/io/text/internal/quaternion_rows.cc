// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/quaternion_rows.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/text/internal/time_column.h"

namespace kinemark::io::internal {
namespace {

constexpr std::int64_t kNumbers = 4;      // of a quaternion
constexpr double kLengthTolerance = 0.1;  // files round to a few digits; more is no rotation

}  // namespace

Result<data::Orientations> settle_quaternions(QuaternionRows rows) {
  data::Orientations out;
  out.names = std::move(rows.names);
  out.warnings = std::move(rows.warnings);
  const auto S = out.size(), R = std::ssize(rows.time_s);
  if (S == 0 || R == 0)
    return fail(Code::bad_input, "holds no orientation; expected a column of quaternions for each sensor");
  const auto clock = even_clock({.time_s = rows.time_s,
                                 .resolution_s = rows.resolution_s,
                                 .stated = rows.rates_hz,
                                 .most_frames = 2 * R + 1'000'000 / S,
                                 .place = rows.place},
                                out.warnings);
  if (!clock) return std::unexpected(clock.error());
  // Such a table need not state a rate.
  std::erase_if(out.warnings,
                [](const std::string& warning) { return warning.starts_with("header gives no rate"); });
  out.time = clock->time;
  out.quaternion.assign(at(kNumbers * out.frames() * S), kNaN);
  std::vector<std::int64_t> zeros(at(S));
  for (std::int64_t r = 0; r < R; ++r) {
    const auto f = clock->frame.empty() ? r : clock->frame[at(r)];
    for (std::int64_t s = 0; s < S; ++s) {
      const double* q = rows.values.data() + kNumbers * (r * S + s);
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      if (length == 0.0) ++zeros[at(s)];
      if (!(length > 0.0)) continue;
      if (!(std::abs(length - 1.0) < kLengthTolerance))
        return fail(Code::bad_input, fmt::format("{}, '{}': a quaternion of length {:.3g}; expected 1",
                                                 rows.place(at(r)), out.names[at(s)], length));
      for (std::int64_t k = 0; k < kNumbers; ++k)
        out.quaternion[at(kNumbers * (f * S + s) + k)] = q[k] / length;
    }
  }
  for (std::int64_t s = 0; s < S; ++s)
    if (zeros[at(s)] > 0)
      out.warnings.push_back(fmt::format("sensor '{}': quaternions of zeros in {} rows, taken as missing",
                                         out.names[at(s)], zeros[at(s)]));
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::io::internal
