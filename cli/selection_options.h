// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "kinemark/pipeline/files/selection.h"

namespace kinemark::cli {

/// How a command takes a part of a marker file.
inline void add_selection_options(CLI::App& command, pipeline::Selection& selection) {
  const auto add = [&](const char* name, auto& value, const char* type, const char* text) {
    return command.add_option(name, value, text)->type_name(type)->group("Part of a marker file");
  };
  const auto list = [&](const char* name, auto& value, const char* type, const char* text) {
    add(name, value, type, text)->delimiter(',')->allow_extra_args(false);
  };
  list("--select", selection.select, "NAME",
       "Markers and model outputs to keep, with commas between; * is any text, ? any letter");
  list("--drop", selection.drop, "NAME", "Markers and model outputs to leave out");
  list("--rename", selection.rename, "OLD=NEW", "New names");
  add("--frames", selection.frames, "A-B",
      "Frames to keep, in the file's numbers, both included: 101-250, 101-, -250");
  add("--start", selection.first_time_s, "S", "First time to keep, s");
  add("--end", selection.last_time_s, "S", "Last time to keep, s");
}

}  // namespace kinemark::cli
