// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a recording and a model fit: which marker is which, which took no part and why, and how far the markers
// of the solved motion lie from the measured ones. Solvers fill it in, reports read it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"

namespace kinemark::data {

/// What one used marker contributed.
struct FittedMarker {
  std::string name;           ///< in the model
  std::string name_in_data;   ///< in the recording (may carry a subject prefix)
  std::string body;           ///< that carries it, "ground" for none
  double weight = 1.0;        ///< as given, >= 0
  double seen = 0.0;          ///< share of the solved frames, 0 to 1
  double rms_m = kNaN;        ///< distance measured to model; NaN when never seen
  double max_m = 0.0;         ///< largest distance; 0 when never seen
  double noise_sd_m = kNaN;   ///< per axis: part of its own, as used for the error bars; NaN: not estimated
  double common_sd_m = kNaN;  ///< per axis: part shared by the markers of its segment; NaN: not estimated
  std::optional<std::int64_t> rejected_frames;  ///< in which its sample was left out; none: not judged

  /// Both parts of the noise together, per axis; NaN where one is not known.
  [[nodiscard]] double total_sd_m() const;
};

/// A marker of the model or of the recording that took no part.
struct ExcludedMarker {
  std::string name;  ///< in the model; in the recording where the model lacks it
  std::string why;   ///< not empty; usually one of those below
};

inline constexpr std::string_view kNoWeight = "given the weight 0";  ///< ExcludedMarker::why
inline constexpr std::string_view kNeverSeen = "never seen";         ///< ExcludedMarker::why
/// ExcludedMarker::why
inline constexpr std::string_view kNotInRecording = "in the model, not in the recording";
/// ExcludedMarker::why
inline constexpr std::string_view kAmbiguous = "in the model, and of several subjects in the recording";
inline constexpr std::string_view kNotInModel =
    "in the recording, not in the model";  ///< ExcludedMarker::why

/// How markers and model go together: which marker is which, and how well each fits.
struct MarkerFit {
  std::int64_t first_frame = 0;       ///< index in the recording of the motion's frame 0
  std::vector<FittedMarker> markers;  ///< in the order of the motion's markers
  std::vector<ExcludedMarker>
      excluded;                       ///< shared ones first, then those of the model, then of the recording
  std::vector<std::string> warnings;  ///< of the matching, one sentence each
  std::vector<Finding> findings;      ///< what the solver noticed; frames are those of the motion
  double rms_error_m = kNaN;          ///< measured to model, all frames and markers seen, unweighted
  double max_error_m = 0.0;           ///< 0 when none is seen, where RMS and mean are NaN
  /// Mean of measured minus model: large when recording and model do not share a frame.
  Eigen::Vector3d mean_error_m = Eigen::Vector3d::Constant(kNaN);
  double max_loop_gap_m = kNaN;  ///< widest gap of a closed loop, 0 without loops; NaN: not computed

  /// Names of the markers that were left out for this reason, in order.
  [[nodiscard]] std::vector<std::string> excluded_as(std::string_view why) const;
  /// Every marker has a name, is listed once as used, has weights and standard deviations that are not
  /// negative, a share between 0 and 1 and no fewer than 0 frames left out; every excluded one says why;
  /// every finding is valid.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
