// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A walker of whom everything is known: feet that land on the heel, lie flat, rise about the joint of the
// toes, roll over these and swing; with markers, force plates and the instants at which each foot touches and
// leaves the ground. At these instants they move as feet of nine laboratories do on plates
// (docs/theory/gait.md).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::analysis::testing {

/// How somebody walks.
struct KnownWalk {
  double speed_m_per_s = 1.3;                ///< over the ground
  double stride_s = 1.08;                    ///< of both feet
  std::array<double, 2> stance{0.62, 0.62};  ///< share of the stride, left, right
  double right_later = 0.5;                  ///< share of the stride, of the right strike after the left one
  double width_m = 0.1;                      ///< between the heels' lines
  double foot_m = 0.2;                       ///< from heel to toe marker
  double tip_m =
      0.06;  ///< from the toe marker (second metatarsal, over a joint) to the tip, which leaves last
  double roll_m = 0.02;  ///< radius of the tip, which rolls on the ground
  double land_rad = 0.35,
         push_rad = 1.05;      ///< pitch of the foot at strike, toes up, and at leaving, toes down
  double flat_at = 0.13;       ///< share of the stance after which the foot lies flat
  double rises_at = 0.6;       ///< share of the stance at which the heel rises
  double toes_rise_at = 0.85;  ///< share of the stance at which the toes rise about their tip
  double toes_rad = 0.6;       ///< pitch of the toes at leaving, tip down
  Eigen::Vector2d land_velocity{0.2, -0.1};  ///< of the heel at strike, forward and up, m/s
  double land_turn = -1.0;                   ///< pitch rate of the foot before it strikes, rad/s
  /// Pitch rates over the mean rate of the phase: after strike, as the forefoot falls; at leaving, of the
  /// foot and of the toes.
  double land_rate = 1.7, push_rate = 1.8, toes_rate = 2.0;
  /// Late in the swing, this long before strike: pitch over that at strike, its rate, height of the heel, its
  /// speed upwards.
  double late_s = 0.08, late_rad = 0.05, late_turn = 1.5, late_m = 0.02, late_up = 0.1;
  double toe_out_rad = 0.1;      ///< of each foot
  double sway_m = 0.02;          ///< of the pelvis, over the foot that stands
  double heading_rad = 0.4;      ///< of the walk in the laboratory
  bool treadmill = false;        ///< stays where it is; the belt runs
  double duration_s = 6.0;       ///< of the recording
  double rate_hz = 100.0;        ///< of frames
  double weight_n = 700.0;       ///< of the body
  double first_strike_s = -0.3;  ///< of the left foot

  /// Somebody, drawn.
  static KnownWalk draw(Random& random) {
    KnownWalk out;
    out.speed_m_per_s = random.uniform(0.8, 1.7);
    const double step_m = random.uniform(0.9, 1.1) * 0.42 * std::sqrt(out.speed_m_per_s / 1.3) * 1.65;
    out.stride_s = 2.0 * step_m / out.speed_m_per_s;
    const double stance = 0.68 - 0.05 * out.speed_m_per_s + random.uniform(-0.015, 0.015);
    out.stance = {stance + random.uniform(-0.01, 0.01), stance + random.uniform(-0.01, 0.01)};
    out.right_later = 0.5 + random.uniform(-0.015, 0.015);
    out.width_m = random.uniform(0.05, 0.18);
    out.foot_m = random.uniform(0.17, 0.23);
    out.tip_m = random.uniform(0.04, 0.08);
    out.land_rad = random.uniform(0.2, 0.45), out.push_rad = random.uniform(0.85, 1.2);
    out.flat_at = random.uniform(0.1, 0.17), out.rises_at = random.uniform(0.54, 0.66);
    out.land_velocity = {random.uniform(-0.25, 0.15), random.uniform(-0.2, 0.0)};
    out.land_turn = random.uniform(-3.0, 0.5), out.roll_m = random.uniform(0.01, 0.03);
    out.land_rate = random.uniform(1.4, 2.0), out.push_rate = random.uniform(1.5, 2.1);
    out.toes_rise_at = random.uniform(0.80, 0.90), out.toes_rad = random.uniform(0.3, 0.9);
    out.toes_rate = random.uniform(1.5, 2.5);
    out.late_rad = random.uniform(0.0, 0.1), out.late_turn = random.uniform(0.5, 2.5);
    out.late_m = random.uniform(0.01, 0.03), out.late_up = random.uniform(0.0, 0.2);
    out.toe_out_rad = random.uniform(0.0, 0.2);
    out.heading_rad = random.uniform(-3.0, 3.0);
    out.first_strike_s = random.uniform(-1.0, 0.0);
    return out;
  }

  [[nodiscard]] double stride_m() const { return speed_m_per_s * stride_s; }  ///< of both feet
  /// Strike of a foot's step, s.
  [[nodiscard]] double strike_s(data::Side side, std::int64_t step) const {
    return first_strike_s +
           stride_s * (static_cast<double>(step) + (side == data::Side::left ? 0.0 : right_later));
  }
  /// The foot leaves the ground after that strike, s.
  [[nodiscard]] double off_s(data::Side side, std::int64_t step) const {
    return strike_s(side, step) + stride_s * stance[data::index_of(side)];
  }
  /// Every instant within the recording, ascending.
  [[nodiscard]] std::vector<data::GaitEvent> events() const;
  /// Heel and toe marker of a foot at a time, in the laboratory, m.
  [[nodiscard]] std::array<Eigen::Vector3d, 2> foot_at(data::Side side, double time_s) const;
  /// Back of the pelvis.
  [[nodiscard]] Eigen::Vector3d pelvis_at(double time_s) const;
  /// "LHEE", "LTOE", "RHEE", "RTOE", "SACR" with white noise.
  [[nodiscard]] data::Trajectories markers(double noise_m, std::uint64_t seed) const;
  /// The same with "LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK" and "RANK". Feet may cross over (a
  /// width below 0); hips, knees and outer ankles stay on their sides.
  [[nodiscard]] data::Trajectories body_markers(double noise_m, std::uint64_t seed) const;
  /// The vertical force under a foot, N: up within a tenth of the stance, two humps, down within a tenth.
  [[nodiscard]] double load_n(data::Side side, double time_s) const;
  /// A plate that sees one step of a foot and nothing else, its frames means over a frame.
  [[nodiscard]] data::Wrench plate(const std::string& name, data::Side side, std::int64_t step) const;

 private:
  [[nodiscard]] Eigen::Vector3d in_laboratory(double forward, double left, double up, double time_s) const {
    const double x = treadmill ? forward - speed_m_per_s * time_s : forward;
    return {std::cos(heading_rad) * x - std::sin(heading_rad) * left,
            std::sin(heading_rad) * x + std::cos(heading_rad) * left, up};
  }
};

namespace walk_detail {

// Cubic between two values with their slopes; u from 0 to 1 over `span`. Value and slope.
inline std::array<double, 2> hermite(double u, double span, double a, double va, double b, double vb) {
  const double u2 = u * u, u3 = u2 * u;
  return {(2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * span * va + (-2 * u3 + 3 * u2) * b +
              (u3 - u2) * span * vb,
          ((6 * u2 - 6 * u) * a + (-6 * u2 + 6 * u) * b) / span + (3 * u2 - 4 * u + 1) * va +
              (3 * u2 - 2 * u) * vb};
}

inline constexpr double kHeelHeight_m = 0.035, kToeHeight_m = 0.03;

// Heel marker, forward and up, of a foot that turns about its heel or tip on the ground, and its velocity.
struct Pose {
  double x, z, pitch, vx, vz, pitch_rate;
};
inline Pose about_heel(double x0, double pitch, double rate) {
  // The heel marker stands over the point it turns about.
  const double h = kHeelHeight_m;
  return {x0 - h * std::sin(pitch),    h * std::cos(pitch),         pitch,
          -h * std::cos(pitch) * rate, -h * std::sin(pitch) * rate, rate};
}
// The toes turn about their tip, which rolls, and the rest of the foot about the joint behind them.
inline Pose about_tip(double x0, double foot, double tip, double roll, double pitch, double rate, double toes,
                      double toes_rate) {
  const double h = kHeelHeight_m, c = std::cos(pitch), s = std::sin(pitch);
  const double ct = std::cos(toes), st = std::sin(toes);
  // From the joint back to the heel marker: (-foot, height).
  const double x = -foot * c - h * s, z = -foot * s + h * c;
  return {x0 + foot + tip - tip * ct + roll * toes + x,
          tip * st + z,
          pitch,
          (tip * st + roll) * toes_rate + (foot * s - h * c) * rate,
          tip * ct * toes_rate + (-foot * c - h * s) * rate,
          rate};
}

}  // namespace walk_detail

inline std::array<Eigen::Vector3d, 2> KnownWalk::foot_at(data::Side side, double time_s) const {
  using namespace walk_detail;
  const double share = stance[data::index_of(side)], flat_s = flat_at * share * stride_s,
               rise_s = rises_at * share * stride_s, leave_s = share * stride_s;
  const double begun = strike_s(side, 0);
  const auto step = static_cast<std::int64_t>(std::floor((time_s - begun) / stride_s));
  const double t = time_s - strike_s(side, step),
               x0 = speed_m_per_s * (strike_s(side, step) - strike_s(data::Side::left, 0));
  const double landing_rate = -land_rate * land_rad / flat_s,
               leave_rate = -push_rate * push_rad / (leave_s - rise_s),
               toes_s = toes_rise_at * share * stride_s,
               toes_leave = toes_rate * toes_rad / (leave_s - toes_s);
  const Pose leaving = about_tip(x0, foot_m, tip_m, roll_m, -push_rad, leave_rate, toes_rad, toes_leave);
  Pose pose{};
  if (t < flat_s) {
    const auto p = hermite(t / flat_s, flat_s, land_rad, landing_rate, 0.0, 0.0);
    pose = about_heel(x0, p[0], p[1]);
  } else if (t < rise_s) {
    pose = about_heel(x0, 0.0, 0.0);
  } else if (t < leave_s) {
    const auto p =
        hermite((t - rise_s) / (leave_s - rise_s), leave_s - rise_s, 0.0, 0.0, -push_rad, leave_rate);
    const double v = std::max(0.0, (t - toes_s) / (leave_s - toes_s));
    const auto toes = hermite(v, leave_s - toes_s, 0.0, 0.0, toes_rad, toes_leave);
    pose = about_tip(x0, foot_m, tip_m, roll_m, p[0], p[1], toes[0], toes[1]);
  } else {
    const double span = stride_s - leave_s, u = (t - leave_s) / span;
    const Pose landing = about_heel(x0 + stride_m(), land_rad, landing_rate);
    pose.x = hermite(u, span, leaving.x, leaving.vx, landing.x, land_velocity.x())[0];
    if (const double first = span - late_s; t - leave_s < first) {
      const double w = (t - leave_s) / first;
      pose.z = hermite(w, first, leaving.z, leaving.vz, landing.z + late_m, late_up)[0];
      pose.pitch = hermite(w, first, -push_rad, leave_rate, land_rad + late_rad, late_turn)[0];
    } else {
      const double w = (t - leave_s - first) / late_s;
      pose.z = hermite(w, late_s, landing.z + late_m, late_up, landing.z, land_velocity.y())[0];
      pose.pitch = hermite(w, late_s, land_rad + late_rad, late_turn, land_rad, land_turn)[0];
    }
  }
  const double c = std::cos(pose.pitch), s = std::sin(pose.pitch), drop = kToeHeight_m - kHeelHeight_m;
  const double toe_x = pose.x + foot_m * c - drop * s, toe_z = pose.z + foot_m * s + drop * c;
  const double outward = side == data::Side::left ? 1.0 : -1.0, line = outward * 0.5 * width_m;
  const double out = outward * std::sin(toe_out_rad), along = std::cos(toe_out_rad);
  return {in_laboratory(pose.x, line, pose.z, time_s),
          in_laboratory(pose.x + along * (toe_x - pose.x), line + out * (toe_x - pose.x), toe_z, time_s)};
}

inline Eigen::Vector3d KnownWalk::pelvis_at(double time_s) const {
  const double phase = 2.0 * std::numbers::pi * (time_s - first_strike_s) / stride_s;
  const double middle =
      speed_m_per_s * (time_s - strike_s(data::Side::left, 0)) + 0.5 * foot_m - 0.31 * stride_m() - 0.08;
  return in_laboratory(middle + 0.01 * std::sin(2.0 * phase), sway_m * std::cos(phase),
                       0.95 - 0.02 * std::cos(2.0 * phase), time_s);
}

inline std::vector<data::GaitEvent> KnownWalk::events() const {
  std::vector<data::GaitEvent> out;
  const double last = duration_s - 1.0 / rate_hz;
  for (const data::Side side : data::kBothSides)
    for (std::int64_t step = -2; strike_s(side, step) <= last; ++step)
      for (const auto what : data::kFootEvents) {
        const double t = what == data::FootEvent::strike ? strike_s(side, step) : off_s(side, step);
        if (t >= 0.0 && t <= last) out.push_back({.side = side, .what = what, .time_s = t});
      }
  std::ranges::stable_sort(out, {}, &data::GaitEvent::time_s);
  return out;
}

inline data::Trajectories KnownWalk::markers(double noise_m, std::uint64_t seed) const {
  Random random(seed, 0x77616c6b);
  auto out = data::Trajectories::all_missing(
      {"LHEE", "LTOE", "RHEE", "RTOE", "SACR"},
      {.rate_hz = rate_hz, .frames = static_cast<std::int64_t>(std::llround(duration_s * rate_hz))});
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const double t = out.time.time_s(f);
    const auto left = foot_at(data::Side::left, t), right = foot_at(data::Side::right, t);
    const std::array<Eigen::Vector3d, 5> x{left[0], left[1], right[0], right[1], pelvis_at(t)};
    for (std::int64_t m = 0; m < 5; ++m) {
      for (int axis = 0; axis < 3; ++axis)
        out.x(f, m)[axis] = x[static_cast<std::size_t>(m)][axis] + noise_m * random.gaussian();
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

inline data::Trajectories KnownWalk::body_markers(double noise_m, std::uint64_t seed) const {
  const auto feet = markers(noise_m, seed);
  auto out = data::Trajectories::all_missing({"LHEE", "LTOE", "RHEE", "RTOE", "SACR", "LASI", "RASI", "LPSI",
                                              "RPSI", "LKNE", "RKNE", "LANK", "RANK"},
                                             feet.time);
  Random random(seed, 0x626f6479);
  const Eigen::Vector3d forward(std::cos(heading_rad), std::sin(heading_rad), 0.0),
      left(-std::sin(heading_rad), std::cos(heading_rad), 0.0), up = Eigen::Vector3d::UnitZ();
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    std::vector<Eigen::Vector3d> x;
    for (std::int64_t m = 0; m < feet.markers(); ++m) x.emplace_back(feet.x(f, m));
    const Eigen::Vector3d sacrum = x[4];
    for (const auto& [ahead, aside] : {std::pair{0.16, 0.12}, std::pair{0.0, 0.045}})
      for (const double side : {1.0, -1.0}) x.emplace_back(sacrum + ahead * forward + side * aside * left);
    std::array<Eigen::Vector3d, 2> ankles;
    for (const std::size_t i : {0, 1}) {
      const double side = i == 0 ? 1.0 : -1.0;
      ankles[i] = x[2 * i] + 0.35 * (x[2 * i + 1] - x[2 * i]) + 0.04 * side * left + 0.05 * up;
      const Eigen::Vector3d hip = sacrum + 0.08 * forward + 0.09 * side * left;
      x.emplace_back(0.5 * (hip + ankles[i]) + 0.06 * forward + 0.05 * side * left);
    }
    x.insert(x.end(), ankles.begin(), ankles.end());
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const auto& from = x[static_cast<std::size_t>(m)];
      for (int axis = 0; axis < 3; ++axis)
        out.x(f, m)[axis] = from[axis] + (m < feet.markers() ? 0.0 : noise_m * random.gaussian());
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

inline double KnownWalk::load_n(data::Side side, double time_s) const {
  const double share = stance[data::index_of(side)];
  const double from = (time_s - strike_s(side, 0)) / stride_s;
  const double u = (from - std::floor(from)) / share;
  if (u >= 1.0) return 0.0;
  const double humps = 1.0 + 0.15 * std::cos(4.0 * std::numbers::pi * (u - 0.25));
  return weight_n * humps * std::clamp(std::min(u, 1.0 - u) / 0.12, 0.0, 1.0);
}

inline data::Wrench KnownWalk::plate(const std::string& name, data::Side side, std::int64_t step) const {
  data::Wrench out{.name = name, .body = {}, .force = {}, .moment = {}, .point = {}};
  const double from = strike_s(side, step) - 0.05, to = off_s(side, step) + 0.05;
  constexpr int kWithin = 10;
  const auto frames = static_cast<std::int64_t>(std::llround(duration_s * rate_hz));
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / rate_hz;
    double load = 0.0;
    for (int k = 0; k < kWithin; ++k) {
      const double s = t + ((k + 0.5) / kWithin - 0.5) / rate_hz;
      if (s > from && s < to) load += load_n(side, s) / kWithin;
    }
    const auto foot = foot_at(side, t);
    Eigen::Vector3d point = foot[0] + std::clamp((t - from) / (to - from), 0.0, 1.0) * (foot[1] - foot[0]);
    point.z() = 0.0;
    for (const double x : {0.0, 0.0, load}) out.force.push_back(x);
    for (int axis = 0; axis < 3; ++axis) out.moment.push_back(0.0), out.point.push_back(point[axis]);
  }
  return out;
}

}  // namespace kinemark::analysis::testing
