// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/ik_setup.h"

#include <fmt/core.h>

#include "kinemark/io/osim/internal/ik_tasks_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using osim::path_of;
using osim::XmlFile;

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
  IkSetup setup{.name = osim::name_of(tool), .parts = file->inlined()};
  setup.model_file = osim::input_path_of(*file, tool, "model_file", folder, setup.notes);
  if (const auto trials = osim::objects_of(tool, "IKTrialSet"); !trials.empty()) {
    setup.tasks = osim::read_ik_tasks(*file, tool, "IKTaskSet");
    setup.constraint_weight = 20.0;  // what OpenSim takes for these old files
    tool = trials.front();
  }
  setup.marker_file = osim::input_path_of(*file, tool, "marker_file", folder, setup.notes);
  setup.coordinate_file = osim::input_path_of(*file, tool, "coordinate_file", folder, setup.notes);
  setup.output_motion_file = path_of(tool, "output_motion_file", folder);
  setup.results_directory = path_of(tool, "results_directory", folder);
  if (const auto range = osim::read_time_range(*file, tool)) {
    setup.time_begin_s = range->first;
    setup.time_end_s = range->second;
  }
  setup.constraint_weight = file->number(tool, "constraint_weight", setup.constraint_weight);
  setup.accuracy = file->number(tool, "accuracy", setup.accuracy);
  setup.report_errors = file->flag(tool, "report_errors", setup.report_errors);
  setup.report_marker_locations = file->flag(tool, "report_marker_locations", setup.report_marker_locations);
  if (tool.child("IKTaskSet")) setup.tasks = osim::read_ik_tasks(*file, tool, "IKTaskSet");
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
  IkTasks tasks = osim::read_ik_tasks(*file, set.parent(), "IKTaskSet");
  if (file->error()) return std::unexpected(*file->error());
  return tasks;
}

}  // namespace kinemark::io
