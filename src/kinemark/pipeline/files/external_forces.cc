// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/external_forces.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/markers/marker_format.h"
#include "kinemark/io/osim/external_loads.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;

/// One frame of a wrench.
struct Push {
  Vector3d force, moment, point;

  static Push unknown() {
    const Vector3d nan = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return {nan, nan, nan};
  }
  static Push of(const data::Wrench& wrench, std::int64_t f) {
    const auto triple = [f](const Array<double>& values) -> Vector3d {
      return Eigen::Map<const Vector3d>(values.data() + 3 * f);
    };
    return {triple(wrench.force), triple(wrench.moment), triple(wrench.point)};
  }
  [[nodiscard]] bool rests() const { return force.isZero(0.0) && moment.isZero(0.0); }
  [[nodiscard]] Vector3d moment_about(const Vector3d& x) const {
    return rests() ? Vector3d(Vector3d::Zero()) : Vector3d(moment + (point - x).cross(force));
  }
};

Push between(const Push& a, const Push& b, double later) {
  Push push;
  if (a.rests())
    push.point = b.point;
  else if (b.rests())
    push.point = a.point;
  else
    push.point = (1.0 - later) * a.point + later * b.point;
  push.force = (1.0 - later) * a.force + later * b.force;
  push.moment =
      a.rests() && b.rests()
          ? Vector3d(Vector3d::Zero())
          : Vector3d((1.0 - later) * a.moment_about(push.point) + later * b.moment_about(push.point));
  return push;
}

Push at_frame(const data::Wrench& wrench, std::int64_t frames, double frame) {
  constexpr double kSame = 0.01;
  const double nearest = std::round(frame);
  if (!(nearest >= 0.0 && nearest < static_cast<double>(frames)) &&
      !(frame > 0.0 && frame < static_cast<double>(frames - 1)))
    return Push::unknown();
  if (std::abs(frame - nearest) < kSame) return Push::of(wrench, static_cast<std::int64_t>(nearest));
  if (frame < 0.0 || frame > static_cast<double>(frames - 1)) return Push::unknown();
  const double before = std::floor(frame);
  const auto f = static_cast<std::int64_t>(before);
  return between(Push::of(wrench, f), Push::of(wrench, f + 1), frame - before);
}

Result<ExternalForces> read_plates(const std::filesystem::path& path, const TimeBase& time,
                                   double contact_force_n) {
  const auto trial = io::read_markers(path);
  if (!trial) return std::unexpected(trial.error());
  auto plates = io::plate_forces(*trial, {.contact_force_n = contact_force_n});
  if (!plates) return std::unexpected(plates.error());
  ExternalForces out{.wrenches = resample(plates->wrenches, time), .files = {path}, .warnings = {}};
  // Of its other irregularities, those of its markers, nothing is used here.
  std::ranges::copy_if(trial->warnings, std::back_inserter(out.warnings),
                       [](const std::string& warning) { return warning.starts_with("force plate "); });
  std::ranges::move(plates->warnings, std::back_inserter(out.warnings));
  return out;
}

/// Whether files of an extension can hold force plates.
bool keeps_plates(std::string_view extension) {
  const auto* format = io::written_format(extension);
  return format != nullptr && format->keeps(io::Part::force_plates) != io::Kept::none;
}

Result<ExternalForces> read_loads(const std::filesystem::path& path, const TimeBase& time) {
  const auto loads = io::read_external_loads(path);
  if (!loads) return std::unexpected(loads.error());
  const auto table = io::read_table(loads->data_file);
  if (!table)
    return fail(table.error().code,
                fmt::format("{} (the <datafile> of {})", table.error().message, path.string()));
  auto wrenches = io::sample_external_loads(*loads, *table, time);
  if (!wrenches) return std::unexpected(wrenches.error());
  return ExternalForces{
      .wrenches = std::move(*wrenches), .files = {path, loads->data_file}, .warnings = table->warnings};
}

Result<ExternalForces> read_columns(const std::filesystem::path& path, const TimeBase& time) {
  const auto table = io::read_table(path);
  if (!table) return std::unexpected(table.error());
  const auto loads = io::loads_of_columns(*table, path);
  if (!loads) return std::unexpected(loads.error());
  auto wrenches = io::sample_external_loads(*loads, *table, time);
  if (!wrenches) return std::unexpected(wrenches.error());
  return ExternalForces{.wrenches = std::move(*wrenches), .files = {path}, .warnings = table->warnings};
}

}  // namespace

data::Wrenches resample(const data::Wrenches& wrenches, const TimeBase& time) {
  data::Wrenches out{.time = time, .items = {}};
  const TimeBase& from = wrenches.time;
  for (const data::Wrench& wrench : wrenches.items) {
    data::Wrench& to = out.items.emplace_back(data::Wrench{.name = wrench.name,
                                                           .body = wrench.body,
                                                           .force = {},
                                                           .moment = {},
                                                           .point = {},
                                                           .corners_in_world = wrench.corners_in_world});
    for (std::int64_t f = 0; f < time.frames; ++f) {
      const Push push = at_frame(wrench, wrenches.frames(), (time.time_s(f) - from.t0_s) * from.rate_hz);
      to.force.insert(to.force.end(), push.force.data(), push.force.data() + 3);
      to.moment.insert(to.moment.end(), push.moment.data(), push.moment.data() + 3);
      to.point.insert(to.point.end(), push.point.data(), push.point.data() + 3);
    }
  }
  return out;
}

Result<ExternalForces> read_external_forces(const std::filesystem::path& path, const TimeBase& time,
                                            double contact_force_n) {
  std::string kind = path.extension().string();
  std::ranges::transform(kind, kind.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (kind == ".xml") return read_loads(path, time);
  if (kind == ".mot" || kind == ".sto") return read_columns(path, time);
  if (keeps_plates(kind)) return read_plates(path, time, contact_force_n);
  return fail(
      Code::usage,
      fmt::format("{}: forces are read from the plates of a .c3d or .mat file, from a .mot or .sto with "
                  "columns such as ground_force_vx, or from an OpenSim ExternalLoads .xml",
                  path.string()));
}

}  // namespace kinemark::pipeline
