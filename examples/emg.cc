// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Electromyograms of a recording: bursts of a channel that is named for its muscle, each measure with its
// interval.
#include <cstdio>

#include "kinemark/core/random.h"
#include "kinemark/kinemark.h"

int main() {
  // Four seconds at 1000 Hz beside markers at 100 Hz: the muscle works from 1.0 to 1.6 s and from 2.5 to 3.2
  // s.
  kinemark::Recording recording;
  recording.trial.markers.time = {.rate_hz = 100.0, .frames = 400};
  auto& analog = recording.trial.analog;
  analog.names = {"Left soleus EMG"};
  analog.units = {"mV"};
  analog.rate_hz = 1000.0;
  analog.samples = 4000;
  kinemark::Random random(1, 0);
  for (int s = 0; s < 4000; ++s) {
    const bool works = (s >= 1000 && s < 1600) || (s >= 2500 && s < 3200);
    analog.values.push_back((works ? 0.3 : 0.01) * random.gaussian());
  }

  const auto found = kinemark::emg(std::move(recording));
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& one : found->measures)
    std::printf("%-20s %-22s %.3f to %.3f s  %.6g [%.6g to %.6g]\n", one.subject.c_str(), one.id.c_str(),
                one.start_s, one.end_s, one.value, one.interval.low, one.interval.high);
  for (const auto& warning : found->remarks.warnings) std::printf("note: %s\n", warning.c_str());
  return 0;
}
