// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "kinemark/pipeline/files/axes.h"

namespace kinemark::cli {

/// How a command that meets a model turns the recording.
inline void add_axes_options(CLI::App& command, pipeline::AxesChoice& axes) {
  command
      .add_option("--up", axes.up,
                  "Axis that points up in the recording: x, y, z, -x, -y, -z, or auto to find it")
      ->type_name("AXIS")
      ->group("Input");
  command.add_option("--rotate", axes.rotate, "Turn the recording instead: axis and degrees, \"x -90\"")
      ->type_name("\"AXIS DEG\"")
      ->group("Input");
}

}  // namespace kinemark::cli
