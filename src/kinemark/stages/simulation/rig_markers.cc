// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_markers.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>
#include <numbers>

#include "kinemark/math/euler.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/stages/simulation/rig_recording.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;

/// Present samples without a gap.
struct Run {
  double first_s = 0.0, last_s = 0.0;
  std::array<math::ScalarFunction, 3> axis;
};

struct Path {
  std::vector<Run> runs;  ///< in order of time

  [[nodiscard]] LedState at(double time_s) const {
    auto run = std::ranges::lower_bound(runs, time_s, {}, &Run::last_s);
    if (run == runs.end() || time_s < run->first_s) return {.shining = false};
    LedState out;
    for (std::size_t a = 0; a < 3; ++a) out.x_in_world[static_cast<Eigen::Index>(a)] = run->axis[a](time_s).f;
    return out;
  }
};

Result<Path> follow(const data::Trajectories& markers, std::int64_t m, const math::SE3& rig_from_lab) {
  Path path;
  std::vector<double> time_s;
  std::array<std::vector<double>, 3> x;
  for (std::int64_t f = 0; f <= markers.frames(); ++f) {
    if (f < markers.frames() && markers.present(f, m)) {
      const Vector3d at = rig_from_lab * markers.x(f, m);
      time_s.push_back(markers.time_s(f, m) - markers.time.t0_s);
      for (std::size_t a = 0; a < 3; ++a) x[a].push_back(at[static_cast<Eigen::Index>(a)]);
      continue;
    }
    if (time_s.size() > 1) {
      Run run{.first_s = time_s.front(), .last_s = time_s.back(), .axis = {}};
      for (std::size_t a = 0; a < 3; ++a) {
        auto spline = math::ScalarFunction::natural_spline(time_s, x[a]);
        if (!spline) return fail_at(markers.names[static_cast<std::size_t>(m)], spline.error());
        run.axis[a] = std::move(*spline);
      }
      path.runs.push_back(std::move(run));
    }
    time_s.clear();
    for (auto& axis : x) axis.clear();
  }
  if (path.runs.empty())
    return fail(Code::bad_input, fmt::format("marker '{}' is never seen in two frames that follow each other",
                                             markers.names[static_cast<std::size_t>(m)]));
  return path;
}

Result<std::vector<std::int64_t>> choose(const data::Trajectories& markers,
                                         const std::vector<std::string>& names) {
  std::vector<std::int64_t> out;
  for (const std::string& name : names.empty() ? markers.names : names) {
    const auto m = markers.find(name);
    if (m < 0)
      return fail(Code::bad_input, fmt::format("there is no marker '{}' among the {} of the recording", name,
                                               markers.markers()));
    if (std::ranges::find(out, m) != out.end())
      return fail(Code::usage, fmt::format("marker '{}' is named twice", name));
    out.push_back(m);
  }
  if (out.empty() || out.size() > static_cast<std::size_t>(kMostLeds))
    return fail(Code::usage, fmt::format("{} markers as LEDs; the rig drives 1 to {}: name those to use",
                                         out.size(), kMostLeds));
  return out;
}

math::SE3 pose_in_rig(const data::Trajectories& markers, const std::vector<std::int64_t>& chosen,
                      const MarkerSceneOptions& options) {
  math::SE3 out;
  if (options.z_is_up) out.rotation = math::axis_angle(Vector3d::UnitX(), -std::numbers::pi / 2.0);
  if (!options.centred) return out;
  Eigen::AlignedBox3d box;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (const auto m : chosen)
      if (markers.present(f, m)) box.extend(out.rotation * markers.x(f, m));
  if (!box.isEmpty()) out.translation = -box.center();
  return out;
}

}  // namespace

Result<RigScene> markers_as_leds(const data::Trajectories& markers, const MarkerSceneOptions& options) {
  if (auto s = markers.validate(); !s) return std::unexpected(s.error());
  const auto chosen = choose(markers, options.markers);
  if (!chosen) return std::unexpected(chosen.error());
  const math::SE3 rig_from_lab = pose_in_rig(markers, *chosen, options);
  const auto paths = std::make_shared<std::vector<Path>>();
  RigScene scene;
  for (const auto m : *chosen) {
    auto path = follow(markers, m, rig_from_lab);
    if (!path) return std::unexpected(path.error());
    paths->push_back(std::move(*path));
    scene.leds.push_back(markers.names[static_cast<std::size_t>(m)]);
  }
  scene.led = [paths](int led, double time_s) { return (*paths)[static_cast<std::size_t>(led)].at(time_s); };
  return scene;
}

}  // namespace kinemark::simulation
