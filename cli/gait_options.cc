// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/gait_options.h"

#include <fmt/core.h>

#include <string>

namespace kinemark::cli {

namespace {

constexpr const char* kWalking = "Walking";

}  // namespace

void add_feet_options(CLI::App& command, pipeline::GaitRequest& request, bool movements) {
  std::string text = "Whose events of feet: best (plates, else markers), plates, kinematics, file";
  if (movements) text += "; or movement: of each marker's own movement";
  command.add_option("--events", request.events, text)
      ->type_name("WHOSE")
      ->capture_default_str()
      ->group(kWalking);
  command
      .add_option(
          "--gait-marker", request.markers,
          "A marker under a name of its own: left_heel=L_FCC (left_, right_: heel, toe, ankle; sacrum); or a "
          ".toml of such lines. Repeatable.")
      ->type_name("ROLE=NAME")
      ->allow_extra_args(false)
      ->group(kWalking);
}

void add_cycle_options(CLI::App& command, pipeline::GaitRequest& request, CyclesOf of) {
  const char *events = "Foot strikes and foot offs", *cycles = "Angles over each stride and their mean";
  if (of == CyclesOf::movements) {
    events = "Starts and ends of movements and cycles";
    cycles = "Places and speeds over each repetition and their mean";
  } else if (of == CyclesOf::either) {
    events = "Foot strikes and foot offs, or starts and ends of movements and cycles where no foot steps";
    cycles =
        "Angles over each stride and their mean; where no foot steps, places and speeds over each repetition";
  }
  command
      .add_option("--write-events", request.write_events,
                  fmt::format("{}: .csv, or .c3d, the recording with these events", events))
      ->type_name("FILE")
      ->group("Output");
  command.add_option("--write-cycles", request.write_cycles, fmt::format("{}, 0 to 100 %, .csv", cycles))
      ->type_name("FILE")
      ->group("Output");
}

void add_angles_option(CLI::App& command, pipeline::GaitRequest& request) {
  command
      .add_option("--angles", request.angles,
                  "Motion whose coordinates are cut into cycles, .mot or .sto; Q_sd.sto beside it counts too")
      ->type_name("FILE")
      ->group(kWalking);
}

void add_sheet_options(CLI::App& command, pipeline::GaitRequest& request) {
  command
      .add_option(
          "--norm", request.sheet.norms,
          "Bands to draw in grey and to compare with, .csv: of curves as 'groups band' writes them, of "
          "measures. Repeatable.")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(kWalking);
  command
      .add_option(
          "--angle-angle", request.sheet.angle_angle,
          "Two curves to draw against each other: hip_flexion:knee_flexion, across and up. Repeatable; hip "
          "and knee, knee and ankle when absent")
      ->type_name("A:B")
      ->allow_extra_args(false)
      ->group(kWalking);
}

}  // namespace kinemark::cli
