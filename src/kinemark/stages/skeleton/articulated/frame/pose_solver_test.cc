// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::SegmentKind;
using testing_limbs::hide;
using testing_limbs::make_random_chain;
using testing_limbs::random_rotation;
using testing_limbs::RandomChain;

// Four segments of all kinds, one of them a branch, with noise and two markers hidden.
struct MixedTree {
  Chain chain{{.parent = {0, 0, 2}, .segment_of_marker = {0, 0, 0, 1, 1, 2, 2, 2, 3, 3}},
              {SegmentKind::solid, SegmentKind::line, SegmentKind::plane, SegmentKind::line}};
  ChainPose pose;
  ChainSamples samples;

  MixedTree() {
    Random random(7, 1);
    Eigen::VectorXd offsets(chain.geometry_parameters().size());
    for (double& offset : offsets) offset = random.uniform(-0.15, 0.15);
    chain.move_geometry(offsets);
    for (int s = 0; s < 4; ++s) pose.rotation.push_back(random_rotation(random));
    pose.joint0 = Vector3d(0.4, -0.1, 0.9);
    samples = {.frames = 1, .markers = 10, .x = {}};
    for (int k = 0; k < 10; ++k) {
      const Vector3d x = chain.predict(pose, k);
      for (int i = 0; i < 3; ++i) {
        const double error = 0.01 * random.gaussian();
        samples.x.push_back(x[i] + error);
      }
    }
    hide(samples, 0, 2);
    hide(samples, 0, 8);
  }
  [[nodiscard]] double brute_cost(const Chain& c, const ChainPose& p) const {
    double sum = 0.0;
    for (int k = 0; k < 10; ++k) {
      if (samples.seen(0, k))
        sum += (Eigen::Map<const Vector3d>(samples.frame(0) + 3 * k) - c.predict(p, k)).squaredNorm();
    }
    return sum;
  }
  [[nodiscard]] ChainPose moved(int parameter, double step, int other = 0, double other_step = 0.0) const {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(chain.frame_parameters());
    change[parameter] += step;
    change[other] += other_step;
    ChainPose out = pose;
    move_pose(chain, change, out);
    return out;
  }
};

TEST(PoseSolver, CostIsTheSumOfSquaredDistances) {
  const MixedTree tree;
  PoseSolver solver(tree.chain);
  solver.set(tree.samples.frame(0));
  EXPECT_EQ(solver.sums().seen, 8);
  EXPECT_NEAR(solver.cost(tree.pose), tree.brute_cost(tree.chain, tree.pose), 1e-14);
}

TEST(PoseSolver, WeightsMultiplyAndZeroMeansNotSeen) {
  const MixedTree tree;
  PoseSolver solver(tree.chain);
  std::vector<double> weights(10, 2.0);
  solver.set(tree.samples.frame(0), weights);
  EXPECT_NEAR(solver.cost(tree.pose), 2.0 * tree.brute_cost(tree.chain, tree.pose), 1e-14);
  weights[0] = 0.0;
  solver.set(tree.samples.frame(0), weights);
  EXPECT_EQ(solver.sums().seen, 7);
}

TEST(PoseSolver, GradientAgreesWithDifferences) {
  const MixedTree tree;
  PoseSolver solver(tree.chain);
  solver.set(tree.samples.frame(0));
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  solver.normal(tree.pose, {}, false, H, b);
  const double h = 1e-6;
  for (int i = 0; i < tree.chain.frame_parameters(); ++i) {
    const double slope =
        (tree.brute_cost(tree.chain, tree.moved(i, h)) - tree.brute_cost(tree.chain, tree.moved(i, -h))) /
        (2.0 * h);
    EXPECT_NEAR(b[i], -0.5 * slope, 1e-8) << i;
  }
}

// The normal matrix is J^T J of the predicted positions.
TEST(PoseSolver, NormalMatrixIsTheSquaredJacobian) {
  const MixedTree tree;
  PoseSolver solver(tree.chain);
  solver.set(tree.samples.frame(0));
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  solver.normal(tree.pose, {}, false, H, b);
  const int n = tree.chain.frame_parameters();
  const double h = 1e-6;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < 10; ++k) {
    if (!tree.samples.seen(0, k)) continue;
    Eigen::Matrix3Xd J(3, n);
    for (int i = 0; i < n; ++i) {
      J.col(i) =
          (tree.chain.predict(tree.moved(i, h), k) - tree.chain.predict(tree.moved(i, -h), k)) / (2.0 * h);
    }
    expected += J.transpose() * J;
  }
  EXPECT_LT((H - expected).cwiseAbs().maxCoeff(), 1e-8);
}

// For lines the observed information is the full second derivative.
TEST(PoseSolver, ObservedInformationOfLinesIsTheSecondDerivative) {
  MixedTree tree;
  for (SegmentKind& kind : tree.chain.kind) kind = SegmentKind::line;
  Chain lines(tree.chain.layout, tree.chain.kind);
  lines.marker.row(2) = tree.chain.marker.row(2);
  lines.joint.row(2) = tree.chain.joint.row(2);
  lines.joint(2, 2) = 0.1;
  tree.chain = lines;
  PoseSolver solver(tree.chain);
  solver.set(tree.samples.frame(0));
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  solver.normal(tree.pose, {}, true, H, b);
  const double h = 1e-4;
  const auto value = [&](int i, double di, int j, double dj) {
    return tree.brute_cost(tree.chain, tree.moved(i, di, j, dj));
  };
  for (int i = 0; i < tree.chain.frame_parameters(); ++i) {
    const double second =
        (value(i, h, 0, 0.0) - 2.0 * value(i, 0.0, 0, 0.0) + value(i, -h, 0, 0.0)) / (h * h);
    EXPECT_NEAR(H(i, i), 0.5 * second, 2e-5) << i;
    for (int j = 0; j < i; ++j) {
      // Turns about x and y of one segment do not commute; their mean is the symmetric derivative.
      const double mixed =
          (value(i, h, j, h) - value(i, h, j, -h) - value(i, -h, j, h) + value(i, -h, j, -h)) / (4.0 * h * h);
      EXPECT_NEAR(H(i, j), 0.5 * mixed, 2e-5) << i << ' ' << j;
    }
  }
}

TEST(PoseSolver, DerivativesByTheGeometryAgreeWithDifferences) {
  const MixedTree tree;
  PoseSolver solver(tree.chain);
  solver.set(tree.samples.frame(0));
  const auto n = static_cast<Eigen::Index>(tree.chain.geometry_parameters().size());
  Eigen::MatrixXd G;
  Eigen::MatrixXd Hgg = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd bg = Eigen::VectorXd::Zero(n);
  solver.linearize_geometry(tree.pose, tree.samples.frame(0), {}, G, &Hgg, &bg);
  const double h = 1e-6;
  const int nf = tree.chain.frame_parameters();
  Eigen::MatrixXd expected_G = Eigen::MatrixXd::Zero(nf, n);
  Eigen::MatrixXd expected_H = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd expected_b = Eigen::VectorXd::Zero(n);
  for (int k = 0; k < 10; ++k) {
    if (!tree.samples.seen(0, k)) continue;
    Eigen::Matrix3Xd A(3, nf);
    Eigen::Matrix3Xd B(3, n);
    for (int i = 0; i < nf; ++i) {
      A.col(i) =
          (tree.chain.predict(tree.moved(i, h), k) - tree.chain.predict(tree.moved(i, -h), k)) / (2.0 * h);
    }
    for (Eigen::Index g = 0; g < n; ++g) {
      Chain up = tree.chain;
      Chain down = tree.chain;
      up.move_geometry(h * Eigen::VectorXd::Unit(n, g));
      down.move_geometry(-h * Eigen::VectorXd::Unit(n, g));
      B.col(g) = (up.predict(tree.pose, k) - down.predict(tree.pose, k)) / (2.0 * h);
    }
    expected_G += A.transpose() * B;
    expected_H += B.transpose() * B;
    expected_b += B.transpose() * (Eigen::Map<const Vector3d>(tree.samples.frame(0) + 3 * k) -
                                   tree.chain.predict(tree.pose, k));
  }
  EXPECT_LT((G - expected_G).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((Hgg - expected_H).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((bg - expected_b).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PoseSolver, JointJacobianAgreesWithDifferences) {
  const MixedTree tree;
  const PoseSolver solver(tree.chain);
  const double h = 1e-6;
  Eigen::Matrix3Xd by_frame;
  Eigen::Matrix3Xd by_geometry;
  for (int j = 0; j < 3; ++j) {
    solver.joint_jacobian(tree.pose, j, by_frame, by_geometry);
    for (int i = 0; i < tree.chain.frame_parameters(); ++i) {
      const Vector3d slope =
          (tree.chain.joint_centre(tree.moved(i, h), j) - tree.chain.joint_centre(tree.moved(i, -h), j)) /
          (2.0 * h);
      EXPECT_LT((by_frame.col(i) - slope).norm(), 1e-9) << j << ' ' << i;
    }
    for (Eigen::Index g = 0; g < by_geometry.cols(); ++g) {
      Chain up = tree.chain;
      up.move_geometry(h * Eigen::VectorXd::Unit(by_geometry.cols(), g));
      EXPECT_LT(
          (by_geometry.col(g) - (up.joint_centre(tree.pose, j) - tree.chain.joint_centre(tree.pose, j)) / h)
              .norm(),
          1e-8);
    }
  }
}

TEST(PoseSolver, RefineReturnsToAnExactPose) {
  const RandomChain limb = make_random_chain({.segments = 3, .frames = 20, .noise_sd_m = 0.0});
  PoseSolver solver(limb.chain);
  Random random(9, 1);
  for (int f = 0; f < 20; ++f) {
    ChainPose pose = limb.pose[f];
    Eigen::VectorXd step(limb.chain.frame_parameters());
    for (double& value : step) value = 0.2 * random.gaussian();
    move_pose(limb.chain, step, pose);
    solver.set(limb.samples.frame(f));
    EXPECT_LT(solver.refine(pose), 1e-12);
    for (int j = 0; j < 2; ++j) {
      EXPECT_LT((limb.chain.joint_centre(pose, j) - limb.chain.joint_centre(limb.pose[f], j)).norm(), 1e-6);
    }
  }
}

TEST(PoseSolver, APriorDrawsTheJointAsItsWeightSays) {
  RandomChain limb = make_random_chain({.frames = 1, .noise_sd_m = 0.0});
  for (int k = 1; k < 6; ++k) hide(limb.samples, 0, k);  // one marker: the joint lies on a sphere about it
  PoseSolver solver(limb.chain);
  solver.set(limb.samples.frame(0));
  ChainPose pose = limb.pose[0];
  const Vector3d target = limb.pose[0].joint0;
  pose.joint0 += Vector3d(0.02, -0.01, 0.03);
  const JointPrior prior{.joint = 0, .target = target, .weight = 4.0 * Matrix3d::Identity()};
  EXPECT_LT(solver.refine(pose, {&prior, 1}), 1e-12);
  EXPECT_LT((pose.joint0 - target).norm(), 1e-6);
}

TEST(PoseSolver, ThreeMarkersOrTwoOfALineShowAPose) {
  RandomChain limb = make_random_chain({.segments = 3, .markers_per_segment = 4, .frames = 1});
  PoseSolver solver(limb.chain);
  solver.set(limb.samples.frame(0));
  EXPECT_TRUE(solver.shows_all_joints(0.001));
  EXPECT_FALSE(solver.shows_pose(0, 10.0)) << "narrower than the noise";
  for (const int k : {4, 5}) hide(limb.samples, 0, k);
  solver.set(limb.samples.frame(0));
  EXPECT_FALSE(solver.shows_pose(1, 0.001));
  EXPECT_TRUE(solver.shows_all_joints(0.001)) << "by the segments beside it";
  for (const int k : {0, 1}) hide(limb.samples, 0, k);
  solver.set(limb.samples.frame(0));
  EXPECT_FALSE(solver.shows_all_joints(0.001));
  const RandomChain line = make_random_chain({.frames = 1, .kind = data::SegmentKind::line});
  PoseSolver of_line(line.chain);
  of_line.set(line.samples.frame(0));
  EXPECT_TRUE(of_line.shows_pose(0, 0.001));
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
