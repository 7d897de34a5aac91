// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

class PlateEventsTest : public ::testing::Test {
 protected:
  PlateEventsTest()
      : markers_(walk_.markers(0.0003, 3)),
        smoother_(GaitSmoother::create(markers_, find_gait_markers(markers_).value(), 0.0).value()) {
    plates_.time = markers_.time;
  }
  PlateEvents find() const { return find_plate_events(plates_, smoother_.paths(), smoother_.upright()); }
  // With these corners of the first plate.
  PlateEvents find(const std::vector<Eigen::Vector3d>& corners) {
    plates_.items[0].corners_in_world = corners;
    return find();
  }
  // A square around a place.
  static std::vector<Eigen::Vector3d> square(const Eigen::Vector3d& at, double half) {
    return {Eigen::Vector3d(at + Eigen::Vector3d(half, half, 0)),
            Eigen::Vector3d(at + Eigen::Vector3d(-half, half, 0)),
            Eigen::Vector3d(at + Eigen::Vector3d(-half, -half, 0)),
            Eigen::Vector3d(at + Eigen::Vector3d(half, -half, 0))};
  }

  KnownWalk walk_;
  data::Trajectories markers_;
  GaitSmoother smoother_;
  data::Wrenches plates_;
};

TEST_F(PlateEventsTest, AreThoseOfTheFootThatStandsThere) {
  plates_.items = {walk_.plate("plate 1", Side::left, 2), walk_.plate("plate 2", Side::right, 1)};
  const auto found = find();
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("s, tells of no event: "))));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("the force does not stay under one foot"))));
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("the foot was not wholly on the plate"))));
  ASSERT_EQ(found.events.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& event = found.events[i];
    EXPECT_EQ(event.side, i < 2 ? Side::left : Side::right);
    EXPECT_EQ(event.what, i % 2 == 0 ? FootEvent::strike : FootEvent::off);
    const auto step = i < 2 ? 2 : 1;
    const double truth = i % 2 == 0 ? walk_.strike_s(event.side, step) : walk_.off_s(event.side, step);
    EXPECT_NEAR(event.time_s, truth, 0.006);
    EXPECT_NEAR(event.sd_s, 0.003, 0.001);
    EXPECT_EQ(event.source, data::EventSource::plate);
  }
}

TEST_F(PlateEventsTest, ContactsThatTheRecordingCutsAreNone) {
  plates_.items = {walk_.plate("plate 1", Side::left, 0)};  // begins before the first frame
  EXPECT_TRUE(find().events.empty());
}

TEST_F(PlateEventsTest, TwoFeetOnOnePlateTellNothing) {
  auto both = walk_.plate("plate 1", Side::left, 2);
  const auto other = walk_.plate("", Side::right, 2);
  for (std::size_t i = 2; i < both.force.size(); i += 3) {
    const double a = both.force[i], b = other.force[i];
    for (std::size_t axis = 0; axis < 3 && a + b > 0.0; ++axis)
      both.point[i - 2 + axis] = (a * both.point[i - 2 + axis] + b * other.point[i - 2 + axis]) / (a + b);
    both.force[i] = a + b;
  }
  plates_.items = {both};
  const auto found = find();
  EXPECT_TRUE(found.events.empty());
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("tells of no event: the force does not stay under one foot"),
            std::string::npos);
}

TEST_F(PlateEventsTest, AFootAcrossTheEdgeTellsNothing) {
  plates_.items = {walk_.plate("plate 1", Side::left, 2)};
  const auto foot = walk_.foot_at(Side::left, walk_.strike_s(Side::left, 2) + 0.25);
  const Eigen::Vector3d middle = 0.5 * (foot[0] + foot[1]);
  EXPECT_EQ(find(square(middle, 0.3)).events.size(), 2u);
  const auto across = find(square(foot[0], 0.1));
  EXPECT_TRUE(across.events.empty());
  ASSERT_EQ(across.notes.size(), 1u);
  EXPECT_NE(across.notes[0].find("not wholly on the plate"), std::string::npos);
  // A plate beside it, of which another would be the first, changes nothing.
  plates_.items.insert(plates_.items.begin(), walk_.plate("plate 0", Side::right, 1));
  EXPECT_EQ(find_plate_events(plates_, smoother_.paths(), smoother_.upright()).notes, across.notes);
}

TEST_F(PlateEventsTest, ADriftingPlateStillTells) {
  plates_.items = {walk_.plate("plate 1", Side::left, 2)};
  const auto before = find();
  for (std::size_t i = 2; i < plates_.items[0].force.size(); i += 3) plates_.items[0].force[i] += 12.0;
  const auto drifted = find();
  ASSERT_EQ(drifted.events.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(drifted.events[i].time_s, before.events[i].time_s, 1e-9);
}

}  // namespace
}  // namespace kinemark::analysis
