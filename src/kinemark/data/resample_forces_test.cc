// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/resample_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <utility>

#include "kinemark/core/missing.h"

namespace kinemark::data {
namespace {

using Eigen::Vector3d;

Vector3d of_frame(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

/// A force and a moment about a point that all change evenly; nothing in the last two of 10 frames.
Wrenches even() {
  Wrenches w{.time = {.rate_hz = 50.0, .t0_s = 1.0, .frames = 10}, .items = {}};
  Wrench wrench{.name = "plate 1", .body = "foot", .force = {}, .moment = {}, .point = {}};
  for (int f = 0; f < 10; ++f)
    for (int axis = 0; axis < 3; ++axis) {
      wrench.force.push_back(f < 8 ? 100.0 * axis + f : 0.0);
      wrench.moment.push_back(f < 8 ? axis - 0.1 * f : 0.0);
      wrench.point.push_back(f < 8 ? 0.3 + 0.01 * f * axis : kNaN);
    }
  w.items.push_back(std::move(wrench));
  return w;
}

/// Moment about the laboratory's origin.
Vector3d at_origin(const Wrench& w, std::int64_t f) {
  return of_frame(w.moment, f) + of_frame(w.point, f).cross(of_frame(w.force, f));
}

TEST(Resample, TheSameInstantsAreTheSameNumbers) {
  const auto wrenches = even();
  // Another first frame, and times that miss by rounding.
  const auto part = resample(wrenches, {.rate_hz = 50.0, .t0_s = 1.06 + 1e-9, .frames = 4});
  ASSERT_TRUE(part.validate());
  EXPECT_EQ(part.items.at(0).name, "plate 1");
  EXPECT_EQ(part.items.at(0).body, "foot");
  for (std::int64_t f = 0; f < 4; ++f) {
    EXPECT_EQ(of_frame(part.items[0].force, f), of_frame(wrenches.items[0].force, f + 3));
    EXPECT_EQ(of_frame(part.items[0].moment, f), of_frame(wrenches.items[0].moment, f + 3));
    EXPECT_EQ(of_frame(part.items[0].point, f), of_frame(wrenches.items[0].point, f + 3));
  }
}

TEST(Resample, BetweenFramesTheWholePushIsLinear) {
  const auto wrenches = even();
  const auto fine = resample(wrenches, {.rate_hz = 100.0, .t0_s = 1.0, .frames = 15});
  ASSERT_TRUE(fine.validate());
  for (std::int64_t f = 1; f < 14; f += 2) {
    const auto before = (f - 1) / 2;
    EXPECT_LT((of_frame(fine.items[0].force, f) - 0.5 * (of_frame(wrenches.items[0].force, before) +
                                                         of_frame(wrenches.items[0].force, before + 1)))
                  .norm(),
              1e-12);
    EXPECT_LT((at_origin(fine.items[0], f) -
               0.5 * (at_origin(wrenches.items[0], before) + at_origin(wrenches.items[0], before + 1)))
                  .norm(),
              1e-12);
  }
}

TEST(Resample, AStepOffIsHalfAPushWhereTheFootWas) {
  const auto wrenches = even();
  const auto fine = resample(wrenches, {.rate_hz = 100.0, .t0_s = 1.0, .frames = 19});
  const auto& w = fine.items[0];
  EXPECT_LT((of_frame(w.force, 15) - 0.5 * of_frame(wrenches.items[0].force, 7)).norm(), 1e-11);
  EXPECT_LT((of_frame(w.point, 15) - of_frame(wrenches.items[0].point, 7)).norm(), 1e-12);
  EXPECT_LT((at_origin(w, 15) - 0.5 * at_origin(wrenches.items[0], 7)).norm(), 1e-12);
  EXPECT_EQ(of_frame(w.force, 17), Vector3d::Zero());
  EXPECT_EQ(of_frame(w.moment, 17), Vector3d::Zero());
}

TEST(Resample, NothingIsKnownOutsideOrBesideTheUnknown) {
  auto wrenches = even();
  const auto wide = resample(wrenches, {.rate_hz = 50.0, .t0_s = 0.98, .frames = 12});
  for (const std::int64_t f : {0, 11}) EXPECT_TRUE(of_frame(wide.items[0].force, f).hasNaN());
  EXPECT_FALSE(of_frame(wide.items[0].force, 1).hasNaN());
  EXPECT_FALSE(of_frame(wide.items[0].force, 10).hasNaN());
  wrenches.items[0].force[9] = kNaN;  // frame 3
  const auto fine = resample(wrenches, {.rate_hz = 100.0, .t0_s = 1.0, .frames = 12});
  for (const std::int64_t f : {5, 6, 7}) EXPECT_TRUE(of_frame(fine.items[0].force, f).hasNaN()) << f;
  for (const std::int64_t f : {4, 8}) EXPECT_FALSE(of_frame(fine.items[0].force, f).hasNaN()) << f;
  EXPECT_EQ(resample(wrenches, {.rate_hz = 50.0, .t0_s = 99.0, .frames = 0}).items[0].force.size(), 0u);
}

}  // namespace
}  // namespace kinemark::data
