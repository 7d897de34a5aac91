// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/ik_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinemark/io/number.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using osim::in_quotes;
using osim::text_of;
using osim::XmlFile;

double read_weight(XmlFile& file, pugi::xml_node node) {
  const double weight = file.number(node, "weight", 0.0);
  if (!std::isfinite(weight) || weight < 0.0)
    file.note(node.child("weight"), fmt::format("is {}; need a finite number, 0 or more", weight));
  return weight;
}

IkCoordinateTask::Target read_target(XmlFile& file, pugi::xml_node node) {
  using enum IkCoordinateTask::Target;
  std::string word = text_of(node, "value_type");
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "manual_value") return manual_value;
  if (word == "from_file") return from_file;
  if (!word.empty() && word != "default_value")
    file.note(node.child("value_type"),
              fmt::format("is {}; need default_value, manual_value or from_file", in_quotes(word)));
  return default_value;
}

IkTasks read_tasks(XmlFile& file, pugi::xml_node owner, const char* set) {
  IkTasks tasks;
  std::set<std::string> seen;
  for (const pugi::xml_node node : osim::objects_of(owner, set)) {
    const std::string_view tag = node.name();
    const std::string name = osim::name_of(node);
    if (tag != "IKMarkerTask" && tag != "IKCoordinateTask") continue;
    if (name.empty()) file.note(node, fmt::format("a {} has no name", tag));
    if (!seen.insert(std::string(tag) + name).second) file.note(node, "occurs twice");
    if (tag == "IKMarkerTask") {
      tasks.markers.push_back(
          {.name = name, .weight = read_weight(file, node), .apply = file.flag(node, "apply", true)});
      continue;
    }
    const double value = file.number(node, "value", 0.0);
    if (!std::isfinite(value)) file.note(node.child("value"), "must be finite");
    tasks.coordinates.push_back({.name = name,
                                 .weight = read_weight(file, node),
                                 .apply = file.flag(node, "apply", true),
                                 .target = read_target(file, node),
                                 .value = value});
  }
  return tasks;
}

/// A path as the file writes it, on any system, seen from `folder`.
std::filesystem::path path_of(pugi::xml_node node, const char* child, const std::filesystem::path& folder) {
  std::string text = text_of(node, child);
  if (text.empty() || text == "Unassigned") return {};
  std::ranges::replace(text, '\\', '/');
  return (folder / text).lexically_normal();
}

void read_time_range(XmlFile& file, pugi::xml_node tool, IkSetup& setup) {
  const auto words = osim::words_of(text_of(tool, "time_range"));
  if (words.empty()) return;
  const auto begin = parse_number(words.front()), end = parse_number(words.back());
  if (words.size() != 2 || !begin || !end || !(*begin <= *end))
    return file.note(tool.child("time_range"),
                     fmt::format("{} is not a range; need two times, the earlier first",
                                 in_quotes(text_of(tool, "time_range"))));
  setup.time_begin_s = *begin;
  setup.time_end_s = *end;
}

/// The tool's element. One file of OpenSim's own misspells it, and OpenSim reads that.
pugi::xml_node find_tool(const XmlFile& file) {
  return file.find_object({"InverseKinematicsTool", "InverseKinemtaticsTool", "IKTool"});
}

}  // namespace

Result<IkSetup> read_ik_setup(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const std::filesystem::path folder = path.parent_path();
  file->inline_files(&folder);
  pugi::xml_node tool = find_tool(*file);
  if (!tool)
    return fail(Code::bad_input, fmt::format("{}: has no <InverseKinematicsTool>; its first element is <{}>",
                                             path.string(), file->document().name()));
  IkSetup setup{.name = osim::name_of(tool), .model_file = path_of(tool, "model_file", folder)};
  if (const auto trials = osim::objects_of(tool, "IKTrialSet"); !trials.empty()) {
    setup.tasks = read_tasks(*file, tool, "IKTaskSet");
    setup.constraint_weight = 20.0;  // what OpenSim takes for these old files
    tool = trials.front();
  }
  setup.marker_file = path_of(tool, "marker_file", folder);
  setup.coordinate_file = path_of(tool, "coordinate_file", folder);
  setup.output_motion_file = path_of(tool, "output_motion_file", folder);
  setup.results_directory = path_of(tool, "results_directory", folder);
  read_time_range(*file, tool, setup);
  setup.constraint_weight = file->number(tool, "constraint_weight", setup.constraint_weight);
  setup.accuracy = file->number(tool, "accuracy", setup.accuracy);
  setup.report_errors = file->flag(tool, "report_errors", setup.report_errors);
  setup.report_marker_locations = file->flag(tool, "report_marker_locations", setup.report_marker_locations);
  if (tool.child("IKTaskSet")) setup.tasks = read_tasks(*file, tool, "IKTaskSet");
  if (!(setup.constraint_weight >= 0.0)) file->note(tool.child("constraint_weight"), "must be 0 or more");
  if (!(setup.accuracy > 0.0)) file->note(tool.child("accuracy"), "must be above 0");
  if (file->error()) return std::unexpected(*file->error());
  return setup;
}

Result<IkTasks> read_ik_tasks(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const pugi::xml_node set = file->find_object({"IKTaskSet"});
  if (!set)
    return fail(Code::bad_input, fmt::format("{}: has no <IKTaskSet>; its first element is <{}>",
                                             path.string(), file->document().name()));
  IkTasks tasks = read_tasks(*file, set.parent(), "IKTaskSet");
  if (file->error()) return std::unexpected(*file->error());
  return tasks;
}

}  // namespace kinemark::io
