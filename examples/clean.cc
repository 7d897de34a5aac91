// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Cleaning marker trajectories: look for defects, fill gaps, smooth, differentiate; nothing happens silently.
//   clean                      a simulated subject with gaps
//   clean MARKERS.c3d OUT.csv  your own recording
#include <cmath>
#include <cstdio>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stages/trajectory/gaps/fill_gaps.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

using namespace kinemark;

/// A recording of two seconds in which cameras lost a twentieth of the samples.
Result<data::Trial> simulated() {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const simulation::SubjectOptions options{.duration_s = 2.0, .dropout_random = 0.05};
  auto subject = simulation::simulate_subject(model, options);
  if (!subject) return std::unexpected(subject.error());
  return data::Trial{.source = "simulated", .markers = std::move(subject->markers)};
}

int main(int argc, char** argv) {
  auto trial = argc == 3 ? io::read_markers(argv[1]) : simulated();
  if (!trial) return std::fprintf(stderr, "%s\n", trial.error().message.c_str()), 1;
  std::printf("%lld of %lld samples are missing\n", static_cast<long long>(trial->markers.count_missing()),
              static_cast<long long>(trial->markers.frames() * trial->markers.markers()));

  // Defects of recorders and exporters. They are told; samples of sure ones are rejected, not deleted.
  const auto defects = trajectory::screen(trial->markers);
  if (!defects) return std::fprintf(stderr, "%s\n", defects.error().message.c_str()), 1;
  for (const auto& defect : *defects)
    std::printf("defect: %s\n", data::sentence_of(defect, trial->markers.time).c_str());
  const auto screened = trajectory::reject_defects(trial->markers, *defects);
  if (!screened) return std::fprintf(stderr, "%s\n", screened.error().message.c_str()), 1;

  // Gaps: every filled sample has a state that says so, a method and a standard deviation. Gaps that cannot
  // be filled within the bounds of the options stay open, with the reason.
  const auto filled = trajectory::fill_gaps(*screened);
  if (!filled) return std::fprintf(stderr, "%s\n", filled.error().message.c_str()), 1;
  for (const auto& gap : filled->gaps)
    if (!gap.filled) std::printf("left open: %s\n", gap.why_open.c_str());
  std::printf("%lld samples filled in %zu gaps\n", static_cast<long long>(filled->filled_frames()),
              filled->gaps.size());

  // Smoothing chooses its own bandwidth for each marker and says why; velocity and acceleration come with it.
  auto smoothed = trajectory::smooth(filled->trajectories);
  if (!smoothed) return std::fprintf(stderr, "%s\n", smoothed.error().message.c_str()), 1;
  const auto& marker = smoothed->markers.front();
  std::printf("%s: %s\n", marker.name.c_str(), marker.description.c_str());

  if (argc != 3) return 0;
  trial->markers = std::move(smoothed->trajectories);
  const auto written = io::write_markers(argv[2], *trial, false);
  return written ? 0 : (std::fprintf(stderr, "%s\n", written.error().message.c_str()), 1);
}
