// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "kinemark/io/osim/osim_model.h"
#include "support/test_data.h"

namespace kinemark::studies {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

/// Two seconds at 179 Hz of 21 points that stand above each other along z and sway, in reversed order.
data::Trajectories standing() {
  std::vector<std::string> names(kTaiChiLandmarks.rbegin(), kTaiChiLandmarks.rend());
  auto out =
      data::Trajectories::all_missing(std::move(names), {.rate_hz = 179.0, .t0_s = 0.5, .frames = 359});
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const double t = out.time.time_s(f);
      out.x(f, m) = Vector3d(0.1 * std::sin(3.0 * t), 0.2 * std::cos(2.0 * t), 0.08 * static_cast<double>(m));
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(PrepareLandmarks, BringsThemUprightInOrderAndTo60Hz) {
  const auto recorded = standing();
  const auto out = prepare_landmarks(recorded);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_TRUE(out->validate()) << out->validate().error().message;
  EXPECT_EQ(out->time, (TimeBase{60.0, 0.5, 121}));
  EXPECT_EQ(out->names.front(), "FHead");
  EXPECT_EQ(out->made_by(10, 0), "cubic spline through the frames");
  for (const std::int64_t f : {0, 7, 60, 120}) {
    const double t = out->time.time_s(f);
    const Vector3d expected(0.1 * std::sin(3.0 * t), 0.08 * 20.0, -0.2 * std::cos(2.0 * t));
    // Natural ends cost a little in the first and last steps.
    EXPECT_LT((out->x(f, 0) - expected).norm(), f == 7 || f == 60 ? 1e-8 : 1e-5) << f;
  }
}

TEST(PrepareLandmarks, LeavesARecordingWithYUpAsItIs) {
  auto recorded = standing();
  for (std::int64_t f = 0; f < recorded.frames(); ++f)
    for (std::int64_t m = 0; m < recorded.markers(); ++m) {
      const Vector3d x = recorded.x(f, m);
      recorded.x(f, m) = Vector3d(x.x(), x.z(), -x.y());
    }
  const auto rotated = prepare_landmarks(standing()).value();
  EXPECT_EQ(prepare_landmarks(recorded)->x_in_world, rotated.x_in_world);
}

TEST(PrepareLandmarks, GapsStayGaps) {
  auto recorded = standing();
  for (std::int64_t f = 100; f < 140; ++f) recorded.set_missing(f, 3);
  recorded.set_missing(0, 4);
  const auto out = prepare_landmarks(recorded).value();
  const auto gap = out.find(recorded.names[3]), late = out.find(recorded.names[4]);
  EXPECT_FALSE(out.present(0, late));
  EXPECT_TRUE(out.present(1, late));
  EXPECT_FALSE(out.made_by(0, late) == "cubic spline through the frames");
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const double at = (out.time.time_s(f) - 0.5) * 179.0;
    EXPECT_EQ(out.present(f, gap), at <= 99.0 || at >= 140.0) << f;
    EXPECT_EQ(out.made_by(f, gap) == "cubic spline through the frames", out.present(f, gap)) << f;
  }
  EXPECT_TRUE(out.validate());
}

TEST(PrepareLandmarks, RefusesWhatIsNotThisRecording) {
  auto recorded = standing();
  recorded.names[0] = "Toe";
  EXPECT_THAT(prepare_landmarks(recorded).error().message, HasSubstr("the recording lacks RFoot; the 21"));
  auto lying = standing();
  for (std::int64_t f = 0; f < lying.frames(); ++f)
    for (std::int64_t m = 0; m < lying.markers(); ++m) lying.x(f, m) = lying.x(f, m).reverse().eval();
  EXPECT_THAT(prepare_landmarks(lying).error().message, HasSubstr("expected it above them along y or z"));
  auto headless = standing();
  for (std::int64_t f = 0; f < headless.frames(); ++f) headless.set_missing(f, headless.find("FHead"));
  EXPECT_THAT(prepare_landmarks(headless).error().message, HasSubstr("head or ankles are never seen"));
  auto single = standing();
  single.time.frames = 1;
  EXPECT_THAT(prepare_landmarks(single).error().message, HasSubstr("fewer than two frames"));
}

TEST(PrepareLandmarks, RefusesARateThatMakesADayOfASecond) {
  auto slow = standing();
  slow.time.rate_hz = 1e-9;
  EXPECT_THAT(prepare_landmarks(slow).error().message,
              HasSubstr("frames, and the study takes 1000000 at most"));
  for (const double rate :
       {0.0, -60.0, 1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THAT(prepare_landmarks(standing(), rate).error().message, HasSubstr("at most")) << rate;
}

TEST(MedianDistance, IsRobustAndSaysWhenThereIsNone) {
  auto recorded = standing();
  recorded.x(5, 1) = Vector3d(100.0, 0.0, 0.0);
  EXPECT_NEAR(median_distance(recorded, "RFoot", "LFoot"), 0.08, 1e-12);
  for (std::int64_t f = 0; f < recorded.frames(); ++f) recorded.set_missing(f, f % 2);
  EXPECT_TRUE(std::isnan(median_distance(recorded, "RFoot", "LFoot")));
}

TEST(LandmarkAttachments, AreInTheHumanModel) {
  const auto human = io::read_osim(testing_support::project_folder() / "models/human.osim").value();
  const auto attachments = landmark_attachments();
  ASSERT_EQ(attachments.size(), kTaiChiLandmarks.size());
  std::set<std::string> joints;
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    EXPECT_EQ(attachments[i].landmark, kTaiChiLandmarks[i]);
    const int body = human.find_body(attachments[i].body);
    EXPECT_GE(body, 0) << attachments[i].body;
    if (attachments[i].joint.empty()) continue;
    EXPECT_TRUE(joints.insert(attachments[i].joint).second) << attachments[i].joint;
    const auto joint = std::ranges::find(human.joints, attachments[i].joint, &data::JointDescription::name);
    ASSERT_NE(joint, human.joints.end()) << attachments[i].joint;
    EXPECT_EQ(joint->parent_body_idx, body) << "a joint centre is fixed in the parent";
  }
  EXPECT_EQ(joints.size(), 13U);
}

}  // namespace
}  // namespace kinemark::studies
