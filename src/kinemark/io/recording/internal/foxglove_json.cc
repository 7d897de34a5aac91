// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/internal/foxglove_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

using Json = nlohmann::json;
using Positions = std::vector<TimedPosition>;

constexpr int kMostDepth = 16;  // of JSON; a scene has six
constexpr std::string_view kPrefix = "foxglove.";

const Json& member(const Json& json, const char* key) {
  static const Json kNothing;
  if (!json.is_object()) return kNothing;
  const auto found = json.find(key);
  return found == json.end() ? kNothing : *found;
}

std::string text_at(const Json& json, const char* key) {
  const Json& text = member(json, key);
  return text.is_string() ? name_of_bytes(text.get_ref<const std::string&>()) : "";
}

/// {"x": .., "y": .., "z": ..}, all three, or NaN.
Eigen::Vector3d vector_of(const Json& json) {
  Eigen::Vector3d out;
  constexpr std::array kAxes = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Json& number = member(json, kAxes[axis]);
    if (!number.is_number()) return Eigen::Vector3d::Constant(kNaN);
    out[static_cast<Eigen::Index>(axis)] = number.get<double>();
  }
  return out.allFinite() ? out : Eigen::Vector3d::Constant(kNaN);
}

/// {"sec": .., "nsec": ..}; nothing where it is not there.
std::optional<std::int64_t> time_of(const Json& json) {
  const Json& seconds = member(json, "sec");
  const Json& rest = member(json, "nsec");
  if (!seconds.is_number_integer() || !rest.is_number_integer()) return std::nullopt;
  const auto s = seconds.get<std::int64_t>(), ns = rest.get<std::int64_t>();
  if (s < 0 || s > 9'000'000'000 || ns < 0 || ns > 999'999'999) return std::nullopt;
  return s * 1'000'000'000 + ns;
}

/// What the messages of a channel are called after.
std::string point_of(const RecordingChannel& channel) {
  std::string_view topic = channel.topic;
  while (topic.starts_with('/')) topic.remove_prefix(1);
  std::string name = name_of_bytes(topic);
  return name.empty() ? "point" : name;
}

/// Whose, when, and where positions go.
struct Context {
  const RecordingChannel& channel;
  std::int64_t log_time_ns;
  Positions& out;

  [[nodiscard]] std::int64_t time(const Json& json) const {
    return time_of(member(json, "timestamp")).value_or(log_time_ns);
  }
  void add(std::string point, std::string frame, std::int64_t time_ns, const Json& x) const {
    out.push_back({std::move(point), std::move(frame), time_ns, vector_of(x)});
  }
};

void take_transform(const Json& json, const Context& to) {
  const std::string child = text_at(json, "child_frame_id");
  if (!child.empty())
    to.add(child, text_at(json, "parent_frame_id"), to.time(json), member(json, "translation"));
}

void take_transforms(const Json& json, const Context& to) {
  for (const Json& transform : member(json, "transforms")) take_transform(transform, to);
}

void take_pose(const Json& json, const Context& to) {
  to.add(point_of(to.channel), text_at(json, "frame_id"), to.time(json),
         member(member(json, "pose"), "position"));
}

void take_poses(const Json& json, const Context& to) {
  int n = 0;
  for (const Json& pose : member(json, "poses"))
    to.add(fmt::format("{}_{}", point_of(to.channel), ++n), text_at(json, "frame_id"), to.time(json),
           member(pose, "position"));
}

/// Solid things of an entity; an entity of one gives it its name.
void take_entity(const Json& entity, const Context& to) {
  std::vector<const Json*> solids;
  for (const char* kind : {"spheres", "cubes", "cylinders", "models"})
    for (const Json& solid : member(entity, kind)) solids.push_back(&solid);
  std::string name = text_at(entity, "id");
  if (name.empty()) name = point_of(to.channel);
  int n = 0;
  for (const Json* solid : solids)
    to.add(solids.size() == 1 ? name : fmt::format("{}_{}", name, ++n), text_at(entity, "frame_id"),
           to.time(entity), member(member(*solid, "pose"), "position"));
}

void take_scene(const Json& json, const Context& to) {
  for (const Json& entity : member(json, "entities")) take_entity(entity, to);
}

void take_point(const Json& json, const Context& to) {
  to.add(point_of(to.channel), "", to.log_time_ns, json);
}

struct Schema {
  std::string_view name;
  void (*take)(const Json& json, const Context& to);
};
constexpr std::array<Schema, 6> kSchemas = {{{"FrameTransform", take_transform},
                                             {"FrameTransforms", take_transforms},
                                             {"PoseInFrame", take_pose},
                                             {"PosesInFrame", take_poses},
                                             {"SceneUpdate", take_scene},
                                             {"Point3", take_point}}};

const Schema* schema_of(const RecordingChannel& channel) {
  if (channel.message_encoding != "json" || !channel.schema_name.starts_with(kPrefix)) return nullptr;
  const auto found = std::ranges::find(kSchemas, std::string_view(channel.schema_name).substr(kPrefix.size()),
                                       &Schema::name);
  return found == kSchemas.end() ? nullptr : &*found;
}

}  // namespace

bool holds_positions(const RecordingChannel& channel) { return schema_of(channel) != nullptr; }

std::string names_of_position_schemas() {
  std::vector<std::string> names;
  for (const Schema& schema : kSchemas) names.push_back(std::string(kPrefix) + std::string(schema.name));
  return join_names(names, names.size());
}

Status take_positions(const RecordingChannel& channel, const RecordingMessage& message, Positions& out) {
  const Schema* schema = schema_of(channel);
  const auto* begin = reinterpret_cast<const char*>(message.data.data());
  // What lies too deep is no part of these schemas and is not kept.
  const auto shallow = [](int depth, Json::parse_event_t, const Json&) { return depth <= kMostDepth; };
  const Json json = Json::parse(begin, begin + message.data.size(), shallow, false);
  if (!json.is_object())
    return fail(Code::bad_input,
                fmt::format("a message of '{}' is no object of JSON", printable(channel.topic, 80)));
  schema->take(json,
               {channel, static_cast<std::int64_t>(message.log_time_ns & 0x7FFF'FFFF'FFFF'FFFFULL), out});
  return {};
}

}  // namespace kinemark::io::internal
