// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/recording_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "kinemark/io/markers/marker_file.h"

namespace kinemark::cli {

void add_recording_options(CLI::App& command, pipeline::RecordingOptions& recording,
                           pipeline::Doubtful by_itself) {
  const auto add = [&](const char* name, auto& value, const char* type, const char* text) {
    return command.add_option(name, value, text)->type_name(type)->group("Recording");
  };
  const auto list = [&](const char* name, auto& value, const char* type, const char* text) {
    add(name, value, type, text)->delimiter(',')->allow_extra_args(false);
  };
  auto& part = recording.selection;
  add("--rate", recording.rate_hz, "HZ",
      "Frame rate of a file that stores none (.v3d, .amc, tables without times)");
  add("--unit", recording.unit, "UNIT", "Unit of a table of coordinates that states none: mm, cm or m");
  add("--edits", recording.edits, "FILE",
      "Journal of edits to apply first: that beside the recording where there is one, none, or a FILE")
      ->default_str(io::kEditsBeside);
  list("--select", part.select, "NAME",
       "Markers and model outputs to keep, with commas between; * is any text, ? any letter");
  list("--drop", part.drop, "NAME", "Markers and model outputs to leave out");
  list("--rename", part.rename, "OLD=NEW", "New names");
  add("--frames", part.frames, "A-B",
      "Frames to use, in the file's numbers, both included: 101-250, 101-, -250");
  add("--start", part.first_time_s, "S", "First time to use, s")->check(finite_time);
  add("--end", part.last_time_s, "S", "Last time to use, s")->check(finite_time);
  add("--up", recording.axes.up, "AXIS",
      "Axis that points up in the recording: x, y, z, -x, -y, -z, or auto to find it");
  add("--rotate", recording.axes.rotate, "\"AXIS DEG\"",
      "Turn the recording instead: axis and degrees, \"x -90\" makes z up into y up");
  command
      .add_option_function<std::string>(
          "--doubtful",
          [&recording](const std::string& name) {
            const auto doubtful = pipeline::parse_doubtful(name);
            if (!doubtful) throw CLI::ValidationError(doubtful.error().message);
            recording.doubtful = *doubtful;
          },
          "Samples that are surely swapped, stuck or false: drop or keep them")
      ->type_name("WHAT")
      ->default_str(std::string(pipeline::to_string(by_itself)))
      ->group("Recording");
}

std::string finite_time(const std::string& text) {
  return std::isinf(std::strtod(text.c_str(), nullptr))
             ? fmt::format("'{}' is no time; need a number of seconds", text)
             : std::string();
}

void drop_what_it_states(pipeline::RecordingOptions& recording, const std::filesystem::path& input) {
  if (!io::needs_rate(input)) recording.rate_hz = 0.0;
  if (!recording.unit.empty() && !io::may_lack_unit(input)) recording.unit.clear();
}

}  // namespace kinemark::cli
