// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/rig_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/rig/calibrate_job.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

constexpr double kMostCells = 24.0;

struct Sample {
  std::array<double, 2> at;
  double sd_m;
};

std::vector<Sample> samples_of(const data::Trajectories& points, const std::array<int, 2>& axes) {
  std::vector<Sample> out;
  if (points.covariance.empty()) return out;
  for (std::int64_t f = 0; f < points.frames(); ++f)
    for (std::int64_t m = 0; m < points.markers(); ++m) {
      if (!points.present(f, m)) continue;
      const double* c = points.covariance.data() + 6 * points.index(f, m);
      const double trace = c[0] + c[3] + c[5];
      if (!std::isfinite(trace) || trace < 0.0) continue;
      out.push_back({{points.x(f, m)[axes[0]], points.x(f, m)[axes[1]]}, std::sqrt(trace)});
    }
  return out;
}

double side_of_cell(double reach_m) {
  const double least = std::max(reach_m, 1e-6) / kMostCells;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least) return step * power;
  return 10.0 * power;
}

using Json = nlohmann::ordered_json;
using report::Notice;
using report::Verdict;

constexpr double kFewLocated = 0.8;

report::SceneCamera drawn(const data::Camera& camera, bool nominal) {
  report::SceneCamera out{
      .name = camera.name, .centre_in_world = camera.centre_in_world(), .nominal = nominal};
  out.axes_in_world = camera.cam_from_world.inverse().rotation;
  // A detector reaches from -1 to 1; of an image in pixels the principal point is taken for its middle.
  const Eigen::Vector2d half = camera.kind == data::CameraKind::lateral_effect
                                   ? Eigen::Vector2d(1.0, 1.0)
                                   : Eigen::Vector2d(camera.principal_point);
  out.half_view =
      Eigen::Vector2d(half.x() / camera.focal, half.y() / (camera.focal * camera.aspect)).cwiseAbs();
  return out;
}

/// The tree's origin, a frame a pose.
data::Trajectories poses_of(const CalibrateOutcome& outcome) {
  const auto poses = outcome.bundle ? std::ssize(outcome.bundle->world_from_tree) : 0;
  auto out = data::Trajectories::all_missing(
      {"origin of the tree"}, {.rate_hz = 1.0, .t0_s = 0.0, .frames = std::max<std::int64_t>(1, poses)});
  for (std::int64_t f = 0; f < poses; ++f) {
    out.x(f, 0) = outcome.bundle->world_from_tree[static_cast<std::size_t>(f)].translation;
    out.state[out.index(f, 0)] = data::SampleState::measured;
  }
  return out;
}

std::vector<report::NoticeGroup> groups_of(const ReconstructOutcome& outcome) {
  std::vector<report::NoticeGroup> groups;
  std::vector<Notice> never, few, contradicted;
  for (const auto& led : outcome.found.leds) {
    const double share =
        led.frames > 0 ? static_cast<double>(led.located) / static_cast<double>(led.frames) : 0.0;
    const Notice notice{.subject = led.name,
                        .text = fmt::format("{}: located in {} of {} frames; {} occluded, {} saturated, {} "
                                            "where the cameras contradict each other.",
                                            led.name, led.located, led.frames, led.occluded, led.saturated,
                                            led.inconsistent)};
    if (led.located == 0)
      never.push_back(notice);
    else if (share < kFewLocated)
      few.push_back(notice);
    if (led.inconsistent > 0 && led.located > 0)
      contradicted.push_back(
          {.subject = led.name,
           .text = fmt::format("{}: the cameras contradict each other in {} of {} frames; no point there.",
                               led.name, led.inconsistent, led.frames)});
  }
  report::add_gates(groups, outcome.gates);
  report::add_group(groups, Verdict::attention, "marker", "LED located in no frame",
                    "LEDs located in no frame", std::move(never));
  report::add_group(groups, Verdict::attention, "marker", "LED located in less than 80 % of the frames",
                    "LEDs located in less than 80 % of the frames", std::move(few));
  report::add_group(groups, Verdict::good, "marker", "LED with frames that the cameras contradict",
                    "LEDs with frames that the cameras contradict", std::move(contradicted));
  report::add_remarks(groups, outcome.warnings);
  return groups;
}

Json number(double value, double unit) { return std::isfinite(value) ? Json(unit * value) : Json(nullptr); }

Json map_json(const PrecisionMap& map) {
  if (map.columns == 0) return nullptr;
  Json cells = Json::array();
  for (const double sd : map.sd_m) cells.push_back(number(sd, 1e3));
  return {{"axes", map.axes}, {"first_m", map.first},      {"cell_m", map.cell_m},  {"columns", map.columns},
          {"rows", map.rows}, {"sd_mm", std::move(cells)}, {"samples", map.samples}};
}

/// Light as each camera sees it, of LEDs whose light is known; frames that no camera was looked at in left
/// out.
Json light_curves(const ReconstructOutcome& outcome, const data::Rig& rig, const data::Trajectories& points) {
  Json out = Json::array();
  for (std::size_t led = 0; led < outcome.found.lights.size(); ++led) {
    const auto& found = outcome.found.lights[led];
    if (found.source == reconstruction::LightSource::unknown) continue;
    Json names = Json::array(), time = Json::array(), seen = Json::array();
    const auto cameras = rig.cameras.size();
    for (const auto& camera : rig.cameras) {
      names.push_back(camera.name);
      seen.push_back(Json::array());
    }
    for (std::int64_t f = 0; f < points.frames(); ++f) {
      const double* row = found.seen.data() + static_cast<std::size_t>(f) * cameras;
      if (std::all_of(row, row + cameras, [](double v) { return std::isnan(v); })) continue;
      time.push_back(points.time.time_s(f));
      for (std::size_t c = 0; c < cameras; ++c) seen[c].push_back(number(row[c], 1.0));
    }
    if (!time.empty())
      out.push_back({{"led", points.names[led]}, {"cameras", names}, {"time_s", time}, {"seen", seen}});
  }
  return out;
}

/// Where a camera's lens and axes are known to, from the rig's covariance.
Json cameras_json(const data::Rig& rig) {
  Json out = Json::array();
  for (int c = 0; c < rig.camera_count(); ++c) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(c)];
    const Eigen::Vector3d x = camera.centre_in_world();
    Json entry{{"name", camera.name},
               {"centre_mm", {1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z()}},
               {"centre_sd_mm", nullptr},
               {"rotation_sd_deg", nullptr}};
    if (rig.covariance.size() > 0) {
      const auto sd = [&](int first, double unit) {
        const auto rows = rig.covariance.diagonal().segment<3>(rig.first_parameter(c) + first);
        const Eigen::Vector3d root = unit * rows.cwiseMax(0.0).cwiseSqrt();
        return Json::array({root.x(), root.y(), root.z()});
      };
      entry["centre_sd_mm"] = sd(data::ParameterLayout::centre, 1e3);
      entry["rotation_sd_deg"] = sd(data::ParameterLayout::rotation, kDegPerRad);
    }
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace

PrecisionMap precision_map(const data::Trajectories& points, int along) {
  PrecisionMap map{.axes = {along == 0 ? 1 : 0, along == 2 ? 1 : 2}};
  const auto samples = samples_of(points, map.axes);
  if (samples.empty()) return map;
  std::array<double, 2> low{samples.front().at}, high = low;
  for (const auto& sample : samples)
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], sample.at[k]);
      high[k] = std::max(high[k], sample.at[k]);
    }
  map.cell_m = side_of_cell(std::max(high[0] - low[0], high[1] - low[1]));
  const auto cell_of = [&](std::size_t k, double value) {
    return static_cast<std::int64_t>(std::floor((value - map.first[k]) / map.cell_m));
  };
  for (std::size_t k = 0; k < 2; ++k) map.first[k] = map.cell_m * std::floor(low[k] / map.cell_m);
  map.columns = cell_of(0, high[0]) + 1;
  map.rows = cell_of(1, high[1]) + 1;
  std::vector<std::vector<double>> cells(static_cast<std::size_t>(map.columns * map.rows));
  for (const auto& sample : samples)
    cells[static_cast<std::size_t>(cell_of(1, sample.at[1]) * map.columns + cell_of(0, sample.at[0]))]
        .push_back(sample.sd_m);
  for (auto& cell : cells) {
    map.samples.push_back(std::ssize(cell));
    if (cell.empty()) {
      map.sd_m.push_back(kNaN);
      continue;
    }
    const auto middle = cell.begin() + std::ssize(cell) / 2;
    std::ranges::nth_element(cell, middle);
    map.sd_m.push_back(*middle);
  }
  return map;
}

std::string calibrate_page(const CalibrateJob& job, const CalibrateOutcome& outcome, const data::Rig& nominal,
                           const data::Rig& found) {
  report::ResultReport page{.kind = "calibrate",
                            .trial = job.inputs.empty() ? "" : job.inputs.front().filename().string(),
                            .version = std::string(kVersion),
                            .command_line = job.command_line};
  report::add_gates(page.groups, outcome.gates);
  if (outcome.alignment && !outcome.alignment->aligned)
    report::add_group(page.groups, Verdict::good, "camera", "camera is to be turned or moved", "",
                      {{.text = outcome.alignment->next}});
  report::add_remarks(page.groups, outcome.warnings);
  page.result = calibrate_json(outcome);
  page.result["cameras"] = cameras_json(found);
  const data::Trajectories poses = poses_of(outcome);
  report::Scene scene{.markers = &poses};
  for (const auto& camera : found.cameras) scene.cameras.push_back(drawn(camera, false));
  for (const auto& camera : nominal.cameras) scene.cameras.push_back(drawn(camera, true));
  page.scene = std::move(scene);
  return report::result_report_html(page);
}

std::string reconstruct_page(const ReconstructJob& job, const ReconstructOutcome& outcome,
                             const data::Rig& rig, const data::Trajectories& points) {
  report::ResultReport page{.kind = "reconstruct",
                            .trial = job.recording.filename().string(),
                            .version = std::string(kVersion),
                            .command_line = job.command_line,
                            .groups = groups_of(outcome),
                            .result = reconstruct_json(outcome)};
  if (!outcome.found.lights.empty()) page.result["light_curves"] = light_curves(outcome, rig, points);
  page.result["precision"] = Json::array();
  for (const int along : {1, 2}) page.result["precision"].push_back(map_json(precision_map(points, along)));
  report::Scene scene{.markers = &points};
  for (const auto& camera : rig.cameras) scene.cameras.push_back(drawn(camera, false));
  page.scene = std::move(scene);
  return report::result_report_html(page);
}

}  // namespace kinemark::pipeline
