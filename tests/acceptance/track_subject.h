// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the acceptance programs of direct marker control share: a simulated subject and errors against it.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
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

/// How many subjects, and the seed of the first: "[SUBJECTS] [seed=N]" of a command line.
struct Asked {
  int subjects = 1;
  std::uint64_t seed = 1;

  Asked(int argc, char** argv, int by_itself) : subjects(by_itself) {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word.starts_with("seed="))
        seed = std::stoull(word.substr(5));
      else
        subjects = std::max(1, std::stoi(word));
    }
  }
};

struct DrawnSubject {
  simulation::SimulatedSubject recording;
  std::string what;
};

/// A subject drawn at random. One that moves `speed` times as fast is recorded as much more slowly, and its
/// recording then played at 60 Hz.
inline DrawnSubject draw(const model::Model& model, std::uint64_t seed, double soft_tissue) {
  constexpr double kRate_hz = 60.0, kDuration_s = 8.0;
  constexpr std::uint64_t kStream = 0x646972656374;
  Random random(seed, kStream);
  constexpr simulation::MotionKind kKinds[] = {simulation::MotionKind::walk, simulation::MotionKind::reach,
                                               simulation::MotionKind::tai_chi,
                                               simulation::MotionKind::mixed};
  simulation::SubjectOptions options;
  options.motion = kKinds[std::min(3, static_cast<int>(random.uniform(0.0, 4.0)))];
  const double speed = std::exp(random.uniform(std::log(0.5), std::log(3.0)));
  options.noise_sd_m = std::exp(random.uniform(std::log(0.2e-3), std::log(3.1e-3)));
  options.soft_tissue = soft_tissue;
  options.rate_hz = kRate_hz / speed;
  options.duration_s = kDuration_s * speed;
  options.seed = seed;
  DrawnSubject out{.recording = simulation::simulate_subject(model, options).value()};
  for (auto* time : {&out.recording.markers.time, &out.recording.truth.time}) time->rate_hz = kRate_hz;
  out.what = fmt::format("{}, {:.1f} times as fast, {:.2f} mm", simulation::to_string(options.motion), speed,
                         1e3 * options.noise_sd_m);
  return out;
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
