// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/upsampling.h"

#include <algorithm>
#include <iterator>

#include "kinemark/core/enum_names.h"

namespace kinemark::data {

std::string_view to_string(InterpolationKernel kernel) {
  static constexpr EnumNames<InterpolationKernel::akima> kNames{
      "none", "hold", "linear", "cubic spline", "Catmull-Rom", "Lagrange", "PCHIP", "Akima"};
  return kNames[kernel];
}

std::string_view to_string(BandVerdict verdict) {
  static constexpr EnumNames<BandVerdict::undecided> kNames{"unknown", "open",
                                                            "low-passed or model-generated", "undecided"};
  return kNames[verdict];
}

int Upsampling::phase_at(std::int64_t frame) const {
  const auto after = std::ranges::upper_bound(runs, frame, {}, &PhaseRun::first_frame);
  return after == runs.begin() ? phase : std::prev(after)->phase;
}

int UpsamplingAccount::factor() const {
  int largest = recording.factor;
  for (const Upsampling& marker : markers) largest = std::max(largest, marker.factor);
  return largest;
}

}  // namespace kinemark::data
