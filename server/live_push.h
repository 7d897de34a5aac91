// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/model/model.h"
#include "kinemark/workflow/live/live.h"
#include "server/live_clock.h"

namespace kinemark::server {

/// Bytes of a push, as a page sends it: uint8 kind (1), uint8 version (1), uint16 body, float32 point[3] in m
/// in the body, float32 force[3] in N in the world. No force: the body is let go.
inline constexpr std::size_t kPushBytes = 28;

/// A force at a point of a body.
struct BodyPush {
  int body = 0;                                              ///< index into Model::bodies()
  Eigen::Vector3d point_in_body = Eigen::Vector3d::Zero();   ///< m
  Eigen::Vector3d force_in_world = Eigen::Vector3d::Zero();  ///< N
};

/// Who pushes the body of a live source, and how: one viewer at a time. A push that is not said again for a
/// second ends. Threads may call at once.
class LivePush {
 public:
  explicit LivePush(std::size_t bodies) : bodies_(bodies) {}

  /// What the bytes of a viewer say; nothing: another version, a body that is none, a number that is not
  /// finite.
  [[nodiscard]] std::optional<BodyPush> read(std::string_view bytes) const;
  /// A viewer pushes, or lets go. Empty, or why it is refused, in one sentence.
  [[nodiscard]] std::string take(const void* viewer, const BodyPush& push, double now_s);
  /// That viewer is gone.
  void let_go(const void* viewer);
  /// What pushes now; nothing: nobody.
  [[nodiscard]] std::optional<BodyPush> now(double now_s);

 private:
  std::size_t bodies_;
  std::mutex mutex_;
  std::optional<BodyPush> push_;
  const void* viewer_ = nullptr;
  double said_s_ = 0.0;
};

/// The model that follows a source, with the force that pushes it.
class PushedAngles final : public stream::Sink {
 public:
  PushedAngles(std::unique_ptr<workflow::LiveAngles> angles, std::shared_ptr<LivePush> push,
               std::shared_ptr<LiveClock> clock);
  [[nodiscard]] Status push(const stream::Frame& frame) override;
  [[nodiscard]] Status finish() override { return angles_->finish(); }

 private:
  std::unique_ptr<workflow::LiveAngles> angles_;
  std::shared_ptr<LivePush> push_;
  std::shared_ptr<LiveClock> clock_;
  bool acts_ = false;
};

/// Numbers of each body in messages: origin in m, quaternion w x y z.
inline constexpr std::size_t kPoseNumbers = 7;

/// Where the bodies of a model are.
class BodyPoses {
 public:
  explicit BodyPoses(std::shared_ptr<const model::Model> model);
  /// Of the pushed body while there is one; NaN where nothing is known.
  [[nodiscard]] const std::vector<double>& find(const motion::LivePose& pose);

 private:
  std::shared_ptr<const model::Model> model_;
  model::Workspace w_;
  std::vector<double> poses_;
};

}  // namespace kinemark::server
