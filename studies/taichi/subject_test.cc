// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "studies/taichi/landmarks.h"
#include "studies/taichi/least_squares.h"
#include "support/test_data.h"

namespace kinemark::studies {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

data::ModelDescription human() {
  return io::read_osim(testing_support::project_folder() / "models/human.osim").value();
}

/// Landmarks of a model in its default pose, two frames.
data::Trajectories posed(const data::ModelDescription& description) {
  const auto model = model::Model::compile(description).value();
  data::JointMotion motion{.time = {.rate_hz = 60.0, .frames = 2}};
  for (const auto& coordinate : description.coordinates) motion.coordinates.push_back(coordinate.name);
  for (int f = 0; f < 2; ++f)
    for (const auto& coordinate : description.coordinates) motion.q.push_back(coordinate.default_value);
  return carried_landmarks(model, motion);
}

double total_mass(const data::ModelDescription& model) {
  double sum = 0.0;
  for (const auto& body : model.bodies) sum += body.mass;
  return sum;
}

const data::JointDescription& joint(const data::ModelDescription& model, std::string_view name) {
  return *std::ranges::find(model.joints, name, &data::JointDescription::name);
}

TEST(WithLandmarks, PutsJointCentresWhereTheJointsAre) {
  const auto model = with_landmarks(human()).value();
  EXPECT_TRUE(model.validate());
  ASSERT_EQ(model.markers.size(), kTaiChiLandmarks.size());
  const auto compiled = model::Model::compile(model).value();
  model::Workspace w(compiled);
  model::kinematics(compiled, w, compiled.default_state());
  for (const auto& attachment : landmark_attachments()) {
    if (attachment.joint.empty()) continue;
    const int child = compiled.body_of(joint(model, attachment.joint).child_body_idx);
    EXPECT_LT(
        (w.marker.col(model.find_marker(attachment.landmark)) - w.position[static_cast<std::size_t>(child)])
            .norm(),
        1e-12)
        << attachment.landmark;
  }
  EXPECT_GT(w.marker(1, model.find_marker("FHead")), w.marker(1, model.find_marker("Neck")));
  EXPECT_LT(w.marker(1, model.find_marker("LFoot")), 0.1);
  EXPECT_NEAR(total_mass(model), 75.0, 1e-9);
  EXPECT_NEAR(total_mass(*with_landmarks(human(), {.mass_kg = 60.0})), 60.0, 1e-9);
}

TEST(WithLandmarks, LocksWhatTheLandmarksDoNotMove) {
  const auto locked = with_landmarks(human(), {.lock_unseen = true}).value();
  int count = 0;
  for (const auto& coordinate : locked.coordinates) count += coordinate.locked;
  EXPECT_EQ(count, 4);
  // Rotating any of them moves no landmark; rotating any other moves some.
  const auto compiled = model::Model::compile(*with_landmarks(human())).value();
  model::Workspace w(compiled);
  Eigen::VectorXd q(compiled.coordinate_count());
  for (int c = 0; c < q.size(); ++c)
    q[c] = compiled.description().coordinates[static_cast<std::size_t>(c)].default_value;
  q += Eigen::VectorXd::Constant(q.size(), 0.3);
  model::kinematics(compiled, w, model::state_from_coordinates(compiled, q));
  const Eigen::Matrix3Xd before = w.marker;
  for (int c = 0; c < q.size(); ++c) {
    Eigen::VectorXd moved = q;
    moved[c] += 0.1;
    model::kinematics(compiled, w, model::state_from_coordinates(compiled, moved));
    const double most = (w.marker - before).colwise().norm().maxCoeff();
    // The forearm's axis passes the wrist at some millimetres, and the palm rotates with it.
    const bool unseen = locked.coordinates[static_cast<std::size_t>(c)].locked;
    if (unseen)
      EXPECT_LT(most, 0.01) << locked.coordinates[static_cast<std::size_t>(c)].name;
    else
      EXPECT_GT(most, 0.001) << locked.coordinates[static_cast<std::size_t>(c)].name;
  }
}

TEST(ScaleByMedians, FindsTheLengthsOfASubject) {
  auto subject = with_landmarks(human()).value();
  // A taller man with one short shank and a long upper arm.
  for (auto& joint : subject.joints)
    if (joint.parent_body_idx != data::kGround) joint.parent_from_joint.translation *= 1.08;
  const auto at = [&](std::string_view name) -> data::JointDescription& {
    return *std::ranges::find(subject.joints, name, &data::JointDescription::name);
  };
  at("ankle_l").parent_from_joint.translation *= 0.9;
  at("elbow_r").parent_from_joint.translation *= 1.1;
  for (const auto& attachment : landmark_attachments())
    if (!attachment.joint.empty())
      subject.markers[static_cast<std::size_t>(subject.find_marker(attachment.landmark))].x_in_body =
          at(attachment.joint).parent_from_joint.translation;
  const auto landmarks = posed(subject);
  const auto sized = scale_by_medians(human(), landmarks);
  ASSERT_TRUE(sized) << sized.error().message;
  for (const char* name : {"ankle_l", "ankle_r", "knee_l", "knee_r", "elbow_l", "elbow_r"})
    EXPECT_NEAR(joint(*sized, name).parent_from_joint.translation.norm(),
                joint(subject, name).parent_from_joint.translation.norm(), 1e-9)
        << name;
  // What it is sized for, it reproduces: distances that the medians were taken of.
  const auto again = posed(*sized);
  for (const auto& [a, b] : std::vector<std::pair<const char*, const char*>>{{"Pelvis", "RHip"},
                                                                             {"LHip", "RHip"},
                                                                             {"Pelvis", "Thorax"},
                                                                             {"Thorax", "Neck"},
                                                                             {"LShoulder", "RShoulder"},
                                                                             {"BHead", "Neck"},
                                                                             {"FHead", "BHead"},
                                                                             {"FHead", "Neck"},
                                                                             {"LElbow", "LWrist"},
                                                                             {"RWrist", "RHand"},
                                                                             {"LAnkle", "LFoot"}})
    EXPECT_NEAR(median_distance(again, a, b), median_distance(landmarks, a, b), 1e-9) << a << " " << b;
  EXPECT_NEAR(total_mass(*sized), 75.0, 1e-9);
  // A shank of 1.08 * 0.9 of the length: its mass centre moves along, its moments with the square.
  const auto generic = human();
  const auto tibia = static_cast<std::size_t>(generic.find_body("tibia_l"));
  EXPECT_NEAR(sized->bodies[tibia].com_in_body.norm() / generic.bodies[tibia].com_in_body.norm(), 0.972,
              1e-9);
  EXPECT_NEAR(sized->bodies[tibia].inertia_about_com(0, 0) / generic.bodies[tibia].inertia_about_com(0, 0),
              0.972 * 0.972, 1e-9);
}

TEST(ScaleByMedians, RefusesWhatItCannotSize) {
  auto landmarks = posed(*with_landmarks(human()));
  auto unseen = landmarks;
  for (std::int64_t f = 0; f < 2; ++f) unseen.set_missing(f, unseen.find("LKnee"));
  EXPECT_THAT(scale_by_medians(human(), unseen).error().message, HasSubstr("LHip and LKnee is not known"));
  auto renamed = landmarks;
  renamed.names[0] = "Nose";
  EXPECT_THAT(scale_by_medians(human(), renamed).error().message, HasSubstr("no landmark 'FHead'"));
  EXPECT_EQ(scale_by_medians(human(), landmarks, {.mass_kg = -1.0}).error().code, Code::usage);
  auto other = human();
  other.bodies[0].name = "hip";
  EXPECT_THAT(scale_by_medians(other, landmarks).error().message, HasSubstr("no body 'pelvis'"));
}

TEST(SimulateTaiChi, MakesARecordingThatTheStudyCanUse) {
  const auto one = simulate_tai_chi(human(), 1);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->landmarks.frames(), 1002);
  EXPECT_EQ(one->landmarks.count_missing(), 0);
  EXPECT_EQ(one->truth.frames(), 1002);
  EXPECT_TRUE(std::ranges::equal(one->landmarks.names, kTaiChiLandmarks));
  // Slow and wide, upright, of human size.
  EXPECT_NEAR(median_distance(one->landmarks, "LHip", "LKnee"), 0.43, 0.06);
  double fastest = 0.0;
  const auto wrist = one->landmarks.find("RWrist");
  Vector3d low = one->landmarks.x(0, wrist), high = low;
  for (std::int64_t f = 1; f < 1002; ++f) {
    const Vector3d x = one->landmarks.x(f, wrist);
    fastest = std::max(fastest, 60.0 * (x - one->landmarks.x(f - 1, wrist)).norm());
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  EXPECT_LT(fastest, 3.0);
  EXPECT_GT((high - low).norm(), 0.3);
  const auto two = simulate_tai_chi(human(), 2).value();
  EXPECT_GT(std::abs(median_distance(one->landmarks, "LHip", "LKnee") -
                     median_distance(two.landmarks, "LHip", "LKnee")),
            1e-4)
      << "another seed is another subject";
  EXPECT_EQ(simulate_tai_chi(human(), 1)->landmarks.x_in_world, one->landmarks.x_in_world);
}

}  // namespace
}  // namespace kinemark::studies
