// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The Kalman smoother of smooth(), live: each frame comes out `lag_frames` later, smoothed by all that was
// seen until then.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "kinemark/core/result.h"

namespace kinemark::trajectory {

/// Nothing is chosen live: take order, cut-off and noise from smooth() of an earlier recording.
struct OnlineOptions {
  int order = 4;               ///< 2 to 5
  double cutoff_hz = 6.0;      ///< below half the rate
  double noise_sd_m = 0.0005;  ///< per axis, > 0
  int lag_frames = 12;         ///< 0 to 1,000,000; about rate / (2 cutoff_hz) is as good as any longer one
  bool bridge = false;         ///< also give frames inside gaps that have ended within the lag

  [[nodiscard]] Status check(double rate_hz) const;  ///< Ranges hold at this rate.
};

/// One frame of M markers; borrowed until the next call. NaN where a marker was missing or nothing is known.
struct OnlineFrame {
  std::int64_t frame = 0;                                   ///< counted from the first push
  std::span<const double> x, velocity, acceleration, jerk;  ///< M x 3; m, m/s, m/s^2, m/s^3
  std::span<const double> sd;  ///< M x 4, per axis, of the four above: by the model alone
};

/// Fixed-lag smoother. Evenly spaced frames; a gap is a frame of NaN. With a lag as long as the recording the
/// results are those of smooth() with the same order and cut-off.
class OnlineTrajectorySmoother {
 public:
  /// Fails with usage when the options do not check() or markers is negative. All memory is taken here:
  /// about 700 bytes per marker and frame of lag at order 5.
  static Result<OnlineTrajectorySmoother> create(std::int64_t markers, double rate_hz,
                                                 const OnlineOptions& options);
  OnlineTrajectorySmoother(OnlineTrajectorySmoother&&) noexcept;  ///< takes a running smoother over
  OnlineTrajectorySmoother& operator=(OnlineTrajectorySmoother&&) noexcept;  ///< replaces this one by another
  ~OnlineTrajectorySmoother();

  /// The next frame, M x 3 in m; a marker with a coordinate that is not finite is missing. Gives the frame
  /// `lag_frames` ago, or nothing while there is none. Allocates nothing; O(markers lag).
  [[nodiscard]] std::optional<OnlineFrame> push(std::span<const double> x);
  /// After the last push: the frames that are still inside, one per call, then nothing.
  [[nodiscard]] std::optional<OnlineFrame> drain();

  class Core;

 private:
  explicit OnlineTrajectorySmoother(std::unique_ptr<Core> core);
  std::unique_ptr<Core> core_;
};

}  // namespace kinemark::trajectory
