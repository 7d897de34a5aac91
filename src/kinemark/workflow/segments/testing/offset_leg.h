// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A leg built forwards from the offsets of the conventional gait model.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::workflow {

/// What the leg is made of: m, rad.
struct OffsetLeg {
  double side = 1.0;  ///< 1 left, -1 right
  double thigh = 0.2, shank = -0.15, torsion = -0.3, abduction = 0.2;
  double knee_width = 0.102, ankle_width = 0.07, diameter = 0.014, leg = 0.92, asis = 0.24;
  double hip_forward = 0.0;  ///< away from the regression, m
  double wobble = 0.0;       ///< of the thigh's wand about the axis, which no model has, rad

  [[nodiscard]] std::string letter() const { return side > 0.0 ? "L" : "R"; }

  /// Knee flexion, and nothing else at the knee, in each frame; the shank leans too.
  [[nodiscard]] static double flexion(std::int64_t f) {
    return 0.3 + 0.3 * std::sin(0.1 * static_cast<double>(f));
  }

  /// Markers and centres of a frame, and points of the shank's bone.
  [[nodiscard]] std::map<std::string, Eigen::Vector3d> points(std::int64_t f) const {
    using Eigen::AngleAxisd, Eigen::Matrix3d, Eigen::Vector3d;
    const Vector3d ux = Vector3d::UnitX(), uy = Vector3d::UnitY(), uz = Vector3d::UnitZ();
    const double dk = 0.5 * (knee_width + diameter), da = 0.5 * (ankle_width + diameter);
    // Before the abduction: the shank's frame, its centre 0.4 m below the knee.
    const Matrix3d f0 =
        AngleAxisd(-0.2 + 0.1 * std::cos(0.07 * static_cast<double>(f)), uy).toRotationMatrix();
    const Vector3d knee(0.1 + 0.01 * static_cast<double>(f), 0.2, 0.5);
    const Vector3d a0 = knee - 0.4 * f0.col(2), marker = a0 + side * da * f0.col(1);
    const Vector3d ankle =
        marker - side * da * std::cos(abduction) * f0.col(1) + da * std::sin(abduction) * f0.col(2);
    Matrix3d t;
    t.col(2) = (knee - ankle).normalized();
    t.col(1) = (side * (marker - ankle) - side * (marker - ankle).dot(t.col(2)) * t.col(2)).normalized();
    t.col(0) = t.col(1).cross(t.col(2));
    const Matrix3d at_knee = t * AngleAxisd(side * torsion, uz).toRotationMatrix();
    const Matrix3d femur = at_knee * AngleAxisd(-flexion(f), uy).toRotationMatrix();
    const Vector3d hip = knee + 0.4 * femur.col(2);
    const double depth = 0.115 * leg - 0.0153, trochanter = 0.1288 * leg - 0.04856 + 0.5 * diameter;
    const Vector3d pelvis =
        hip - Vector3d(hip_forward + depth * std::cos(0.5) * std::sin(0.314) - trochanter * std::cos(0.314),
                       side * (0.5 * asis - depth * std::sin(0.5)),
                       -depth * std::cos(0.5) * std::cos(0.314) - trochanter * std::sin(0.314));
    const auto wand = [&](const Matrix3d& m, double turn) -> Vector3d {
      return m * Vector3d(-std::sin(turn), side * std::cos(turn), 0.0);
    };
    const double moved = thigh + wobble * std::sin(0.5 * static_cast<double>(f));
    const std::string s = letter();
    return {{"LASI", pelvis + 0.5 * asis * uy},
            {"RASI", pelvis - 0.5 * asis * uy},
            {"LPSI", pelvis + 0.05 * uy - 0.15 * ux},
            {"RPSI", pelvis - 0.05 * uy - 0.15 * ux},
            {s + "THI", knee + 0.2 * femur.col(2) + 0.12 * wand(femur, moved)},
            {s + "KNE", knee + side * dk * femur.col(1)},
            {s + "TIB", a0 + 0.2 * f0.col(2) + 0.09 * wand(f0, shank)},
            {s + "ANK", marker},
            {s + "FEP", hip},
            {s + "FEO", knee},
            {s + "TIO", ankle},
            {s + "TIL", ankle + 0.1 * at_knee.col(1)}};
  }

  /// The recording, with the model's own knee angles as a channel when `outputs` are asked for.
  [[nodiscard]] data::Trial trial(std::int64_t frames, bool outputs) const {
    data::Trial out;
    out.source = "leg.c3d";
    std::vector<std::string> names;
    for (const auto& [name, x] : points(0))
      if (outputs || !is_output(name)) names.push_back(name);
    out.markers = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = frames});
    for (std::int64_t f = 0; f < frames; ++f) {
      const auto x = points(f);
      for (std::int64_t m = 0; m < std::ssize(names); ++m) {
        out.markers.x(f, m) = x.at(names[static_cast<std::size_t>(m)]);
        out.markers.state[out.markers.index(f, m)] = data::SampleState::measured;
      }
    }
    if (!outputs) return out;
    out.channels.names = {letter() + "KneeAngles"};
    out.channels.kinds = {data::ChannelKind::angle};
    out.channels.units = {"deg"};
    out.channels.rate_hz = 100.0;
    out.channels.frames = frames;
    for (std::int64_t f = 0; f < frames; ++f)
      for (const double v : {flexion(f) * 180.0 / 3.14159265358979323846, 1e-9, 1e-9})
        out.channels.values.push_back(v);
    return out;
  }

  /// The subject's measures as a file has them.
  [[nodiscard]] std::vector<analysis::SubjectValue> values() const {
    const std::string s = letter();
    return {{"LLegLength", leg, "leg.c3d"},           {"RLegLength", leg, "leg.c3d"},
            {s + "KneeWidth", knee_width, "leg.c3d"}, {s + "AnkleWidth", ankle_width, "leg.c3d"},
            {"InterAsisDistance", asis, "leg.c3d"},   {s + "ThighRotation", thigh, "leg.c3d"},
            {s + "ShankRotation", shank, "leg.c3d"},  {s + "TibialTorsion", torsion, "leg.c3d"},
            {s + "AnkleAbAdd", abduction, "leg.c3d"}};
  }

 private:
  static bool is_output(const std::string& name) {
    const auto bone = name.substr(1);
    return bone == "FEP" || bone == "FEO" || bone == "TIO" || bone == "TIL";
  }
};

}  // namespace kinemark::workflow
