// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/standing_body.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/io/osim/osim_model.h"
#include "support/test_data.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

data::ModelDescription own_model() {
  return io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
}

Vector3d mirrored(const Vector3d& x) { return {x.x(), x.y(), -x.z()}; }

/// Where a marker stands, from the first segment's joint.
Vector3d standing(const StandingBody& body, const std::string& name) {
  const auto m = std::ranges::find(body.markers, name, &StandingBody::Marker::name);
  EXPECT_NE(m, body.markers.end()) << name;
  if (m == body.markers.end()) return Vector3d::Zero();
  Vector3d x = m->x_in_segment;
  for (int s = m->segment; s >= 0; s = body.segments[at(s)].parent) x += body.segments[at(s)].joint_in_parent;
  return x;
}

TEST(StandingBody, NamesBringTheSegmentsThatTheyNeed) {
  const auto body = body_of_names({"LASI", "RASI", "LTOE", "RTOE", "LFEO", "*3"});
  EXPECT_EQ(body.markers.size(), 4);
  EXPECT_EQ(body.segments.size(), 7);  // pelvis, and thigh, shank and foot twice
  for (std::size_t s = 0; s < body.segments.size(); ++s)
    EXPECT_LT(body.segments[s].parent, static_cast<int>(s));
}

TEST(StandingBody, OfSeveralPeopleIsThatOfOne) {
  const auto body = body_of_names({"Bob:LASI", "Ann:LASI", "Ann:RASI", "Bob:RASI", "Ann:LTOE", "LFEO"});
  std::vector<std::string> names;
  for (const auto& marker : body.markers) names.push_back(marker.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Ann:LASI", "Ann:RASI", "Ann:LTOE"}));
  EXPECT_EQ(body_of_names({"Ann:LASI", "RASI", "Wand:LTOE"}).markers.size(), 3) << "nothing is there twice";
}

TEST(StandingBody, SidesMirrorEachOther) {
  const auto body = body_of_names({"LASI", "RASI", "LKNE", "RKNE", "LTOE", "RTOE", "C7"});
  for (const auto& marker : body.markers) {
    if (marker.name == "C7") {
      EXPECT_EQ(marker.mirror, -1);
      continue;
    }
    ASSERT_GE(marker.mirror, 0) << marker.name;
    const auto& other = body.markers[at(marker.mirror)];
    EXPECT_EQ(other.name.substr(1), marker.name.substr(1));
    EXPECT_LT((standing(body, other.name) - mirrored(standing(body, marker.name))).norm(), 1e-12);
  }
  for (std::size_t s = 0; s < body.sizes.size(); ++s) {
    if (body.sizes[s].mirror < 0) continue;
    EXPECT_EQ(body.sizes[at(body.sizes[s].mirror)].mirror, static_cast<int>(s));
  }
}

TEST(StandingBody, AModelStandsAsItsNamesSay) {
  const auto model = body_of_model(own_model());
  ASSERT_TRUE(model) << model.error().message;
  std::vector<std::string> names;
  for (const auto& marker : model->markers) names.push_back(marker.name);
  const auto body = body_of_names(names);
  const Vector3d a = standing(*model, "LASI"), b = standing(body, "LASI");
  for (const auto& marker : body.markers) {
    // Laboratories differ; arms of the model hang with the palms forward, as the landmarks have them.
    const Vector3d apart = (standing(*model, marker.name) - a) - (standing(body, marker.name) - b);
    EXPECT_LT(apart.norm(), 0.08) << marker.name;
  }
}

TEST(StandingBody, AModelsMarkersPairAcrossSides) {
  const auto body = body_of_model(own_model()).value();
  int paired = 0;
  for (const auto& marker : body.markers) {
    if (marker.mirror < 0) continue;
    ++paired;
    const auto& other = body.markers[at(marker.mirror)];
    EXPECT_LT((standing(body, other.name) - mirrored(standing(body, marker.name))).norm(), 0.02)
        << marker.name;
  }
  EXPECT_EQ(paired, 36);  // all but C7, T10, CLAV, STRN
}

TEST(StandingBody, ArmsHangFromShouldersThatMoveOnTheTrunk) {
  for (const auto& body :
       {body_of_names({"C7", "CLAV", "LSHO", "RSHO", "LELB", "RELB"}), body_of_model(own_model()).value()}) {
    const auto acromion = std::ranges::find(body.markers, "LSHO", &StandingBody::Marker::name);
    ASSERT_NE(acromion, body.markers.end());
    const auto& shoulder = body.segments[at(acromion->segment)];
    EXPECT_EQ(shoulder.name, "left shoulder");
    EXPECT_EQ(body.segments[at(shoulder.parent)].side, Side::middle);
    EXPECT_EQ(body.segments[at(shoulder.mirror)].name, "right shoulder");
    const auto elbow = std::ranges::find(body.markers, "LELB", &StandingBody::Marker::name);
    EXPECT_EQ(body.segments[at(elbow->segment)].parent, acromion->segment);
    EXPECT_GT(shoulder.joint_by_posture, 0.0);
    const auto neck = std::ranges::find(body.markers, "C7", &StandingBody::Marker::name);
    EXPECT_GT(body.segments[at(neck->segment)].joint_by_posture, 0.01) << "spines bend";
  }
}

TEST(StandingBody, AcromiaMoveOnTheTrunkOfAModelWithoutArms) {
  auto model = own_model();
  for (const auto& joint : model.joints)
    if (model.bodies[at(joint.child_body_idx)].name.starts_with("humerus"))
      for (const auto& axis : joint.axes)
        if (axis.coordinate_idx >= 0) model.coordinates[at(axis.coordinate_idx)].locked = true;
  const auto body = body_of_model(model).value(), whole = body_of_model(own_model()).value();
  for (const auto& segment : body.segments) EXPECT_FALSE(segment.name.starts_with("humerus"));
  for (const auto* const name : {"LSHO", "RSHO"}) {
    const auto acromion = std::ranges::find(body.markers, name, &StandingBody::Marker::name);
    ASSERT_NE(acromion, body.markers.end());
    EXPECT_TRUE(body.segments[at(acromion->segment)].name.ends_with(" shoulder"));
    EXPECT_LT((standing(body, name) - standing(whole, name)).norm(), 1e-9) << "where the model has it";
  }
}

TEST(StandingBody, BodiesThatDoNotTurnBelongToTheirCarrier) {
  const auto body = body_of_model(own_model()).value();
  for (const auto& segment : body.segments) {
    EXPECT_NE(segment.name, "thorax");
    EXPECT_NE(segment.name, "clavicle_r");
  }
}

}  // namespace
}  // namespace kinemark::motion
