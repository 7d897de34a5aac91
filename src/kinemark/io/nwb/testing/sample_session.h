// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A session with units, trials and field potentials, for the tests of this folder.
#pragma once

#include <cmath>
#include <filesystem>

#include "kinemark/data/neural.h"
#include "kinemark/io/nwb/testing/sample.h"

namespace kinemark::io::testing {

/// Three units, one of them silent, and two trials.
inline data::Neural sample_neural() {
  data::Neural out;
  out.units = {
      {.id = "0", .labels = {{"quality", "good"}, {"depth", "1.5"}}, .times_s = {0.1, 0.4, 0.4, 7.25}},
      {.id = "1", .labels = {{"quality", "mua"}, {"depth", "2"}}, .times_s = {}},
      {.id = "2", .labels = {{"quality", "good"}, {"depth", "3"}}, .times_s = {1.0 / 3.0}}};
  out.intervals = {{.name = "trials",
                    .rows = {{.start_s = 0.0, .stop_s = 1.5, .labels = {{"side", "left"}}},
                             {.start_s = 2.0, .stop_s = 3.0, .labels = {{"side", "right"}}}}}};
  return out;
}

/// 5,000 samples of two channels at 1 kHz: a sine of 100 uV and a ramp.
inline data::FieldSamples sample_field() {
  data::FieldSamples out{
      .name = "lfp", .channels = {"electrode 0", "electrode 1"}, .rate_hz = 1000.0, .t0_s = 0.25};
  for (int i = 0; i < 5000; ++i) {
    out.values.push_back(1e-4 * std::sin(0.05 * i));
    out.values.push_back(1e-6 * i);
  }
  return out;
}

/// The sample trial with the session beside it.
inline Status write_session(const std::filesystem::path& path, const data::Neural& neural,
                            const std::vector<data::FieldSamples>& fields) {
  const auto trial = sample_trial(4);
  auto writer = NwbWriter::create(path, NwbOutline::of(trial.markers, nullptr));
  if (!writer) return std::unexpected(writer.error());
  if (auto s = writer->write(trial.markers); !s) return s;
  if (auto s = writer->write_signals(trial); !s) return s;
  if (auto s = writer->write_neural(neural, fields); !s) return s;
  return writer->commit();
}

}  // namespace kinemark::io::testing
