// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/force_plates.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "kinemark/io/c3d/internal/count.h"
#include "kinemark/io/c3d/internal/plate_channels.h"
#include "kinemark/io/c3d/internal/plate_corners.h"

namespace kinemark::io {
namespace {

constexpr double kFar = 1000.0;  // m; a corner further away is an invalid number

bool near(const Eigen::Vector3d& x) { return (x.array().abs() < kFar).all(); }

Eigen::Vector3d metres3(const std::vector<double>& values, std::size_t at, double metres) {
  return at + 3 <= values.size()
             ? Eigen::Vector3d(metres * Eigen::Map<const Eigen::Vector3d>(values.data() + at))
             : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

void read_calibration(const C3dParameter* calibrations, std::size_t i, data::ForcePlate& plate) {
  if (calibrations == nullptr || calibrations->dims.size() < 2) return;
  const std::size_t size =
      static_cast<std::size_t>(calibrations->dims[0]) * static_cast<std::size_t>(calibrations->dims[1]);
  if (size == 0 || (i + 1) * size > calibrations->numbers.size()) return;
  const auto begin = calibrations->numbers.begin() + static_cast<std::ptrdiff_t>(i * size);
  plate.calibration.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
  plate.calibration_rows = calibrations->dims[0];
}

/// Kistler's polynomial, six numbers for x and then six for y; zeros, which correct nothing, are none.
void read_pressure_correction(const C3dParameter* polynomials, std::size_t i, data::ForcePlate& plate,
                              std::vector<std::string>& warnings) {
  constexpr std::size_t kNumbers = 12;
  if (polynomials == nullptr || i * kNumbers >= polynomials->numbers.size()) return;
  const auto& numbers = polynomials->numbers;
  const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(i * kNumbers);
  const auto end = begin + static_cast<std::ptrdiff_t>(std::min(kNumbers, numbers.size() - i * kNumbers));
  if (std::all_of(begin, end, [](double v) { return v == 0.0; })) return;
  const auto& dims = polynomials->dims;
  if (dims.size() >= 2 && dims[0] == 6 && dims[1] == 2 && end - begin == kNumbers &&
      std::all_of(begin, end, [](double v) { return std::isfinite(v); })) {
    for (std::ptrdiff_t k = 0; k < 6; ++k) {
      plate.pressure_correction.push_back(begin[k]);
      plate.pressure_correction.push_back(begin[6 + k]);
    }
    return;
  }
  warnings.push_back(
      fmt::format("force plate {}: what corrects its centre of pressure (FPCOPPOLY) is not 6 x 2 finite "
                  "numbers; it is not corrected",
                  i + 1));
}

}  // namespace

std::vector<data::ForcePlate> find_force_plates(const C3dParameters& parameters, const C3dLayout& layout,
                                                std::vector<std::string>& warnings) {
  const C3dParameters& p = parameters;
  const std::size_t used = internal::bounded_count(p.number("FORCE_PLATFORM", "USED").value_or(0.0), 255);
  const C3dParameter* channels = p.find("FORCE_PLATFORM", "CHANNEL");
  const C3dParameter* calibrations = p.find("FORCE_PLATFORM", "CAL_MATRIX");
  const std::vector<double> types = p.numbers("FORCE_PLATFORM", "TYPE");
  const C3dParameter* corners = p.find("FORCE_PLATFORM", "CORNERS");
  const std::vector<double> origins = p.numbers("FORCE_PLATFORM", "ORIGIN");
  const C3dParameter* polynomials = p.find("FORCE_PLATFORM", "FPCOPPOLY");
  const internal::AnalogLabels analog{.labels = p.texts("ANALOG", "LABELS"), .count = layout.analog_channels};
  const auto used_types = std::span(types).first(std::min(used, types.size()));
  const int first_number = internal::first_channel_number(channels, used_types, analog, warnings);
  internal::note_other_labels(channels, used_types, analog, first_number, warnings);
  std::vector<data::ForcePlate> plates;
  for (std::size_t i = 0; i < used; ++i) {
    data::ForcePlate plate{.number = static_cast<int>(i) + 1, .metres_per_unit = layout.metres_per_unit};
    plate.type = i < types.size() ? static_cast<int>(internal::bounded_count(types[i], 1000)) : 0;
    if (plate.type > 0)
      plate.channel_idx =
          internal::channels_of_plate(channels, i, plate.type, layout.analog_channels, first_number);
    if (plate.channel_idx.empty()) {
      warnings.push_back(
          fmt::format("force plate {} is left out: its type or its analog channels are not valid", i + 1));
      continue;
    }
    for (std::size_t c = 0; c < 4; ++c)
      plate.corners_in_world[c] = layout.metres_per_unit * internal::plate_corner(corners, i, c);
    plate.origin_in_plate = metres3(origins, 3 * i, layout.metres_per_unit);
    internal::settle_plate_unit(plate, layout.metres_per_unit, warnings);
    read_calibration(calibrations, i, plate);
    read_pressure_correction(polynomials, i, plate, warnings);
    if (!std::ranges::all_of(plate.corners_in_world, near) || !near(plate.origin_in_plate))
      warnings.push_back(
          fmt::format("force plate {} has corners or an origin that are not plausible", i + 1));
    plates.push_back(std::move(plate));
  }
  internal::settle_corner_order(plates, warnings);
  return plates;
}

std::array<double, 2> unloaded_times(const C3dParameters& parameters, const TimeBase& time,
                                     std::vector<std::string>& warnings) {
  constexpr std::array<double, 2> kNone{0.0, -1.0};
  auto zero = parameters.numbers("FORCE_PLATFORM", "ZERO");
  const auto frames = static_cast<double>(time.frames);
  if (zero.size() < 2 || !(zero[1] >= 1.0)) return kNone;
  // The manual: a range that begins at 0 begins at the first frame.
  if (zero[0] == 0.0) zero[0] = 1.0;
  if (!(zero[0] >= 1.0 && zero[0] <= zero[1] && zero[1] <= frames)) {
    warnings.push_back(
        fmt::format("FORCE_PLATFORM:ZERO names frames {:g} to {:g} of {:g}: no baseline is subtracted",
                    zero[0], zero[1], frames));
    return kNone;
  }
  const auto time_of = [&](double number) { return time.time_s(static_cast<std::int64_t>(number) - 1); };
  return {time_of(zero[0]), time_of(zero[1])};
}

}  // namespace kinemark::io
