// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/upsampling.h"

#include <algorithm>
#include <iterator>

namespace kinemark::data {

std::string_view to_string(InterpolationKernel kernel) {
  switch (kernel) {
    case InterpolationKernel::none:
      return "none";
    case InterpolationKernel::hold:
      return "hold";
    case InterpolationKernel::linear:
      return "linear";
    case InterpolationKernel::spline:
      return "cubic spline";
    case InterpolationKernel::catmull_rom:
      return "Catmull-Rom";
    case InterpolationKernel::lagrange:
      return "Lagrange";
    case InterpolationKernel::pchip:
      return "PCHIP";
    case InterpolationKernel::akima:
      return "Akima";
  }
  return "unknown";
}

std::string_view to_string(BandVerdict verdict) {
  switch (verdict) {
    case BandVerdict::unknown:
      return "unknown";
    case BandVerdict::open:
      return "open";
    case BandVerdict::low_passed:
      return "low-passed or model-generated";
    case BandVerdict::undecided:
      return "undecided";
  }
  return "unknown";
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
