// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_physics.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "kinemark/camera/parameters.h"
#include "kinemark/camera/projection.h"

namespace kinemark::simulation {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

PhysicalRig ideal(data::DetectorKind kind = data::DetectorKind::tetra_lateral) {
  return draw_rig({.imperfection = 0.0, .misalignment = 0.0, .detector = kind}).value();
}

TEST(LookingAtOrigin, IsUprightAndTurnsAboutItsOwnAxes) {
  const Vector3d centre(-1.5, 0.2, 2.6);
  const auto pose = looking_at_origin(centre);
  EXPECT_LT((pose * centre).norm(), 1e-15);
  const Vector3d origin = pose * Vector3d::Zero();
  EXPECT_LT(origin.head<2>().norm(), 1e-15);
  EXPECT_NEAR(origin.z(), centre.norm(), 1e-15);
  EXPECT_NEAR(pose.rotation.row(0).y(), 0.0, 1e-15);  // its x axis is level
  EXPECT_LT(pose.rotation.row(1).y(), -0.9);          // its y axis points down
  // Rolled, it still looks at the origin; turned to the right, the origin moves to the left.
  EXPECT_LT((looking_at_origin(centre, 0.1) * Vector3d::Zero()).head<2>().norm(), 1e-15);
  const Vector3d yawed = looking_at_origin(centre, 0.0, 0.01) * Vector3d::Zero();
  EXPECT_NEAR(yawed.x() / yawed.z(), std::tan(0.01), 1e-12);
  const Vector3d pitched = looking_at_origin(centre, 0.0, 0.0, 0.01) * Vector3d::Zero();
  EXPECT_NEAR(pitched.y() / pitched.z(), -std::tan(0.01), 1e-12);
}

TEST(Photocurrent, FallsWithDistanceAndAngle) {
  const RigLight light;
  EXPECT_NEAR(1e6 * photocurrent_a(light, 3.0, std::cos(std::numbers::pi / 6.0), 1.0), 0.738, 5e-4);
  const double near = photocurrent_a(light, 1.5, 1.0, 1.0);
  EXPECT_NEAR(near / photocurrent_a(light, 3.0, 1.0, 1.0), 4.0, 1e-12);
  EXPECT_NEAR(photocurrent_a(light, 1.5, 0.5, 0.25) / near, 0.125, 1e-15);
}

TEST(DrawRig, AnIdealRigIsItsDrawing) {
  const auto rig = ideal();
  for (std::size_t c = 0; c < 2; ++c) {
    const auto &truth = rig.rig.cameras[c], &drawn = rig.nominal.cameras[c];
    EXPECT_LT((truth.cam_from_world.rotation - drawn.cam_from_world.rotation).norm(), 1e-15);
    EXPECT_EQ(truth.focal, drawn.focal);
    EXPECT_EQ(truth.detector.gain, drawn.detector.gain);
    EXPECT_LT(std::abs(drawn.centre_in_world().norm() - 3.0), 1e-14);
  }
  const Vector3d a = rig.nominal.cameras[0].centre_in_world(), b = rig.nominal.cameras[1].centre_in_world();
  EXPECT_NEAR(a.dot(b) / 9.0, std::cos(std::numbers::pi / 3.0), 1e-14);
  EXPECT_LT(a.x(), 0.0);
  EXPECT_TRUE(rig.rig.validate());
  EXPECT_TRUE(rig.nominal.validate());
}

TEST(DrawRig, TolerancesAreAsLargeAsTheySay) {
  constexpr int kRigs = 200;
  double centre = 0.0, focal = 0.0, gain = 0.0, warp = 0.0, offset = 0.0;
  for (int seed = 1; seed <= kRigs; ++seed) {
    const auto rig = draw_rig({.seed = static_cast<std::uint64_t>(seed)}).value();
    const auto &truth = rig.rig.cameras[1], &drawn = rig.nominal.cameras[1];
    centre += (truth.centre_in_world() - drawn.centre_in_world()).squaredNorm() / (3.0 * kRigs);
    focal += std::pow(truth.focal / drawn.focal - 1.0, 2) / kRigs;
    gain += (truth.detector.gain.array() - 1.0).square().mean() / kRigs;
    warp += std::pow(truth.detector.warp_x[4], 2) / kRigs;
    offset += truth.detector.offset_counts.squaredNorm() / (4.0 * kRigs);
  }
  EXPECT_NEAR(std::sqrt(centre), 10e-3, 1e-3);
  EXPECT_NEAR(std::sqrt(focal), 0.006, 0.001);
  EXPECT_NEAR(std::sqrt(gain), 0.005, 0.0005);
  EXPECT_NEAR(std::sqrt(warp), 0.003, 0.0005);
  EXPECT_NEAR(std::sqrt(offset), 2.0, 0.15);
}

TEST(DrawRig, CrosstalkKeepsTheCurrentAndChangesNothingElse) {
  const auto plain = draw_rig({.seed = 3}).value();
  const auto spoilt = draw_rig({.seed = 3, .crosstalk = 0.02, .ripple = 0.001}).value();
  for (std::size_t c = 0; c < 2; ++c) {
    const auto &a = plain.rig.cameras[c].detector, &b = spoilt.rig.cameras[c].detector;
    EXPECT_LT(b.crosstalk.rowwise().sum().norm(), 1e-16);  // what leaves an electrode arrives at another
    EXPECT_GT(b.crosstalk.norm(), 0.01);
    EXPECT_EQ(b.warp_degree, 10);
    EXPECT_TRUE(std::equal(a.warp_x.begin(), a.warp_x.end(), b.warp_x.begin()));
    EXPECT_EQ(a.gain, b.gain);
  }
}

TEST(DrawRig, DarkSlotsRaiseTheChannels) {
  const auto plain = draw_rig({.seed = 3}).value(), dark = draw_rig({.seed = 3, .dark_slot = true}).value();
  const Eigen::Vector4d raised =
      dark.rig.cameras[0].detector.offset_counts - plain.rig.cameras[0].detector.offset_counts;
  EXPECT_LT((raised - Eigen::Vector4d::Constant(16.0)).norm(), 1e-13);
  EXPECT_TRUE(dark.rig.timing.dark_slot && dark.nominal.timing.dark_slot);
}

TEST(DrawRig, OfAnotherConverterIsTheSameRig) {
  const auto fine = draw_rig({.seed = 3}).value(),
             coarse = draw_rig({.seed = 3, .bits = 10, .conversion_s = 64e-6}).value();
  EXPECT_EQ(coarse.rig.electronics.highest_code(), 1023);
  EXPECT_EQ(coarse.rig.timing.conversion_s, 64e-6);
  EXPECT_EQ(coarse.nominal.electronics.bits, 10);
  EXPECT_EQ(coarse.rig.cameras[0].focal, fine.rig.cameras[0].focal);
  const LedState led;
  for (int camera : {0, 1})
    EXPECT_LT((4.0 * expected_counts(coarse, camera, led).counts - expected_counts(fine, camera, led).counts)
                  .norm(),
              1e-9);
  EXPECT_EQ(coarse.room[0].flicker_counts * 4.0, fine.room[0].flicker_counts);
}

TEST(DrawRig, RefusesOptionsOutOfRange) {
  EXPECT_THAT(draw_rig({.imperfection = -1.0}).error().message, HasSubstr("one is -1"));
  EXPECT_THAT(draw_rig({.crosstalk = 0.6}).error().message, HasSubstr("it is 0.6"));
  EXPECT_THAT(draw_rig({.ripple = NAN}).error().message, HasSubstr("nan"));
  EXPECT_THAT(draw_rig({.bits = 7}).error().message, HasSubstr("8 to 14"));
  EXPECT_THAT(draw_rig({.bits = 15}).error().message, HasSubstr("15 bits"));
  EXPECT_THAT(draw_rig({.conversion_s = 2e-3}).error().message, HasSubstr("2000 us; need 1 to 1000"));
  EXPECT_THAT(draw_rig({.detector = data::DetectorKind::generic}).error().message, HasSubstr("no physics"));
}

TEST(ExpectedCounts, AddUpToTheLight) {
  const auto rig = ideal();
  const auto at_origin = expected_counts(rig, 0, {});
  // 0.738 uA of direct light and 0.6 % of 0.852 uA by way of the room
  const double count_a = rig.rig.electronics.count_a();
  EXPECT_NEAR(at_origin.counts.sum(), (0.73803e-6 + 0.006 * 0.85220e-6) / count_a, 0.1);
  EXPECT_TRUE(at_origin.on_sheet);
  const auto half = expected_counts(rig, 0, {}, 0.5);
  EXPECT_LT((2.0 * half.counts - at_origin.counts).norm(), 1e-9);  // no offset in an ideal rig
  const auto dark = expected_counts(rig, 0, {.shining = false});
  EXPECT_EQ(dark.counts.norm(), 0.0);
}

TEST(ExpectedCounts, OnlyStrayLightComesFromBehindOrBesideTheSheet) {
  const auto rig = ideal();
  const double stray = expected_counts(rig, 0, {.x_in_world = {-3.0, 0.0, 6.0}}).counts.sum();
  EXPECT_NEAR(stray, 0.006 * 0.85220e-6 / rig.rig.electronics.count_a(), 0.01);
  const auto beside = expected_counts(rig, 0, {.x_in_world = {0.0, 1.5, 0.0}});
  EXPECT_FALSE(beside.on_sheet);
  EXPECT_NEAR(beside.counts.sum(), stray, 1e-9);
}

TEST(RigInRoom, OffsetsAreWhatALedGivesThatIsNotSeen) {
  const auto rig = draw_rig({.seed = 4}).value();
  const data::Rig in_room = rig_in_room(rig);
  for (int c = 0; c < 2; ++c) {
    const auto hidden = expected_counts(rig, c, {.x_in_world = {0.0, 0.0, 9.0}});
    ASSERT_FALSE(hidden.on_sheet) << "behind both cameras";
    const auto& offset = in_room.cameras[static_cast<std::size_t>(c)].detector.offset_counts;
    EXPECT_LT((offset - hidden.counts).norm(), 1e-9);
    EXPECT_GT((offset - rig.rig.cameras[static_cast<std::size_t>(c)].detector.offset_counts).minCoeff(), 1.0);
  }
}

TEST(ExpectedCounts, EveryKindOfDetectorSeesTheSameLight) {
  const LedState led{.x_in_world = {0.1, -0.2, 0.1}};
  const auto tetra = expected_counts(ideal(), 1, led).counts;
  const auto pin = expected_counts(ideal(data::DetectorKind::pin_cushion), 1, led).counts;
  const auto duo = expected_counts(ideal(data::DetectorKind::duo_lateral), 1, led).counts;
  EXPECT_NEAR(pin.sum(), tetra.sum(), 1e-9);
  EXPECT_GT(duo.sum(), 1.98 * tetra.sum());  // each of its two layers carries the whole current
  // and the ratio of its opposite currents is the position itself, except for the stray light
  const auto rig = ideal(data::DetectorKind::duo_lateral);
  EXPECT_NEAR((duo[0] - duo[1]) / (duo[0] + duo[1]),
              camera::project(rig.rig.cameras[1], led.x_in_world).image.x(), 2e-3);
}

TEST(ReflectedCounts, AreAShareOfTheLedFromAnotherPosition) {
  const auto rig = ideal();
  const LedState led{.x_in_world = {0.1, 0.0, 0.0}};
  const Vector3d mirror(0.1, 0.26, 0.03);
  const Eigen::Vector4d stray = expected_counts(rig, 0, {.x_in_world = {-3.0, 0.0, 6.0}}).counts;
  const Eigen::Vector4d direct = expected_counts(rig, 0, led).counts - stray;
  const Eigen::Vector4d glint = reflected_counts(rig, 0, led, 1.0, mirror, 0.04);
  EXPECT_NEAR(glint.sum(), 0.04 * direct.sum(), 1e-9);
  EXPECT_GT(glint[3], direct[3] * 0.04);  // above the LED: image y is down, so more at -y
  EXPECT_EQ(reflected_counts(rig, 0, led, 1.0, {0.0, 5.0, 0.0}, 0.04).norm(), 0.0);
}

}  // namespace
}  // namespace kinemark::simulation
