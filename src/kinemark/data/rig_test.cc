// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/rig.h"

#include <gmock/gmock.h>

#include <cmath>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

Rig good() {
  Rig rig;
  rig.cameras.resize(2);
  rig.cameras[0].name = "A";
  rig.cameras[1].name = "B";
  rig.cameras[1].detector.warp_degree = 3;
  rig.cameras[1].detector.warp_x.assign(7, 0.001);
  rig.cameras[1].detector.warp_y.assign(7, 0.001);
  return rig;
}

TEST(Kinds, NamesReadBack) {
  for (const auto kind : {CameraKind::pinhole, CameraKind::lateral_effect})
    EXPECT_EQ(parse_camera_kind(to_string(kind)), kind);
  for (const auto kind : {DetectorKind::tetra_lateral, DetectorKind::duo_lateral, DetectorKind::pin_cushion,
                          DetectorKind::generic})
    EXPECT_EQ(parse_detector_kind(to_string(kind)), kind);
  EXPECT_THAT(parse_camera_kind("fisheye").error().message,
              "there is no kind of camera 'fisheye'; there are pinhole and lateral-effect");
  EXPECT_THAT(parse_detector_kind("ccd").error().message, HasSubstr("duo-lateral"));
}

TEST(ParameterLayout, CountsTermsOfWarpAndShares) {
  EXPECT_EQ(monomial_count(2, 5), 18);
  EXPECT_EQ(monomial_count(0, 11), 78);
  EXPECT_EQ(monomial_count(2, 0), 0);
  const Rig rig = good();
  EXPECT_EQ(ParameterLayout(rig.cameras[0]).count, 15 + 12 + 8);
  EXPECT_EQ(ParameterLayout(rig.cameras[1]).count, 15 + 14 + 12 + 8);
  EXPECT_EQ(ParameterLayout(rig.cameras[1]).gain, 15 + 14 + 12);
  EXPECT_EQ(rig.first_parameter(1), 35);
  EXPECT_EQ(rig.parameter_count(), 35 + 49);
  Camera pinhole;
  pinhole.kind = CameraKind::pinhole;
  EXPECT_EQ(ParameterLayout(pinhole).count, 15);
}

TEST(SlotTiming, NumbersOfThePaper) {
  const SlotTiming timing;
  EXPECT_NEAR(timing.slot_s(2), 904e-6, 1e-12);
  const int hz[] = {1106, 553, 369, 277, 221, 184, 158, 138};
  for (int leds = 1; leds <= 8; ++leds) EXPECT_EQ(std::lround(timing.highest_rate_hz(leds, 2)), hz[leds - 1]);
  EXPECT_NEAR(timing.conversion_offset_s(3, 1, 3, 2), 0.003368, 1e-12);
  const SlotTiming dark{.dark_slot = true};
  EXPECT_NEAR(1.0 / dark.highest_rate_hz(8, 2), 9 * 904e-6, 1e-12);
}

TEST(Electronics, OneCount) { EXPECT_NEAR(1e9 * Electronics().count_a(), 0.29296875, 1e-12); }

TEST(Rig, EachBrokenRuleIsNamed) {
  const auto message = [](auto&& spoil) {
    Rig rig = good();
    spoil(rig);
    const auto status = rig.validate();
    return status ? std::string("valid") : status.error().message;
  };
  EXPECT_EQ(message([](Rig&) {}), "valid");
  EXPECT_THAT(message([](Rig& r) { r.cameras.clear(); }), HasSubstr("no camera"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[1].name = "A"; }), HasSubstr("'A' occurs twice"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].cam_from_world.rotation(0, 0) = -1.0; }),
              HasSubstr("camera 'A': its rotation is not orthonormal"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].cam_from_world.translation.x() = NAN; }), HasSubstr("pose"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].focal = 0.0; }), HasSubstr("focal length 0"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].aspect = -1.0; }), HasSubstr("aspect -1"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].distortion.k2 = NAN; }), HasSubstr("not finite"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.half_side_m = 0; }), HasSubstr("half-side 0"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.edge = 1.1; }), HasSubstr("edge at 1.1"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[1].detector.warp_y.pop_back(); }),
              HasSubstr("has 6 terms; need 7"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[1].detector.warp_degree = 16; }), HasSubstr("degree 16"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.kind = DetectorKind::generic; }),
              HasSubstr("has 0 terms; need 3"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.gain[2] = 0.0; }), HasSubstr("a gain of 0"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.dark_counts[1] = 16.0; }),
              HasSubstr("need all four, or none"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.dark_sd_counts = -1.0; }),
              HasSubstr("dark_sd_counts -1"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.light_counts = 0.0; }), HasSubstr("light_counts 0"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].detector.crosstalk(1, 2) = NAN; }), HasSubstr("not finite"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].table.nodes = 2; }), HasSubstr("table of 2 nodes"));
  EXPECT_THAT(message([](Rig& r) { r.cameras[0].table.nodes = 15; }), HasSubstr("need 450"));
  EXPECT_THAT(message([](Rig& r) { r.electronics.bits = 16; }), HasSubstr("16 bits"));
  EXPECT_THAT(message([](Rig& r) { r.electronics.full_scale_a = 0.0; }),
              HasSubstr("electronics: full_scale_a is 0; need more than 0"));
  EXPECT_THAT(message([](Rig& r) { r.electronics.time_constant_s = 1e30; }),
              HasSubstr("time_constant_s is 1e+30; need more than 0, at most 1"));
  EXPECT_THAT(message([](Rig& r) { r.electronics.ambient_a = -1.0; }),
              HasSubstr("electronics: ambient_a is -1; need at least 0, at most 1"));
  EXPECT_THAT(message([](Rig& r) { r.timing.settle_s = -1e-6; }), HasSubstr("within a slot"));
  EXPECT_THAT(message([](Rig& r) { r.timing.conversion_s = 0.0; }), HasSubstr("no time"));
  EXPECT_THAT(message([](Rig& r) { r.chi2_per_dof = NAN; }), HasSubstr("chi2"));
  EXPECT_THAT(message([](Rig& r) { r.covariance.setZero(3, 3); }), HasSubstr("84 parameters"));
  EXPECT_THAT(message([](Rig& r) { r.covariance = -Eigen::MatrixXd::Identity(84, 84); }),
              HasSubstr("negative"));
  EXPECT_THAT(message([](Rig& r) {
                r.covariance = Eigen::MatrixXd::Identity(84, 84);
                r.covariance(0, 1) = 0.5;
              }),
              HasSubstr("not symmetric"));
}

}  // namespace
}  // namespace kinemark::data
