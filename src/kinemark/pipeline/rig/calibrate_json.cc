// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/calibrate_json.h"

#include <utility>

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json alignment_json(const calibration::Alignment& alignment) {
  Json cameras = Json::array();
  const auto list = [](const Eigen::Vector3d& v, double unit) {
    return Json::array({unit * v.x(), unit * v.y(), unit * v.z()});
  };
  for (const auto& c : alignment.cameras)
    cameras.push_back({{"camera", c.camera},
                       {"right_down_forward_mm", list(c.shift_m, 1e3)},
                       {"right_down_forward_sd_mm", list(c.shift_sd_m, 1e3)},
                       {"tilt_pan_roll_deg", list(c.rotation_deg, 1.0)},
                       {"tilt_pan_roll_sd_deg", list(c.rotation_sd_deg, 1.0)}});
  return {{"cameras", std::move(cameras)}, {"aligned", alignment.aligned}, {"next", alignment.next}};
}

}  // namespace

Json calibrate_json(const CalibrateOutcome& outcome) {
  Json json;
  json["method"] = to_string(outcome.method);
  if (outcome.bundle) {
    json["chi2_per_dof"] = outcome.bundle->chi2_per_dof;
    json["warp_degree"] = outcome.bundle->warp_degree;
    json["crosstalk"] = outcome.bundle->crosstalk;
    json["iterations"] = outcome.bundle->iterations;
    json["poses"] = outcome.bundle->poses;
    json["sightings"] = outcome.bundle->observations;
    json["outliers"] = outcome.bundle->outliers;
    json["side_rms_mm"] = 1e3 * outcome.bundle->side_rms_m;
  }
  if (outcome.alignment) json["alignment"] = alignment_json(*outcome.alignment);
  if (outcome.has_rig) json["written"] = outcome.written.front().string();
  json["warnings"] = outcome.warnings;
  return json;
}

}  // namespace kinemark::pipeline
