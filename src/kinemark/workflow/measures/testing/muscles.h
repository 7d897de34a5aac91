// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/random.h"
#include "kinemark/data/trial.h"

namespace kinemark::workflow::testing {

/// Two seconds of four channels at ten samples a frame: a plate's, two of muscles in mV, a switch.
inline data::Trial muscles() {
  data::Trial trial;
  trial.markers.time = {.rate_hz = 100.0, .t0_s = 1.0, .frames = 200, .first_number = 101};
  auto& analog = trial.analog;
  analog.names = {"Fz1", "LSOL", "RSOL", "Switch"};
  analog.units = {"V", "mV", "mV", "V"};
  analog.rate_hz = 1000.0;
  analog.samples = 2000;
  Random random(1, 0);
  for (int s = 0; s < 2000; ++s)
    for (int c = 0; c < 4; ++c) analog.values.push_back(random.gaussian());
  trial.force_plates.push_back({.type = 1, .channel_idx = {0}});
  return trial;
}

}  // namespace kinemark::workflow::testing
