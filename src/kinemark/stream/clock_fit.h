// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How fast a device's clock is, by the times at which its frames come.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace kinemark::stream {

/// The rate of a device by the host's clock.
struct ClockRate {
  double rate_hz = 0.0;     ///< frames in a second of the host
  double sd_hz = 0.0;       ///< standard deviation of it
  double ppm_fast = 0.0;    ///< that the device's clock is fast against its nominal rate, millionths
  double sd_ppm = 0.0;      ///< standard deviation of it
  double span_s = 0.0;      ///< between the first and the last time that went in
  double delay_sd_s = 0.0;  ///< scatter of the least delays about the line
};

/// Frames come late by chance, never early: the line below the times of arrival is the device's clock. Time
/// is cut into at most 256 stretches, of each of which the least delay is kept; a line is fitted to these,
/// those far above it weighing little (Cauchy weights, scale three times the median distance). Its SD is that
/// of the weighted fit: right where least delays of different stretches have nothing to do with each other.
/// Constant memory.
class ClockFit {
 public:
  /// @param rate_hz  nominal, > 0: by the device's own clock
  explicit ClockFit(double rate_hz);
  /// So many frames had ended when they were read. Both grow from call to call.
  void add(std::int64_t frames_ended, std::int64_t host_ns);
  /// What follows is numbered anew, as after a plug was pulled; the longer of both parts counts.
  void restart();
  /// Nothing before eight stretches of a quarter of a second.
  [[nodiscard]] std::optional<ClockRate> rate() const;

 private:
  struct Point {
    std::int64_t stretch = 0;
    double time_s = 0.0;  ///< by the device's clock as it says
    double late_s = 0.0;  ///< by the host's clock, since the first point
  };
  struct Line {
    double offset_s = 0.0, slope = 0.0, sd_slope = 0.0, scatter_s = 0.0;
  };
  [[nodiscard]] Line fit() const;
  [[nodiscard]] bool is_less_late(const Point& a, const Point& b) const;
  void keep(const Point& point);
  void halve();

  double rate_hz_;
  std::int64_t frames_per_stretch_;
  std::int64_t first_frame_ = 0, first_ns_ = 0;
  bool begun_ = false;
  double slope_ = 0.0;  ///< so far, by which points of a stretch are compared
  std::vector<Point> points_;
  std::optional<ClockRate> before_;  ///< of the parts before restart()
};

}  // namespace kinemark::stream
