// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

namespace kinemark::pipeline {

/// What `kinemark reconstruct` is asked to do.
struct ReconstructJob : JobSettings {
  /// How points come from counts.
  enum class Method : std::uint8_t { smoother, frames, classic };

  std::filesystem::path recording;            ///< of counts
  std::filesystem::path rig;                  ///< rig.toml
  std::filesystem::path output;               ///< markers: .c3d, .trc or .csv
  std::filesystem::path report;               ///< page to write as well, .html
  Method method = Method::smoother;           ///< how points come from counts
  reconstruction::ReconstructOptions frames;  ///< for Method::frames
  trajectory::SmoothCountsOptions smoother;   ///< for Method::smoother
};

[[nodiscard]] std::string_view method_name(
    ReconstructJob::Method method);  ///< "smoother", "frames", "classic"

/// What `kinemark reconstruct` made.
struct ReconstructOutcome : JobOutcome {
  ReconstructJob::Method method = ReconstructJob::Method::smoother;  ///< as asked
  std::int64_t frames = 0;                                           ///< F
  std::vector<reconstruction::LedSummary> leds;                      ///< what became of each LED's frames
  std::vector<trajectory::LedFit> fits;  ///< how each was smoothed; empty without the smoother
};

/// Points of a recording of counts as markers. Fails as the readers, reconstruct() and smooth_counts().
[[nodiscard]] Result<ReconstructOutcome> run_reconstruct(const ReconstructJob& job);

}  // namespace kinemark::pipeline
