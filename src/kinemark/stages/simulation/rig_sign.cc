// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The sign LOOK-AT with the inflection [Continuative], as Poizner, Wooten & Salot (1986) show it: round and
// round with an uneven rhythm.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kPeriod =
    0.7188853793315183;  ///< s; with kUneven: 2.7 m/s at the fastest, 0.5 at the slowest
constexpr double kUneven = 0.7359709609674898;
constexpr double kUnevenTwice = 0.06;
constexpr double kUpperArm = 0.310, kForearm = 0.280, kHand = 0.080;  ///< m

class Signer {
 public:
  Signer()
      : along_(math::axis_angle(Vector3d::UnitZ(), 25.0 * kRadPerDeg) * Vector3d::UnitX()),
        across_(math::axis_angle(Vector3d::UnitZ(), 25.0 * kRadPerDeg) *
                math::axis_angle(Vector3d::UnitX(), 40.0 * kRadPerDeg) * Vector3d::UnitY()),
        swivel_(Vector3d(0.55, -0.80, -0.25).normalized()),
        fingers_(Vector3d(-0.35, 0.75, 0.55).normalized()) {}

  [[nodiscard]] Vector3d at(int led, double time_s) const {
    const double phase = 2.0 * pi * time_s / kPeriod;
    if (led == 0) return shoulder(phase);
    if (led == 3) return hand(phase, time_s);
    return led == 2 ? wrist(phase, time_s) : elbow(phase, time_s);
  }

 private:
  static Vector3d shoulder(double phase) {
    return Vector3d(0.150, 0.200, -0.130) + 0.008 * std::sin(phase + 0.7) * Vector3d(0.5, 0.8, 0.3);
  }
  [[nodiscard]] Vector3d hand(double phase, double time_s) const {
    const double angle =
        60.0 * kRadPerDeg + phase + kUneven * std::sin(phase) + kUnevenTwice * std::sin(2.0 * phase);
    const Vector3d drift(0.0, 0.0, 0.006 * std::sin(2.0 * pi * 0.31 * time_s));  // no two rounds are the same
    return Vector3d(-0.060, 0.040, 0.150) + 0.170 * std::cos(angle) * along_ +
           0.080 * std::sin(angle) * across_ + drift;
  }
  [[nodiscard]] Vector3d wrist(double phase, double time_s) const {
    const Vector3d direction = fingers_ + 0.25 * std::sin(phase + 1.1) * Vector3d::UnitX();
    return hand(phase, time_s) - kHand * direction.normalized();
  }
  /// Where two bones from shoulder to wrist meet, with the elbow always to the same side.
  [[nodiscard]] Vector3d elbow(double phase, double time_s) const {
    const Vector3d from = shoulder(phase);
    const Vector3d reach = wrist(phase, time_s) - from;
    const double length = reach.norm();
    const Vector3d u = reach / length;
    const double along = (kUpperArm * kUpperArm - kForearm * kForearm + length * length) / (2.0 * length);
    const double aside = std::sqrt(std::max(kUpperArm * kUpperArm - along * along, 1e-12));
    const Vector3d n = (swivel_ - swivel_.dot(u) * u).normalized();
    return from + along * u + aside * n;
  }

  Vector3d along_, across_, swivel_, fingers_;
};

}  // namespace

RigScene signing_arm() {
  RigScene scene;
  scene.leds = {"shoulder", "elbow", "wrist", "hand"};
  scene.led = [signer = Signer()](int led, double time_s) {
    return LedState{.x_in_world = signer.at(led, time_s)};
  };
  scene.occlusions = {{.led = 3, .camera = 1, .first_frame = 120, .last_frame = 131},
                      {.led = 2, .camera = 0, .first_frame = 200, .last_frame = 209},
                      {.led = 1, .camera = -1, .first_frame = 300, .last_frame = 306}};
  return scene;
}

}  // namespace kinemark::simulation
