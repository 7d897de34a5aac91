// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/camera_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/camera/projection.h"
#include "kinemark/camera/testing/cameras.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"
#include "support/allocations.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

const BodyPoint kF2{.body = "forearm", .x_in_body = {-0.02, -0.25, 0.04}};

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// A pinhole camera at a position, looking at the origin, with 1000 px per unit slope.
data::Camera camera_at(const Vector3d& position) {
  data::Camera camera;
  camera.kind = data::CameraKind::pinhole;
  camera.focal = 1000.0;
  const Vector3d z = -position.normalized(), x = Vector3d::UnitY().cross(z).normalized(), y = z.cross(x);
  camera.cam_from_world.rotation << x.transpose(), y.transpose(), z.transpose();
  camera.cam_from_world.translation = -camera.cam_from_world.rotation * position;
  return camera;
}

/// What cameras see of all markers.
data::ImageTracks film(const data::Trajectories& markers, std::vector<data::Camera> cameras) {
  data::ImageTracks tracks{.names = markers.names,
                           .cameras = std::move(cameras),
                           .noise_sd = {},
                           .time = markers.time,
                           .image = {}};
  tracks.noise_sd.assign(tracks.cameras.size(), 0.5);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (const auto& camera : tracks.cameras)
      for (std::int64_t m = 0; m < markers.markers(); ++m)
        for (const double u : camera::project(camera, markers.x(f, m)).image) tracks.image.push_back(u);
  return tracks;
}

void hide(data::ImageTracks& tracks, std::size_t camera, std::int64_t first, std::int64_t end) {
  for (std::int64_t f = first; f < end; ++f)
    for (std::size_t m = 0; m < tracks.names.size(); ++m)
      tracks.image[tracks.index(f, camera, m)] = tracks.image[tracks.index(f, camera, m) + 1] = kNaN;
}

/// Tracks of one marker "P" at rate_hz 100, image by frame, the same for all cameras.
template <typename Image>
data::ImageTracks one_track(std::vector<data::Camera> cameras, std::int64_t frames, Image&& image) {
  data::ImageTracks tracks{.names = {"P"},
                           .cameras = std::move(cameras),
                           .noise_sd = {},
                           .time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames},
                           .image = {}};
  tracks.noise_sd.assign(tracks.cameras.size(), 0.5);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::size_t c = 0; c < tracks.cameras.size(); ++c) {
      const Vector2d u = image(f);
      tracks.image.insert(tracks.image.end(), {u.x(), u.y()});
    }
  return tracks;
}

Vector2d middle(std::int64_t /*frame*/) { return {300.0, 200.0}; }

/// A body that stands still in its default pose.
struct Still {
  model::Model model = body();
  model::Workspace w{model};
  TaskRows rows;

  Still() {
    model::kinematics(model, w, model.default_state());
    model::velocities(model, w, Eigen::VectorXd::Zero(model.speed_count()));
  }
  const TaskRows& rows_at(const Task& task, double time_s) {
    rows.resize(task.rows(), model.speed_count());
    task.evaluate(model, w, time_s, rows);
    return rows;
  }
};

TEST(CameraTask, VelocityJacobianAndBiasBelongTogether) {
  const auto model = body();
  using camera::imperfect_camera;
  const auto tracks =
      one_track({imperfect_camera(data::CameraKind::pinhole, data::DetectorKind::tetra_lateral, 1),
                 imperfect_camera(data::CameraKind::lateral_effect, data::DetectorKind::tetra_lateral, 2)},
                1, middle);
  const auto task = camera_task(kF2, tracks, "P");
  ASSERT_TRUE(task->bind(model));
  ASSERT_EQ(task->rows(), 4);
  model::Workspace w(model);
  const int n = model.speed_count();
  const Eigen::VectorXd x0 = model::state_from_coordinates(model, testing_body::coordinates(model, 40));
  Eigen::VectorXd v(n), a(n);
  for (int k = 0; k < n; ++k) {
    v[k] = 0.5 * std::sin(1.0 + k);
    a[k] = std::cos(2.0 * k);
  }
  const auto rows_at = [&](double t) {
    Eigen::VectorXd x = x0;
    model::integrate(model, x, v * t + 0.5 * a * t * t);
    model::kinematics(model, w, x);
    model::velocities(model, w, v + a * t);
    TaskRows rows;
    rows.resize(task->rows(), n);
    task->evaluate(model, w, 0.0, rows);
    return rows;
  };
  const double h = 1e-5;
  const TaskRows before = rows_at(-h), after = rows_at(h), now = rows_at(0.0);
  ASSERT_GT(now.weight.minCoeff(), 0.0);
  // Rows of the two cameras differ in size by their units: each is judged by its own.
  for (int row = 0; row < 4; ++row) {
    const double unit = row < 2 ? 1000.0 : 1.0;
    EXPECT_NEAR(now.jacobian.row(row).dot(v), now.velocity[row], 1e-12 * unit) << row;
    const double velocity = (before.error[row] - after.error[row]) / (2.0 * h);  // the goal stands still
    EXPECT_NEAR(velocity, now.velocity[row], 1e-7 * unit) << row;
    const double acceleration = (after.velocity[row] - before.velocity[row]) / (2.0 * h);
    EXPECT_NEAR(acceleration, now.jacobian.row(row).dot(a) + now.bias[row], 1e-6 * unit) << row;
    EXPECT_GT(std::abs(now.bias[row]), 1e-2 * unit) << row;
  }
}

TEST(CameraTask, AnImageCountsLikeTheMetresThatItCovers) {
  auto far = camera_at({6.0, 0.0, 0.0});
  far.aspect = 1.25;
  Still still;
  const auto task =
      camera_task(kF2, one_track({camera_at({3.0, 0.5, 2.0}), far}, 1, middle), "P", {.weight = 2.0});
  ASSERT_TRUE(task->bind(still.model));
  const auto& rows = still.rows_at(*task, 12.0);
  const Vector3d position = model::point_in_world(still.w, still.model.body_of(2), kF2.x_in_body);
  const double depth = (far.cam_from_world * position).z();
  EXPECT_NEAR(rows.weight[2], 2.0 * std::pow(depth / 1000.0, 2), 1e-15);
  EXPECT_NEAR(rows.weight[3], 2.0 * std::pow(depth / 1250.0, 2), 1e-15);
  // The weighted rows hardly change when the same camera counts other units.
  Eigen::MatrixXd J(3, still.model.speed_count());
  model::point_jacobian(still.model, still.w, still.model.body_of(2), position, J);
  const double in_metres =
      (rows.weight.cwiseSqrt().asDiagonal() * rows.jacobian).row(2).norm() / std::sqrt(2.0);
  EXPECT_NEAR(in_metres / (far.cam_from_world.rotation.row(0) * J).norm(), 1.0, 0.1);
  EXPECT_EQ(rows.sd, Eigen::VectorXd::Constant(4, 0.5));
}

TEST(CameraTask, AMovingImageFeedsItsRateForward) {
  Still still;
  const auto tracks = one_track({camera_at({3.0, 0.5, 2.0})}, 200, [](std::int64_t f) {
    const double t = static_cast<double>(f) / 100.0;
    return Vector2d(100.0 * t + 20.0 * t * t, 50.0 - 30.0 * t);
  });
  for (const double cutoff : {0.0, 6.0}) {
    const auto task = camera_task(kF2, tracks, "P", {.cutoff_hz = cutoff});
    ASSERT_TRUE(task->bind(still.model));
    const auto& rows = still.rows_at(*task, 1.005);
    EXPECT_NEAR(rows.goal_velocity[0], 100.0 + 40.2, 1e-2) << cutoff;
    EXPECT_NEAR(rows.goal_velocity[1], -30.0, 1e-2) << cutoff;
    EXPECT_NEAR(rows.goal_acceleration[0], 40.0, 0.5) << cutoff;
    const Vector3d position = model::point_in_world(still.w, still.model.body_of(2), kF2.x_in_body);
    const Vector2d goal = rows.error + camera::project(tracks.cameras[0], position).image;
    EXPECT_NEAR(goal.x(), 100.5 + 20.0 * 1.005 * 1.005, 1e-2) << cutoff;
  }
}

TEST(CameraTask, DeviationIsTheNoiseThatTheLowPassLeaves) {
  Still still;
  Random random(3, 3);
  const auto tracks = one_track({camera_at({3.0, 0.5, 2.0})}, 4000, [&](std::int64_t /*f*/) {
    return Vector2d{0.5 * random.gaussian(), 0.5 * random.gaussian()};  // braces fix the order
  });
  const auto task = camera_task(kF2, tracks, "P");
  ASSERT_TRUE(task->bind(still.model));
  const Vector3d position = model::point_in_world(still.w, still.model.body_of(2), kF2.x_in_body);
  const Vector2d there = camera::project(tracks.cameras[0], position).image;
  double squares = 0.0;
  for (int f = 50; f < 3950; ++f)
    squares += (still.rows_at(*task, f / 100.0).error.head<2>() + there).squaredNorm();
  EXPECT_NEAR(std::sqrt(squares / (2.0 * 3900.0)) / still.rows.sd[0], 1.0, 0.1);
  EXPECT_LT(still.rows.sd[0], 0.25);
}

TEST(CameraTask, FadesBesideGapsButNotAtTheEnds) {
  Still still;
  auto tracks = one_track({camera_at({3.0, 0.5, 2.0}), camera_at({3.0, 0.5, -2.0})}, 100, middle);
  hide(tracks, 0, 40, 60);
  const auto one_frame = tracks.index(50, 0, 0);
  tracks.image[one_frame] = tracks.image[one_frame + 1] = 1.0;  // a single frame is not enough for a goal
  const auto task = camera_task(kF2, tracks, "P");
  ASSERT_TRUE(task->bind(still.model));
  const double full = still.rows_at(*task, 0.0).weight[0];
  const auto share = [&](double time_s) { return still.rows_at(*task, time_s).weight[0] / full; };
  for (const double t : {0.0, 0.1, 0.29, 0.7, 0.99}) EXPECT_NEAR(share(t), 1.0, 1e-9) << t;
  for (const double t : {0.34, 0.65, 1.04, -0.05}) EXPECT_NEAR(share(t), 0.5, 1e-9) << t;
  for (const double t : {0.391, 0.45, 0.5, 0.505, 0.59, 1.1, -0.2}) {
    EXPECT_EQ(share(t), 0.0) << t;
    EXPECT_EQ(still.rows.error.head<2>(), Vector2d::Zero()) << t;
    EXPECT_TRUE(still.rows.jacobian.topRows<2>().isZero()) << t;
  }
  EXPECT_GT(still.rows_at(*task, 0.5).weight[2], 0.0);  // the other camera is not affected
  double before = share(0.25);
  for (int i = 1; i < 500; ++i) {
    const double now = share(0.25 + 1e-3 * i);
    EXPECT_LT(std::abs(now - before), 0.016);  // steepest: 1.5 / 0.1 s
    before = now;
  }
}

TEST(CameraTask, WhatIsBehindTheCameraOrBesideItIsNotSeen) {
  Still still;
  auto behind = camera_at({3.0, 0.5, 2.0}), beside = camera_at({0.0, 0.3, 3.0});
  behind.cam_from_world = camera_at({-3.0, -0.5, -2.0}).cam_from_world;
  behind.cam_from_world.translation += Vector3d(0.0, 0.0, -8.0);
  beside.cam_from_world.translation += Vector3d(20.0, 0.0, -2.0);
  const auto task = camera_task(kF2, one_track({behind, beside}, 1, middle), "P");
  ASSERT_TRUE(task->bind(still.model));
  const auto& rows = still.rows_at(*task, 0.0);
  EXPECT_EQ(rows.weight, Eigen::VectorXd::Zero(4));
  EXPECT_TRUE(rows.jacobian.isZero());
  EXPECT_EQ(rows.error, Eigen::VectorXd::Zero(4));
}

/// The pose of one frame for a second: markers of the trunk, and what cameras see of all.
struct Pose {
  model::Model model = body();
  data::Trajectories trunk;
  Vector3d position;  // of F2
  data::ImageTracks tracks;

  explicit Pose(std::vector<data::Camera> cameras) {
    auto all = testing_body::record(model, 100);
    const std::int64_t last = 30;
    for (std::int64_t f = 0; f < 100; ++f)
      for (std::int64_t m = 0; m < all.markers(); ++m)
        if (f != last) all.x(f, m) = Vector3d(all.x(last, m));
    tracks = film(all, std::move(cameras));
    position = all.x(0, model.description().find_marker("F2"));
    trunk = data::Trajectories::all_missing({"T1", "T2", "T3", "T4"}, all.time);
    for (std::int64_t f = 0; f < 100; ++f)
      for (std::int64_t m = 0; m < 4; ++m) {
        trunk.x(f, m) = all.x(f, m);
        trunk.state[trunk.index(f, m)] = data::SampleState::measured;
      }
  }
  [[nodiscard]] Result<TrackResult> track() const {
    TrackOptions options{.levels = {{.markers = {"*"}, .tasks = {camera_task(kF2, tracks, "F2")}}},
                         .step_s = 2e-3};
    options.damping = 0.02;
    return track_markers(model, trunk, options);
  }
  [[nodiscard]] Vector3d tracked(const data::JointMotion& motion) const {
    Eigen::VectorXd q(motion.size());
    for (std::int64_t c = 0; c < motion.size(); ++c) q[c] = motion.q[motion.index(99, c)];
    model::Workspace w(model);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    return model::point_in_world(w, model.body_of(2), kF2.x_in_body);
  }
};

TEST(CameraTask, OneCameraPutsThePointOntoItsRayAndLeavesTheDepth) {
  const Pose pose({camera_at({3.0, 0.5, 2.0})});
  const auto result = pose.track();
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->rank[99], 8);  // six of the trunk, two of the image
  EXPECT_EQ(result->flagged_frames, 0);
  const auto& camera = pose.tracks.cameras[0];
  const Vector3d found = pose.tracked(result->motion);
  const Vector2d miss = camera::project(camera, found).image - camera::project(camera, pose.position).image;
  EXPECT_LT(miss.norm(), 0.1);
  EXPECT_GT(std::abs((camera.cam_from_world * found).z() - (camera.cam_from_world * pose.position).z()),
            5e-3);
  EXPECT_LT(result->rms_goal_error_m, 1e-3);  // the trunk stays with its markers
}

TEST(CameraTask, TwoCamerasFixThePoint) {
  const Pose pose({camera_at({3.0, 0.5, 2.0}), camera_at({3.0, 0.5, -2.0})});
  const auto result = pose.track();
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->rank[99], 9);
  EXPECT_LT((pose.tracked(result->motion) - pose.position).norm(), 3e-4);
}

TEST(CameraTask, OneCameraOfAPairIsBetterThanNone) {
  const auto model = body();
  const auto markers = testing_body::record(model, 200);
  auto trunk = markers;
  for (std::int64_t m = 4; m < markers.markers(); ++m)
    for (std::int64_t f = 0; f < 200; ++f) trunk.set_missing(f, m);
  // Largest error of the arm's and the leg's angles in frames 70 to 130, rad.
  const auto worst = [&](std::size_t cameras_lost) {
    auto tracks = film(markers, {camera_at({3.0, 0.5, 2.0}), camera_at({3.0, 0.5, -2.0})});
    for (std::size_t c = 0; c < cameras_lost; ++c) hide(tracks, c, 60, 140);
    const auto tasks = camera_tasks(model, tracks).value();
    EXPECT_EQ(tasks.size(), 14U);
    TrackOptions options{.levels = {{.markers = {"*"}, .tasks = tasks}}, .step_s = 2e-3};
    options.error_bars = false;
    const auto result = track_markers(model, trunk, options);
    EXPECT_TRUE(result) << result.error().message;
    double most = 0.0;
    for (std::int64_t f = 70; f < 130; ++f) {
      const Eigen::VectorXd q = testing_body::coordinates(model, f);
      for (std::int64_t c = 6; c < result->motion.size(); ++c)
        most = std::max(most, std::abs(result->motion.q[result->motion.index(f, c)] - q[c]));
    }
    return most;
  };
  const double both = worst(0), one = worst(1), none = worst(2);
  EXPECT_LT(both, 1e-3);
  EXPECT_LT(one, 1e-3);  // the joints and the other images determine the depth
  EXPECT_GT(none, 5.0 * one);
}

TEST(CameraTask, EveryMarkerThatMovesAndIsSeenGetsATask) {
  const auto model = body();
  auto tracks = film(testing_body::record(model, 3), {camera_at({3.0, 0.5, 2.0})});
  tracks.names[0] = "unknown";
  for (const std::int64_t f : {0, 2}) {  // T2 is seen in single frames only
    const auto k = tracks.index(f, 0, 1);
    tracks.image[k] = kNaN;
  }
  const auto tasks = camera_tasks(model, tracks);
  ASSERT_TRUE(tasks) << tasks.error().message;
  ASSERT_EQ(tasks->size(), 12U);
  EXPECT_EQ(tasks->front()->name(), "images of 'T3'");
  for (const auto& task : *tasks) EXPECT_TRUE(task->bind(model));
  hide(tracks, 0, 1, 2);
  EXPECT_THAT(camera_tasks(model, tracks).error().message, HasSubstr("no marker of the model"));
  tracks.noise_sd[0] = -1.0;
  EXPECT_THAT(camera_tasks(model, tracks).error().message, HasSubstr("noise of -1"));
}

TEST(CameraTask, SaysWhatIsWrongWithIt) {
  const auto model = body();
  const auto good = one_track({camera_at({3.0, 0.5, 2.0})}, 5, middle);
  const auto sentence = [&](const BodyPoint& point, const data::ImageTracks& tracks,
                            const CameraTaskOptions& options = {}, const std::string& name = "P") {
    const auto status = camera_task(point, tracks, name, options)->bind(model);
    return status ? std::string() : status.error().message;
  };
  EXPECT_EQ(sentence(kF2, good), "");
  EXPECT_THAT(sentence(kF2, good, {}, "Q"), HasSubstr("do not have it"));
  EXPECT_THAT(sentence({"tail", {}}, good), HasSubstr("no body 'tail'"));
  EXPECT_THAT(sentence({"ground", {}}, good), HasSubstr("welded"));
  EXPECT_THAT(sentence({"trunk", {kNaN, 0.0, 0.0}}, good), HasSubstr("not a number"));
  EXPECT_THAT(sentence(kF2, good, {.weight = 0.0}), HasSubstr("weight is 0"));
  EXPECT_THAT(sentence(kF2, good, {.fade_s = kNaN}), HasSubstr("fades within nan s"));
  EXPECT_THAT(sentence(kF2, good, {.cutoff_hz = -1.0}), HasSubstr("cut-off is -1 Hz"));
  EXPECT_THAT(sentence(kF2, good, {.cutoff_hz = 1e-9}), HasSubstr("thousandth"));
  auto bad = good;
  hide(bad, 0, 1, 5);
  EXPECT_THAT(sentence(kF2, bad), HasSubstr("two frames in a row"));
  bad = good;
  bad.image.pop_back();
  EXPECT_THAT(sentence(kF2, bad), HasSubstr("9 numbers; need 10"));
  bad = good;
  bad.cameras[0].focal = 0.0;
  EXPECT_THAT(sentence(kF2, bad), HasSubstr("focal length 0"));
  EXPECT_THAT(sentence(kF2, one_track({}, 5, middle)), HasSubstr("0 cameras"));
  EXPECT_THAT(sentence(kF2, one_track({camera_at({3.0, 0.5, 2.0})}, 0, middle)), HasSubstr("0 frames"));
}

TEST(CameraTask, EvaluatingAllocatesNothing) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  using camera::imperfect_camera;
  Still still;
  model::velocities(still.model, still.w, Eigen::VectorXd::Ones(still.model.speed_count()));
  const auto tracks =
      one_track({imperfect_camera(data::CameraKind::pinhole, data::DetectorKind::tetra_lateral, 1),
                 imperfect_camera(data::CameraKind::lateral_effect, data::DetectorKind::tetra_lateral, 2)},
                10, middle);
  const auto task = camera_task(kF2, tracks, "P");
  ASSERT_TRUE(task->bind(still.model));
  still.rows.resize(task->rows(), still.model.speed_count());
  const auto before = testing_support::allocations_on_this_thread();
  task->evaluate(still.model, still.w, 0.05, still.rows);
  EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
  EXPECT_GT(still.rows.weight.minCoeff(), 0.0);
}

}  // namespace
}  // namespace kinemark::motion
