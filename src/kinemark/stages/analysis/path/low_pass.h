// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Noise of a model, and the filter that a recording went through, done to whole series.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/math/difference_smoother.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/math/noise_model.h"

namespace kinemark::analysis {

/// The low-pass of a noise model, for series of n even samples without gaps.
class LowPassFilter {
 public:
  /// @param model  with an order above 0
  LowPassFilter(const math::NoiseModel& model, std::int64_t samples);
  /// Filter every column in place, both ends continued as the filters of recordings do.
  void apply(math::SeriesMatrix& series) const;

 private:
  std::optional<math::DifferenceSmoother> spline_;  // none: Butterworth's
  std::vector<math::Biquad> sections_;
  int padding_ = 0;
};

/// Noise of a model, n x axes, from stream `stream` of the seed; what is before its filter where there is
/// one, without its floor.
[[nodiscard]] math::SeriesMatrix noise_before_filter(const math::NoiseModel& model, std::int64_t samples,
                                                     std::int64_t axes, std::uint64_t seed,
                                                     std::uint64_t stream);

/// Its floor, likewise, added to the first `axes` columns from `column` on.
void add_floor(const math::NoiseModel& model, math::SeriesMatrix& to, std::int64_t column, std::int64_t axes,
               std::uint64_t seed, std::uint64_t stream);

}  // namespace kinemark::analysis
