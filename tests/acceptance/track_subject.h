// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the acceptance programs of direct marker control share: a simulated subject and errors against it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/test_data.h"

namespace kinemark::track_subject {

/// The larger one; NaN when one is NaN, so that no bound passes it.
inline double larger(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

inline model::Model human() {
  return model::Model::compile(
             io::read_osim(testing_support::project_folder() / "models" / "human.osim").value())
      .value();
}

/// Everything moves at 0.1 to 0.9 Hz, as a camera system of 60 Hz would see it.
inline simulation::SimulatedSubject subject(const model::Model& model, double noise_sd_m, double rate_hz,
                                            double duration_s, std::uint64_t seed) {
  simulation::SubjectOptions options;
  options.noise_sd_m = noise_sd_m;
  options.rate_hz = rate_hz;
  options.duration_s = duration_s;
  options.seed = seed;
  return simulation::simulate_subject(model, options).value();
}

/// Coordinates of joints: those of the free root left out.
inline std::vector<std::int64_t> joints(const model::Model& model) {
  std::vector<std::int64_t> list;
  for (int c = 0; c < model.coordinate_count(); ++c)
    if (model.coordinates()[static_cast<std::size_t>(c)].speed_idx >= 0) list.push_back(c);
  return list;
}

/// RMS joint error against the truth in deg, from the second second on.
inline double joint_rms_deg(const model::Model& model, const data::JointMotion& motion,
                            const data::JointMotion& truth) {
  double squares = 0.0;
  std::int64_t count = 0;
  const auto list = joints(model);
  const auto first = static_cast<std::int64_t>(motion.time.rate_hz);
  for (std::int64_t f = first; f < motion.frames(); ++f)
    for (const auto c : list) {
      const double d = motion.q[motion.index(f, c)] - truth.q[truth.index(f, c)];
      squares += d * d;
      ++count;
    }
  return kDegPerRad * std::sqrt(squares / static_cast<double>(count));
}

/// Trunk and pelvis; upper arms and thighs; the ends.
inline std::vector<motion::TrackLevel> three_levels(const model::Model& model) {
  std::vector<motion::TrackLevel> levels(3);
  for (int m = 0; m < model.marker_count(); ++m) {
    // Depth in the tree: how many bodies carry the marker's.
    int depth = 0;
    for (int body = model.markers()[static_cast<std::size_t>(m)].body; body >= 0;
         body = model.bodies()[static_cast<std::size_t>(body)].parent)
      ++depth;
    levels[static_cast<std::size_t>(std::min(2, (depth - 1) / 2))].markers.push_back(
        model.description().markers[static_cast<std::size_t>(m)].name);
  }
  std::erase_if(levels, [](const auto& level) { return level.markers.empty(); });
  return levels;
}

}  // namespace kinemark::track_subject
