// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <pugixml.hpp>

#include "kinemark/core/counted.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/vsk/vsk.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMostBytes = 4UL << 20;  // a whole body has 50 kB
constexpr int kMostDepth = 100;                // of segments in segments; a body has ten
constexpr double kPerMetre = 1000.0;           // of lengths in the file

using Index = std::map<std::string, int, std::less<>>;

std::string named(const pugi::xml_node& node, const char* attribute = "NAME") {
  return name_of_bytes(node.attribute(attribute).value());
}

std::string in_quotes(std::string_view name) { return fmt::format("'{}'", printable(name, 60)); }

/// Of an element: its kind, and what it does to the segment.
std::optional<VskJointKind> joint_kind(std::string_view tag) {
  using enum VskJointKind;
  constexpr std::array<std::pair<std::string_view, VskJointKind>, 6> kTags = {
      {{"JointFree", free},
       {"JointBall", ball},
       {"JointHardySpicer", hardy_spicer},
       {"JointHinge", hinge},
       {"JointSlider", slider},
       {"JointDummy", fixed}}};
  for (const auto& [word, kind] : kTags)
    if (tag == word) return kind;
  return std::nullopt;
}

/// A name that must be there and not twice.
Status enter(Index& index, const std::string& name, int value, const char* what) {
  if (name.empty()) return fail(Code::bad_input, fmt::format("a <{}> has no NAME", what));
  if (!index.emplace(name, value).second)
    return fail(Code::bad_input, fmt::format("two elements <{}> are called {}", what, in_quotes(name)));
  return {};
}

/// The joint of a segment: the first element of one of its kinds.
Status take_joint(const pugi::xml_node& node, VskSegment& out) {
  for (const pugi::xml_node child : node.children()) {
    const std::string_view tag = child.name();
    if (!tag.starts_with("Joint")) continue;
    const auto kind = joint_kind(tag);
    if (!kind)
      return fail(Code::bad_input, fmt::format("segment {} has a <{}>, which is none of Vicon's joints",
                                               in_quotes(out.name), printable(tag, 40)));
    out.kind = *kind;
    out.joint = named(child);
    return {};
  }
  return fail(Code::bad_input, fmt::format("segment {} has no joint", in_quotes(out.name)));
}

/// Segments in segments, each after its parent.
Status take_segments(const pugi::xml_node& parent, int parent_idx, int depth, Index& index, Vsk& out) {
  if (depth > kMostDepth)
    return fail(Code::bad_input, fmt::format("segments are nested deeper than {}", kMostDepth));
  for (const pugi::xml_node node : parent.children("Segment")) {
    VskSegment segment{.name = named(node), .parent = parent_idx};
    const int own = static_cast<int>(out.segments.size());
    if (auto s = enter(index, segment.name, own, "Segment"); !s) return s;
    if (auto s = take_joint(node, segment); !s) return s;
    out.segments.push_back(std::move(segment));
    if (auto s = take_segments(node, own, depth + 1, index, out); !s) return s;
  }
  return {};
}

/// Three numbers; none where a template has expressions in their place.
std::optional<Eigen::Vector3d> position_of(std::string_view text) {
  Eigen::Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    text = trim(text);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    const auto number = parse_number(text.substr(0, end));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    out[axis] = *number / kPerMetre;
    text.remove_prefix(end);
  }
  return trim(text).empty() ? std::optional(out) : std::nullopt;
}

/// Newer files say where a marker is in a target of its own: the first of each.
std::map<std::string, pugi::xml_node, std::less<>> targets_of(const pugi::xml_node& root) {
  std::map<std::string, pugi::xml_node, std::less<>> out;
  for (const pugi::xml_node node : root.child("TargetSet").child("Targets").children())
    if (node.attribute("SEGMENT")) out.emplace(named(node, "MARKER"), node);
  return out;
}

Status take_markers(const pugi::xml_node& root, const Index& segments, Index& index, Vsk& out) {
  const auto targets = targets_of(root);
  for (pugi::xml_node node : root.child("MarkerSet").child("Markers").children("Marker")) {
    VskMarker marker{.name = named(node), .x_in_segment = std::nullopt};
    marker.required = std::string_view(node.attribute("STATUS").value()) != "optional";
    if (auto s = enter(index, marker.name, static_cast<int>(out.markers.size()), "Marker"); !s) return s;
    const auto target = targets.find(marker.name);
    if (!node.attribute("SEGMENT") && target != targets.end()) node = target->second;
    marker.x_in_segment = position_of(node.attribute("POSITION").value());
    const std::string segment = named(node, "SEGMENT");
    if (segment.empty())
      return fail(Code::bad_input,
                  fmt::format("marker {} is on no segment, neither by itself nor by a target",
                              in_quotes(marker.name)));
    const auto found = segments.find(segment);
    if (found == segments.end())
      return fail(Code::bad_input, fmt::format("marker {} is on segment {}, which is not there",
                                               in_quotes(marker.name), in_quotes(segment)));
    marker.segment = found->second;
    out.markers.push_back(std::move(marker));
  }
  return {};
}

void take_sticks(const pugi::xml_node& set, const Index& markers, Vsk& out) {
  std::int64_t lost = 0;
  for (const pugi::xml_node node : set.child("Sticks").children("Stick")) {
    const auto from = markers.find(named(node, "MARKER1"));
    const auto to = markers.find(named(node, "MARKER2"));
    if (from == markers.end() || to == markers.end())
      ++lost;
    else
      out.sticks.emplace_back(from->second, to->second);
  }
  if (lost > 0)
    out.warnings.push_back(
        fmt::format("{} left out, as they join markers that are not there", counted(lost, "stick")));
}

Status take_parameters(const pugi::xml_node& root, Vsk& out) {
  Index index;
  for (const pugi::xml_node node : root.child("Parameters").children()) {
    const std::string_view tag = node.name();
    if (tag != "Parameter" && tag != "StaticParameter") continue;
    VskParameter parameter{.name = named(node)};
    if (auto s = enter(index, parameter.name, 0, "Parameter"); !s) return s;
    const std::string_view quantity = node.attribute("QUANTITY").value();
    parameter.unit = quantity == "length"  ? "m"
                     : quantity == "mass"  ? "kg"
                     : quantity == "angle" ? "rad"
                                           : "";
    parameter.expression = name_of_bytes(node.attribute("EXPRESSION").value());
    if (const std::string_view text = node.attribute("VALUE").value(); !trim(text).empty()) {
      parameter.value = parse_number(text);
      if (!parameter.value || !std::isfinite(*parameter.value))
        return fail(Code::bad_input, fmt::format("parameter {} is '{}'; expected a number",
                                                 in_quotes(parameter.name), printable(text, 40)));
      if (parameter.unit == "m") *parameter.value /= kPerMetre;
    }
    out.parameters.push_back(std::move(parameter));
  }
  return {};
}

Result<Vsk> parse(std::string_view xml) {
  if (xml.size() > kMostBytes)
    return fail(Code::bad_input,
                fmt::format("has {} bytes; at most {} are read of a skeleton", xml.size(), kMostBytes));
  pugi::xml_document document;
  if (const auto read = document.load_buffer(xml.data(), xml.size()); !read)
    return fail(Code::bad_input,
                fmt::format("is not XML that can be read ({} at byte {})", read.description(), read.offset));
  const pugi::xml_node root = document.child("KinematicModel");
  if (!root) return fail(Code::bad_input, "has no element <KinematicModel>, as a skeleton of Vicon does");
  Vsk out{.model = named(root, "MODEL")};
  Index segments, markers;
  if (auto s = take_segments(root.child("Skeleton"), -1, 0, segments, out); !s)
    return std::unexpected(s.error());
  if (out.segments.empty()) return fail(Code::bad_input, "has no <Segment> in a <Skeleton>");
  const pugi::xml_node set = root.child("MarkerSet");
  if (auto s = take_markers(root, segments, markers, out); !s) return std::unexpected(s.error());
  take_sticks(set, markers, out);
  if (auto s = take_parameters(root, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace

std::string_view to_string(VskJointKind kind) {
  static constexpr EnumNames<VskJointKind::fixed> kNames{"free",  "ball",   "hardy_spicer",
                                                         "hinge", "slider", "fixed"};
  return kNames[kind];
}

bool is_vsk_ending(std::string_view ending) { return ending == ".vsk" || ending == ".vst"; }

Result<Vsk> parse_vsk(std::string_view xml, std::string_view name) {
  auto out = parse(xml);
  if (!out) return fail_at(name, out.error());
  return out;
}

Result<Vsk> read_vsk(const std::filesystem::path& path) {
  const auto text = read_text(path, kMostBytes);
  if (!text) return std::unexpected(text.error());
  return parse_vsk(*text, path.string());
}

}  // namespace kinemark::io
