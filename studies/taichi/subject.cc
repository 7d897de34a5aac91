// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/subject.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/subject.h"
#include "studies/taichi/landmarks.h"

namespace kinemark::studies {
namespace {

using data::ModelDescription;
using data::Trajectories;
using Eigen::Vector3d;

// Positions of landmarks that are not joint centres, in the human model as it is, m.
const Vector3d kPelvisPoint(-0.120, 0.010, 0.0);  // on the sacrum: the hips lie 60 mm ahead, 87 mm below
const Vector3d kHeadFront(0.095, 0.200, 0.0), kHeadBack(-0.065, 0.200, 0.0);
const Vector3d kHand(0.0, -0.090, 0.0), kFoot(0.227, 0.002, 0.0);
// From the pelvis landmark to the middle of the hips, x forward and y up.
const Vector3d kHipDirection = Vector3d(0.56, -0.83, 0.0).normalized();
constexpr double kClavicleForward_m = 0.020, kClavicleAside_m = 0.030;

/// The description with its joints by name; every position is set through here.
class Body {
 public:
  explicit Body(ModelDescription& model) : model_(model) {}

  Result<std::size_t> joint(std::string_view name) const {
    const auto at = std::ranges::find(model_.joints, name, &data::JointDescription::name);
    if (at == model_.joints.end())
      return fail(Code::not_supported,
                  fmt::format("the model has no joint '{}'; kinemark's human was expected", name));
    return static_cast<std::size_t>(at - model_.joints.begin());
  }
  /// Position of a joint in its parent, m. with_landmarks() has checked that the joint exists.
  Vector3d& position(std::string_view name) {
    return model_.joints[*joint(name)].parent_from_joint.translation;
  }
  void stretch(std::string_view name, double length_m) { position(name) *= length_m / position(name).norm(); }
  void mark(std::string_view landmark, const Vector3d& x_in_body) {
    model_.markers[static_cast<std::size_t>(model_.find_marker(landmark))].x_in_body = x_in_body;
  }

 private:
  ModelDescription& model_;
};

/// Mass centres and moments follow the distance of the first far joint that hangs on each body.
void scale_masses(const ModelDescription& before, ModelDescription& after, double mass_kg) {
  constexpr double kFar_m = 0.05;
  double total = 0.0;
  for (const auto& body : after.bodies) total += body.mass;
  for (std::size_t b = 0; b < after.bodies.size(); ++b) {
    double ratio = 1.0;
    for (std::size_t j = 0; j < before.joints.size(); ++j) {
      const auto& joint = before.joints[j];
      const double length = joint.parent_from_joint.translation.norm();
      if (joint.parent_body_idx != static_cast<int>(b) || length < kFar_m) continue;
      ratio = after.joints[j].parent_from_joint.translation.norm() / length;
      break;
    }
    auto& body = after.bodies[b];
    body.mass *= mass_kg / total;
    body.com_in_body *= ratio;
    body.inertia_about_com *= ratio * ratio * mass_kg / total;
  }
}

/// How far up the trunk (from Thorax towards Neck) the middle of the shoulders lies on average, m.
double shoulder_height(const Trajectories& landmarks) {
  const auto thorax = landmarks.find("Thorax"), neck = landmarks.find("Neck");
  const auto left = landmarks.find("LShoulder"), right = landmarks.find("RShoulder");
  double sum = 0.0, count = 0.0;
  for (std::int64_t f = 0; f < landmarks.frames(); ++f) {
    if (!landmarks.present(f, thorax) || !landmarks.present(f, neck) || !landmarks.present(f, left) ||
        !landmarks.present(f, right))
      continue;
    const Vector3d up = (landmarks.x(f, neck) - landmarks.x(f, thorax)).normalized();
    sum += (0.5 * (landmarks.x(f, left) + landmarks.x(f, right)) - landmarks.x(f, thorax)).dot(up);
    count += 1.0;
  }
  return sum / count;
}

/// Distances that must be known; missing ones are reported by name.
class Medians {
 public:
  explicit Medians(const Trajectories& landmarks) : landmarks_(landmarks) {}

  double operator()(const std::string& a, const std::string& b) {
    const double distance = median_distance(landmarks_, a, b);
    if (!(distance > 1e-3) && unknown_.empty()) unknown_ = a + " and " + b;
    return distance;
  }
  [[nodiscard]] Status status() const {
    if (unknown_.empty()) return {};
    return fail(Code::bad_input, fmt::format("the distance of {} is not known; they are never seen together "
                                             "or lie on each other",
                                             unknown_));
  }

 private:
  const Trajectories& landmarks_;
  std::string unknown_;
};

void scale_trunk(Body& body, Medians& median, double size, double shoulder_height_m) {
  const double half_width = 0.5 * median("LHip", "RHip");
  const double reach = median("Pelvis", "RHip");
  const double depth = std::sqrt(std::max(0.0, reach * reach - half_width * half_width));
  // The generic pelvis, sized; the landmark's position follows from the hips.
  const Vector3d hip = size * Vector3d(body.position("hip_r").x(), body.position("hip_r").y(), 0.0);
  body.position("hip_r") = hip + Vector3d(0.0, 0.0, half_width);
  body.position("hip_l") = hip - Vector3d(0.0, 0.0, half_width);
  const Vector3d pelvis = hip - depth * kHipDirection;
  body.mark("Pelvis", pelvis);
  // The trunk bends half way between pelvis and thorax.
  const double rise = median("Pelvis", "Thorax");
  body.position("back") = pelvis + Vector3d(0.0, 0.5 * rise, 0.0);
  body.position("diaphragm") = Vector3d(0.0, 0.5 * rise, 0.0);
  const double trunk = median("Thorax", "Neck");
  body.mark("Thorax", Vector3d::Zero());
  body.position("neck") = Vector3d(0.0, trunk, 0.0);
  const double aside = 0.5 * median("LShoulder", "RShoulder");
  for (const double sign : {1.0, -1.0}) {
    const std::string side = sign > 0.0 ? "_r" : "_l";
    body.position("sternoclavicular" + side) =
        Vector3d(kClavicleForward_m, shoulder_height_m, sign * kClavicleAside_m);
    body.position("acromial" + side) = Vector3d(-kClavicleForward_m, 0.0, sign * (aside - kClavicleAside_m));
  }
  // The head's two points lie on a line along x; the nearer one by its distances to neck and front.
  const double back_of_head = median("BHead", "Neck"), deep = median("FHead", "BHead");
  const double front_of_head = median("FHead", "Neck");
  const double x = (front_of_head * front_of_head - back_of_head * back_of_head - deep * deep) / (2.0 * deep);
  const double y = std::sqrt(std::max(0.0, back_of_head * back_of_head - x * x));
  body.mark("BHead", Vector3d(x, y, 0.0));
  body.mark("FHead", Vector3d(x + deep, y, 0.0));
}

void scale_limbs(Body& body, Medians& median) {
  for (const std::string s : {"R", "L"}) {
    const std::string side = s == "R" ? "_r" : "_l";
    body.stretch("elbow" + side, median(s + "Shoulder", s + "Elbow"));
    // The forearm's two bones keep their proportion.
    const double forearm = median(s + "Elbow", s + "Wrist") /
                           (body.position("radioulnar" + side) + body.position("radius_hand" + side)).norm();
    body.position("radioulnar" + side) *= forearm;
    body.position("radius_hand" + side) *= forearm;
    body.mark(s + "Hand", Vector3d(0.0, -median(s + "Wrist", s + "Hand"), 0.0));
    body.stretch("knee" + side, median(s + "Hip", s + "Knee"));
    body.stretch("ankle" + side, median(s + "Knee", s + "Ankle"));
    const Vector3d heel = body.position("subtalar" + side);
    const Vector3d foot = heel + kFoot;
    body.mark(s + "Foot", foot * (median(s + "Ankle", s + "Foot") / foot.norm()) - heel);
  }
}

/// Landmarks that are joint centres, where their joints now are.
void settle_centres(ModelDescription& model) {
  Body body(model);
  for (const auto& attachment : landmark_attachments())
    if (!attachment.joint.empty()) body.mark(attachment.landmark, body.position(attachment.joint));
}

}  // namespace

std::vector<std::string> unseen_coordinates() {
  return {"pro_sup_r", "pro_sup_l", "mtp_angle_r", "mtp_angle_l"};
}

Result<ModelDescription> with_landmarks(const ModelDescription& human, const TaiChiModelOptions& options) {
  if (!(options.mass_kg > 0.0) || !std::isfinite(options.mass_kg))
    return fail(Code::usage, fmt::format("a body mass of {} kg; need a positive number", options.mass_kg));
  ModelDescription model = human;
  model.name += "_tai_chi";
  model.markers.clear();
  Body body(model);
  for (const auto& attachment : landmark_attachments()) {
    const int b = model.find_body(attachment.body);
    if (b < 0)
      return fail(Code::not_supported,
                  fmt::format("the model has no body '{}'; kinemark's human was expected", attachment.body));
    if (!attachment.joint.empty())
      if (const auto joint = body.joint(attachment.joint); !joint) return std::unexpected(joint.error());
    model.markers.push_back({.name = attachment.landmark, .body_idx = b, .x_in_body = Vector3d::Zero()});
  }
  for (const char* name : {"back", "diaphragm", "sternoclavicular_r", "sternoclavicular_l", "radioulnar_r",
                           "radioulnar_l", "subtalar_r", "subtalar_l"})
    if (const auto joint = body.joint(name); !joint) return std::unexpected(joint.error());
  body.mark("Pelvis", kPelvisPoint);
  body.mark("FHead", kHeadFront);
  body.mark("BHead", kHeadBack);
  for (const char* side : {"R", "L"}) {
    body.mark(std::string(side) + "Hand", kHand);
    body.mark(std::string(side) + "Foot", kFoot);
  }
  settle_centres(model);
  if (options.lock_unseen)
    for (const auto& name : unseen_coordinates()) {
      const int c = model.find_coordinate(name);
      if (c < 0) return fail(Code::not_supported, fmt::format("the model has no coordinate '{}'", name));
      model.coordinates[static_cast<std::size_t>(c)].locked = true;
    }
  scale_masses(model, model, options.mass_kg);
  return model;
}

Result<ModelDescription> scale_by_medians(const ModelDescription& human, const Trajectories& landmarks,
                                          const TaiChiModelOptions& options) {
  for (const auto name : kTaiChiLandmarks)
    if (landmarks.find(name) < 0)
      return fail(Code::bad_input, fmt::format("the recording has no landmark '{}'", name));
  auto generic = with_landmarks(human, options);
  if (!generic) return std::unexpected(generic.error());
  ModelDescription model = *generic;
  Body body(model);
  Medians median(landmarks);
  const auto leg = [&](const std::string& s) {
    return median(s + "Hip", s + "Knee") + median(s + "Knee", s + "Ankle");
  };
  const double size =
      0.5 * (leg("R") + leg("L")) / (body.position("knee_r").norm() + body.position("ankle_r").norm());
  scale_trunk(body, median, size, shoulder_height(landmarks));
  scale_limbs(body, median);
  settle_centres(model);
  if (auto status = median.status(); !status) return std::unexpected(status.error());
  scale_masses(*generic, model, options.mass_kg);
  if (auto status = model.validate(); !status) return std::unexpected(status.error());
  return model;
}

Result<SimulatedTaiChi> simulate_tai_chi(const ModelDescription& human, std::uint64_t seed) {
  constexpr double kScatter = 0.04;
  constexpr double kDuration_s = 16.7, kRate_hz = 60.0;
  constexpr std::uint64_t kStream = 700;
  auto described = with_landmarks(human, {});
  if (!described) return std::unexpected(described.error());
  Random random(seed, kStream);
  for (auto& joint : described->joints)
    if (joint.parent_body_idx != data::kGround)
      joint.parent_from_joint.translation *= 1.0 + kScatter * random.gaussian();
  settle_centres(*described);
  auto model = model::Model::compile(std::move(*described));
  if (!model) return std::unexpected(model.error());
  auto subject = simulation::simulate_subject(*model, {.motion = simulation::MotionKind::tai_chi,
                                                       .duration_s = kDuration_s,
                                                       .rate_hz = kRate_hz,
                                                       .seed = seed,
                                                       .noise_sd_m = 0.001,
                                                       .soft_tissue = 0.5});
  if (!subject) return std::unexpected(subject.error());
  return SimulatedTaiChi{.landmarks = std::move(subject->markers), .truth = std::move(subject->truth)};
}

}  // namespace kinemark::studies
