// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/articulated/ends.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A sleeve with an LED at the wrist, and the skeleton that its markers give.
struct Arm {
  simulation::LimbRecording limb;
  data::Skeleton skeleton;

  explicit Arm(simulation::SleeveOptions options) {
    options.tip = true;
    limb = simulation::simulate_sleeve(options).value();
    fit();
  }
  void fit() {
    skeleton = skeleton::fit_articulated(limb.markers, limb.layout).value().skeleton;
    skeleton.warnings.clear();
  }
  void place() { skeleton::place_ends(limb.markers, limb.layout.ends, skeleton); }
};

Eigen::Vector3d centre(const data::SkeletonEnd& end, std::int64_t f) {
  return Eigen::Map<const Eigen::Vector3d>(end.centre_in_world.data() + 3 * f);
}

Eigen::Vector3d sd(const data::SkeletonEnd& end, std::int64_t f) {
  return math::unpack_symmetric3(end.covariance_in_world.data() + 6 * f).diagonal().cwiseSqrt();
}

TEST(PlaceEnds, AShoulderThatStays) {
  Arm arm({.duration_s = 12.0, .seed = 3});
  arm.place();
  ASSERT_EQ(arm.skeleton.ends.size(), 2U);
  EXPECT_TRUE(arm.skeleton.validate());
  const auto& shoulder = arm.skeleton.ends[0];
  EXPECT_EQ(shoulder.name, "shoulder");
  EXPECT_TRUE(shoulder.stays());
  EXPECT_LT((centre(shoulder, 0).array().abs() / sd(shoulder, 0).array()).maxCoeff(), 3.5)
      << "it is the origin";
  EXPECT_LT(sd(shoulder, 0).norm(), 1.5e-3);
  EXPECT_EQ(centre(shoulder, 0), centre(shoulder, 500)) << "one position in all frames";
  EXPECT_NEAR(shoulder.length_m, 0.150, 4.0 * shoulder.length_sd_m);
  EXPECT_LT(shoulder.length_sd_m, 1.5e-3);
  EXPECT_EQ(shoulder.joint, 0);
  EXPECT_THAT(shoulder.description, HasSubstr("deg of motion: stays in the room, known to"));
  EXPECT_THAT(shoulder.description, Not(HasSubstr("marker 'w0': placed in ")));
  EXPECT_THAT(arm.skeleton.warnings, IsEmpty());
}

TEST(PlaceEnds, AWristIsCoveredWhereItsMarkerIsNotSeenAsWell) {
  Arm arm({.duration_s = 20.0, .seed = 4});
  arm.place();
  const auto& wrist = arm.skeleton.ends[1];
  EXPECT_EQ(wrist.name, "wrist");
  double in_1sd = 0.0, in_2sd = 0.0, n = 0.0, hidden = 0.0;
  for (std::int64_t f = 0; f < arm.skeleton.frames(); ++f) {
    if (wrist.state[static_cast<std::size_t>(f)] == data::CentreState::undetermined) continue;
    hidden += arm.limb.markers.present(f, wrist.marker) ? 0.0 : 1.0;
    const Eigen::Vector3d off =
        centre(wrist, f) - Eigen::Map<const Eigen::Vector3d>(arm.limb.end_in_world.data() + 3 * f);
    for (int i = 0; i < 3; ++i) {
      in_1sd += std::abs(off[i]) <= sd(wrist, f)[i] ? 1.0 : 0.0;
      in_2sd += std::abs(off[i]) <= 1.96 * sd(wrist, f)[i] ? 1.0 : 0.0;
      n += 1.0;
    }
  }
  EXPECT_GT(n, 3.0 * 0.95 * static_cast<double>(arm.skeleton.frames()));
  EXPECT_GT(hidden, 100.0) << "or nothing was asked";
  EXPECT_GT(in_1sd / n, 0.55);
  EXPECT_LT(in_1sd / n, 0.80);
  EXPECT_GT(in_2sd / n, 0.88);
  EXPECT_LT(in_2sd / n, 0.995);
  EXPECT_NEAR(wrist.length_m, 0.160, 4.0 * wrist.length_sd_m);
  EXPECT_THAT(wrist.description, HasSubstr("marker 'w0': placed in "));
  EXPECT_THAT(wrist.description, HasSubstr(" frames, SD "));
  EXPECT_THAT(wrist.description, Not(HasSubstr("stays in the room, known to")));
}

TEST(PlaceEnds, AShoulderThatMovesIsSaidAndItsErrorBarWidens) {
  Arm arm({.duration_s = 12.0, .seed = 3});
  for (std::int64_t f = 0; f < arm.limb.markers.frames(); ++f)
    for (std::int64_t m = 0; m < arm.limb.markers.markers(); ++m)
      arm.limb.markers.x(f, m).z() += 0.015 * std::sin(0.05 * static_cast<double>(f));
  arm.fit();
  arm.place();
  EXPECT_THAT(arm.skeleton.warnings,
              Contains(HasSubstr("'shoulder' does not stay where it is: its places in the room and on")));
  const double wide = sd(arm.skeleton.ends[0], 0).norm();
  EXPECT_GT(wide, 0.005);
  EXPECT_LT(wide, 0.03);
}

TEST(PlaceEnds, ALineHasNoPoseAndALeftOutSegmentNoEnd) {
  const auto chain = simulation::simulate_chain({.frames = 60}).value();
  auto skeleton = skeleton::fit_articulated(chain.markers, chain.layout).value().skeleton;
  skeleton.warnings.clear();
  const std::vector<data::SegmentLayout::End> ends{{.name = "root", .segment = "s0"},
                                                   {.name = "hand", .segment = "gone", .marker = 0}};
  skeleton::place_ends(chain.markers, ends, skeleton);
  EXPECT_THAT(skeleton.ends, IsEmpty());
  EXPECT_THAT(skeleton.warnings, Contains(HasSubstr("'root' was not placed: segment 's0' shows no pose")));
  EXPECT_THAT(skeleton.warnings, Contains("'hand' was not placed: segment 'gone' was left out"));
}

TEST(PlaceEnds, SkinWidensBothErrorBars) {
  double narrow[2], wide[2];
  for (const double skin_m : {0.0, 0.008}) {
    Arm arm({.duration_s = 20.0, .line_of_sight = false, .skin_m = skin_m, .seed = 5});
    arm.place();
    for (std::size_t e = 0; e < 2; ++e) {
      const double mean = sd(arm.skeleton.ends[e], 300).norm();
      (skin_m > 0.0 ? wide : narrow)[e] = mean;
    }
    EXPECT_LT(
        (centre(arm.skeleton.ends[0], 0).array().abs() / sd(arm.skeleton.ends[0], 0).array()).maxCoeff(), 3.5)
        << skin_m;
  }
  EXPECT_GT(wide[0], 3.0 * narrow[0]);
  EXPECT_GT(wide[1], 3.0 * narrow[1]);
}

}  // namespace
}  // namespace kinemark::workflow
