// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/gates.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/data/trajectories.h"

namespace kinemark::workflow {

void add_gate(Gates& gates, std::string name, double value, double bound, std::string unit,
              std::string sentence) {
  gates.push_back({.name = std::move(name),
                   .passed = value <= bound,
                   .value = value,
                   .bound = bound,
                   .unit = std::move(unit),
                   .sentence = std::move(sentence)});
}

void add_frames_gate(Gates& gates, std::string name, std::int64_t bad, std::int64_t all,
                     std::string_view what) {
  constexpr double kMostBad = 0.1;  // %: three frames of 100,000 do not spoil a trial, one of 100 does
  const double percent = all > 0 ? 100.0 * static_cast<double>(bad) / static_cast<double>(all) : 0.0;
  add_gate(gates, std::move(name), percent, kMostBad, "%",
           fmt::format("{} of {} frames {}; at most {:g} % are accepted.", bad, all, what, kMostBad));
}

void add_left_out_gate(Gates& gates, const data::JointMotion& motion) {
  constexpr double kMostOut = 5.0;  // %: more bad samples are no accident
  if (motion.marker_state.empty()) return;
  const auto out = std::ranges::count(motion.marker_state, data::SampleState::rejected);
  const auto there =
      std::ssize(motion.marker_state) - std::ranges::count(motion.marker_state, data::SampleState::missing);
  const double percent = there > 0 ? 100.0 * static_cast<double>(out) / static_cast<double>(there) : 0.0;
  add_gate(gates, "samples_left_out", percent, kMostOut, "%",
           fmt::format("{} of {} samples were left out; at most {:g} % are accepted.", out, there, kMostOut));
}

void add_marker_gates(Gates& gates, const MarkerBounds& bounds, double offset_m, std::string offset_sentence,
                      double rms_m) {
  add_gate(gates, "mean_marker_offset", 1e3 * offset_m, 1e3 * bounds.max_offset_m, "mm",
           std::isfinite(offset_m) ? std::move(offset_sentence) : "No marker is seen in the time range.");
  add_gate(
      gates, "marker_rms", 1e3 * rms_m, 1e3 * bounds.max_rms_m, "mm",
      std::isfinite(rms_m)
          ? fmt::format("The RMS distance between measured and model markers is {:.1f} mm; at most {:.1f} mm "
                        "is accepted.",
                        1e3 * rms_m, 1e3 * bounds.max_rms_m)
          : "How far measured and model markers are apart is not known: none is seen in the time range.");
}

}  // namespace kinemark::workflow
