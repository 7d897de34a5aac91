// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/functional.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::centre_error;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::make_chain;
using ::testing::Not;
using testing::Rotations;

constexpr FunctionalMethod kAll[] = {FunctionalMethod::score,    FunctionalMethod::sara,
                                     FunctionalMethod::gamage,   FunctionalMethod::gamage_plain,
                                     FunctionalMethod::cylinder, FunctionalMethod::constant_distance};

TEST(Functional, NamesReadBack) {
  for (const auto method : kAll) EXPECT_EQ(parse_functional_method(to_string(method)).value(), method);
  EXPECT_EQ(parse_functional_method("best").error().code, Code::usage);
  for (const auto sides : {Sides::both, Sides::parent, Sides::child})
    EXPECT_EQ(parse_sides(to_string(sides)).value(), sides);
  EXPECT_FALSE(parse_sides("left"));
}

TEST(Functional, EveryMethodFindsTheJointsOfAChain) {
  const auto chain = make_chain(
      {.lengths_m = {0.12, 0.15, 0.16, 0.08}, .per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005});
  for (const auto method :
       {FunctionalMethod::score, FunctionalMethod::gamage, FunctionalMethod::gamage_plain}) {
    const auto skeleton = find_joints(chain.markers, chain.layout, {.method = method});
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    EXPECT_TRUE(skeleton->validate()) << skeleton->validate().error().message;
    ASSERT_EQ(skeleton->joints.size(), 3U);
    EXPECT_TRUE(skeleton->warnings.empty());
    for (std::int64_t j = 0; j < 3; ++j) {
      EXPECT_LT(centre_error(*skeleton, chain, j).rms_m, 0.0015) << to_string(method);
      EXPECT_EQ(centre_error(*skeleton, chain, j).share, 1.0);
      EXPECT_EQ(skeleton->joints[static_cast<std::size_t>(j)].kind, data::JointKind::ball);
    }
    ASSERT_EQ(skeleton->lengths.size(), 2U);
    EXPECT_NEAR(skeleton->lengths[0].length_m, 0.15, 4.0 * skeleton->lengths[0].sd_m + 1e-4);
    EXPECT_LT(skeleton->lengths[0].sd_m, 1e-3);
    EXPECT_NEAR(skeleton->noise_sd_m, 0.0005, 5e-5);
  }
}

TEST(Functional, SidesAgreeOnExactData) {
  const auto chain = make_chain({.per_segment = 4, .rotations = Rotations::cone});
  for (const auto method : {FunctionalMethod::score, FunctionalMethod::gamage})
    for (const auto sides : {Sides::both, Sides::parent, Sides::child}) {
      const auto skeleton = find_joints(chain.markers, chain.layout, {.method = method, .sides = sides});
      ASSERT_TRUE(skeleton);
      EXPECT_LT(centre_error(*skeleton, chain, 0).rms_m, 1e-6);
      EXPECT_TRUE(skeleton->warnings.empty());
      EXPECT_EQ(skeleton->joints[0].covariance_in_parent.allFinite(), sides != Sides::child);
      EXPECT_EQ(skeleton->joints[0].covariance_in_child.allFinite(), sides != Sides::parent);
    }
}

TEST(Functional, TheDataChooseTheHinge) {
  const auto chain = make_chain({.per_segment = 4,
                                 .stagger_m = 0.03,
                                 .rotations = Rotations::hinge,
                                 .range_rad = 1.0,
                                 .noise_sd_m = 0.0005});
  for (const auto method : {FunctionalMethod::score, FunctionalMethod::sara, FunctionalMethod::cylinder}) {
    const auto skeleton = find_joints(chain.markers, chain.layout, {.method = method});
    ASSERT_TRUE(skeleton);
    const auto& joint = skeleton->joints[0];
    EXPECT_EQ(joint.kind, data::JointKind::hinge);
    EXPECT_NEAR(joint.axis_in_parent.norm(), 1.0, 1e-9);
    EXPECT_NE(joint.description.find("axis direction known"), std::string::npos) << joint.description;
    EXPECT_NE(joint.description.find("position along it not"), std::string::npos) << joint.description;
    EXPECT_NEAR(joint.range_of_motion_rad, 1.0, 0.05);
  }
  const auto forced = find_joints(chain.markers, chain.layout, {.kind = data::JointChoice::ball});
  EXPECT_EQ(forced->joints[0].kind, data::JointKind::ball);
}

TEST(Functional, CovarianceOfEveryFrameIsHonest) {
  double squares = 0.0;
  int inside = 0, count = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const auto chain =
        make_chain({.frames = 200, .per_segment = 5, .noise_sd_m = 0.001, .missing = 0.15, .seed = seed});
    const auto skeleton = find_joints(chain.markers, chain.layout);
    ASSERT_TRUE(skeleton);
    for (std::int64_t f = 0; f < 200; ++f) {
      if (skeleton->state[skeleton->index(f, 0)] == data::CentreState::undetermined) continue;
      const Eigen::Vector3d d = skeleton->centre(f, 0) - chain.centres[0].col(f);
      const double z2 = d.x() * d.x() / skeleton->centre_covariance(f, 0)(0, 0);
      squares += z2;
      inside += z2 < 3.841;
      ++count;
    }
  }
  EXPECT_NEAR(static_cast<double>(inside) / count, 0.95, 0.03);
  EXPECT_NEAR(squares / count, 1.0, 0.25);
}

TEST(Functional, TwoMarkersOnOneSideAreEnoughForASphere) {
  auto chain = make_chain({.per_segment = 4});
  chain.layout.segments[1].markers.resize(2);
  const auto skeleton = find_joints(chain.markers, chain.layout);
  ASSERT_TRUE(skeleton) << skeleton.error().message;
  EXPECT_LT(centre_error(*skeleton, chain, 0).rms_m, 1e-6);
  ASSERT_EQ(skeleton->warnings.size(), 1U);
  EXPECT_NE(skeleton->warnings[0].find("'s1' has no pose"), std::string::npos) << skeleton->warnings[0];
  EXPECT_EQ(skeleton->joints[0].method, "Gamage-Lasenby");
}

TEST(Functional, ConstantDistanceIsSelectable) {
  const auto chain = make_chain({.stagger_m = 0.03, .noise_sd_m = 0.0005, .missing = 0.1});
  const auto skeleton =
      find_joints(chain.markers, chain.layout, {.method = FunctionalMethod::constant_distance});
  ASSERT_TRUE(skeleton);
  EXPECT_TRUE(skeleton->validate());
  EXPECT_EQ(skeleton->joints[0].method, "constant distance");
  int ambiguous = 0;
  for (const auto state : skeleton->state) ambiguous += state == data::CentreState::ambiguous;
  EXPECT_GT(ambiguous, 0);
  EXPECT_FALSE(skeleton->joints[0].description.contains("distances of the markers from the joint keep to"));
}

TEST(Functional, JointsOfLinesAreKnownByTheirDistancesAlone) {
  const auto chain = make_chain({.stagger_m = 0.0, .noise_sd_m = 0.0005});
  const auto skeleton =
      find_joints(chain.markers, chain.layout, {.method = FunctionalMethod::constant_distance});
  ASSERT_TRUE(skeleton) << skeleton.error().message;
  EXPECT_TRUE(skeleton->joints[0].description.contains("distances of the markers from the joint keep to 0."))
      << skeleton->joints[0].description;
}

TEST(Functional, OfAJointThatIsNotPlacedNothingIsKnown) {
  auto chain = make_chain({.lengths_m = {0.150, 0.160, 0.150}, .per_segment = 4});
  chain.layout.segments[1].markers.resize(2);
  chain.layout.segments[2].markers.resize(2);
  const auto skeleton = find_joints(chain.markers, chain.layout);
  ASSERT_TRUE(skeleton) << skeleton.error().message;
  EXPECT_FALSE(skeleton->joints[0].description.contains("nothing can be known"));
  EXPECT_EQ(skeleton->joints[1].description, "nothing can be known");
}

std::string message_of(const Result<data::Skeleton>& skeleton) {
  return skeleton ? std::string() : skeleton.error().message;
}

TEST(Functional, OneSentenceForWhatCannotBe) {
  auto chain = make_chain({.frames = 50, .stagger_m = 0.0});
  EXPECT_NE(message_of(find_joints(chain.markers, chain.layout)).find("not on a line"), std::string::npos);
  auto two = make_chain({.frames = 50, .per_segment = 1});
  EXPECT_NE(message_of(find_joints(two.markers, two.layout)).find("three markers"), std::string::npos);
  auto one = chain.layout;
  one.segments.resize(1);
  one.joints.clear();
  EXPECT_NE(message_of(find_joints(chain.markers, one)).find("on one segment"), std::string::npos);
  auto none = chain.layout;
  none.joints.clear();
  EXPECT_NE(message_of(find_joints(chain.markers, none)).find("no joint"), std::string::npos);
  FunctionalOptions options;
  options.noise_sd_m = -1.0;
  EXPECT_EQ(find_joints(chain.markers, chain.layout, options).error().code, Code::usage);
  options.noise_sd_m = 0.0;
  options.mask.assign(3, 1);
  EXPECT_EQ(find_joints(chain.markers, chain.layout, options).error().code, Code::usage);
}

TEST(Functional, AJointThatNeverMovesIsReturnedWide) {
  const auto chain = make_chain({.per_segment = 4,
                                 .stagger_m = 0.03,
                                 .rotations = Rotations::cone,
                                 .range_rad = 0.0,
                                 .noise_sd_m = 0.001});
  const auto skeleton = find_joints(chain.markers, chain.layout);
  ASSERT_TRUE(skeleton);
  EXPECT_GT(skeleton->joints[0].covariance_in_parent.trace(), 0.05 * 0.05);
  EXPECT_EQ(skeleton->joints[0].description.find("centre known"), std::string::npos)
      << skeleton->joints[0].description;
}

TEST(Functional, SwappedLabelsAreReportedAndLeftOut) {
  auto chain = make_chain({.per_segment = 4, .noise_sd_m = 0.0005});
  for (std::int64_t f = 60; f < 70; ++f) {
    const Eigen::Vector3d x = chain.markers.x(f, 0);
    chain.markers.x(f, 0) = chain.markers.x(f, 5);
    chain.markers.x(f, 5) = x;
  }
  const auto skeleton = find_joints(chain.markers, chain.layout);
  ASSERT_TRUE(skeleton);
  ASSERT_EQ(skeleton->warnings.size(), 2U);
  EXPECT_NE(skeleton->warnings[0].find("do not keep their shape in 10 frames, first at 1.000 s"),
            std::string::npos)
      << skeleton->warnings[0];
  EXPECT_NE(skeleton->warnings[0].find(
                " mm usually): labels swapped, or a marker elsewhere? These frames were left out."),
            std::string::npos);
  EXPECT_LT(centre_error(*skeleton, chain, 0).rms_m, 0.003);
}

/// The chain in another frame: every sample rotated, shifted and scaled.
data::Trajectories moved(const data::Trajectories& from, const Eigen::Matrix3d& R, const Eigen::Vector3d& t,
                         double scale) {
  data::Trajectories to = from;
  for (std::int64_t f = 0; f < from.frames(); ++f)
    for (std::int64_t m = 0; m < from.markers(); ++m)
      if (from.present(f, m)) to.x(f, m) = scale * (R * from.x(f, m)) + t;
  return to;
}

// Where the room's axes point, where its origin is and in what unit it is measured changes no method's
// answer.
TEST(Functional, CentresTurnShiftAndScaleWithTheRoom) {
  const auto chain = make_chain({.frames = 200,
                                 .per_segment = 4,
                                 .stagger_m = 0.03,
                                 .rotations = Rotations::cone,
                                 .noise_sd_m = 0.0005});
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d t(3.0, -1.0, 2.0);
  for (const auto method :
       {FunctionalMethod::score, FunctionalMethod::gamage, FunctionalMethod::gamage_plain}) {
    const FunctionalOptions options{.method = method, .kind = data::JointChoice::ball};
    const auto plain = find_joints(chain.markers, chain.layout, options).value();
    for (const double scale : {1.0, 10.0}) {
      const auto other = find_joints(moved(chain.markers, R, t, scale), chain.layout, options).value();
      EXPECT_NEAR(other.noise_sd_m / plain.noise_sd_m, scale, 1e-4 * scale) << to_string(method);
      for (const std::int64_t f : {0, 77, 199}) {
        const Eigen::Vector3d expected = scale * (R * plain.centre(f, 0)) + t;
        EXPECT_LT((other.centre(f, 0) - expected).norm(), 1e-5 * scale) << to_string(method);
        EXPECT_NEAR(other.centre_covariance(f, 0).trace() / plain.centre_covariance(f, 0).trace(),
                    scale * scale, 0.01 * scale * scale);
      }
    }
  }
}

TEST(Functional, NamesAndOrderOfMarkersDoNotMatter) {
  const auto chain = make_chain({.frames = 150, .per_segment = 5, .noise_sd_m = 0.0005, .missing = 0.1});
  auto permuted = chain;
  for (auto& segment : permuted.layout.segments) std::reverse(segment.markers.begin(), segment.markers.end());
  for (auto& name : permuted.markers.names) name = "any " + name;
  const auto a = find_joints(chain.markers, chain.layout).value();
  const auto b = find_joints(permuted.markers, permuted.layout).value();
  for (std::int64_t f = 0; f < 150; ++f) {
    ASSERT_EQ(a.state[a.index(f, 0)], b.state[b.index(f, 0)]) << f;
    if (a.state[a.index(f, 0)] == data::CentreState::undetermined) continue;
    EXPECT_LT((a.centre(f, 0) - b.centre(f, 0)).norm(), 1e-6) << f;
  }
}

// A masked sample is a missing one, whatever stands in its place.
TEST(Functional, MasksHideEvenAbsurdSamples) {
  auto chain = make_chain({.frames = 200, .per_segment = 5, .noise_sd_m = 0.0005});
  const auto plain = find_joints(chain.markers, chain.layout).value();
  FunctionalOptions options;
  options.mask.assign(chain.markers.state.size(), 1);
  for (std::int64_t f = 0; f < 200; f += 4) {
    options.mask[chain.markers.index(f, 2)] = 0;
    chain.markers.x(f, 2) = Eigen::Vector3d::Constant(1e6);
  }
  const auto masked = find_joints(chain.markers, chain.layout, options).value();
  EXPECT_LT(centre_error(masked, chain, 0).rms_m, 1.5 * centre_error(plain, chain, 0).rms_m);
  EXPECT_TRUE(masked.warnings.empty());
}

TEST(Functional, AFrameOrNoneIsASentence) {
  for (const std::int64_t frames : {1, 2}) {
    const auto chain = make_chain({.frames = frames, .per_segment = 4});
    for (const auto method : kAll) {
      const auto found = find_joints(chain.markers, chain.layout, {.method = method});
      if (!found) {
        EXPECT_FALSE(found.error().message.empty()) << to_string(method);
        continue;
      }
      // What can be said of one frame is wide, or nothing; but eight distances that do not change between two
      // frames are more than the six numbers of two centres.
      if (method == FunctionalMethod::constant_distance && frames == 2) continue;
      const bool open = found->state[0] == data::CentreState::undetermined;
      EXPECT_TRUE(open || !(found->centre_covariance(0, 0).trace() < 1e-6)) << to_string(method);
    }
  }
  auto chain = make_chain({.frames = 20, .per_segment = 4});
  for (std::int64_t f = 0; f < 20; ++f)
    for (std::int64_t m = 0; m < chain.markers.markers(); ++m) chain.markers.set_missing(f, m);
  for (const auto method : kAll) {
    const auto found = find_joints(chain.markers, chain.layout, {.method = method});
    if (!found) continue;
    for (const auto state : found->state)
      EXPECT_EQ(state, data::CentreState::undetermined) << to_string(method);
  }
}

TEST(Functional, TheReportsMethodSaysOnWhichMarkersItRests) {
  auto chain = testing::make_chain({.frames = 400, .stagger_m = 0.02});
  const auto whole =
      find_joints(chain.markers, chain.layout, {.method = FunctionalMethod::constant_distance}).value();
  EXPECT_THAT(whole.warnings, Not(Contains(HasSubstr("no two frames show all"))));
  for (std::int64_t f = 0; f < 400; ++f) chain.markers.set_missing(f, f % 10 == 0 ? 0 : 5);
  const auto part =
      find_joints(chain.markers, chain.layout, {.method = FunctionalMethod::constant_distance}).value();
  EXPECT_THAT(
      part.warnings,
      Contains(HasSubstr(
          "no two frames show all 6 markers; the distances are those of 5 markers in 30 of the 360 frames")));
}

}  // namespace
}  // namespace kinemark::skeleton
