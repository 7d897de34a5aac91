// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/curve_block.h"
#include "kinemark/stages/report/internal/scene_parts.h"
#include "kinemark/stages/report/internal/track_block.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kFinest_m = 2e-5, kCoarsest_m = 5e-4;
constexpr double kFinest_n = 0.05, kCoarsest_n = 1.0;

/// The frames of a page: every step-th.
struct Kept {
  std::int64_t frames, step;
  [[nodiscard]] std::int64_t points() const { return (frames + step - 1) / step; }
};

/// Triples (F x M x 3) as series: marker by marker, axis by axis.
Json pack_triples(std::span<const double> triples, std::int64_t markers, const Kept& kept, double finest,
                  double coarsest) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(3 * markers * kept.points()));
  for (std::int64_t k = 0; k < 3 * markers; ++k)
    for (std::int64_t f = 0; f < kept.frames; f += kept.step)
      values.push_back(triples[static_cast<std::size_t>(f * 3 * markers + k)]);
  return internal::pack_series(values, kept.points(), finest, coarsest);
}

std::string pack_states(const data::Trajectories& t, const Kept& kept) {
  std::vector<std::uint8_t> codes;
  codes.reserve(static_cast<std::size_t>(t.markers() * kept.points()));
  for (std::int64_t m = 0; m < t.markers(); ++m)
    for (std::int64_t f = 0; f < kept.frames; f += kept.step)
      codes.push_back(internal::state_rank(t.state[t.index(f, m)]));
  return internal::deflated(codes);
}

/// The worst state among the frames that each point stands for.
std::string pack_worst(const data::Trajectories& t, const Kept& kept) {
  std::vector<std::uint8_t> codes(static_cast<std::size_t>(t.markers() * kept.points()), 0);
  for (std::int64_t f = 0; f < kept.frames; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      auto& code = codes[static_cast<std::size_t>(m * kept.points() + f / kept.step)];
      code = std::max(code, internal::state_rank(t.state[t.index(f, m)]));
    }
  return internal::deflated(codes);
}

Json pack_markers(const data::Trajectories& t, const Kept& kept) {
  return {{"positions_m", pack_triples(t.x_in_world, t.markers(), kept, kFinest_m, kCoarsest_m)},
          {"states", pack_states(t, kept)}};
}

Json pack_forces(const data::Wrenches* forces, const Kept& kept) {
  Json out = Json::array();
  if (forces == nullptr) return out;
  for (const auto& wrench : forces->items) {
    // Nothing is drawn where nothing was measured.
    std::vector<double> known(wrench.force.begin(), wrench.force.end());
    std::ranges::replace_if(known, [](double v) { return !std::isfinite(v); }, 0.0);
    out.push_back({{"name", wrench.name},
                   {"force_n", pack_triples(known, 1, kept, kFinest_n, kCoarsest_n)},
                   {"point_m", pack_triples(wrench.point, 1, kept, kFinest_m, kCoarsest_m)}});
  }
  return out;
}

Json vector_json(const Eigen::Vector3d& v) {
  Json out = Json::array();
  for (const double value : v) out.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return out;
}

Json plates_json(std::span<const data::ForcePlate> plates) {
  Json out = Json::array();
  for (const auto& plate : plates) {
    Json corners = Json::array();
    for (const auto& corner : plate.corners_in_world) corners.push_back(vector_json(corner));
    out.push_back({{"type", plate.type}, {"corners_m", std::move(corners)}});
  }
  return out;
}

Json pack_scene(const Scene& scene, const Kept& kept) {
  const auto& markers = *scene.markers;
  Json out = {{"frame_step", kept.step},
              {"points", kept.points()},
              {"up", scene.up ? vector_json(*scene.up) : Json(nullptr)},
              {"up_from", scene.up_from},
              {"names", markers.names},
              {"markers", pack_markers(markers, kept)},
              {"model_m", nullptr},
              {"before", nullptr},
              {"worst", nullptr},
              {"plates", plates_json(scene.plates)},
              {"forces", pack_forces(scene.forces, kept)}};
  if (scene.model != nullptr)
    out["model_m"] = pack_triples(*scene.model, markers.markers(), kept, kFinest_m, kCoarsest_m);
  if (scene.before != nullptr) out["before"] = pack_markers(*scene.before, kept);
  if (scene.bodies != nullptr && !scene.bodies->names.empty())
    out["bodies"] = internal::bodies_json(*scene.bodies, kept.step);
  if (scene.skeleton != nullptr) out["skeleton"] = internal::skeleton_json(*scene.skeleton, kept.step);
  if (!scene.cameras.empty()) out["cameras"] = internal::cameras_json(scene.cameras);
  if (kept.step > 1) out["worst"] = pack_worst(markers, kept);
  return out;
}

}  // namespace

Status SceneOptions::check() const {
  if (max_bytes < 1000 || max_bytes_long < 1000)
    return fail(Code::usage, fmt::format("a scene may take {} and {} bytes; need 1000 or more", max_bytes,
                                         max_bytes_long));
  if (short_frames < 0)
    return fail(Code::usage, fmt::format("short_frames is {}; need 0 or more", short_frames));
  return {};
}

Json scene_json(const Scene& scene, const SceneOptions& options) {
  check(options.check().has_value(), "scene options are out of range");
  check(scene.markers != nullptr, "a scene needs markers");
  const auto& markers = *scene.markers;
  check(scene.model == nullptr || scene.model->size() == markers.x_in_world.size(),
        "a scene needs a model position for each sample");
  check(scene.before == nullptr || scene.before->x_in_world.size() == markers.x_in_world.size(),
        "a scene needs the same markers and frames before as after");
  check(scene.forces == nullptr || scene.forces->frames() == markers.frames(),
        "a scene needs forces on the markers' clock");
  check(scene.bodies == nullptr || std::ssize(scene.bodies->origin_in_world) ==
                                       3 * markers.frames() * std::ssize(scene.bodies->names),
        "a scene needs a place of each body in each frame");
  check(scene.bodies == nullptr || scene.bodies->meshes.empty() ||
            (scene.bodies->meshes.size() == scene.bodies->names.size() &&
             3 * scene.bodies->world_from_body.size() == 4 * scene.bodies->origin_in_world.size()),
        "a scene with meshes needs one a body, and how each is turned in each frame");
  check(scene.skeleton == nullptr || scene.skeleton->frames() == markers.frames(),
        "a scene needs joint centres on the markers' clock");
  const std::int64_t frames = markers.frames();
  const std::int64_t most = frames <= options.short_frames ? options.max_bytes : options.max_bytes_long;
  const std::int64_t coarsest = std::max<std::int64_t>(1, frames / 2);
  // A sample packs into a byte or more: what is surely too much is not tried.
  const std::int64_t least = 2 * frames * std::max<std::int64_t>(1, markers.markers());
  Kept kept{frames, std::clamp<std::int64_t>(least / most, 1, coarsest)};
  for (;;) {
    Json out = pack_scene(scene, kept);
    const std::int64_t taken = internal::room(out);
    if (taken <= most || kept.step >= coarsest) return out;
    const auto wanted = static_cast<std::int64_t>(
        std::ceil(static_cast<double>(kept.step) * static_cast<double>(taken) / static_cast<double>(most)));
    kept.step = std::min(coarsest, std::max(kept.step + 1, wanted));
  }
}

}  // namespace kinemark::report
