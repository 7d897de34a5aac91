// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/segments_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/name_index.h"
#include "kinemark/io/file.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kMarkersListed = 8;

bool turns_about_a_point(io::VskJointKind kind) {
  using enum io::VskJointKind;
  return kind == ball || kind == hardy_spicer || kind == hinge;
}

/// Of each segment the one that it is one body with: itself, or what it is fixed to.
std::vector<int> bodies_of(const io::Vsk& vsk) {
  std::vector<int> body;
  for (const io::VskSegment& segment : vsk.segments) {
    const bool fixed = segment.kind == io::VskJointKind::fixed && segment.parent >= 0;
    body.push_back(fixed ? body[at(segment.parent)] : static_cast<int>(body.size()));
  }
  return body;
}

using Need = io::TomlFields::Need;

constexpr std::size_t kMostBytes = 16UL << 20;

Result<data::SegmentLayout::Segment> read_segment(const toml::table& table, const std::string& where,
                                                  const data::NameIndex& markers) {
  data::SegmentLayout::Segment segment;
  const auto* list = table["markers"].as_array();
  if (list == nullptr || list->empty())
    return fail(Code::bad_input, where + ": needs markers = [\"NAME\", ...]");
  segment.name = table["name"].value_or(std::string());
  if (segment.name.empty()) return fail(Code::bad_input, where + ": needs a name");
  for (const auto& [key, value] : table)
    if (key.str() != "name" && key.str() != "markers")
      return fail(Code::bad_input,
                  fmt::format("{}: '{}' is not a key; use name and markers", where, key.str()));
  for (const auto& item : *list) {
    const auto name = item.value<std::string>();
    if (!name)
      return fail(Code::bad_input, fmt::format("{}: markers of '{}' must be names", where, segment.name));
    const auto m = markers.find(*name);
    if (m < 0)
      return fail(Code::bad_input,
                  fmt::format("{}: segment '{}': {} in the recording is called '{}'; it has {}", where,
                              segment.name, markers.ambiguous(*name) ? "more than one marker" : "no marker",
                              *name, markers.instead_of(*name)));
    segment.markers.push_back(static_cast<int>(m));
  }
  return segment;
}

int find_segment(const data::SegmentLayout& layout, const std::string& name) {
  const auto at = std::ranges::find(layout.segments, name, &data::SegmentLayout::Segment::name);
  return at == layout.segments.end() ? -1 : static_cast<int>(at - layout.segments.begin());
}

constexpr const char* kRoom = "ground";

/// A joint, or a fixed one that is put to the ends.
Status read_joint(const toml::table& table, const std::string& where, data::SegmentLayout& layout) {
  data::SegmentLayout::Joint joint;
  std::string parent, child;
  io::TomlFields fields(table, where);
  fields.text("name", joint.name).text("parent", parent, Need::required).text("child", child, Need::required);
  if (auto s = fields.finish(); !s) return s;
  if (joint.name.empty()) joint.name = parent + "-" + child;
  joint.parent = find_segment(layout, parent);
  joint.child = find_segment(layout, child);
  const bool stays = joint.parent < 0 && parent == kRoom;
  for (const auto& [index, name] : {std::pair{joint.parent, parent}, {joint.child, child}})
    if (index < 0 && !(stays && name == kRoom))
      return fail(Code::bad_input, fmt::format("{}: no segment is called '{}'", where, name));
  if (stays)
    layout.ends.push_back({.name = joint.name, .segment = child});
  else
    layout.joints.push_back(std::move(joint));
  return {};
}

/// Where a segment ends: one of its markers.
Status read_end(const toml::table& table, const std::string& where, const data::NameIndex& markers,
                data::SegmentLayout& layout) {
  data::SegmentLayout::End end;
  std::string marker;
  io::TomlFields fields(table, where);
  fields.text("name", end.name, Need::required)
      .text("segment", end.segment, Need::required)
      .text("marker", marker, Need::required);
  if (auto s = fields.finish(); !s) return s;
  const int segment = find_segment(layout, end.segment);
  if (segment < 0)
    return fail(Code::bad_input, fmt::format("{}: no segment is called '{}'", where, end.segment));
  end.marker = static_cast<int>(markers.find(marker));
  const auto& on = layout.segments[at(segment)].markers;
  if (std::ranges::find(on, end.marker) == on.end())
    return fail(Code::bad_input, fmt::format("{}: '{}' is no marker of segment '{}'; name one of its own",
                                             where, marker, end.segment));
  layout.ends.push_back(std::move(end));
  return {};
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\u{:04X}", static_cast<int>(c));  // a line of TOML holds no line's end
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

Result<data::SegmentLayout> layout_of(const io::Vsk& vsk, const std::vector<std::string>& markers,
                                      std::vector<std::string>& warnings) {
  const data::NameIndex index(markers);
  const std::vector<int> body = bodies_of(vsk);
  std::vector<std::vector<int>> on_body(vsk.segments.size());
  std::vector<std::string> lacking;
  for (const io::VskMarker& marker : vsk.markers) {
    const auto m = index.find(marker.name);
    if (m < 0 && index.ambiguous(marker.name))
      return fail(Code::bad_input,
                  fmt::format("more than one marker in the recording is called '{}'; it has {}", marker.name,
                              index.instead_of(marker.name)));
    if (m < 0)
      lacking.push_back(marker.name);
    else
      on_body[at(body[at(marker.segment)])].push_back(static_cast<int>(m));
  }
  if (!lacking.empty())
    warnings.push_back(fmt::format("Not in the recording: {} of the {} markers of the subject: {}.",
                                   lacking.size(), vsk.markers.size(), join_some(lacking, kMarkersListed)));

  data::SegmentLayout layout;
  std::vector<int> number(vsk.segments.size(), -1);
  for (std::size_t s = 0; s < vsk.segments.size(); ++s) {
    if (on_body[s].empty()) continue;
    number[s] = static_cast<int>(layout.segments.size());
    layout.segments.push_back({vsk.segments[s].name, std::move(on_body[s])});
  }
  for (std::size_t s = 0; s < vsk.segments.size(); ++s) {
    const io::VskSegment& segment = vsk.segments[s];
    if (number[s] < 0 || segment.parent < 0 || !turns_about_a_point(segment.kind)) continue;
    const int parent = number[at(body[at(segment.parent)])];
    if (parent < 0) continue;
    const std::string name = vsk.segments[at(body[at(segment.parent)])].name + "-" + segment.name;
    layout.joints.push_back({segment.joint.empty() ? name : segment.joint, parent, number[s]});
  }
  if (layout.joints.empty())
    return fail(Code::bad_input,
                fmt::format("no joint lies between two segments of which the recording has markers; it has "
                            "{} of the {} markers of the subject",
                            vsk.markers.size() - lacking.size(), vsk.markers.size()));
  if (auto s = layout.validate(static_cast<std::int64_t>(markers.size())); !s)
    return std::unexpected(s.error());
  return layout;
}

Result<data::SegmentLayout> parse_segments(std::string_view text, const std::string& name,
                                           const std::vector<std::string>& markers) {
  const auto parsed = io::parse_toml(text, name);
  if (!parsed) return std::unexpected(parsed.error());
  const toml::table& root = *parsed;
  for (const auto& [key, value] : root)
    if ((key.str() != "segment" && key.str() != "joint" && key.str() != "end") || !value.is_array_of_tables())
      return fail(
          Code::bad_input,
          fmt::format("{}: '{}': only [[segment]], [[joint]] and [[end]] tables are read", name, key.str()));
  data::SegmentLayout layout;
  const data::NameIndex index(markers);
  const auto* segments = root["segment"].as_array();
  if (segments == nullptr) return fail(Code::bad_input, name + ": holds no [[segment]]");
  int n = 0;
  for (const auto& item : *segments) {
    auto segment = read_segment(*item.as_table(), fmt::format("{}: segment {}", name, ++n), index);
    if (!segment) return std::unexpected(segment.error());
    layout.segments.push_back(std::move(*segment));
  }
  n = 0;
  if (const auto* joints = root["joint"].as_array())
    for (const auto& item : *joints)
      if (auto s = read_joint(*item.as_table(), fmt::format("{}: joint {}", name, ++n), layout); !s)
        return std::unexpected(s.error());
  n = 0;
  if (const auto* ends = root["end"].as_array())
    for (const auto& item : *ends)
      if (auto s = read_end(*item.as_table(), fmt::format("{}: end {}", name, ++n), index, layout); !s)
        return std::unexpected(s.error());
  if (layout.joints.empty())
    for (std::size_t s = 1; s < layout.segments.size(); ++s)
      layout.joints.push_back({layout.segments[s - 1].name + "-" + layout.segments[s].name,
                               static_cast<int>(s) - 1, static_cast<int>(s)});
  if (auto s = layout.validate(static_cast<std::int64_t>(markers.size())); !s)
    return fail_at(name, s.error());
  return layout;
}

Result<data::SegmentLayout> read_segments(const std::filesystem::path& path,
                                          const std::vector<std::string>& markers) {
  const auto text = io::read_text(path, kMostBytes);
  if (!text) return std::unexpected(text.error());
  return parse_segments(*text, path.string(), markers);
}

std::string segments_text(const data::SegmentLayout& layout, const std::vector<std::string>& markers) {
  std::string text;
  for (const auto& segment : layout.segments) {
    text += fmt::format("[[segment]]\nname = {}\nmarkers = [", toml_string(segment.name));
    for (std::size_t i = 0; i < segment.markers.size(); ++i)
      text += (i ? ", " : "") + toml_string(markers[static_cast<std::size_t>(segment.markers[i])]);
    text += "]\n\n";
  }
  for (const auto& joint : layout.joints)
    text += fmt::format("[[joint]]\nname = {}\nparent = {}\nchild = {}\n\n", toml_string(joint.name),
                        toml_string(layout.segments[static_cast<std::size_t>(joint.parent)].name),
                        toml_string(layout.segments[static_cast<std::size_t>(joint.child)].name));
  for (const auto& end : layout.ends)
    text += end.stays()
                ? fmt::format("[[joint]]\nname = {}\nparent = \"{}\"\nchild = {}\n\n", toml_string(end.name),
                              kRoom, toml_string(end.segment))
                : fmt::format("[[end]]\nname = {}\nsegment = {}\nmarker = {}\n\n", toml_string(end.name),
                              toml_string(end.segment), toml_string(markers[at(end.marker)]));
  return text;
}

}  // namespace kinemark::pipeline
