// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "skin_limbs.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/math/rotation_fit.h"

namespace kinemark::skin_limbs {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixX3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRateHz = 50.0;
constexpr double kStep_s = 1.0 / kRateHz;

/// Markers about the joint's centre, the centre's scatter, softness of parent and child.
struct Anatomy {
  std::vector<Vector3d> parent, child;
  double soft_parent, soft_child;
};

Anatomy anatomy(Limb limb) {
  switch (limb) {
    case Limb::hip:
      return {{{0.04, 0.07, 0.11}, {-0.20, 0.07, 0.11}, {-0.02, -0.12, 0.13}, {-0.14, -0.12, 0.13}},
              {{0.07, 0.03, -0.15},
               {0.05, -0.06, -0.22},
               {0.08, 0.01, -0.28},
               {0.0, 0.08, -0.20},
               {0.04, 0.05, -0.34}},
              0.4,
              1.0};
    case Limb::shoulder:
      return {{{-0.17, 0.10, 0.0}, {-0.17, 0.11, -0.15}, {-0.19, -0.09, 0.03}, {-0.18, -0.08, -0.14}},
              {{0.05, 0.02, -0.10}, {0.05, -0.03, -0.16}, {0.04, 0.03, -0.20}, {0.0, -0.05, -0.14}},
              0.5,
              1.0};
    case Limb::knee:
      return {{{0.07, 0.03, 0.25}, {0.05, -0.06, 0.18}, {0.08, 0.01, 0.12}, {0.0, 0.08, 0.20}},
              {{0.05, 0.03, -0.12}, {0.04, -0.05, -0.20}, {0.05, 0.02, -0.28}, {-0.02, 0.05, -0.20}},
              1.0,
              0.5};
    case Limb::elbow:
      break;
  }
  return {{{0.04, 0.02, 0.18}, {0.04, -0.03, 0.12}, {0.05, 0.02, 0.08}, {0.0, -0.05, 0.13}},
          {{0.03, 0.02, -0.10}, {0.03, -0.03, -0.15}, {0.02, 0.02, -0.21}, {-0.03, 0.02, -0.15}},
          1.0,
          0.6};
}

Vector3d draw3(Random& random) {
  const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  return {x, y, z};
}

Matrix3d draw33(Random& random) {
  Matrix3d out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = random.gaussian();
  return out;
}

/// A slow path of unit SD: sums of sines of random frequency below `top_hz`.
VectorXd slow(Random& random, Eigen::Index frames, double top_hz) {
  VectorXd out = VectorXd::Zero(frames);
  for (int k = 0; k < 12; ++k) {
    const double hz = top_hz * std::sqrt(random.uniform()),
                 phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double a = random.gaussian();
    for (Eigen::Index i = 0; i < frames; ++i)
      out(i) += a * std::sin(2.0 * std::numbers::pi * hz * kStep_s * static_cast<double>(i) + phase);
  }
  out.array() -= out.mean();
  return out / std::sqrt(out.squaredNorm() / static_cast<double>(frames));
}

/// Rotation vectors of the joint, and the movement of each frame.
struct Motion {
  MatrixX3d posture;
  std::vector<int> movement;
  int movements = 0;
};

Motion make_motion(const Case& of, Random& random) {
  Motion out;
  out.movements = of.movements;
  std::vector<Vector3d> path;
  for (int m = 0; m < of.movements; ++m) {
    const auto frames = static_cast<int>(2.2 * random.uniform(0.85, 1.15) * kRateHz);
    const double reach = of.range_deg * kRadPerDeg * random.uniform(0.88, 1.12);
    const double azimuth = of.arcs == Arcs::star  ? std::numbers::pi / 3.5 * (m % 7)
                           : of.arcs == Arcs::two ? std::numbers::pi / 2.0 * (m % 2)
                                                  : 0.0;
    for (int i = 0; i < frames; ++i) {
      const double phase = static_cast<double>(i) / frames;
      if (is_ball(of.limb)) {
        const double angle = reach * (std::sin(std::numbers::pi * phase) - 0.3);
        path.emplace_back(angle * std::cos(azimuth), angle * std::sin(azimuth), 0.0);
      } else {
        path.emplace_back(reach * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * phase)), 0.0, 0.0);
      }
      out.movement.push_back(m);
    }
  }
  const auto F = static_cast<Eigen::Index>(path.size());
  out.posture.resize(F, 3);
  for (Eigen::Index i = 0; i < F; ++i) out.posture.row(i) = path[at(i)].transpose();
  if (is_ball(of.limb)) {
    const Vector3d wander(0.02, 0.02, of.arcs == Arcs::one ? 0.03 : 0.06);
    for (int k = 0; k < 3; ++k) out.posture.col(k) += wander(k) * slow(random, F, 0.5);
  }
  return out;
}

/// A cluster whose markers slide.
struct Sheet {
  const Matrix3Xd& bone;  ///< markers about the joint, m
  const Motion& motion;
  MatrixX3d q;      ///< posture about its mean
  double sd = 0.0;  ///< of all of it, rad
  Matrix3Xd arm;    ///< markers about their mean
  double radius = 0.0;
  MatrixX3d acceleration;  ///< of the cluster in its own axes, in units of its SD

  Sheet(const Matrix3Xd& of, const Motion& with) : bone(of), motion(with), q(with.posture) {
    q.rowwise() -= q.colwise().mean().eval();
    sd = std::sqrt(q.squaredNorm() / static_cast<double>(q.rows()));
    arm = bone.colwise() - bone.rowwise().mean();
    radius = std::sqrt(arm.squaredNorm() / static_cast<double>(arm.cols()));
  }
  [[nodiscard]] Eigen::Index frames() const { return q.rows(); }
  [[nodiscard]] Eigen::Index markers() const { return bone.cols(); }
  [[nodiscard]] Vector3d along() const {
    const Vector3d mean = bone.rowwise().mean();
    return mean.norm() > 0.1 ? Vector3d(mean.normalized()) : Vector3d(Vector3d::UnitZ());
  }
};

/// Slides are F x 3M with an expected RMS length of about 1.
MatrixXd linear_slide(Random& random, const Sheet& on, bool as_body) {
  const double own = as_body ? 0.55 : 1.0, common = as_body ? 1.0 : 0.7, turn = as_body ? 1.2 : 0.0;
  const Matrix3d together = draw33(random), turning = draw33(random);
  MatrixXd out(on.frames(), 3 * on.markers());
  for (Eigen::Index m = 0; m < on.markers(); ++m) {
    const Matrix3d B = own * draw33(random) + common * together;
    for (Eigen::Index i = 0; i < on.frames(); ++i) {
      const Vector3d q = on.q.row(i).transpose();
      const Vector3d turned = (turning * q).cross(on.arm.col(m) / on.radius);
      out.block<1, 3>(i, 3 * m) = (B * q + turn * turned).transpose();
    }
  }
  return out / (std::sqrt(3.0 * (own * own + common * common) + 2.0 * turn * turn) * on.sd);
}

/// One number a movement, carried smoothly from one to the next.
VectorXd by_movement(const Motion& motion, const VectorXd& value) {
  const auto F = static_cast<Eigen::Index>(motion.movement.size());
  VectorXd out(F);
  constexpr Eigen::Index kHalf = 12;
  for (Eigen::Index i = 0; i < F; ++i) {
    double sum = 0.0;
    int n = 0;
    for (auto k = std::max<Eigen::Index>(0, i - kHalf); k < std::min(F, i + kHalf + 1); ++k, ++n)
      sum += value(motion.movement[at(k)]);
    out(i) = sum / n;
  }
  return out;
}

VectorXd draws(Random& random, int n) {
  VectorXd out(n);
  for (double& x : out) x = random.gaussian();
  return out;
}

MatrixXd curved_slide(Random& random, const Sheet& on) {
  constexpr int kWays = 4;
  const auto F = on.frames();
  MatrixXd way(F, kWays);
  for (int k = 0; k < kWays; ++k) {
    const Vector3d u = draw3(random).normalized() * random.uniform(1.0, 4.0);
    const double at_rest = random.uniform(-0.5, 0.5);
    way.col(k) = (on.q * u).array() + at_rest;
    way.col(k) = way.col(k).array().tanh();
  }
  way.rowwise() -= way.colwise().mean().eval();
  way /= std::sqrt(way.squaredNorm() / static_cast<double>(F));
  const VectorXd gain =
      by_movement(on.motion, (1.0 + 0.2 * draws(random, on.motion.movements).array()).matrix());
  way = gain.asDiagonal() * way;
  MatrixXd together(kWays, 3), turning(kWays, 3);
  for (int k = 0; k < kWays; ++k) {
    together.row(k) = 0.5 * draw3(random).transpose();
    turning.row(k) = 0.45 * draw3(random).transpose();
  }
  // What wanders from movement to movement: a random walk, all markers alike and each by itself.
  const auto walk = [&] {
    VectorXd steps = draws(random, on.motion.movements);
    for (Eigen::Index k = 1; k < steps.size(); ++k) steps(k) += steps(k - 1);
    steps.array() -= steps.mean();
    return by_movement(on.motion, steps * (0.6 / std::sqrt(0.5 * static_cast<double>(steps.size()))));
  };
  MatrixXd common_walk(F, 3);
  for (int axis = 0; axis < 3; ++axis) common_walk.col(axis) = walk();
  MatrixXd out(F, 3 * on.markers());
  for (Eigen::Index m = 0; m < on.markers(); ++m) {
    MatrixXd own(kWays, 3);
    for (int k = 0; k < kWays; ++k) own.row(k) = 0.4 * draw3(random).transpose();
    MatrixXd path = way * (together + own);
    for (int axis = 0; axis < 3; ++axis) path.col(axis) += 0.25 * (common_walk.col(axis) + walk());
    const MatrixXd turn = way * turning;
    for (Eigen::Index i = 0; i < F; ++i)
      path.row(i) += Vector3d(turn.row(i).transpose()).cross(on.arm.col(m) / on.radius).transpose();
    out.middleCols<3>(3 * m) = path;
  }
  return out / std::sqrt(3.0 * (0.25 + 0.16) + 2.0 * 0.2 + 3.0 * 0.06);
}

/// An oscillator that follows a drive late: x'' = w^2 (drive - x) - 2 z w x'.
VectorXd follow(const VectorXd& drive, double hz, double damping) {
  constexpr int kSteps = 20;
  const double w = 2.0 * std::numbers::pi * hz, h = kStep_s / kSteps;
  VectorXd out(drive.size());
  double x = drive(0), v = 0.0;
  for (Eigen::Index i = 0; i < drive.size(); ++i) {
    const double from = i == 0 ? drive(0) : drive(i - 1);
    for (int k = 1; k <= kSteps; ++k) {
      const double now = from + (drive(i) - from) * k / kSteps;
      v += h * (w * w * (now - x) - 2.0 * damping * w * v);
      x += h * v;
    }
    out(i) = x;
  }
  out.array() -= out.mean();
  return out;
}

MatrixXd late_slide(Random& random, const Sheet& on, bool plate) {
  const auto F = on.frames();
  const Vector3d mix(1.0, 0.4 * random.gaussian(), 0.3 * random.gaussian());
  const double hz = random.uniform(3.0, 6.0), damping = random.uniform(0.3, 0.6);
  const VectorXd attraction = follow(on.q * mix, hz, damping) / on.sd;
  const double gain = (random.uniform() < 0.5 ? -1.0 : 1.0) * std::exp(0.3 * random.gaussian());
  const Vector3d along = on.along(), aside = plate ? along : Vector3d(along + 0.25 * draw3(random));
  const VectorXd height = on.arm.transpose() * along;
  const double spread = std::sqrt(height.squaredNorm() / static_cast<double>(height.size()));
  const VectorXd axial = -0.8 / on.sd * (on.q * along);
  MatrixXd out(F, 3 * on.markers());
  for (Eigen::Index m = 0; m < on.markers(); ++m) {
    const double share = plate ? 1.0 : 1.0 + 0.3 * height(m) / spread + 0.15 * random.gaussian();
    const Matrix3d own = (plate ? 0.0 : 0.2 / on.sd) * draw33(random);
    for (Eigen::Index i = 0; i < F; ++i) {
      Vector3d d = gain * attraction(i) * share * aside + own * on.q.row(i).transpose();
      if (!plate)
        d += axial(i) * along.cross(on.arm.col(m) / on.radius) + 0.1 * on.acceleration.row(i).transpose();
      out.block<1, 3>(i, 3 * m) = d.transpose();
    }
  }
  out.rowwise() -= out.colwise().mean().eval();
  return plate ? out : MatrixXd(out / 1.25);
}

/// A path that stays behind what drives it by as much as there is play.
VectorXd with_play(const VectorXd& drive, double play) {
  VectorXd out(drive.size());
  double x = drive(0);
  for (Eigen::Index i = 0; i < drive.size(); ++i) {
    x = std::clamp(x, drive(i) - play, drive(i) + play);
    out(i) = x;
  }
  out.array() -= out.mean();
  return out;
}

/// Radial functions along and around the segment, each with its own drive.
MatrixXd sheet_slide(Random& random, const Sheet& on) {
  constexpr int kSites = 6;
  constexpr double kReach_m = 0.10;
  const auto F = on.frames();
  MatrixXd out = MatrixXd::Zero(F, 3 * on.markers());
  double energy = 0.0;
  for (int k = 0; k < kSites; ++k) {
    const Vector3d place = on.bone.rowwise().mean() + 0.8 * on.radius * draw3(random);
    const Vector3d u = draw3(random).normalized();
    VectorXd drive = with_play(on.q * u, random.uniform(0.05, 0.25) * on.sd);
    const double deflection = random.uniform(-0.4, 0.4) / on.sd;
    drive = (drive.array() + deflection * drive.array().square()).matrix();
    drive.array() -= drive.mean();
    drive /= std::max(std::sqrt(drive.squaredNorm() / static_cast<double>(F)), 1e-9);
    const Vector3d to = draw3(random);
    for (Eigen::Index m = 0; m < on.markers(); ++m) {
      const double weight = std::exp(-0.5 * (on.bone.col(m) - place).squaredNorm() / (kReach_m * kReach_m));
      energy += 3.0 * weight * weight / static_cast<double>(on.markers());
      out.middleCols<3>(3 * m) += weight * drive * to.transpose();
    }
  }
  return out / std::sqrt(energy);
}

MatrixXd slide_of(Random& random, Skin skin, const Sheet& on) {
  switch (skin) {
    case Skin::linear:
      return linear_slide(random, on, false);
    case Skin::rigid:
      return linear_slide(random, on, true);
    case Skin::curved:
      return curved_slide(random, on);
    case Skin::late:
      return late_slide(random, on, false);
    case Skin::plate:
      return late_slide(random, on, true);
    case Skin::sheet:
      return sheet_slide(random, on);
    case Skin::none:
    case Skin::coloured:
      break;
  }
  return MatrixXd::Zero(on.frames(), 3 * on.markers());
}

/// Energy of slides, all of it and what no small movement as one body explains.
struct Energy {
  double all = 0.0, deforming = 0.0;
};

Energy energy_of(const MatrixXd& slide, const Sheet& on) {
  Energy out{.all = slide.squaredNorm()};
  const Matrix3d scatter = on.arm * on.arm.transpose();
  const Matrix3d inverse = (scatter.trace() * Matrix3d::Identity() - scatter).inverse();
  for (Eigen::Index i = 0; i < slide.rows(); ++i) {
    const VectorXd row = slide.row(i).transpose();
    const Eigen::Map<const Matrix3Xd> d(row.data(), 3, on.markers());
    Vector3d moment = Vector3d::Zero();
    for (Eigen::Index m = 0; m < on.markers(); ++m) moment += on.arm.col(m).cross(d.col(m));
    const Vector3d turn = inverse * moment, shift = d.rowwise().mean();
    for (Eigen::Index m = 0; m < on.markers(); ++m)
      out.deforming += (d.col(m) - shift - turn.cross(on.arm.col(m))).squaredNorm();
  }
  return out;
}

/// Acceleration of the child's cluster by the joint's motion, in its own axes, in units of its SD.
MatrixX3d acceleration_of(const std::vector<Matrix3d>& rotation, const Vector3d& place) {
  const auto F = static_cast<Eigen::Index>(rotation.size());
  MatrixX3d out = MatrixX3d::Zero(F, 3);
  for (Eigen::Index i = 1; i + 1 < F; ++i)
    out.row(i) =
        (rotation[at(i)].transpose() *
         (rotation[at(i - 1)] * place - 2.0 * (rotation[at(i)] * place) + rotation[at(i + 1)] * place) /
         (kStep_s * kStep_s))
            .transpose();
  out.rowwise() -= out.colwise().mean().eval();
  return out / std::max(std::sqrt(out.squaredNorm() / static_cast<double>(3 * F)), 0.05);
}

Matrix3Xd on_bone(Random& random, const std::vector<Vector3d>& about, double scatter_m) {
  Matrix3Xd out(3, static_cast<Eigen::Index>(about.size()));
  for (std::size_t k = 0; k < about.size(); ++k)
    out.col(static_cast<Eigen::Index>(k)) = about[k] + scatter_m * draw3(random);
  return out;
}

}  // namespace

std::string_view to_string(Limb limb) {
  constexpr std::array<std::string_view, 4> kNames = {"hip", "shoulder", "knee", "elbow"};
  return kNames[at(static_cast<int>(limb))];
}

std::string_view to_string(Skin skin) {
  constexpr std::array<std::string_view, 8> kNames = {
      "no skin", "no skin, coloured noise", "linear skin", "skin as one body", "curved skin", "late skin",
      "a plate", "a sheet of skin"};
  return kNames[at(static_cast<int>(skin))];
}

Subject make_subject(const Case& of) {
  Random shape(of.seed, 1), moving(of.seed, 2), sliding(of.seed, 3), noise(of.seed, 4);
  Subject out;
  const Anatomy limb = anatomy(of.limb);
  out.bone = {on_bone(shape, limb.parent, 0.009), on_bone(shape, limb.child, 0.010)};
  out.centre = {Vector3d::Zero(), Vector3d::Zero()};
  const Motion motion = make_motion(of, moving);
  const auto F = motion.posture.rows();
  if (!is_ball(of.limb)) out.axis = (Vector3d::UnitX() + 0.05 * draw3(shape)).normalized();
  std::vector<Matrix3d> rotation;
  for (Eigen::Index i = 0; i < F; ++i)
    rotation.push_back(math::exp_so3(is_ball(of.limb) ? Vector3d(motion.posture.row(i).transpose())
                                                      : Vector3d(motion.posture(i, 0) * out.axis)));
  MatrixX3d sway(F, 3), at_world(F, 3);
  for (int k = 0; k < 3; ++k) {
    sway.col(k) = 0.07 * slow(moving, F, 0.4);
    at_world.col(k) = (0.02 * slow(moving, F, 0.4)).array() + (k == 2 ? 0.95 : 0.0);
  }
  const std::array<double, 2> soft = {limb.soft_parent, limb.soft_child};
  std::array<MatrixXd, 2> slide;
  Energy energy;
  for (std::size_t s = 0; s < 2; ++s) {
    Sheet sheet(out.bone[s], motion);
    sheet.acceleration =
        s == 0 ? MatrixX3d::Zero(F, 3) : acceleration_of(rotation, out.bone[1].rowwise().mean());
    slide[s] = of.slide_m * soft[s] * slide_of(sliding, of.skin, sheet);
    const Energy e = energy_of(slide[s], sheet);
    energy.all += e.all;
    energy.deforming += e.deforming;
  }
  out.deforming = energy.all > 0.0 ? energy.deforming / energy.all : 1.0;
  std::vector<std::string> names;
  out.layout.segments = {{"parent", {}}, {"child", {}}};
  out.layout.joints = {{"joint", 0, 1}};
  for (std::size_t s = 0; s < 2; ++s)
    for (Eigen::Index m = 0; m < out.bone[s].cols(); ++m) {
      out.layout.segments[s].markers.push_back(static_cast<int>(names.size()));
      names.push_back((s == 0 ? "P" : "C") + std::to_string(m));
    }
  out.markers = data::Trajectories::all_missing(names, {.rate_hz = kRateHz, .t0_s = 0.0, .frames = F});
  const double keeps = std::pow(0.98, kStep_s / 0.01);
  MatrixXd coloured = MatrixXd::Zero(3, static_cast<Eigen::Index>(names.size()));
  for (Eigen::Index i = 0; i < F; ++i) {
    const Matrix3d R = math::exp_so3(sway.row(i).transpose());
    const std::array<Matrix3d, 2> pose = {R, R * rotation[at(i)]};
    Eigen::Index column = 0;
    for (std::size_t s = 0; s < 2; ++s)
      for (Eigen::Index m = 0; m < out.bone[s].cols(); ++m, ++column) {
        Vector3d x = at_world.row(i).transpose();
        x += pose[s] * (out.bone[s].col(m) + slide[s].block<1, 3>(i, 3 * m).transpose());
        x += of.noise_m * draw3(noise);
        if (of.skin == Skin::coloured) {
          coloured.col(column) =
              i == 0 ? draw3(noise)
                     : Vector3d(keeps * coloured.col(column) + std::sqrt(1.0 - keeps * keeps) * draw3(noise));
          x += of.slide_m * coloured.col(column);
        }
        out.markers.x(i, column) = x;
        out.markers.state[out.markers.index(i, column)] = data::SampleState::measured;
      }
  }
  return out;
}

Comparison compare(const data::Skeleton& skeleton, const Subject& subject) {
  const auto& segment = skeleton.segments[0];
  const auto& joint = skeleton.joints[0];
  Matrix3Xd bone(3, static_cast<Eigen::Index>(segment.markers.size()));
  for (std::size_t k = 0; k < segment.markers.size(); ++k)
    bone.col(static_cast<Eigen::Index>(k)) = subject.bone[0].col(segment.markers[k]);
  const auto fit = math::fit_rigid(bone, segment.x_in_segment).target_from_source;
  Comparison out;
  const Vector3d error = joint.centre_in_parent - fit * subject.centre[0];
  if (subject.axis.isZero()) {
    out.error = error;
    out.covariance = joint.covariance_in_parent;
    return out;
  }
  const Vector3d truth = fit.rotation * subject.axis;
  const Vector3d axis =
      joint.axis_in_parent.dot(truth) < 0.0 ? Vector3d(-joint.axis_in_parent) : joint.axis_in_parent;
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = truth.unitOrthogonal().transpose();
  across.row(1) = truth.cross(truth.unitOrthogonal()).transpose();
  const Eigen::Matrix<double, 2, 3> to =
      across * (Matrix3d::Identity() - axis * truth.transpose() / truth.dot(axis));
  out.tilt = across * axis;
  out.tilt_covariance = across * joint.axis_covariance_in_parent * across.transpose();
  // Where the axis passes the true centre: away from the place that is stated, the axis' direction adds its
  // share.
  const double away = truth.dot(error) / truth.dot(axis);
  out.error = to * error;
  out.covariance = to * joint.covariance_in_parent * to.transpose() + away * away * out.tilt_covariance;
  return out;
}

}  // namespace kinemark::skin_limbs
