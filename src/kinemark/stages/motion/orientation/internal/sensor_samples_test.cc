// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_samples.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/sensors.h"

namespace kinemark::motion::internal {
namespace {

using ::testing::IsEmpty;
using testing_body::session;

constexpr double kDegree = std::numbers::pi / 180.0;

Eigen::Matrix3d random_turn(Random& random, double angle_rad) {
  const Eigen::Vector3d axis(random.gaussian(), random.gaussian(), random.gaussian());
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

void put(data::Orientations& o, std::int64_t f, std::int64_t s, const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  double* to = o.quaternion.data() + 4 * (f * o.size() + s);
  to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
}

/// Turn a sensor in its own axes from a frame on.
void turn(data::Orientations& o, std::int64_t sensor, std::int64_t first, std::int64_t count,
          const Eigen::Matrix3d& by) {
  for (auto f = first; f < first + count; ++f) put(o, f, sensor, o.rotation(f, sensor) * by);
}

std::vector<std::pair<std::int64_t, std::int64_t>> spans_of(const data::Orientations& o,
                                                            std::int64_t sensor) {
  std::vector<std::pair<std::int64_t, std::int64_t>> out;
  for (const auto& span : find_turned_spans(o))
    if (span.sensor == sensor) out.emplace_back(span.first, span.last);
  return out;
}

using Spans = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(SensorSamples, FindsSpansOfOneToTenFramesAndNothingElse) {
  Random random(11, 3);
  for (std::int64_t count = 1; count <= kMostWrong; ++count)
    for (const double angle : {30.0, 60.0, 120.0, 180.0}) {
      auto o = session(0.4, 1.0 * kDegree, static_cast<std::uint64_t>(count)).recording;
      const auto first = 20 + 13 * count;
      turn(o, 2, first, count, random_turn(random, angle * kDegree));
      const auto found = find_turned_spans(o);
      ASSERT_EQ(found.size(), 1U) << count << " samples turned by " << angle;
      EXPECT_EQ(found[0].sensor, 2);
      EXPECT_EQ(found[0].first, first);
      EXPECT_EQ(found[0].last, first + count - 1);
      EXPECT_NEAR(found[0].angle_rad, angle * kDegree, 0.35);
    }
}

TEST(SensorSamples, FindsSamplesTurnedEachInItsOwnWay) {
  Random random(12, 3);
  auto o = session(0.4, 1.0 * kDegree, 7).recording;
  for (std::int64_t f = 60; f < 66; ++f)
    turn(o, 1, f, 1, random_turn(random, (50.0 + 10.0 * static_cast<double>(f - 60)) * kDegree));
  EXPECT_EQ(spans_of(o, 1), (Spans{{60, 65}}));
}

TEST(SensorSamples, GoodRecordingsAccuseNone) {
  for (const double noise_deg : {0.0, 1.0, 3.0})
    for (std::uint64_t seed = 1; seed < 8; ++seed)
      EXPECT_THAT(find_turned_spans(session(1.0, noise_deg * kDegree, seed, 300).recording), IsEmpty())
          << noise_deg << " deg, seed " << seed;
}

TEST(SensorSamples, AChangeOfSignIsNone) {
  auto o = session(0.4, 0.0, 3).recording;
  for (std::int64_t f = 40; f < 47; ++f)
    for (std::size_t k = 0; k < 4; ++k) o.quaternion[4 * static_cast<std::size_t>(f * o.size()) + k] *= -1.0;
  EXPECT_THAT(find_turned_spans(o), IsEmpty());
}

TEST(SensorSamples, ASensorThatStaysTurnedIsNotAccused) {
  Random random(13, 3);
  auto o = session(0.4, 1.0 * kDegree, 3).recording;
  turn(o, 0, 90, o.frames() - 90, random_turn(random, 50.0 * kDegree));
  EXPECT_THAT(find_turned_spans(o), IsEmpty());
  auto long_one = session(0.4, 1.0 * kDegree, 3).recording;
  turn(long_one, 0, 90, 2 * kMostWrong, random_turn(random, 50.0 * kDegree));
  EXPECT_THAT(find_turned_spans(long_one), IsEmpty());
}

TEST(SensorSamples, AtTheEndsTheShorterSideIsWrong) {
  Random random(14, 3);
  auto o = session(0.4, 1.0 * kDegree, 5).recording;
  const auto by = random_turn(random, 70.0 * kDegree);
  turn(o, 0, 0, 6, by);
  turn(o, 1, 0, 1, by);
  turn(o, 2, 2, 1, by);
  turn(o, 3, o.frames() - 4, 4, by);
  turn(o, 4, o.frames() - 1, 1, by);
  const auto last = o.frames() - 1;
  EXPECT_EQ(spans_of(o, 0), (Spans{{0, 5}}));
  EXPECT_EQ(spans_of(o, 1), (Spans{{0, 0}}));
  EXPECT_EQ(spans_of(o, 2), (Spans{{2, 2}}));
  EXPECT_EQ(spans_of(o, 3), (Spans{{last - 3, last}}));
  EXPECT_EQ(spans_of(o, 4), (Spans{{last, last}}));
}

TEST(SensorSamples, MissingSamplesAreNoJumpAndStayMissing) {
  auto o = session(0.4, 1.0 * kDegree, 5).recording;
  for (std::int64_t f = 50; f < 80; ++f) {
    double* q = o.quaternion.data() + 4 * (f * o.size());
    std::fill_n(q, 4, kNaN);
  }
  EXPECT_THAT(find_turned_spans(o), IsEmpty());
  Random random(15, 3);
  turn(o, 0, 100, 3, random_turn(random, 90.0 * kDegree));
  const auto judged = judge_sensors(o, nullptr);
  EXPECT_EQ(judged.pose_or_null(), nullptr);
  for (std::int64_t f = 0; f < o.frames(); ++f)
    EXPECT_EQ(judged.recording.present(f, 0), (f < 50 || f >= 80) && (f < 100 || f > 102)) << f;
}

TEST(SensorSamples, TheAccountNamesSensorsThatWereUsedInSolvedFrames) {
  auto s = session(0.4, 1.0 * kDegree, 6);
  Random random(16, 3);
  const auto by = random_turn(random, 90.0 * kDegree);
  turn(s.recording, 0, 30, 2, by);
  turn(s.recording, 0, 150, 2, by);
  turn(s.recording, 1, 30, 2, by);
  turn(s.pose, 0, 9, 1, by);
  const auto judged = judge_sensors(s.recording, &s.pose);
  OrientationFit fit;
  fit.sensors.push_back({.name = s.recording.names[0]});
  auto solved = s.recording.time;
  solved.frames = 100;
  judged.account(solved, fit);
  ASSERT_EQ(fit.rejected.size(), 2U);
  EXPECT_EQ(fit.rejected[0].sensor, s.recording.names[0]);
  EXPECT_EQ(fit.rejected[0].samples(), 2);
  EXPECT_NEAR(fit.rejected[0].first_s, 30.0 / 60.0, 1e-12);
  EXPECT_FALSE(fit.rejected[0].in_pose);
  EXPECT_TRUE(fit.rejected[1].in_pose);
  EXPECT_EQ(fit.rejected[1].samples(), 1);
}

}  // namespace
}  // namespace kinemark::motion::internal
