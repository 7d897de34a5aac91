// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/around/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"

namespace kinemark::workflow {
namespace {

using analysis::SampledCurve;

/// True times of a marker's samples.
std::vector<double> times_of(const data::Trajectories& markers, std::int64_t marker) {
  std::vector<double> out;
  const auto& offset = markers.sample_offset_s;
  const bool each = offset.size() == markers.names.size();
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double own = offset.empty() ? 0.0 : each ? offset[at(marker)] : offset[markers.index(f, marker)];
    out.push_back(markers.time.time_s(f) + (std::isfinite(own) ? own : 0.0));
  }
  return out;
}

/// What a column of a motion or of forces holds, by the names that OpenSim gives; an angle where they say
/// nothing else.
data::Quantity quantity_of(std::string_view column) {
  const auto ends = [&](std::initializer_list<std::string_view> words) {
    return std::ranges::any_of(words, [&](std::string_view word) { return column.ends_with(word); });
  };
  if (column.find("_moment") != std::string_view::npos || column.find("_torque") != std::string_view::npos)
    return data::Quantity::moment;
  if (ends({"_vx", "_vy", "_vz", "_force"})) return data::Quantity::force;
  if (ends({"_tx", "_ty", "_tz", "_px", "_py", "_pz"})) return data::Quantity::length;
  return data::Quantity::angle;
}

std::string_view id_of(data::Quantity quantity) {
  switch (quantity) {
    case data::Quantity::moment:
      return "moment";
    case data::Quantity::force:
      return "force";
    case data::Quantity::length:
      return "position";
    default:
      return "angle";
  }
}

}  // namespace

std::vector<SampledCurve> curves_of(const data::Trajectories& markers, const data::Derivatives* rates) {
  constexpr std::array kAxes = {"x", "y", "z"};
  const bool speeds = rates != nullptr && !rates->velocity.empty();
  std::vector<SampledCurve> out;
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    const auto times = times_of(markers, m);
    std::array<SampledCurve, 4> own;
    for (std::size_t k = 0; k < own.size(); ++k)
      own[k] = {.subject = markers.names[at(m)],
                .id = k < kAxes.size() ? kAxes[k] : "speed",
                .quantity = k < kAxes.size() ? data::Quantity::length : data::Quantity::speed,
                .time_s = times,
                .value = std::vector<double>(times.size(), kNaN)};
    bool any = false;
    for (std::int64_t f = 0; f < markers.frames(); ++f) {
      if (!markers.present(f, m)) continue;
      any = true;
      const auto x = markers.x(f, m);
      for (std::size_t k = 0; k < kAxes.size(); ++k) own[k].value[at(f)] = x[static_cast<Eigen::Index>(k)];
      if (!speeds) continue;
      const Eigen::Map<const Eigen::Vector3d> v(rates->velocity.data() + 3 * markers.index(f, m));
      own[3].value[at(f)] = v.norm();
    }
    if (!any) continue;
    const std::size_t count = speeds ? 4 : 3;
    for (std::size_t k = 0; k < count; ++k) out.push_back(std::move(own[k]));
  }
  return out;
}

std::vector<SampledCurve> curves_of(const data::Table& motion, bool degrees) {
  std::vector<SampledCurve> out;
  for (std::size_t c = 0; c < motion.columns.size(); ++c) {
    const auto quantity = quantity_of(motion.columns[c]);
    SampledCurve one{.subject = motion.columns[c],
                     .id = std::string(id_of(quantity)),
                     .quantity = quantity,
                     .time_s = {motion.time_s.begin(), motion.time_s.end()},
                     .value = {}};
    const double si = quantity == data::Quantity::angle && degrees ? kRadPerDeg : 1.0;
    for (std::int64_t r = 0; r < motion.rows(); ++r)
      one.value.push_back(si * motion(r, static_cast<std::int64_t>(c)));
    out.push_back(std::move(one));
  }
  return out;
}

analysis::ObservedSpan span_of(const std::vector<SampledCurve>& curves) {
  analysis::ObservedSpan out;
  for (const auto& curve : curves) {
    if (curve.time_s.empty()) continue;
    out.start_s =
        std::isfinite(out.start_s) ? std::min(out.start_s, curve.time_s.front()) : curve.time_s.front();
    out.end_s = std::isfinite(out.end_s) ? std::max(out.end_s, curve.time_s.back()) : curve.time_s.back();
  }
  return out;
}

}  // namespace kinemark::workflow
