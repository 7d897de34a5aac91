// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/skeleton_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "kinemark/io/file.h"

namespace kinemark::pipeline {
namespace {

using JsonValue = nlohmann::json;

constexpr std::size_t kMostBytes = 64UL << 20;

/// A member of an object, or null.
const JsonValue& member(const JsonValue& object, const char* name) {
  static const JsonValue kNull;
  const auto found = object.find(name);
  return found == object.end() ? kNull : *found;
}

std::string text_of(const JsonValue& object, const char* name) {
  const JsonValue& value = member(object, name);
  return value.is_string() ? value.get<std::string>() : std::string();
}

double number_of(const JsonValue& object, const char* name) {
  const JsonValue& value = member(object, name);
  return value.is_number() ? value.get<double>() : kNaN;
}

bool fill(const JsonValue& list, std::span<double, 3> out) {
  if (!list.is_array() || list.size() != out.size()) return false;
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!list[k].is_number() && !list[k].is_null()) return false;
    out[k] = list[k].is_number() ? list[k].get<double>() : kNaN;
  }
  return true;
}

/// Where in the file something is wrong.
class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  Result<SkeletonFile> read(const JsonValue& json) {
    if (!json.is_object() || text_of(json, "schema") != "kinemark.skeleton")
      return fail(Code::bad_input,
                  fmt::format("{}: not a skeleton.json; need one that 'kinemark joints' wrote", name_));
    auto& skeleton = out_.skeleton;
    skeleton.time = {.rate_hz = 1.0, .t0_s = 0.0, .frames = 0};
    skeleton.noise_sd_m = number_of(json, "noise_sd_m");
    if (const JsonValue& input = member(json, "input"); input.is_object())
      out_.recording = {.role = "markers", .path = text_of(input, "path"), .hash = text_of(input, "xxh3_64")};
    const JsonValue &segments = member(json, "segments"), &joints = member(json, "joints");
    if (!segments.is_array()) return wrong("segments", "a list of segments");
    if (!joints.is_array()) return wrong("joints", "a list of joints");
    for (std::size_t s = 0; s < segments.size(); ++s)
      if (auto status = read_segment(segments[s], fmt::format("segments[{}]", s)); !status)
        return std::unexpected(status.error());
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (auto status = read_joint(joints[j], fmt::format("joints[{}]", j)); !status)
        return std::unexpected(status.error());
    skeleton.allocate_centres();
    if (auto status = skeleton.validate(); !status) return fail_at(name_, status.error());
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::unexpected<Error> wrong(const std::string& place, const std::string& need) const {
    return fail(Code::bad_input, fmt::format("{}: {}: need {}", name_, place, need));
  }

  Status read_segment(const JsonValue& json, const std::string& place) {
    if (!json.is_object()) return wrong(place, "an object");
    data::SkeletonSegment segment{.name = text_of(json, "name")};
    if (segment.name.empty()) return wrong(place + ".name", "a name");
    bool known = false;
    for (const auto kind : {data::SegmentKind::line, data::SegmentKind::plane, data::SegmentKind::solid})
      if (text_of(json, "kind") == data::to_string(kind)) {
        segment.kind = kind;
        known = true;
      }
    if (!known) return wrong(place + ".kind", "\"line\", \"plane\" or \"solid\"");
    const JsonValue& markers = member(json, "markers");
    if (!markers.is_array()) return wrong(place + ".markers", "a list of markers");
    segment.x_in_segment.resize(3, std::ssize(markers));
    for (std::size_t m = 0; m < markers.size(); ++m) {
      const std::string where = fmt::format("{}.markers[{}]", place, m);
      if (!markers[m].is_object()) return wrong(where, "an object");
      std::string name = text_of(markers[m], "name");
      if (name.empty()) return wrong(where + ".name", "a name");
      std::array<double, 3> x{};
      if (!fill(member(markers[m], "x_in_segment_m"), x))
        return wrong(where + ".x_in_segment_m", "three numbers");
      if (!taken_.insert(name).second)
        return fail(
            Code::bad_input,
            fmt::format("{}: {}: marker '{}' is on a segment already; need each once", name_, where, name));
      segment.markers.push_back(static_cast<int>(out_.skeleton.markers.size()));
      segment.x_in_segment.col(static_cast<Eigen::Index>(m)) = Eigen::Vector3d(x[0], x[1], x[2]);
      out_.skeleton.markers.push_back(std::move(name));
    }
    out_.skeleton.segments.push_back(std::move(segment));
    return {};
  }

  Status read_joint(const JsonValue& json, const std::string& place) {
    if (!json.is_object()) return wrong(place, "an object");
    data::SkeletonJoint joint{.name = text_of(json, "name"),
                              .method = text_of(json, "method"),
                              .description = text_of(json, "words")};
    if (joint.name.empty()) return wrong(place + ".name", "a name");
    const std::string kind = text_of(json, "kind");
    if (kind != "ball" && kind != "hinge") return wrong(place + ".kind", "\"ball\" or \"hinge\"");
    joint.kind = kind == "ball" ? data::JointKind::ball : data::JointKind::hinge;
    for (const auto& [key, segment] :
         {std::pair{"parent", &joint.parent_segment}, {"child", &joint.child_segment}}) {
      const std::string name = text_of(json, key);
      const auto& all = out_.skeleton.segments;
      const auto found = std::ranges::find(all, name, &data::SkeletonSegment::name);
      if (found == all.end()) return wrong(fmt::format("{}.{}", place, key), "the name of a segment");
      *segment = static_cast<int>(found - all.begin());
    }
    for (const auto& [key, value] : {std::pair{"centre_in_parent_m", &joint.centre_in_parent},
                                     {"centre_in_child_m", &joint.centre_in_child},
                                     {"axis_in_parent", &joint.axis_in_parent},
                                     {"axis_in_child", &joint.axis_in_child}})
      if (const JsonValue& list = member(json, key); !list.is_null()) {
        std::array<double, 3> x{};
        if (!fill(list, x)) return wrong(fmt::format("{}.{}", place, key), "three numbers");
        *value = Eigen::Vector3d(x[0], x[1], x[2]);
      }
    for (const auto& [key, value] : {std::pair{"covariance_in_parent_m2", &joint.covariance_in_parent},
                                     {"covariance_in_child_m2", &joint.covariance_in_child},
                                     {"repeatability_in_parent_m2", &joint.repeatability_in_parent},
                                     {"repeatability_in_child_m2", &joint.repeatability_in_child},
                                     {"axis_covariance_in_parent", &joint.axis_covariance_in_parent},
                                     {"axis_repeatability_in_parent", &joint.axis_repeatability_in_parent}})
      if (auto s = read_matrix(member(json, key), fmt::format("{}.{}", place, key), *value); !s) return s;
    if (joint.kind == data::JointKind::ball) joint.axis_covariance_in_parent.setZero();
    joint.axis_sd_rad =
        joint.kind == data::JointKind::hinge ? number_of(json, "axis_sd_deg") * kRadPerDeg : 0.0;
    joint.range_of_motion_rad = number_of(json, "range_of_motion_deg") * kRadPerDeg;
    joint.prior_share = number_of(json, "prior_share");
    out_.skeleton.joints.push_back(std::move(joint));
    return {};
  }

  Status read_matrix(const JsonValue& rows, const std::string& place, Eigen::Matrix3d& out) const {
    out.setConstant(kNaN);
    if (rows.is_null()) return {};
    if (!rows.is_array() || rows.size() != 3) return wrong(place, "three rows");
    for (std::size_t row = 0; row < 3; ++row) {
      std::array<double, 3> x{};
      if (!fill(rows[row], x)) return wrong(fmt::format("{}[{}]", place, row), "three numbers");
      out.row(static_cast<Eigen::Index>(row)) = Eigen::RowVector3d(x[0], x[1], x[2]);
    }
    return {};
  }

  const std::string& name_;
  SkeletonFile out_;
  std::set<std::string> taken_;  ///< markers
};

}  // namespace

Result<SkeletonFile> parse_skeleton(std::string_view text, const std::string& name) {
  const JsonValue json = JsonValue::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded())
    return fail(Code::bad_input, fmt::format("{}: not JSON; need a skeleton.json", name));
  return Reader(name).read(json);
}

Result<SkeletonFile> read_skeleton(const std::filesystem::path& path) {
  std::error_code none;
  const auto file = std::filesystem::is_directory(path, none) ? path / "skeleton.json" : path;
  const auto text = io::read_text(file, kMostBytes);
  if (!text) return std::unexpected(text.error());
  return parse_skeleton(*text, file.string());
}

}  // namespace kinemark::pipeline
