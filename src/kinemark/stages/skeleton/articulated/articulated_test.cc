// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/articulated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/articulated/bound.h"
#include "kinemark/stages/skeleton/articulated/testing/limbs.h"

namespace kinemark::skeleton {
namespace {

using data::CentreState;
using data::SegmentKind;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;
using testing::Not;
using testing_limbs::Limb;
using testing_limbs::LimbOptions;
using testing_limbs::make_limb;

ArticulatedOptions alone(SegmentKind kind, int segments = 2) {
  ArticulatedOptions options;
  options.kinds.assign(static_cast<std::size_t>(segments), kind);
  options.continuity = false;
  options.max_fit_frames = 120;  // as many as the laws below need
  return options;
}

Eigen::Vector3d error_of(const Limb& limb, const data::Skeleton& skeleton, std::int64_t f, std::int64_t j) {
  return skeleton.centre(f, j) -
         Eigen::Map<const Eigen::Vector3d>(limb.centre_in_world.data() + 3 * skeleton.index(f, j));
}

/// Root mean square error of the frames in one of two states, m.
double rms(const Limb& limb, const data::Skeleton& skeleton, CentreState a, CentreState b) {
  double sum = 0.0, n = 0.0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    for (std::int64_t j = 0; j < static_cast<std::int64_t>(skeleton.joints.size()); ++j) {
      const CentreState s = skeleton.state[skeleton.index(f, j)];
      if (s == a || s == b) sum += error_of(limb, skeleton, f, j).squaredNorm(), n += 1.0;
    }
  return std::sqrt(sum / n);
}

TEST(FitArticulated, StaysAtTheBoundForSolidSegments) {
  const Limb limb = make_limb({.frames = 200, .stagger_m = 0.02, .missing = 0.2, .seed = 1});
  auto options = alone(SegmentKind::solid);
  options.max_fit_frames = 200;  // the bound knows all frames
  const auto fit = fit_articulated(limb.markers, limb.layout, options).value();
  ASSERT_TRUE(fit.skeleton.validate().has_value());
  const std::vector<SegmentKind> kinds(2, SegmentKind::solid);
  const auto bound =
      calc_centre_bound(limb.markers, limb.layout, kinds,
                        {.x_in_world = limb.x_true, .centre_in_world = limb.centre_in_world}, 0.001)
          .value();
  double squares = 0.0, least = 0.0, beyond = 0.0, n = 0.0;
  for (std::int64_t f = 0; f < 200; ++f) {
    const std::size_t k = fit.skeleton.index(f, 0);
    if (fit.skeleton.state[k] != CentreState::determined) continue;
    const double e2 = error_of(limb, fit.skeleton, f, 0).squaredNorm();
    squares += e2;
    least += bound.variance(k);
    beyond += e2 > 25.0 * fit.skeleton.centre_covariance(f, 0).trace() ? 1.0 : 0.0;
    n += 1.0;
  }
  EXPECT_THAT(std::sqrt(squares / least), AllOf(Gt(0.8), Lt(1.2)));
  EXPECT_EQ(beyond, 0.0);
  EXPECT_GT(n, 160.0) << "determined";
  EXPECT_NEAR(fit.skeleton.noise_sd_m, 0.001, 1e-4);
  EXPECT_EQ(fit.joints[0].determined, static_cast<std::int64_t>(n));
  EXPECT_EQ(fit.joints[0].determined + fit.joints[0].ambiguous + fit.joints[0].undetermined, 200);
  EXPECT_GT(fit.joints[0].modes, fit.joints[0].ambiguous) << "an ambiguous frame shows two positions or more";
  EXPECT_THAT(fit.skeleton.joints[0].description, HasSubstr("deg of motion: centre known to"));
  EXPECT_THAT(fit.skeleton.joints[0].description,
              Not(AnyOf(HasSubstr("no frame determines it by its own markers"),
                        HasSubstr("no more than noise: neither axis nor centre known"),
                        HasSubstr("deg of motion: axis direction known to"),
                        HasSubstr("deg of motion: centre not known in its segments"))));
  EXPECT_GT(fit.skeleton.joints[0].range_of_motion_rad, 2.5);
}

TEST(FitArticulated, LinesNeedTwoMarkersOfOneSegment) {
  const Limb limb = make_limb({.frames = 200, .missing = 0.4, .seed = 2});
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::line)).value();
  std::int64_t two = 0;
  for (std::int64_t f = 0; f < 200; ++f) {
    int seen[2] = {0, 0};
    for (int m = 0; m < 6; ++m) seen[m / 3] += limb.markers.present(f, m) ? 1 : 0;
    const bool enough = std::max(seen[0], seen[1]) >= 2 && std::min(seen[0], seen[1]) >= 1;
    const bool rigid = std::max(seen[0], seen[1]) >= 2;
    two += rigid ? 1 : 0;
    if (!enough) continue;
    EXPECT_EQ(fit.skeleton.state[fit.skeleton.index(f, 0)], CentreState::determined) << f;
  }
  EXPECT_LE(fit.joints[0].determined, two);
  EXPECT_LT(rms(limb, fit.skeleton, CentreState::determined, CentreState::determined), 0.0035);
}

TEST(FitArticulated, SaysWhatTwoMarkersLeaveOpen) {
  Limb limb = make_limb({.frames = 60, .segments = 3, .stagger_m = 0.02, .seed = 4});
  ArticulatedOptions options;
  options.continuity = false;
  const auto whole = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_THAT(whole.skeleton.warnings, Each(Not(HasSubstr("on the line through"))));
  limb.layout.segments[1].markers.pop_back();
  const auto two = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_THAT(two.skeleton.warnings, Contains(HasSubstr("on the line through the two markers of '" +
                                                        limb.layout.segments[1].name + "':")));
}

TEST(FitArticulated, ContinuityAnswersEveryFrame) {
  const Limb limb =
      make_limb({.frames = 400, .stagger_m = 0.02, .missing = 0.4, .rotation_hz = 0.5, .seed = 3});
  auto options = alone(SegmentKind::solid);
  const auto single = fit_articulated(limb.markers, limb.layout, options).value();
  options.continuity = true;
  const auto path = fit_articulated(limb.markers, limb.layout, options).value();
  ASSERT_TRUE(path.skeleton.validate().has_value());
  EXPECT_EQ(path.joints[0].determined, single.joints[0].determined);
  EXPECT_EQ(path.joints[0].determined + path.joints[0].bridged, 400);
  EXPECT_GT(path.joints[0].bridged, 80);
  EXPECT_GT(path.joints[0].white_jerk, 0.0);
  EXPECT_THAT(path.skeleton.warnings, Each(Not(HasSubstr("': nothing was smoothed, for"))));
  const double determined = rms(limb, path.skeleton, CentreState::determined, CentreState::determined);
  EXPECT_LT(determined, rms(limb, single.skeleton, CentreState::determined, CentreState::determined));
  EXPECT_LT(rms(limb, path.skeleton, CentreState::bridged, CentreState::bridged), 1.4 * determined);
  for (std::int64_t f = 0; f < 400; ++f)
    EXPECT_LT(error_of(limb, path.skeleton, f, 0).squaredNorm(),
              25.0 * path.skeleton.centre_covariance(f, 0).trace())
        << f;
}

TEST(FitArticulated, FramesThatDoNotFollowEachOtherAreNotSmoothed) {
  const Limb limb = make_limb({.frames = 150, .stagger_m = 0.02, .seed = 4});
  auto options = alone(SegmentKind::solid);
  const auto single = fit_articulated(limb.markers, limb.layout, options).value();
  options.continuity = true;
  const auto fit = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_EQ(fit.skeleton.centre_in_world, single.skeleton.centre_in_world);
  EXPECT_EQ(fit.joints[0].white_jerk, 0.0);
  EXPECT_THAT(fit.skeleton.warnings,
              Contains(HasSubstr("': nothing was smoothed, for the determined frames do not follow")));
  EXPECT_THAT(fit.skeleton.warnings, Each(Not(HasSubstr("frames alone determine it"))));
}

TEST(FitArticulated, SameBitsForAnyNumberOfThreads) {
  const Limb limb =
      make_limb({.frames = 1100, .stagger_m = 0.02, .missing = 0.3, .rotation_hz = 0.5, .seed = 5});
  auto options = alone(SegmentKind::solid);
  options.continuity = true;
  options.max_fit_frames = 50;
  const auto one = fit_articulated(limb.markers, limb.layout, options).value();
  options.threads = 3;
  const auto three = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_EQ(one.skeleton.centre_in_world, three.skeleton.centre_in_world);
  EXPECT_EQ(one.skeleton.covariance, three.skeleton.covariance);
}

TEST(FitArticulated, ChainsInAnyOrderGiveTheSameJoints) {
  LimbOptions o{.frames = 120, .segments = 3, .markers_per_segment = 4, .stagger_m = 0.02, .seed = 6};
  Limb limb = make_limb(o);
  const auto straight = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid, 3)).value();
  ASSERT_EQ(straight.skeleton.lengths.size(), 1U);
  EXPECT_NEAR(straight.skeleton.lengths[0].length_m, 0.150, 4.0 * straight.skeleton.lengths[0].sd_m);
  EXPECT_LT(straight.skeleton.lengths[0].sd_m, 0.0005);
  // The second joint first, and named from the hand inwards.
  std::swap(limb.layout.joints[0], limb.layout.joints[1]);
  std::swap(limb.layout.joints[0].parent, limb.layout.joints[0].child);
  const auto reversed = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid, 3)).value();
  for (std::int64_t f = 0; f < 120; ++f)
    for (int j = 0; j < 2; ++j)
      EXPECT_LT((straight.skeleton.centre(f, j) - reversed.skeleton.centre(f, 1 - j)).norm(), 2e-4) << f;
  EXPECT_EQ(reversed.skeleton.joints[0].name, "j1");
  EXPECT_EQ(reversed.skeleton.joints[0].parent_segment, 2);
}

TEST(FitArticulated, AHingeIsKnownButForItsPositionAlongTheAxis) {
  const Limb limb = make_limb({.frames = 400,
                               .markers_per_segment = 4,
                               .stagger_m = 0.03,
                               .noise_sd_m = 0.0005,
                               .rotation_hz = 0.5,
                               .rotation_rad = 0.5,
                               .one_axis = true,
                               .seed = 7});
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value();
  const data::SkeletonJoint& joint = fit.skeleton.joints[0];
  EXPECT_EQ(joint.kind, data::JointKind::hinge);
  EXPECT_THAT(joint.description, HasSubstr("deg of motion: axis direction known to"));
  EXPECT_THAT(joint.description, HasSubstr("position along it not"));
  EXPECT_THAT(joint.description, Not(HasSubstr("deg of motion: centre known to")));
  EXPECT_NEAR(joint.axis_in_parent.norm(), 1.0, 1e-9);
  EXPECT_LT(joint.axis_sd_rad, 0.02);
  EXPECT_NEAR(joint.range_of_motion_rad, 1.0, 0.1);
  // What is not known is wide, what is known is not.
  EXPECT_GT(joint.axis_in_parent.dot(joint.covariance_in_parent * joint.axis_in_parent), 0.03 * 0.03);
  const Eigen::Matrix3d C = fit.skeleton.centre_covariance(100, 0);
  EXPECT_GT(C.trace(), 0.03 * 0.03);
  EXPECT_GT(C.determinant(), 0.0);
  const Eigen::Vector3d e = error_of(limb, fit.skeleton, 100, 0);
  EXPECT_LT(e.squaredNorm(), 25.0 * C.trace());
  // Across the axis the position is right, and along it where the markers are.
  const Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvectors().col(2);
  EXPECT_LT((e - axis.dot(e) * axis).norm(), 0.003);
  const auto along = [](const data::SkeletonSegment& segment, const Eigen::Vector3d& centre,
                        const Eigen::Vector3d& of) {
    return of.dot(centre - segment.x_in_segment.rowwise().mean());
  };
  EXPECT_NEAR(along(fit.skeleton.segments[0], joint.centre_in_parent, joint.axis_in_parent) +
                  along(fit.skeleton.segments[1], joint.centre_in_child, joint.axis_in_child),
              0.0, 0.002);
}

TEST(FitArticulated, StopsWhenAskedBeforeTheFirstFrameIsSolved) {
  const Limb limb = make_limb({.frames = 200, .markers_per_segment = 4, .stagger_m = 0.03, .seed = 7});
  std::int64_t asked = 0;
  const auto stop_at = [&asked](std::int64_t last) {
    return [&asked, last](std::int64_t done, std::int64_t) {
      EXPECT_EQ(done, 0);
      return ++asked < last;
    };
  };
  for (const std::int64_t last : {1, 3, 5}) {
    asked = 0;
    const auto fit = fit_articulated(limb.markers, limb.layout, {}, stop_at(last));
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error().code, Code::cancelled);
    EXPECT_EQ(asked, last);
  }
}

TEST(FitArticulated, LinesHaveNoHingeEvenWhenAsked) {
  const Limb limb = make_limb({.frames = 200, .seed = 2});
  auto options = alone(SegmentKind::line);
  options.joint = data::JointChoice::hinge;
  const auto fit = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_EQ(fit.skeleton.joints[0].kind, data::JointKind::ball);
  EXPECT_THAT(fit.skeleton.warnings,
              Contains("joint 'j0': a hinge was asked for, but no axis can be seen; it "
                       "is given as a ball joint"));
}

// The joint turns about every axis: who calls it a hinge is told nothing of its position along the main one.
TEST(FitArticulated, AHingeThatWasAskedForIsWideAlongItsAxis) {
  const Limb limb = make_limb({.frames = 200, .markers_per_segment = 4, .stagger_m = 0.03, .seed = 7});
  auto options = alone(SegmentKind::solid);
  options.joint = data::JointChoice::hinge;
  const auto fit = fit_articulated(limb.markers, limb.layout, options).value();
  const data::SkeletonJoint& joint = fit.skeleton.joints[0];
  EXPECT_EQ(joint.kind, data::JointKind::hinge);
  EXPECT_NEAR(joint.axis_in_parent.norm(), 1.0, 1e-9);
  EXPECT_GT(joint.axis_sd_rad, 0.0);
  EXPECT_GT(joint.axis_in_parent.dot(joint.covariance_in_parent * joint.axis_in_parent), 0.03 * 0.03);
  EXPECT_GT(fit.skeleton.centre_covariance(100, 0).trace(), 0.03 * 0.03);
  EXPECT_THAT(joint.description, HasSubstr("position along it not"));
  EXPECT_THAT(fit.skeleton.warnings, Each(Not(HasSubstr("a hinge was asked for, but no axis can be seen"))));
}

// Two straight segments that never bend: the joint may lie anywhere along them.
TEST(FitArticulated, LinesThatStayStraightDoNotShowTheirJoint) {
  const Limb limb = make_limb({.frames = 60, .rotation_hz = 0.5, .rotation_rad = 0.0, .seed = 16});
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::line)).value();
  EXPECT_THAT(fit.skeleton.joints[0].description,
              HasSubstr("deg of motion: centre not known in its segments ("));
  EXPECT_THAT(fit.skeleton.joints[0].description, Not(HasSubstr("deg of motion: centre known to")));
}

// Eight frames show both segments; in the others a marker of each is left, from which no pose can be had.
TEST(FitArticulated, AJointOfEightFramesIsNotSmoothed) {
  Limb limb =
      make_limb({.frames = 100, .markers_per_segment = 4, .stagger_m = 0.02, .rotation_hz = 0.5, .seed = 15});
  for (std::int64_t f = 0; f < 100; ++f)
    for (std::int64_t m = 0; m < 8; ++m)
      if (f % 13 != 0 && m % 4 != 0) limb.markers.set_missing(f, m);
  auto options = alone(SegmentKind::solid);
  options.continuity = true;
  const auto fit = fit_articulated(limb.markers, limb.layout, options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->joints[0].determined, 8);
  EXPECT_THAT(fit->skeleton.warnings,
              Contains("joint 'j0': nothing was smoothed, for 8 frames alone determine it; 10 are needed"));
  EXPECT_THAT(fit->skeleton.warnings, Each(Not(HasSubstr("the determined frames do not follow"))));
}

TEST(FitArticulated, AMarkerWithoutAPositionIsLeftOutByName) {
  Limb limb = make_limb({.frames = 200, .markers_per_segment = 5, .stagger_m = 0.03, .seed = 13});
  // In two frames alone, far away: too few to know its position, enough to draw a pose to it.
  for (std::int64_t f = 0; f < 200; ++f) {
    if (f == 50 || f == 51)
      limb.markers.x(f, 7) += Eigen::Vector3d(0.1, 0.0, 0.0);
    else
      limb.markers.set_missing(f, 7);
  }
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value();
  EXPECT_THAT(fit.skeleton.warnings, Contains(AllOf(HasSubstr("'s1m2'"), HasSubstr("left out"))));
  EXPECT_EQ(fit.skeleton.segments[1].markers.size(), 4U);
  EXPECT_TRUE(fit.skeleton.joints[0].covariance_in_parent.allFinite());
  EXPECT_TRUE(fit.skeleton.joints[0].covariance_in_child.allFinite());
  for (const std::int64_t f : {50, 51}) {
    EXPECT_EQ(fit.skeleton.state[fit.skeleton.index(f, 0)], CentreState::determined);
    EXPECT_LT(error_of(limb, fit.skeleton, f, 0).norm(), 0.005);
  }
}

TEST(FitArticulated, AJointThatNeverMovesSaysSo) {
  const Limb limb = make_limb({.frames = 200,
                               .markers_per_segment = 4,
                               .stagger_m = 0.03,
                               .rotation_hz = 0.5,
                               .rotation_rad = 0.001,
                               .seed = 8});
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid));
  if (!fit) {
    EXPECT_THAT(fit.error().message, HasSubstr("mo"));
    return;
  }
  EXPECT_THAT(fit->skeleton.joints[0].description, HasSubstr("neither axis nor centre known"));
  for (std::int64_t f = 0; f < 200; ++f) {
    if (fit->skeleton.state[fit->skeleton.index(f, 0)] == CentreState::undetermined) continue;
    EXPECT_LT(error_of(limb, fit->skeleton, f, 0).squaredNorm(),
              25.0 * fit->skeleton.centre_covariance(f, 0).trace());
  }
}

TEST(FitArticulated, FindsAMarkerThatSlipped) {
  Limb limb =
      make_limb({.frames = 240, .markers_per_segment = 5, .stagger_m = 0.03, .rotation_hz = 0.5, .seed = 9});
  for (std::int64_t f = 120; f < 240; ++f) {
    // Along the bone: 10 mm towards the next marker of the same segment.
    const Eigen::Vector3d way = (limb.markers.x(f, 3) - limb.markers.x(f, 2)).normalized();
    limb.markers.x(f, 1) += 0.010 * way;
  }
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value();
  EXPECT_THAT(fit.skeleton.warnings,
              Contains(AllOf(HasSubstr("marker 's0m1' sits "),
                             HasSubstr("mm elsewhere on its segment from 2.0"), HasSubstr("did it slip?"))));
  EXPECT_THAT(fit.skeleton.warnings, Each(Not(HasSubstr("'s0m1' moves on its segment by"))));
  EXPECT_LT(rms(limb, fit.skeleton, CentreState::determined, CentreState::determined), 0.010);
}

TEST(FitArticulated, FindsExchangedNames) {
  Limb limb =
      make_limb({.frames = 160, .markers_per_segment = 4, .stagger_m = 0.03, .rotation_hz = 0.5, .seed = 10});
  for (std::int64_t f = 120; f < 126; ++f) {
    const Eigen::Vector3d a = limb.markers.x(f, 1), b = limb.markers.x(f, 6);
    limb.markers.x(f, 1) = b;
    limb.markers.x(f, 6) = a;
  }
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value();
  EXPECT_THAT(fit.skeleton.warnings,
              Contains(HasSubstr(
                  "markers 's0m1' and 's1m2' have exchanged names in about 6 frames, the first at 2.00 s")));
  EXPECT_THAT(fit.skeleton.warnings,
              Contains(HasSubstr("6 of 160 frames are not explained by rigid segments and noise of")));
  EXPECT_THAT(fit.skeleton.warnings, Each(Not(AnyOf(HasSubstr("'s0m1' moves on its segment by"),
                                                    HasSubstr("'s1m2' moves on its segment by")))));
}

TEST(FitArticulated, RigidSegmentsGiveNothingToWarnOf) {
  const Limb limb =
      make_limb({.frames = 240, .markers_per_segment = 5, .stagger_m = 0.03, .rotation_hz = 0.5, .seed = 9});
  EXPECT_THAT(fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value().skeleton.warnings,
              IsEmpty());
}

TEST(FitArticulated, NeedsNoCompleteFrame) {
  Limb limb = make_limb({.frames = 160, .markers_per_segment = 4, .stagger_m = 0.02, .seed = 11});
  for (std::int64_t f = 0; f < 160; ++f)
    limb.markers.set_missing(f, static_cast<std::int64_t>(f % 4) + (f % 8 < 4 ? 0 : 4));
  const auto fit = fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid)).value();
  EXPECT_EQ(fit.joints[0].determined, 160);
  EXPECT_LT(rms(limb, fit.skeleton, CentreState::determined, CentreState::determined), 0.0035);
}

TEST(FitArticulated, SoftTissueGivesALooseMarkerANoiseOfItsOwn) {
  Limb limb = make_limb({.frames = 150, .markers_per_segment = 5, .stagger_m = 0.03, .seed = 14});
  limb.layout.segments[1].markers.pop_back();
  Random skin(14, 9);
  for (std::int64_t f = 0; f < 150; ++f)
    for (double& c : limb.markers.x(f, 6)) c += 0.008 * skin.gaussian();
  auto options = alone(SegmentKind::solid);
  options.robust = false;
  const auto plain = fit_articulated(limb.markers, limb.layout, options).value();
  options.soft_tissue = true;
  const auto soft = fit_articulated(limb.markers, limb.layout, options).value();
  EXPECT_THAT(plain.skeleton.warnings, Contains(HasSubstr("marker 's1m1' moves on its segment by")));
  EXPECT_LT(rms(limb, soft.skeleton, CentreState::determined, CentreState::determined),
            0.7 * rms(limb, plain.skeleton, CentreState::determined, CentreState::determined));
  ASSERT_EQ(soft.marker_noise_sd_m.size(), 10U);
  for (std::size_t m = 0; m < 9; ++m) {
    EXPECT_EQ(plain.marker_noise_sd_m[m], plain.skeleton.noise_sd_m);
    EXPECT_NEAR(soft.marker_noise_sd_m[m], m == 6 ? 0.008 : 0.001, m == 6 ? 0.0015 : 0.0004) << m;
  }
  EXPECT_TRUE(std::isnan(soft.marker_noise_sd_m[9])) << "not in the layout";
  // The covariance knows: errors are as large as it says.
  double z2 = 0.0;
  for (std::int64_t f = 0; f < 150; ++f)
    z2 += error_of(limb, soft.skeleton, f, 0).squaredNorm() / soft.skeleton.centre_covariance(f, 0).trace() /
          150.0;
  EXPECT_THAT(z2, AllOf(Gt(0.6), Lt(1.6)));
}

TEST(FitArticulated, SaysInOneSentenceWhatCannotBeKnown) {
  const Limb limb = make_limb({.frames = 50, .stagger_m = 0.02, .seed = 12});
  const auto message = [&](const data::SegmentLayout& layout, const ArticulatedOptions& options) {
    return fit_articulated(limb.markers, layout, options).error().message;
  };
  data::SegmentLayout layout{.segments = {{.name = "arm", .markers = {0, 1, 2, 3, 4, 5}}}};
  EXPECT_THAT(message(layout, {}), HasSubstr("all markers are on segment 'arm'"));
  layout = {.segments = {{.name = "a", .markers = {0}}, {.name = "b", .markers = {3}}},
            .joints = {{.name = "j", .parent = 0, .child = 1}}};
  EXPECT_THAT(message(layout, {}), HasSubstr("2 markers in all"));
  layout = limb.layout;
  layout.joints.clear();
  EXPECT_THAT(message(layout, {}), HasSubstr("no joint"));
  layout = limb.layout;
  layout.segments[1].markers = {2, 3};
  EXPECT_THAT(message(layout, {}), HasSubstr("marker 2 is on 's1'"));
  EXPECT_THAT(message(limb.layout, {.kinds = {SegmentKind::line}}), HasSubstr("1 kinds for 2 segments"));
  EXPECT_THAT(message(limb.layout, {.noise_sd_m = -1.0}), HasSubstr("noise"));
  EXPECT_THAT(message(limb.layout, {.max_fit_frames = 3}), HasSubstr("20 or more"));
  EXPECT_THAT(message(limb.layout, {.most_noise_m = 0.0}), HasSubstr("0 m of noise"));
  EXPECT_THAT(message(limb.layout, {.most_reach_m = std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("nan m of reach"));
  EXPECT_THAT(message(limb.layout, {.max_bridge_sd_m = 0.0}), HasSubstr("bridged"));
  EXPECT_THAT(message(limb.layout, {.threads = -1}), HasSubstr("threads"));
  auto untimed = limb.markers;
  untimed.time.rate_hz = 0.0;
  EXPECT_THAT(fit_articulated(untimed, limb.layout, {}).error().message, HasSubstr("rate of 0 Hz"));
  untimed.time.rate_hz = std::nan("");
  EXPECT_THAT(fit_articulated(untimed, limb.layout, {}).error().message, HasSubstr("rate of nan Hz"));
  const auto empty = data::Trajectories::all_missing(limb.markers.names, limb.markers.time);
  EXPECT_THAT(fit_articulated(empty, limb.layout, {}).error().message, HasSubstr("frames"));
  EXPECT_EQ(fit_articulated(limb.markers, limb.layout, alone(SegmentKind::solid),
                            [](std::int64_t, std::int64_t) { return false; })
                .error()
                .code,
            Code::cancelled);
}

}  // namespace
}  // namespace kinemark::skeleton
