// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/analysis_setup.h"

#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "kinemark/io/osim/internal/ik_tasks_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using osim::in_quotes;
using osim::input_path_of;
using osim::name_of;
using osim::objects_of;
using osim::path_of;
using osim::text_of;
using osim::words_of;
using osim::XmlFile;
namespace fs = std::filesystem;

/// OpenSim's "not set" is a negative cut-off.
double read_cutoff(XmlFile& file, pugi::xml_node tool) {
  constexpr const char* kElement = "lowpass_cutoff_frequency_for_coordinates";
  const double cutoff = file.number(tool, kElement, -1.0);
  if (!std::isfinite(cutoff)) file.note(tool.child(kElement), "must be finite");
  return cutoff > 0.0 ? cutoff : 0.0;
}

std::vector<std::string> names_in(pugi::xml_node node, const char* child) {
  auto names = words_of(text_of(node, child));
  if (names.empty()) names.emplace_back("all");
  return names;
}

std::string name_or(pugi::xml_node node, const std::string& fallback) {
  std::string name = name_of(node);
  return name.empty() ? fallback : name;
}

PointKinematicsAnalysis read_point(XmlFile& file, pugi::xml_node node) {
  const auto body = [&](const char* child) {
    const std::string name = text_of(node, child);
    return name.empty() ? std::string("ground") : name;
  };
  return {.name = name_or(node, "PointKinematics"),
          .point = text_of(node, "point_name"),
          .body = body("body_name"),
          .relative_to = body("relative_to_body_name"),
          .x_in_body = file.vector3(node, "point")};
}

/// What an analysis says of time, which is the tool's here.
void note_times(XmlFile& file, pugi::xml_node node, AnalysisSetup& setup) {
  const bool ends = file.number(node, "start_time", setup.time_begin_s) > setup.time_begin_s ||
                    file.number(node, "end_time", setup.time_end_s) < setup.time_end_s;
  if (ends || file.number(node, "step_interval", 1.0) > 1.0)
    setup.notes.push_back(fmt::format(
        "{}: <start_time>, <end_time> and <step_interval> of {} are passed over; all rows between the "
        "tool's times are written",
        file.name(), in_quotes(name_or(node, node.name()))));
}

void read_analysis(XmlFile& file, pugi::xml_node node, AnalysisSetup& setup) {
  if (!file.flag(node, "on", true)) return;
  const std::string_view tag = node.name();
  const auto once = [&](bool there) {
    if (there) file.note(node, "is the second of its kind; need one");
  };
  if (tag == "Kinematics") {
    once(setup.kinematics.has_value());
    setup.kinematics = {.name = name_or(node, "Kinematics"),
                        .coordinates = names_in(node, "coordinates"),
                        .in_degrees = file.flag(node, "in_degrees", true)};
  } else if (tag == "BodyKinematics") {
    once(setup.bodies.has_value());
    setup.bodies = {.name = name_or(node, "BodyKinematics"),
                    .bodies = names_in(node, "bodies"),
                    .in_degrees = file.flag(node, "in_degrees", true),
                    .in_body = file.flag(node, "express_results_in_body_local_frame", false)};
  } else if (tag == "PointKinematics") {
    setup.points.push_back(read_point(file, node));
  } else if (tag == "InverseDynamics") {
    setup.torques = true;
  } else {
    setup.notes.push_back(
        fmt::format("{}: {} is passed over; Kinematics, BodyKinematics, PointKinematics and InverseDynamics "
                    "are computed",
                    file.name(), in_quotes(name_or(node, std::string(tag)))));
    return;
  }
  note_times(file, node, setup);
}

void read_analyze_tool(XmlFile& file, pugi::xml_node tool, AnalysisSetup& setup) {
  if (setup.coordinates_file.empty() && !path_of(tool, "states_file", {}).empty())
    file.note(tool.child("states_file"), "names states; a motion is needed, in <coordinates_file>",
              Code::not_supported);
  setup.time_begin_s = file.number(tool, "initial_time", setup.time_begin_s);
  setup.time_end_s = file.number(tool, "final_time", setup.time_end_s);
  if (!(setup.time_begin_s <= setup.time_end_s))
    file.note(tool.child("final_time"), "must not be before <initial_time>");
  for (const pugi::xml_node node : objects_of(tool, "AnalysisSet")) read_analysis(file, node, setup);
}

void read_dynamics_tool(XmlFile& file, pugi::xml_node tool, AnalysisSetup& setup) {
  setup.torques = true;
  setup.force_file = path_of(tool, "output_gen_force_file", {}).filename().string();
  if (const auto range = osim::read_time_range(file, tool)) {
    setup.time_begin_s = range->first;
    setup.time_end_s = range->second;
  }
}

}  // namespace

Result<AnalysisSetup> read_analysis_setup(const fs::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const fs::path folder = path.parent_path();
  file->inline_files(&folder);
  const pugi::xml_node tool = file->find_object({"AnalyzeTool", "InverseDynamicsTool"});
  if (!tool)
    return fail(
        Code::bad_input,
        fmt::format("{}: has no <AnalyzeTool> and no <InverseDynamicsTool>; its first element is <{}>",
                    path.string(), file->document().name()));
  AnalysisSetup setup{.name = name_of(tool)};
  setup.model_file = input_path_of(*file, tool, "model_file", folder, setup.notes);
  setup.coordinates_file = input_path_of(*file, tool, "coordinates_file", folder, setup.notes);
  setup.external_loads_file = input_path_of(*file, tool, "external_loads_file", folder, setup.notes);
  setup.results_directory = path_of(tool, "results_directory", folder);
  setup.cutoff_hz = read_cutoff(*file, tool);
  if (std::string_view(tool.name()) == "AnalyzeTool")
    read_analyze_tool(*file, tool, setup);
  else
    read_dynamics_tool(*file, tool, setup);
  if (file->error()) return std::unexpected(*file->error());
  return setup;
}

}  // namespace kinemark::io
