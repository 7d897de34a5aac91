// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_samples.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kLeastJump_rad = 15.0 * std::numbers::pi / 180.0;
constexpr double kMostBound_rad = 60.0 * std::numbers::pi / 180.0;  // Coarser samples are not judged.
constexpr double kJumpSd = 6.0;
constexpr double kMedianOfLength = 1.538;  // median length of three independent normal numbers
constexpr double kSquareOfGap = 16.0;      // Runners at 60 Hz: within 0.75 of the bound for all gaps.
constexpr std::int64_t kBeside = 3;        // samples that say where the next one is

/// Rotation vector from one orientation to another, in the axes of the sensor.
Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd turn(from.conjugate() * to);
  return turn.angle() * turn.axis();
}

Eigen::Quaterniond turned_by(const Eigen::Quaterniond& from, const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (!(angle > 0.0)) return from;
  return from * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

/// The samples of one sensor.
class SensorTrack {
 public:
  SensorTrack(const data::Orientations& recording, std::int64_t sensor) : sensor_(sensor) {
    for (std::int64_t f = 0; f < recording.frames(); ++f) {
      const double* q = recording.quaternion.data() + 4 * (f * recording.size() + sensor);
      q_.emplace_back(q[0], q[1], q[2], q[3]);
      present_.push_back(recording.present(f, sensor));
    }
    bound_rad_ = std::max(kLeastJump_rad, kJumpSd * usual_miss());
  }

  std::vector<TurnedSpan> judge() {
    if (bound_rad_ > kMostBound_rad) return {};
    for (std::int64_t first = 0, F = std::ssize(q_); first < F; ++first) {
      if (!present_[at(first)]) continue;
      auto end = first;
      while (end < F && present_[at(end)]) ++end;
      judge_run(first, end);
      first = end;
    }
    return std::move(spans_);
  }

 private:
  /// Turn a frame between two others, of which `near` is the nearer one to what is asked.
  [[nodiscard]] Eigen::Vector3d rate(std::int64_t near, std::int64_t far) const {
    return turn_between(q_[at(far)], q_[at(near)]) / static_cast<double>(near - far);
  }

  /// Angle between a sample and where two others would take it at an even rate.
  [[nodiscard]] double miss(std::int64_t frame, std::int64_t near, std::int64_t far) const {
    const auto expected = turned_by(q_[at(near)], static_cast<double>(frame - near) * rate(near, far));
    return expected.angularDistance(q_[at(frame)]);
  }

  /// Scatter of misses about one axis, the median being blind to the few that are wrong.
  [[nodiscard]] double usual_miss() const {
    std::vector<double> misses;
    for (std::int64_t f = kBeside; f < std::ssize(q_); ++f)
      if (present_[at(f)] && present_[at(f - 1)] && present_[at(f - 2)] && present_[at(f - 3)])
        misses.push_back(miss(f, f - 1, f - kBeside));
    if (misses.empty()) return 0.0;
    const auto middle = misses.begin() + std::ssize(misses) / 2;
    std::ranges::nth_element(misses, middle);
    return *middle / kMedianOfLength;
  }

  /// Whether three samples from a frame on turn evenly.
  [[nodiscard]] bool even_from(std::int64_t frame) const {
    return miss(frame + 2, frame + 1, frame) <= bound_rad_;
  }

  [[nodiscard]] std::optional<std::int64_t> first_even(std::int64_t from, std::int64_t end) const {
    for (auto f = from; f + kBeside <= end; ++f)
      if (even_from(f)) return f;
    return std::nullopt;
  }

  /// Whether the samples from `back` on go on as those before did, up to `near`. What rates that change
  /// evenly leave of the turn across a gap grows with its square.
  [[nodiscard]] bool joins(std::int64_t near, std::int64_t far, std::int64_t back) const {
    const auto frames = static_cast<double>(back - near);
    const Eigen::Vector3d even = 0.5 * frames * (rate(near, far) + rate(back, back + 2));
    return (turn_between(q_[at(near)], q_[at(back)]) - even).norm() <=
           bound_rad_ * std::max(1.0, frames * frames / kSquareOfGap);
  }

  /// The frame in which a sensor that jumped in `frame` is back.
  [[nodiscard]] std::optional<std::int64_t> find_return(std::int64_t frame, std::int64_t end,
                                                        std::int64_t near, std::int64_t far) const {
    for (auto back = frame + 1; back <= frame + kMostWrong && back + kBeside <= end; ++back)
      if (even_from(back) && miss(back - 1, back, back + 2) > bound_rad_ && joins(near, far, back))
        return back;
    return std::nullopt;
  }

  /// Accuse [first, end); `before` and `after` are right, or the same where only one is.
  void accuse(std::int64_t first, std::int64_t end, std::int64_t before, std::int64_t after) {
    double angle = 0.0;
    for (auto f = first; f < end; ++f) {
      const double place =
          before == after ? 0.0 : static_cast<double>(f - before) / static_cast<double>(after - before);
      angle = std::max(angle, q_[at(before)].slerp(place, q_[at(after)]).angularDistance(q_[at(f)]));
    }
    spans_.push_back({.sensor = sensor_, .first = first, .last = end - 1, .angle_rad = angle});
  }

  /// Samples before the first even ones, judged by these, backwards.
  void judge_beginning(std::int64_t first, std::int64_t even) {
    auto near = even, far = even + 2;
    bool is_wrong = false;
    for (auto f = even - 1; f >= std::max(first, even - kMostWrong); --f) {
      is_wrong = miss(f, near, far) > bound_rad_;
      if (is_wrong) continue;
      if (near - f > 1) accuse(f + 1, near, f, near);
      far = near;
      near = f;
    }
    if (is_wrong && even - first <= kMostWrong) accuse(first, near, near, near);
  }

  /// A sensor that jumps in `frame` and does not come back. One side is wrong where it is short.
  void judge_ends(std::int64_t first, std::int64_t frame, std::int64_t end, bool is_first_jump) {
    const auto before = frame - first, behind = end - frame;
    if (behind <= kMostWrong && before > kMostWrong) return accuse(frame, end, frame - 1, frame - 1);
    if (!is_first_jump || before > kMostWrong || behind <= kMostWrong) return;
    std::erase_if(spans_, [first](const TurnedSpan& span) { return span.first >= first; });
    accuse(first, frame, frame, frame);
  }

  /// Samples of a run without gaps.
  void judge_run(std::int64_t first, std::int64_t end) {
    auto even = first_even(first, end);
    if (even) judge_beginning(first, *even);
    bool is_first_jump = true;
    while (even) {
      // The last three samples that are right: `near` is the latest of them.
      auto near = *even + 2, far = *even, f = *even + kBeside;
      for (; f < end && miss(f, near, far) <= bound_rad_; ++f) {
        near = f;
        far = f - 2;
      }
      if (f == end) return;
      if (const auto back = find_return(f, end, near, far)) {
        accuse(f, *back, near, *back);
        even = back;
        continue;
      }
      judge_ends(first, f, end, is_first_jump);
      is_first_jump = false;
      even = first_even(f, end);
    }
  }

  std::int64_t sensor_;
  std::vector<Eigen::Quaterniond> q_;
  std::vector<bool> present_;
  double bound_rad_ = 0.0;
  std::vector<TurnedSpan> spans_;
};

/// The samples of these spans go missing.
void leave_out(const std::vector<TurnedSpan>& spans, data::Orientations& recording) {
  for (const auto& span : spans)
    for (auto f = span.first; f <= span.last; ++f)
      std::fill_n(recording.quaternion.begin() + 4 * (f * recording.size() + span.sensor), 4, kNaN);
}

}  // namespace

data::Orientations at_times(const data::Orientations& recording, const TimeBase& time) {
  data::Orientations out;
  out.names = recording.names;
  out.time = time;
  const auto S = recording.size();
  out.quaternion.assign(at(4 * time.frames * S), kNaN);
  const auto sample = [&](std::int64_t f, std::int64_t s) {
    const double* q = recording.quaternion.data() + 4 * (f * S + s);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  };
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double place = (time.time_s(f) - recording.time.t0_s) * recording.time.rate_hz;
    if (!(place > -1.0 && place < static_cast<double>(recording.frames()))) continue;
    const auto nearest = std::llround(place);
    const bool on_sample = std::abs(place - static_cast<double>(nearest)) <= kTimeSlack;
    const auto before = on_sample ? nearest : static_cast<std::int64_t>(std::floor(place));
    const auto after = on_sample ? nearest : before + 1;
    if (before < 0 || after >= recording.frames()) continue;
    for (std::int64_t s = 0; s < S; ++s) {
      if (!recording.present(before, s) || !recording.present(after, s)) continue;
      const Eigen::Quaterniond q =
          on_sample
              ? sample(before, s)
              : sample(before, s).slerp(place - static_cast<double>(before), sample(after, s)).normalized();
      double* to = out.quaternion.data() + 4 * (f * S + s);
      to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
    }
  }
  return out;
}

std::vector<TurnedSpan> find_turned_spans(const data::Orientations& recording) {
  std::vector<TurnedSpan> out;
  for (std::int64_t s = 0; s < recording.size(); ++s) {
    auto spans = SensorTrack(recording, s).judge();
    std::ranges::sort(spans, {}, &TurnedSpan::first);
    out.insert(out.end(), spans.begin(), spans.end());
  }
  return out;
}

JudgedSensors judge_sensors(const data::Orientations& recording, const data::Orientations* pose) {
  JudgedSensors out{
      .recording = recording, .pose = {}, .in_recording = find_turned_spans(recording), .in_pose = {}};
  leave_out(out.in_recording, out.recording);
  if (pose == nullptr) return out;
  out.pose = *pose;
  out.in_pose = find_turned_spans(*pose);
  leave_out(out.in_pose, *out.pose);
  return out;
}

void JudgedSensors::account(const TimeBase& solved, OrientationFit& fit) const {
  const double slack = 0.5 / solved.rate_hz;
  const auto add = [&fit](const data::Orientations& from, const TurnedSpan& span, bool is_pose) {
    const auto& name = from.names[at(span.sensor)];
    if (std::ranges::none_of(fit.sensors, [&name](const auto& sensor) { return sensor.name == name; }))
      return;
    fit.rejected.push_back({.sensor = name,
                            .in_pose = is_pose,
                            .first_frame = from.time.number(span.first),
                            .last_frame = from.time.number(span.last),
                            .first_s = from.time.time_s(span.first),
                            .last_s = from.time.time_s(span.last),
                            .angle_rad = span.angle_rad});
  };
  for (const auto& span : in_recording)
    if (recording.time.time_s(span.last) > solved.t0_s - slack &&
        recording.time.time_s(span.first) < solved.time_s(solved.frames - 1) + slack)
      add(recording, span, false);
  for (const auto& span : in_pose) add(*pose, span, true);
}

}  // namespace kinemark::motion::internal
