// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the space view of a page draws: markers, their states, force plates and forces, thinned to a bound.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/triangle_mesh.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::report {

/// A camera to draw: its lens and what it sees.
struct SceneCamera {
  std::string name;                                           ///< unique
  Eigen::Vector3d centre_in_world = Eigen::Vector3d::Zero();  ///< of the lens, m
  /// Right, down and forward, as columns.
  Eigen::Matrix3d axes_in_world = Eigen::Matrix3d::Identity();
  Eigen::Vector2d half_view = Eigen::Vector2d::Constant(0.3);  ///< slopes of the edges of the view
  bool nominal = false;  ///< where it was meant to stand, not where it stands
};

/// Rigid bodies, each drawn as its mesh, or as a plain shape of its own mass about the line from its origin
/// to its end: F frames, B bodies.
struct SceneBodies {
  std::vector<std::string> names;          ///< B
  std::vector<double> mass_kg;             ///< B, >= 0
  Array<double> origin_in_world;           ///< F x B x 3, m
  Array<double> end_in_world;              ///< F x B x 3, m: where the next body begins
  std::vector<data::TriangleMesh> meshes;  ///< B, m in the axes of each body; an empty one: the plain shape;
                                           ///< or none at all. At most 65,535 points a body.
  Array<double> world_from_body;           ///< F x B x 4, unit quaternions w x y z; empty without meshes
  std::string meshes_note;                 ///< which meshes are drawn, and which are not; may be empty
};

/// Points through time to draw, all in one laboratory frame.
struct Scene {
  const data::Trajectories* markers = nullptr;  ///< F x M; must be set
  const Array<double>* model = nullptr;  ///< F x M x 3, where a model has these markers, m; NaN: not known
  const data::Trajectories* before = nullptr;  ///< F x M, the same markers as they came in; may be absent
  const data::Wrenches* forces = nullptr;      ///< on the markers' clock; may be absent
  std::vector<data::ForcePlate> plates;        ///< corners, m
  const data::Skeleton* skeleton = nullptr;    ///< joint centres on the markers' clock; may be absent
  const SceneBodies* bodies = nullptr;         ///< on the markers' clock; may be absent
  std::vector<SceneCamera> cameras;            ///< may be none
  std::optional<Eigen::Vector3d>
      up;               ///< axis of the laboratory that points up, length 1; none: the page finds it
  std::string up_from;  ///< who says so: "the force plates"; empty: nobody
};

/// How much room a scene may take in a page.
struct SceneOptions {
  std::int64_t max_bytes = 700'000;         ///< of up to `short_frames` frames, as text in the page
  std::int64_t max_bytes_long = 2'000'000;  ///< of longer recordings
  std::int64_t short_frames = 2'000;        ///< F up to which a recording counts as short

  [[nodiscard]] Status check() const;  ///< Ranges hold: at least 1000 bytes, frames of 0 or more.
};

/// PackedScene of docs/formats/pages.md. Every `frame_step`-th frame is kept, the fewest left out that meet
/// the bound, but never fewer than two points; a point is a frame as it is, nothing is averaged. Positions
/// are rounded to 0.02 mm or the 65,535th part of their range, at most 0.5 mm (above that they are float32).
[[nodiscard]] nlohmann::ordered_json scene_json(const Scene& scene, const SceneOptions& options = {});

}  // namespace kinemark::report
