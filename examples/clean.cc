// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Cleaning marker trajectories: defects found, gaps filled, noise smoothed, rates found; nothing happens
// silently.
//   clean                      a simulated subject with gaps
//   clean MARKERS.c3d OUT.csv  your own recording
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

using namespace kinemark;

/// A recording of two seconds in which cameras lost a twentieth of the samples.
Result<data::Trial> simulated() {
  const auto model = Model::compile(pipeline::human_model().value()).value();
  const simulation::SubjectOptions options{.duration_s = 2.0, .dropout_random = 0.05};
  auto subject = simulation::simulate_subject(model, options);
  if (!subject) return std::unexpected(subject.error());
  return data::Trial{.source = "simulated", .markers = std::move(subject->markers)};
}

int main(int argc, char** argv) {
  auto trial = argc == 3 ? read_markers(argv[1]) : simulated();
  if (!trial) return std::fprintf(stderr, "%s\n", trial.error().message.c_str()), 1;
  const auto count = [](const data::Trajectories& markers) {
    std::printf("%lld of %lld samples are missing\n", static_cast<long long>(markers.count_missing()),
                static_cast<long long>(markers.frames() * markers.markers()));
  };
  count(trial->markers);

  // Samples of sure defects are rejected, not deleted; what is filled has a state that says so, a method and
  // a standard deviation.
  workflow::CleanOptions options;
  options.repair.reject_doubtful = true;
  options.repair.gaps.method = trajectory::GapMethod::automatic;
  const auto cleaned = clean({.trial = std::move(*trial)}, options);
  if (!cleaned) return std::fprintf(stderr, "%s\n", cleaned.error().message.c_str()), 1;
  const auto& [recording, derivatives, account, remarks] = *cleaned;
  count(recording.trial.markers);
  for (const auto& defect : account.defects)
    std::printf("%s: %s\n", data::sentence_of(defect.finding, recording.trial.markers.time).c_str(),
                defect.done.c_str());
  for (const auto& gap : account.gaps)
    if (!gap.filled) std::printf("left open: %s\n", gap.why_open.c_str());
  for (const auto& warning : remarks.warnings) std::printf("note: %s\n", warning.c_str());

  // The bandwidth is chosen for each marker, and the account says why.
  std::printf("%s: %s\n", account.markers.front().name.c_str(), account.markers.front().description.c_str());
  if (argc != 3) return 0;
  const auto written = write_markers(argv[2], recording.trial, false);
  return written ? 0 : (std::fprintf(stderr, "%s\n", written.error().message.c_str()), 1);
}
