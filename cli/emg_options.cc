// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/emg_options.h"

namespace kinemark::cli {

void add_emg_options(CLI::App& command, pipeline::EmgRequest& request, const EmgNames& names) {
  const char* what = "Electromyograms";
  command
      .add_option(names.channels, request.channels,
                  "Analog channels that hold EMG, with commas between; * is any text; found by their names "
                  "when absent")
      ->type_name("NAME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(what);
  const auto number = [&](const std::string& name, double& value, const char* unit, const char* text) {
    command.add_option(names.prefix + name, value, text)->type_name(unit)->capture_default_str()->group(what);
  };
  number("high-pass", request.envelope.high_pass_hz, "HZ", "Lower end of the band; 0: none");
  number("low-pass", request.envelope.low_pass_hz, "HZ", "Upper end of the band");
  number("envelope", request.envelope.envelope_hz, "HZ", "Low-pass of the rectified signal");
  number("rms", request.envelope.rms_window_s, "S", "Root mean square of this long instead; 0: none");
  command
      .add_option(
          names.prefix + "max", request.maximum,
          "What 100 % is: trial, the largest envelope of the recording; or a .c3d of maximal contractions")
      ->type_name("trial|FILE")
      ->group(what);
  command.add_option(names.write, request.write, "Envelopes at the frames of the recording, .sto or .csv")
      ->type_name("FILE")
      ->group(what);
  command
      .add_option(names.write_cycles, request.write_cycles,
                  "Envelopes over each cycle of walking and their mean, 0 to 100 %, .csv")
      ->type_name("FILE")
      ->group(what);
}

}  // namespace kinemark::cli
