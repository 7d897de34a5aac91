// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/xdf/internal/stream_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMostChannels = 1'000'000;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

int axis_of(std::string_view word) { return word == "x" ? 0 : word == "y" ? 1 : word == "z" ? 2 : -1; }

/// "Marker_X" or "Marker.x" into "Marker" and 0; -1 for any other label.
std::pair<std::string, int> split_label(const std::string& label) {
  if (label.size() < 3) return {label, -1};
  const int axis = axis_of(lower(label.substr(label.size() - 1)));
  const std::size_t end = label.find_last_not_of("_.:- ", label.size() - 2);
  if (axis < 0 || end == std::string::npos || end == label.size() - 2) return {label, -1};
  return {label.substr(0, end + 1), axis};
}

/// The marker that a channel is a coordinate of, and which; -1: none.
std::pair<std::string, int> coordinate_of(const pugi::xml_node& channel, bool mocap) {
  const std::string type = lower(trim(channel.child_value("type")));
  const std::string marker = name_of_bytes(channel.child_value("marker"));
  auto [name, axis] = split_label(name_of_bytes(channel.child_value("label")));
  if (type.starts_with("position"))
    axis = axis_of(std::string_view(type).substr(8));
  else if (!mocap || !type.empty())
    axis = -1;
  return {marker.empty() ? name : marker, axis};
}

/// A marker's axes may name its unit or not; two that differ are both named, which is no unit of length.
void add_unit(const std::string& unit, std::string& of_marker) {
  if (of_marker.empty())
    of_marker = unit;
  else if (!unit.empty() && unit != of_marker && metres_per_unit(unit) != metres_per_unit(of_marker))
    of_marker += " and " + unit;
}

void find_markers(const pugi::xml_node& info, XdfHeader& out) {
  const bool mocap = lower(out.type) == "mocap";
  std::map<std::string, std::size_t, std::less<>> index;
  std::vector<std::pair<XdfMarker, int>> found;  // and which coordinates there are, a bit each
  std::size_t at = 0;
  for (const pugi::xml_node& channel : info.child("desc").child("channels").children("channel")) {
    if (at == out.channels) break;
    const auto [name, axis] = coordinate_of(channel, mocap);
    if (axis >= 0 && !name.empty()) {
      auto place = index.find(name);
      // A second x of one name is another marker's.
      if (place == index.end() || (found[place->second].second & 1 << axis) != 0) {
        place = index.insert_or_assign(name, found.size()).first;
        found.push_back(
            {XdfMarker{.name = name, .channel = {}, .unit = name_of_bytes(channel.child_value("unit"))}, 0});
      }
      auto& [marker, seen] = found[place->second];
      if (const auto unit = name_of_bytes(channel.child_value("unit")); seen != 0)
        add_unit(unit, marker.unit);
      marker.channel[static_cast<std::size_t>(axis)] = at;
      seen |= 1 << axis;
    }
    ++at;
  }
  for (auto& [marker, seen] : found)
    if (seen == 7) out.markers.push_back(std::move(marker));
  out.other_channels = out.channels - std::min(out.channels, 3 * out.markers.size());
}

}  // namespace

std::size_t size_of(XdfFormat format) {
  constexpr std::array<std::size_t, 7> kBytes = {4, 8, 1, 2, 4, 8, 0};
  return kBytes[static_cast<std::size_t>(format)];
}

Result<XdfHeader> parse_xdf_header(std::string_view xml) {
  pugi::xml_document document;
  if (!document.load_buffer(xml.data(), xml.size()))
    return fail(Code::bad_input, "the header of a stream is no XML");
  const pugi::xml_node info = document.child("info");
  XdfHeader out;
  out.name = name_of_bytes(info.child_value("name"));
  out.type = name_of_bytes(info.child_value("type"));
  const auto channels = parse_number(info.child_value("channel_count"));
  if (!channels || !(*channels >= 1.0 && *channels <= static_cast<double>(kMostChannels)))
    return fail(Code::bad_input,
                fmt::format("stream '{}' has channel_count '{}'; expected 1 to {}", printable(out.name, 80),
                            printable(info.child_value("channel_count"), 40), kMostChannels));
  out.channels = static_cast<std::size_t>(*channels);
  out.rate_hz = parse_number(info.child_value("nominal_srate")).value_or(0.0);
  constexpr std::array<std::string_view, 7> kFormats = {"float32", "double64", "int8",  "int16",
                                                        "int32",   "int64",    "string"};
  const auto format = std::ranges::find(kFormats, trim(info.child_value("channel_format")));
  if (format == kFormats.end())
    return fail(Code::bad_input,
                fmt::format("stream '{}' has channel_format '{}', which is none of XDF",
                            printable(out.name, 80), printable(info.child_value("channel_format"), 40)));
  out.format = static_cast<XdfFormat>(format - kFormats.begin());
  if (out.format != XdfFormat::string) find_markers(info, out);
  return out;
}

}  // namespace kinemark::io::internal
