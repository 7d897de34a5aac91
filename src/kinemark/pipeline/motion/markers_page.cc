// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/markers_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/report/markers_report.h"
#include "kinemark/workflow/prepare/marker_screening.h"

#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/page_forces.h"

namespace kinemark::pipeline {
namespace {

using Eigen::Vector3d;
using internal::kContact_n;
using internal::no_forces;

constexpr double kStandingHeight_m = 0.8, kFarther = 1.2;
constexpr std::int64_t kLeastStanding = 5, kFramesLookedAt = 50;

/// How far the markers of a frame reach along each axis; none with too few of them.
std::optional<Vector3d> extent_in(const data::Trajectories& markers, std::int64_t f) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::int64_t seen = 0;
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    if (!markers.present(f, m) || data::is_unlabelled(markers.names[static_cast<std::size_t>(m)])) continue;
    low = low.cwiseMin(markers.x(f, m)), high = high.cwiseMax(markers.x(f, m));
    ++seen;
  }
  if (seen < kLeastStanding) return std::nullopt;
  return Vector3d(high - low);
}

/// The axis of the longest extent in 8 of 10 frames of those that are looked at.
std::optional<workflow::Vertical> vertical_of_extent(const data::Trajectories& markers) {
  std::array<std::int64_t, 3> longest{};
  std::int64_t looked = 0;
  const std::int64_t step = std::max<std::int64_t>(1, markers.frames() / kFramesLookedAt);
  for (std::int64_t f = 0; f < markers.frames(); f += step) {
    const auto extent = extent_in(markers, f);
    if (!extent) continue;
    ++looked;
    Eigen::Index axis = 0;
    const double most = extent->maxCoeff(&axis);
    Vector3d others = *extent;
    others[axis] = 0.0;
    if (most >= kStandingHeight_m && most >= kFarther * others.maxCoeff())
      ++longest[static_cast<std::size_t>(axis)];
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (looked > 0 && 10 * longest[axis] >= 8 * looked)
      return workflow::Vertical{Vector3d::Unit(static_cast<Eigen::Index>(axis)),
                                "the shape of what the markers outline"};
  return std::nullopt;
}

}  // namespace

workflow::Vertical vertical_without_model(const data::Trial& trial) {
  if (auto plates = workflow::vertical_of_plates(trial)) return *plates;
  if (auto screen = workflow::vertical_of_screen(trial)) return *screen;
  if (auto extent = vertical_of_extent(trial.markers)) return *extent;
  return {Vector3d::UnitZ(), ""};
}

Result<std::string> markers_page(const std::filesystem::path& path, const MarkersPageOptions& options) {
  auto recording = open_recording({.path = path,
                                   .skeleton = options.skeleton,
                                   .rate = io::RateRule::or_unknown,
                                   .record = true,
                                   .plates = true,
                                   .contact_force_n = kContact_n},
                                  options.recording);
  if (!recording) return std::unexpected(recording.error());
  auto& trial = recording->trial;
  std::vector<std::string> notes = recording->notes;
  if (options.recording.drops_doubtful(false))
    if (auto s = workflow::leave_out_defects(trial, false, recording->edits.swapped, notes); !s)
      return fail_at(path.string(), s.error());
  report::MarkersReport report{.trial = path.filename().string(),
                               .version = std::string(kVersion),
                               .command_line = options.command_line,
                               .recording = &trial,
                               .rate_known = recording->rate_known,
                               .inputs = {recording->file},
                               .cycles = internal::cycle_spans(trial.events, trial.markers.time),
                               .editing = options.editing};
  if (recording->journal.file) report.inputs.push_back(*recording->journal.file);
  report.warnings = std::move(notes);
  if (!recording->plates_fault.empty()) report.warnings.push_back(no_forces(recording->plates_fault));
  if (recording->plates && !recording->plates->items.empty()) report.forces = &*recording->plates;
  const auto vertical = vertical_without_model(trial);
  report.up = vertical.up;
  report.up_from = vertical.from;
  if (const auto stated = workflow::stated_vertical(options.recording.axes)) {
    report.up = stated->up;
    report.up_from = stated->from;
  }
  data::Neural neural;
  if (ending_of(path) == ".nwb") {
    if (auto read = io::read_neural_lanes(path)) {
      neural = std::move(*read);
      report.neural = &neural;
      std::ranges::copy(neural.warnings, std::back_inserter(report.warnings));
    } else {
      report.warnings.push_back("spikes and trials are not shown: " + read.error().message);
    }
  }
  return report::markers_report_html(report);
}

}  // namespace kinemark::pipeline
