// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/mixed_bars.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

Eigen::Matrix3d random_rotation(Random& random) {
  return Eigen::Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
      .normalized()
      .toRotationMatrix();
}

TEST(FarPoints, DistancesOfCornersAreThoseOfRotationsAndOfOrigins) {
  Random random(3, 1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = random_rotation(random), S = random_rotation(random);
    const Eigen::Vector3d p(random.gaussian(), random.gaussian(), random.gaussian()), q(0.3, -0.2, 1.0);
    const auto corners = far_corners();
    const double squares = ((R * corners).colwise() + p - ((S * corners).colwise() + q)).squaredNorm();
    EXPECT_NEAR(squares, kFar_m * kFar_m * (R - S).squaredNorm() + kCorners * (p - q).squaredNorm(),
                1e-9 * squares);
  }
}

TEST(FarPoints, TheirWeightIsThatOfTheAngle) {
  // A small angle e costs e^2 / s^2 beside (distance / noise)^2 of a marker.
  const double s = 0.03, noise = 2e-3, e = 1e-4;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(e, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const double cost = far_weight(noise * noise, s * s) * (R * far_corners() - far_corners()).squaredNorm();
  EXPECT_NEAR(cost / (noise * noise), e * e / (s * s), 1e-6 * e * e / (s * s));
}

TEST(FarPoints, StandBehindTheMarkersOfModelAndRecording) {
  const auto description = testing_body::description();
  const auto with = add_far_points(description, {4, 0});
  ASSERT_EQ(with.markers.size(), description.markers.size() + 2 * kCorners);
  EXPECT_TRUE(with.validate());
  EXPECT_EQ(with.markers[description.markers.size()].body_idx, 4);
  EXPECT_EQ(with.markers.back().body_idx, 0);

  const auto model = model::Model::compile(description).value();
  const auto markers = testing_body::record(model, 2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Matrix3d missing = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Eigen::Vector3d origin(0.1, 0.2, 0.3);
  const auto points =
      add_far_points(markers, {turn, missing, turn, turn}, {origin, origin, origin, Eigen::Vector3d::Zero()});
  ASSERT_TRUE(points.validate()) << points.validate().error().message;
  const auto M = markers.markers();
  EXPECT_EQ(points.markers(), M + 8);
  EXPECT_EQ(points.x(1, 3), markers.x(1, 3));
  EXPECT_TRUE(points.present(0, M));
  EXPECT_FALSE(points.present(0, M + 4));
  EXPECT_TRUE(points.present(1, M + 4));
  EXPECT_LT((points.x(0, M + 1) - (origin + turn * far_corners().col(1))).norm(), 1e-12);
  EXPECT_LT((points.x(1, M + 7) - turn * far_corners().col(3)).norm(), 1e-12);
}

constexpr double kMarker = 2e-3;  // m
constexpr double kSensor = 0.03;  // rad

/// The body in one frame, with sensors on trunk and shank; shank and kneecap have no markers.
struct OneFrame {
  data::ModelDescription description = testing_body::description();
  Problem problem;
  data::Trajectories points;
  Eigen::MatrixXd states;
  TurnedBodies sensors;
  MarkerVariances variances;
  data::JointMotion motion;

  explicit OneFrame(const std::vector<int>& bodies = {0, 4}, const char* locked = nullptr) {
    if (locked != nullptr)
      description.coordinates[static_cast<std::size_t>(description.find_coordinate(locked))].locked = true;
    description.markers.resize(10);
    const auto plain = model::Model::compile(description).value();
    const auto markers = testing_body::record(plain, 1);
    const auto model = model::Model::compile(add_far_points(description, bodies)).value();
    states = model::state_from_coordinates(model, testing_body::coordinates(model, 0));
    model::Workspace w(model);
    model::kinematics(model, w, states.col(0));
    std::vector<Eigen::Vector3d> origin;
    for (const int body : bodies) {
      const int b = model.body_of(body);
      sensors.body.push_back(b);
      sensors.turned.push_back(w.rotation[static_cast<std::size_t>(b)]);
      sensors.by_heading.emplace_back(0.0, 1.0, 0.0);
      sensors.placing_variance.push_back(0.0);
      sensors.placing_share.push_back(0.0);
      origin.push_back(w.position[static_cast<std::size_t>(b)]);
    }
    sensors.noise_variance = kSensor * kSensor;
    sensors.marker_variance = kMarker * kMarker;
    points = add_far_points(markers, sensors.turned, origin);
    problem = make_problem(model, points, {.judge_samples = false}).value();
    variances.own.setConstant(model.marker_count(), 2.0 * kFar_m * kFar_m * kSensor * kSensor);
    variances.own.head(10).setConstant(kMarker * kMarker);
    variances.common.setZero(static_cast<Eigen::Index>(model.bodies().size()));
    data::set_coordinates(description, motion);
    motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1};
    const Eigen::VectorXd q = testing_body::coordinates(model, 0);
    motion.q.assign(q.data(), q.data() + q.size());
  }

  void compute() { compute_mixed_bars(problem, points, states, variances, sensors, 1, motion); }

  /// Markers in m and turns in rad, each over its noise, and coordinates: by small steps of the speeds.
  void differentiate(Eigen::MatrixXd& J, Eigen::MatrixXd& E) const {
    const auto& model = problem.model;
    model::Workspace w(model);
    const Eigen::VectorXd x = states.col(0);
    const double h = 1e-6;
    const auto S = static_cast<Eigen::Index>(sensors.size());
    J.resize(30 + 3 * S, model.speed_count());
    E.resize(model.coordinate_count(), model.speed_count());
    const Eigen::VectorXd q0 = testing_body::coordinates(model, 0);
    for (Eigen::Index i = 0; i < model.speed_count(); ++i) {
      Eigen::VectorXd columns[2], q[2];
      for (const int side : {0, 1}) {
        Eigen::VectorXd to = x, step = Eigen::VectorXd::Zero(model.speed_count());
        step[i] = side == 0 ? -h : h;
        model::integrate(model, to, step);
        model::kinematics(model, w, to);
        columns[side].resize(30 + 3 * S);
        for (Eigen::Index m = 0; m < 10; ++m) columns[side].segment<3>(3 * m) = w.marker.col(m) / kMarker;
        for (Eigen::Index s = 0; s < S; ++s) {
          const auto body = static_cast<std::size_t>(sensors.body[static_cast<std::size_t>(s)]);
          const Eigen::AngleAxisd turn(
              Eigen::Matrix3d(w.rotation[body] * sensors.turned[static_cast<std::size_t>(s)].transpose()));
          columns[side].segment<3>(30 + 3 * s) = turn.angle() * turn.axis() / kSensor;
        }
        q[side] = q0;
        model::coordinates_from_state(model, to, q0, q[side]);
      }
      J.col(i) = (columns[1] - columns[0]) / (2.0 * h);
      E.col(i) = (q[1] - q[0]) / (2.0 * h);
    }
  }
};

TEST(MixedBars, AreThoseOfBothKindsTogether) {
  OneFrame one;
  one.compute();
  Eigen::MatrixXd J, E;
  one.differentiate(J, E);
  const Eigen::MatrixXd covariance = E * (J.transpose() * J).inverse() * E.transpose();
  for (Eigen::Index c = 0; c < covariance.rows(); ++c) {
    const double sd = std::sqrt(covariance(c, c));
    ASSERT_TRUE(one.motion.determined[static_cast<std::size_t>(c)])
        << one.motion.coordinates[static_cast<std::size_t>(c)];
    EXPECT_NEAR(one.motion.q_sd[static_cast<std::size_t>(c)], sd, 2e-3 * sd);
  }
}

TEST(MixedBars, AHeadingTurnsWhatOnlySensorsSay) {
  OneFrame one;
  one.compute();
  const auto without = one.motion.q_sd;
  one.sensors.heading_variance = 0.05 * 0.05;
  one.compute();
  Eigen::MatrixXd J, E;
  one.differentiate(J, E);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(J.rows());
  for (Eigen::Index s = 0; s < 2; ++s) r[30 + 3 * s + 1] = 1.0 / kSensor;
  const Eigen::VectorXd slope = E * (J.transpose() * J).inverse() * J.transpose() * r;
  for (std::size_t c = 0; c < without.size(); ++c) {
    const double sd = std::hypot(without[c], 0.05 * slope[static_cast<Eigen::Index>(c)]);
    EXPECT_NEAR(one.motion.q_sd[c], sd, 5e-3 * sd);
  }
}

TEST(MixedBars, HowSensorsStandAddsToTheirNoise) {
  OneFrame one;
  one.compute();
  const auto knee = one.motion.index(0, one.motion.find("knee"));
  const double exact = one.motion.q_sd[knee];
  one.sensors.placing_share = {0.0, 1.0};
  one.compute();
  const double shared = one.motion.q_sd[knee];
  EXPECT_GT(shared, 1.25 * exact);
  EXPECT_LT(shared, 1.42 * exact);
  one.sensors.placing_share = {0.0, 0.0};
  one.sensors.placing_variance = {0.0, kSensor * kSensor};
  one.compute();
  EXPECT_NEAR(one.motion.q_sd[knee], shared, 1e-9);
}

TEST(MixedBars, WithoutASensorTheKneeIsOpen) {
  OneFrame one({0});
  one.compute();
  const auto knee = one.motion.index(0, one.motion.find("knee"));
  EXPECT_FALSE(one.motion.determined[knee]);
  EXPECT_TRUE(std::isnan(one.motion.q_sd[knee]));
  EXPECT_EQ(one.motion.open_frames[knee], 1);
  EXPECT_TRUE(one.motion.determined[one.motion.index(0, one.motion.find("hip"))]);
}

TEST(MixedBars, SensorsAloneSayNothingOfPositions) {
  OneFrame one({0, 1, 2, 3, 4});
  for (std::int64_t m = 0; m < 10; ++m) one.points.set_missing(0, m);
  one.compute();
  for (const char* name : {"tx", "ty", "tz"})
    EXPECT_FALSE(one.motion.determined[one.motion.index(0, one.motion.find(name))]) << name;
  for (const char* name : {"tilt", "arm_flex", "elbow", "hip", "knee"}) {
    const auto i = one.motion.index(0, one.motion.find(name));
    EXPECT_TRUE(one.motion.determined[i]) << name;
    EXPECT_LT(one.motion.q_sd[i], 3.0 * kSensor) << name;
  }
}

TEST(MixedBars, ALockedCoordinateHasNone) {
  OneFrame one({0, 1, 2, 3, 4}, "elbow");
  for (std::int64_t m = 0; m < 10; ++m) one.points.set_missing(0, m);
  one.sensors.heading_variance = 0.05 * 0.05;
  one.compute();
  const auto elbow = one.motion.index(0, one.motion.find("elbow"));
  EXPECT_TRUE(one.motion.determined[elbow]);
  EXPECT_EQ(one.motion.q_sd[elbow], 0.0);
}

TEST(MixedBars, NoiseOfExactPosesIsNone) {
  const OneFrame one;
  const auto noise = estimate_mixed_noise(one.problem, one.points, one.states, one.sensors);
  EXPECT_NEAR(noise.marker_variance, 0.0, 1e-18);
  EXPECT_NEAR(noise.sensor_variance, 0.0, 1e-12);
}

}  // namespace

}  // namespace kinemark::motion::internal
