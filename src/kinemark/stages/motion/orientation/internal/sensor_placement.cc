// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_placement.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/math/rotation_between.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/model/kinematics.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::size_t kNamed = 12;
constexpr double kStanding_s = 0.5;  // of a recording without a pose of its own that should be still
constexpr double kUpright = 0.17;    // horizontal share of an axis, 10 deg off the vertical: no heading

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// "tibia_r" of "tibia_r_imu"; other names as they are.
std::string body_in_name(const std::string& sensor) {
  const auto name = lower(sensor);
  return name.ends_with("_imu") ? name.substr(0, name.size() - 4) : name;
}

int find_body(const data::ModelDescription& model, const std::string& name) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (lower(model.bodies[b].name) == name) return static_cast<int>(b);
  return data::kGround;
}

std::string list(const std::vector<std::string>& names) { return join_some(names, kNamed); }

/// Body of each sensor, kGround: none.
Result<std::vector<int>> match(const data::ModelDescription& model, const std::vector<std::string>& sensors,
                               const std::vector<SensorBody>& given) {
  std::vector<int> bodies;
  for (const auto& sensor : sensors) bodies.push_back(find_body(model, body_in_name(sensor)));
  for (const auto& [sensor, body] : given) {
    const auto found = std::ranges::find(sensors, sensor);
    if (found == sensors.end())
      return fail(Code::bad_input,
                  fmt::format("there is no sensor '{}'; the recording has {}", sensor, list(sensors)));
    const int b = find_body(model, lower(body));
    if (b == data::kGround)
      return fail(
          Code::bad_input,
          fmt::format("sensor '{}' is put on body '{}', which the model does not have", sensor, body));
    bodies[at(found - sensors.begin())] = b;
  }
  return bodies;
}

/// Mean orientation of a sensor over the frames that have it; no value: none has.
std::optional<Eigen::Matrix3d> mean_of(const data::Orientations& pose, std::int64_t sensor,
                                       std::int64_t first, std::int64_t count) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  bool any = false;
  for (std::int64_t f = first; f < first + count; ++f) {
    if (!pose.present(f, sensor)) continue;
    sum += pose.rotation(f, sensor);
    any = true;
  }
  if (!any) return std::nullopt;
  return math::fit_rotation(sum).rotation;
}

/// Angle between the mean orientations of the two halves of so many frames; 0 where one has none.
double drift_of(const data::Orientations& pose, std::int64_t sensor, std::int64_t first, std::int64_t count) {
  const auto before = mean_of(pose, sensor, first, count / 2),
             after = mean_of(pose, sensor, first + count / 2, count - count / 2);
  return before && after ? Eigen::AngleAxisd(before->transpose() * *after).angle() : 0.0;
}

/// The first frame in which all of these sensors are there.
Result<std::int64_t> first_whole_frame(const data::Orientations& recording, const std::vector<int>& bodies) {
  for (std::int64_t f = 0; f < recording.frames(); ++f) {
    bool whole = true;
    for (std::int64_t s = 0; s < recording.size(); ++s)
      whole = whole && (bodies[at(s)] == data::kGround || recording.present(f, s));
    if (whole) return f;
  }
  return fail(Code::bad_input,
              "no frame has the orientations of all sensors, from which they could be placed");
}

/// Sensors that are where the model says; their pose does not matter.
Result<PosedSensors> sensors_of_model(const data::ModelDescription& description,
                                      const data::Orientations& recording,
                                      const std::vector<PlacedSensor>& placed, PosedSensors out) {
  out.by_model = true;
  for (std::int64_t s = 0; s < recording.size(); ++s) {
    const auto& name = recording.names[at(s)];
    const auto found = std::ranges::find(placed, name, &PlacedSensor::sensor);
    if (found == placed.end()) {
      out.left_out.push_back(name);
      continue;
    }
    const int body = find_body(description, lower(found->body));
    if (body == data::kGround)
      return fail(
          Code::bad_input,
          fmt::format("sensor '{}' is put on body '{}', which the model does not have", name, found->body));
    out.sensors.push_back({.column = s,
                           .body_idx = body,
                           .world_from_sensor = {},
                           .world_from_body = {},
                           .body_from_sensor = found->body_from_sensor});
  }
  if (out.sensors.empty())
    return fail(Code::bad_input, "the recording has none of the sensors that are placed");
  return out;
}

/// Upright, and the body of each sensor; none where the model places them.
struct Matched {
  PosedSensors sensors;
  std::vector<int> bodies;
};

Result<Matched> match_upright(const data::ModelDescription& description, const data::Orientations& recording,
                              const OrientationOptions& options) {
  PosedSensors out;
  if (description.gravity.norm() > 0.0) out.up = -description.gravity.normalized();
  if (options.up_in_world.norm() > 0.0)
    out.model_from_world = math::rotation_between(options.up_in_world, out.up).toRotationMatrix();
  if (!options.placed.empty()) {
    auto placed = sensors_of_model(description, recording, options.placed, std::move(out));
    if (!placed) return std::unexpected(placed.error());
    return Matched{.sensors = std::move(*placed), .bodies = {}};
  }
  auto bodies = match(description, recording.names, options.sensors);
  if (!bodies) return std::unexpected(bodies.error());
  if (std::ranges::all_of(*bodies, [](int b) { return b == data::kGround; })) {
    std::vector<std::string> names;
    for (const auto& body : description.bodies) names.push_back(body.name);
    return fail(
        Code::bad_input,
        fmt::format("no sensor is named as a body of the model, with or without '_imu' behind it; the "
                    "recording has {}; the model has {}",
                    list(recording.names), list(names)));
  }
  for (std::int64_t s = 0; s < recording.size(); ++s)
    if ((*bodies)[at(s)] == data::kGround) out.left_out.push_back(recording.names[at(s)]);
  return Matched{.sensors = std::move(out), .bodies = std::move(*bodies)};
}

}  // namespace

Result<PosedSensors> pose_sensors(const model::Model& model, const data::Orientations& recording,
                                  const data::Orientations* pose, const OrientationOptions& options) {
  auto matched = match_upright(model.description(), recording, options);
  if (!matched) return std::unexpected(matched.error());
  auto& [out, bodies] = *matched;
  if (out.by_model) return std::move(out);
  std::int64_t first = 0;
  if (pose == nullptr) {
    const auto whole = first_whole_frame(recording, bodies);
    if (!whole) return std::unexpected(whole.error());
    first = *whole;
  } else {
    out.pose_frames = pose->frames();
  }
  const auto still =
      pose == nullptr ? std::min(recording.frames() - first,
                                 static_cast<std::int64_t>(std::lround(kStanding_s * recording.time.rate_hz)))
                      : out.pose_frames;
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  for (std::int64_t s = 0; s < recording.size(); ++s) {
    const auto& name = recording.names[at(s)];
    const int body = bodies[at(s)];
    if (body == data::kGround) continue;
    const auto& source = pose == nullptr ? recording : *pose;
    const auto column = std::ranges::find(source.names, name) - source.names.begin();
    const auto mean =
        column == source.size() ? std::nullopt : mean_of(source, column, first, out.pose_frames);
    if (!mean)
      return fail(Code::bad_input,
                  fmt::format("sensor '{}' is missing in the pose that places the sensors", name));
    out.drift_rad = std::max(out.drift_rad, drift_of(source, column, first, still));
    out.sensors.push_back({.column = s,
                           .body_idx = body,
                           .world_from_sensor = out.model_from_world * *mean,
                           .world_from_body = w.rotation[at(model.body_of(body))]});
  }
  return std::move(out);
}

Result<PosedSensors> sensors_on_bodies(const model::Model& model, const data::Orientations& recording,
                                       const OrientationOptions& options) {
  auto matched = match_upright(model.description(), recording, options);
  if (!matched) return std::unexpected(matched.error());
  auto& [out, bodies] = *matched;
  if (out.by_model) return std::move(out);
  out.unplaced = true;
  for (std::int64_t s = 0; s < recording.size(); ++s)
    if (bodies[at(s)] != data::kGround)
      out.sensors.push_back({.column = s,
                             .body_idx = bodies[at(s)],
                             .world_from_sensor = Eigen::Matrix3d::Identity(),
                             .world_from_body = Eigen::Matrix3d::Identity()});
  return std::move(out);
}

Status drop_unseen(const data::Orientations& recording, const std::vector<std::int64_t>& frames,
                   PosedSensors& posed, std::vector<std::string>& never_seen) {
  std::erase_if(posed.sensors, [&](const auto& sensor) {
    const bool seen =
        std::ranges::any_of(frames, [&](auto f) { return recording.present(f, sensor.column); });
    if (!seen) never_seen.push_back(recording.names[at(sensor.column)]);
    return !seen;
  });
  if (posed.sensors.empty())
    return fail(Code::bad_input, "no frame of the time range has an orientation of a sensor on a body");
  return {};
}

Eigen::Matrix3d body_from_sensor(const PosedSensors& posed, const PosedSensors::Sensor& sensor,
                                 double heading_rad) {
  if (sensor.body_from_sensor) return *sensor.body_from_sensor;
  return sensor.world_from_body.transpose() * Eigen::AngleAxisd(heading_rad, posed.up) *
         sensor.world_from_sensor;
}

Result<double> heading_of(const PosedSensors& posed, const data::Orientations& recording,
                          const FacingAxis& facing) {
  for (const auto& sensor : posed.sensors) {
    if (recording.names[at(sensor.column)] != facing.sensor) continue;
    const Eigen::Vector3d axis = sensor.world_from_sensor * facing.axis.normalized();
    const Eigen::Vector3d level = axis - axis.dot(posed.up) * posed.up;
    const Eigen::Vector3d forward = Eigen::Vector3d::UnitX() - posed.up.x() * posed.up;
    if (level.norm() < kUpright)
      return fail(
          Code::bad_input,
          fmt::format("the axis of sensor '{}' is upright in the pose and faces nowhere; name another",
                      facing.sensor));
    if (forward.norm() < kUpright)
      return fail(Code::bad_input, "the model's x axis is upright and faces nowhere");
    return std::atan2(level.cross(forward).dot(posed.up), level.dot(forward));
  }
  return fail(Code::bad_input,
              fmt::format("no sensor '{}' on a body, of which an axis could face forward", facing.sensor));
}

}  // namespace kinemark::motion::internal
