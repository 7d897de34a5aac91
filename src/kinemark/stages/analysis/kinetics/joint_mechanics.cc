// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/internal/joint_mechanics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;
using Body = SegmentDefinition::Body;
using Joint = SegmentDefinition::Joint;

constexpr std::int64_t kGrain = 64;

Formula named(const std::string& name) {
  Formula out{.kind = Formula::Kind::name};
  out.name = name;
  return out;
}

Vector3d point(const StepValue& v) { return Eigen::Map<const Vector3d>(v.data()); }
MatrixX3d points_of(const FrameValues& values, std::size_t output) {
  MatrixX3d out(std::ssize(values), 3);
  for (std::int64_t f = 0; f < std::ssize(values); ++f) out.row(f) = point(values[at(f)][output]);
  return out;
}
std::vector<Matrix3d> axes_of(const FrameValues& values, std::size_t output) {
  std::vector<Matrix3d> out;
  out.reserve(values.size());
  for (const auto& frame : values) out.emplace_back(Eigen::Map<const Matrix3d>(frame[output].data()));
  return out;
}
// What is constant may be a formula of markers: the length of a shank.
double mean_of(const FrameValues& values, std::size_t output) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const auto& frame : values)
    if (std::isfinite(frame[output][0])) sum += frame[output][0], ++count;
  return count > 0 ? sum / static_cast<double>(count) : kNaN;
}

}  // namespace

LoadOutputs::LoadOutputs(const SegmentDefinition& d) {
  // Formulas first, as outputs point to them.
  for (const auto& b : d.bodies) frames_.push_back(named(b.segment));
  for (const auto& j : d.joints) frames_.push_back(named(j.child)), frames_.push_back(named(j.parent));
  for (std::size_t i = 0; i < d.bodies.size(); ++i) add_body(d.bodies[i], frames_[i]);
  for (std::size_t i = 0; i < d.joints.size(); ++i)
    add_joint(d.joints[i], frames_[d.bodies.size() + 2 * i], frames_[d.bodies.size() + 2 * i + 1]);
}

std::size_t LoadOutputs::add(const Formula& formula, StepType type, const std::string& what) {
  list.push_back({.formula = &formula, .type = type, .what = what});
  return list.size() - 1;
}

void LoadOutputs::add_body(const Body& b, const Formula& axes) {
  const std::string what = "body " + b.name;
  OfBody out{.mass = add(b.mass, StepType::number, what),
             .centre = add(b.centre, StepType::vector, what),
             .axes = add(axes, StepType::frame, what),
             .gyration = list.size(),
             .floor = 0};
  for (const auto& g : b.gyration) add(g, StepType::number, what);
  out.floor = list.size();
  for (const auto& p : b.floor) add(p, StepType::vector, what);
  bodies.push_back(out);
}

void LoadOutputs::add_joint(const Joint& j, const Formula& child, const Formula& parent) {
  const std::string what = "joint " + j.name;
  joints.push_back({.centre = add(j.centre, StepType::vector, what),
                    .child = add(child, StepType::frame, what),
                    .parent = add(parent, StepType::frame, what),
                    .per = add(j.per, StepType::number, what)});
}

JointMechanics::JointMechanics(const SegmentDefinition& d, const FormulaTracks& tracks,
                               const LoadOutputs& outputs, const JointLoadOptions& options)
    : d_(d), tracks_(tracks), outputs_(outputs), options_(options) {
  for (const auto& b : outputs.bodies) {
    bool some = true;
    for (std::size_t i = b.mass; i < b.floor; ++i) some = some && tracks.lacks(i).empty();
    body_.push_back(some);
  }
  for (std::size_t i = 0; i < d.bodies.size(); ++i) {
    bool some = body_[i] && !d.bodies[i].floor.empty();
    for (std::size_t k = 0; k < d.bodies[i].floor.size(); ++k)
      some = some && tracks.lacks(outputs.bodies[i].floor + k).empty();
    foot_.push_back(some);
  }
  for (std::size_t i = 0; i < d.joints.size(); ++i) {
    const auto& j = outputs.joints[i];
    bool some = true;
    for (std::size_t k = j.centre; k <= j.per; ++k) some = some && tracks.lacks(k).empty();
    for (const auto& name : d.joints[i].bodies) {
      const auto b = index_of_body(name);
      some = some && body_[b] && (d.bodies[b].floor.empty() || foot_[b]);
    }
    joint_.push_back(some);
  }
}

std::size_t JointMechanics::index_of_body(const std::string& name) const {
  return at(std::ranges::find(d_.bodies, name, &Body::name) - d_.bodies.begin());
}

FrameValues JointMechanics::values_of(const data::Trajectories& markers) const {
  FrameValues out(at(markers.frames()));
  parallel_for(markers.frames(), kGrain, options_.segments.threads,
               [&](std::int64_t begin, std::int64_t end) {
                 std::vector<StepValue> work;
                 for (auto f = begin; f < end; ++f) {
                   out[at(f)].resize(outputs_.list.size());
                   tracks_.evaluate(markers, f, work, out[at(f)]);
                 }
               });
  return out;
}

FootTrack JointMechanics::foot_of(std::size_t body, const FrameValues& values) const {
  FootTrack out{.name = d_.bodies[body].name, .points = {}};
  for (std::size_t k = 0; k < d_.bodies[body].floor.size(); ++k)
    out.points.push_back(points_of(values, outputs_.bodies[body].floor + k));
  return out;
}

Eigen::MatrixXd JointMechanics::loads_of(std::size_t joint, const FrameValues& values,
                                         const std::vector<const WrenchTrack*>& floor, double rate_hz) const {
  const auto& j = d_.joints[joint];
  const auto& at_joint = outputs_.joints[joint];
  const auto frames = std::ssize(values);
  WrenchTrack beyond = WrenchTrack::zero(frames);
  for (const auto& name : j.bodies) {
    const auto b = index_of_body(name);
    beyond += inertial_wrench(track_of(b, values), -options_.gravity * options_.segments.up, rate_hz,
                              d_.angular_span);
    if (floor[b] != nullptr) beyond += *floor[b];
  }
  const double per = mean_of(values, at_joint.per);
  const auto child = axes_of(values, at_joint.child), parent = axes_of(values, at_joint.parent);
  const MatrixX3d rate = angular_velocity(child, rate_hz) - angular_velocity(parent, rate_hz);
  Eigen::MatrixXd out(frames, 7);
  for (std::int64_t f = 0; f < frames; ++f) {
    const Vector3d centre = point(values[at(f)][at_joint.centre]);
    // What is beyond pushes the joint; the joint holds against it.
    const Vector3d force = -beyond.force.row(f).transpose() / per;
    const Vector3d moment = -beyond.moment_about(centre, f) / per;
    const Vector3d force_in_child = child[at(f)].transpose() * force;
    const Vector3d moment_in_child = child[at(f)].transpose() * moment;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      out(f, c) = j.force[k].sign * force_in_child[j.force[k].axis];
      out(f, 3 + c) = j.moment[k].sign * moment_in_child[j.moment[k].axis];
    }
    out(f, 6) = moment.dot(rate.row(f));
  }
  return out;
}

double JointMechanics::per(std::size_t joint, const FrameValues& values) const {
  return mean_of(values, outputs_.joints[joint].per);
}

BodyTrack JointMechanics::track_of(std::size_t body, const FrameValues& values) const {
  const auto& b = outputs_.bodies[body];
  BodyTrack out{.mass = mean_of(values, b.mass),
                .centre = points_of(values, b.centre),
                .axes = axes_of(values, b.axes)};
  for (std::size_t k = 0; k < 3; ++k)
    out.gyration[static_cast<Eigen::Index>(k)] = mean_of(values, b.gyration + k);
  return out;
}

}  // namespace kinemark::analysis::internal
