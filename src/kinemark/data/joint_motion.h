// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::data {

/// How the estimate of one frame ended.
enum class FrameStatus : std::uint8_t {
  converged,        ///< the gradient vanished to the asked tolerance
  not_converged,    ///< the iteration limit was reached; the best pose found is given
  underdetermined,  ///< converged, but at least one coordinate is not fixed by the visible markers
  no_markers,       ///< no marker visible: the pose is held from the nearest frame solved and all coordinates
                    ///< are undetermined
};

/// "converged", "not_converged", "underdetermined", "no_markers"
[[nodiscard]] std::string_view to_string(FrameStatus status);

/// Joint coordinates through time: F frames, n coordinates, M markers. Angles in rad, translations in m.
struct JointMotion {
  std::vector<std::string> coordinates;  ///< n names, in the model's order
  std::vector<bool> is_rotation;         ///< n; true: rad, false: m
  std::vector<bool>
      keeps_radians;  ///< n, empty: none; rotations that files in degrees hold in rad all the same
  std::vector<std::string> markers;  ///< M names of the markers that were used
  TimeBase time;                     ///< F = time.frames
  Array<double> q;                   ///< F x n
  Array<double> q_sd;                ///< F x n, one standard deviation; NaN where not determined or unknown
  Array<std::uint8_t> determined;    ///< F x n; 0: the visible markers do not fix this coordinate
  /// n, or empty where it is not known: frames in which the visible markers leave this coordinate open. In
  /// others that are not determined they fix it, but worse than an error bar can say, or two poses fit them.
  std::vector<std::int64_t> open_frames;
  Array<double> qd, qdd;      ///< F x n, dq/dt and d2q/dt2; empty when not computed
  Array<double> tau, tau_sd;  ///< F x n, generalised force of each coordinate, N m or N, and its SD; empty
                              ///< when not computed, NaN where it is not known
  Array<double> q_bound;  ///< F x n, what |q - q of the goals| cannot exceed; empty when not computed, NaN
                          ///< where not determined
  Array<double> marker_error;  ///< F x M x 3, measured minus model, m; NaN where the marker was not seen
  /// F x M, of the samples as the estimate took them, `rejected` where it left one out; empty: not judged.
  Array<SampleState> marker_state;
  Array<FrameStatus> status;  ///< F

  [[nodiscard]] std::int64_t frames() const { return time.frames; }                                  ///< F
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(coordinates.size()); }  ///< n
  /// Index of a coordinate's number in a frame, in every F x n array.
  [[nodiscard]] std::size_t index(std::int64_t frame, std::int64_t coordinate) const {
    return static_cast<std::size_t>(frame * size() + coordinate);
  }
  [[nodiscard]] std::int64_t find(std::string_view coordinate) const;  ///< index of a coordinate, or -1
  /// Shapes agree and q is finite.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
