// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"

namespace kinemark::pipeline {

/// What `kinemark reconstruct` is asked to do.
struct ReconstructJob {
  /// How points come from counts.
  enum class Method : std::uint8_t { smoother, frames, classic };

  std::filesystem::path recording;            ///< of counts
  std::filesystem::path rig;                  ///< rig.toml
  std::filesystem::path output;               ///< markers: .c3d, .trc or .csv
  Method method = Method::smoother;           ///< how points come from counts
  reconstruction::ReconstructOptions frames;  ///< for Method::frames
  trajectory::SmoothCountsOptions smoother;   ///< for Method::smoother
  bool force = false;                         ///< replace a file that exists
};

/// Points of a recording of counts as markers. Returns method, frames, written, warnings and for each LED
/// counts of its frames by outcome, and the parameters of the smoother where it was used.
[[nodiscard]] Result<nlohmann::ordered_json> reconstruct_file(const ReconstructJob& job);

}  // namespace kinemark::pipeline
