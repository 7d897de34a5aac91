// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/body_orientations.h"

#include <gmock/gmock.h>

#include <string>

#include "kinemark/io/text/vendor_exports.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A stick that turns by 90 deg about z, and a hand that is not seen at the end.
data::Trial bodies(const std::string& first = "1\t0\t0\t0\t1\t0\t0\t0\t1") {
  const std::string text =
      "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t4\nNO_OF_BODIES\t2\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_"
      "NAMES\tstick\thand\n"
      "100\t200\t300\t0\t0\t0\t0.3\t" +
      first +
      "\t400\t500\t600\t10\t20\t30\t0.5\t0.8\t0.6\t0\t-0.6\t0.8\t0\t0\t0\t1\n"
      "110\t200\t300\t0\t0\t90\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1\t"
      "0.000\t0.000\t0.000\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\n";
  return parse_vendor_export(text, "b.tsv", VendorExport::qtm).value();
}

TEST(BodyOrientations, AreTheAxesOfQtm) {
  const auto trial = bodies();
  EXPECT_TRUE(has_body_axes(trial));
  const auto found = orientations_of_bodies(trial).value();
  EXPECT_THAT(found.names, ElementsAre("stick", "hand"));
  EXPECT_EQ(found.time.rate_hz, 100.0);
  EXPECT_EQ(found.time.first_number, trial.first_frame);
  EXPECT_TRUE(found.rotation(0, 0).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_TRUE((found.rotation(1, 0) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(
      (found.rotation(0, 1) * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d(-0.6, 0.8, 0.0), 1e-12))
      << "the second three numbers are the y axis";
  EXPECT_FALSE(found.present(1, 1));
}

TEST(BodyOrientations, AreTheNearestRotationOfRoundedNumbers) {
  const auto found = orientations_of_bodies(bodies("0.999\t0.02\t0\t-0.02\t0.999\t0\t0\t0\t1")).value();
  EXPECT_NEAR(found.rotation(0, 0)(1, 0), 0.02 / 0.9992, 1e-6);
}

TEST(BodyOrientations, AxesThatAreNoRotationAreRefused) {
  EXPECT_THAT(orientations_of_bodies(bodies("1\t0\t0\t0.5\t1\t0\t0\t0\t1")).error().message,
              HasSubstr("'stick', frame"));
  EXPECT_FALSE(orientations_of_bodies(bodies("1\t0\t0\t0\t1\t0\t0\t0\t-1"))) << "a mirror";
  auto markers = bodies();
  markers.channels.names[2] = "something else";
  markers.channels.names[6] = "something else too";
  EXPECT_FALSE(has_body_axes(markers));
  EXPECT_THAT(orientations_of_bodies(markers).error().message, HasSubstr("holds no axes"));
}

}  // namespace
}  // namespace kinemark::io
