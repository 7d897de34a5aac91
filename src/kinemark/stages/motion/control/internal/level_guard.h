// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kinemark::motion::internal {

/// Decides when strict levels are followed in one sum of squares: from when one of them was beyond its bound
/// for 50 ms until all are within theirs and a hold has passed, 1 s at first and twice as long each time
/// after; from the third time on, to the end.
class LevelGuard {
 public:
  /// No bounds: it never acts. `given_up`: one sum of squares from the beginning to the end.
  LevelGuard(std::vector<double> bounds_m, double rate_hz, bool given_up);

  /// The errors of a frame (NaN: the level has no goals there), as they are pursued.
  void look(const Eigen::VectorXd& errors_m);

  /// Whether all levels are to be followed in one sum of squares from here on.
  [[nodiscard]] bool joined() const { return joined_; }
  /// Whether that stays so.
  [[nodiscard]] bool given_up() const { return given_up_; }
  /// Times that it began.
  [[nodiscard]] std::int64_t trips() const { return trips_; }
  /// In one sum for so long that what it can reach is reached.
  [[nodiscard]] bool settled() const;
  [[nodiscard]] bool is_beyond(std::size_t level, double error_m) const {
    return level < bounds_m_.size() && error_m > bounds_m_[level];
  }

 private:
  std::vector<double> bounds_m_;
  double rate_hz_;
  bool joined_ = false, given_up_ = false;
  std::int64_t trips_ = 0, frames_ = 0, beyond_ = 0;  // since it began; in a row
};

}  // namespace kinemark::motion::internal
