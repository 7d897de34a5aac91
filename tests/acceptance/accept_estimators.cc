// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Least squares, direct marker control and the whole-trajectory smoother on the same simulated recordings:
// where docs/concepts/three-estimators.md has its numbers from.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/smoother/smoother.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

/// Sums over coordinates, frames and subjects of one estimator in one world.
struct Score {
  double shared_squares = 0.0, own_squares = 0.0, seconds = 0.0;
  std::int64_t shared = 0, own = 0, determined = 0, samples = 0, one = 0, two = 0, frames = 0;

  /// `shared_by_all`: per sample, whether all three determine it; only there their errors compare.
  void add(const data::JointMotion& motion, const data::JointMotion& truth,
           const std::vector<std::uint8_t>& shared_by_all, double took_s) {
    seconds += took_s;
    frames += motion.frames();
    // The first and last half second are left out: control starts from rest.
    const auto margin = static_cast<std::int64_t>(0.5 * motion.time.rate_hz);
    for (std::int64_t f = margin; f + margin < motion.frames(); ++f)
      for (std::int64_t c = 0; c < motion.size(); ++c) {
        const auto i = motion.index(f, c);
        ++samples;
        if (motion.determined[i] == 0) continue;
        ++determined;
        const double error = std::abs(motion.q[i] - truth.q[i]);
        one += error <= motion.q_sd[i];
        two += error <= 2.0 * motion.q_sd[i];
        if (!motion.is_rotation[static_cast<std::size_t>(c)]) continue;
        const bool all = shared_by_all[i] != 0;
        (all ? shared_squares : own_squares) += error * error;
        ++(all ? shared : own);
      }
  }
  [[nodiscard]] double rms_deg() const {
    return kDegPerRad * std::sqrt(shared_squares / static_cast<double>(shared));
  }
  [[nodiscard]] double share(std::int64_t n, std::int64_t of) const {
    return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, of));
  }
  [[nodiscard]] std::string text() const {
    const std::string beyond =
        own == 0 ? std::string()
                 : fmt::format(" ({:.3f} deg in the {:.1f} % that not all determine)",
                               kDegPerRad * std::sqrt(own_squares / static_cast<double>(own)),
                               share(own, own + shared));
    return fmt::format(
        "{:.3f} deg RMS{}; {:.0f} / {:.0f} % within 1 / 2 SD; {:.1f} % determined; {:.0f} frames/s",
        rms_deg(), beyond, share(one, determined), share(two, determined), share(determined, samples),
        static_cast<double>(frames) / seconds);
  }
};

struct World {
  std::string name;
  double soft_tissue = 0.0, gaps = 0.0;
};

struct Scores {
  Score least_squares, control, smoother;
};

double timed(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Scores compare(const model::Model& model, const World& world, int subjects) {
  Scores scores;
  for (int s = 1; s <= subjects; ++s) {
    simulation::SubjectOptions options;
    options.duration_s = 10.0;
    options.rate_hz = 60.0;
    options.seed = static_cast<std::uint64_t>(100 + s);
    options.soft_tissue = world.soft_tissue;
    options.dropout_random = options.dropout_sight = 0.5 * world.gaps;
    const auto subject = simulation::simulate_subject(model, options).value();
    motion::IkResult ik;
    motion::TrackResult track;
    motion::SmootherResult smooth;
    const double ik_s = timed([&] { ik = motion::solve_ik(model, subject.markers).value(); });
    const double track_s = timed([&] { track = motion::track_markers(model, subject.markers).value(); });
    const double smooth_s = timed([&] { smooth = motion::smooth_motion(model, subject.markers).value(); });
    std::vector<std::uint8_t> shared(ik.motion.q.size());
    for (std::size_t i = 0; i < shared.size(); ++i)
      shared[i] =
          ik.motion.determined[i] != 0 && track.motion.determined[i] != 0 && smooth.motion.determined[i] != 0;
    scores.least_squares.add(ik.motion, subject.truth, shared, ik_s);
    scores.control.add(track.motion, subject.truth, shared, track_s);
    scores.smoother.add(smooth.motion, subject.truth, shared, smooth_s);
  }
  return scores;
}

/// accept_motion estimators [SUBJECTS]
int run_check(int argc, char** argv) {
  const int subjects = argc > 1 ? std::stoi(argv[1]) : 3;
  const auto model = model::Model::compile(
                         io::read_osim(testing_support::project_folder() / "models" / "human.osim").value())
                         .value();
  const std::vector<World> worlds = {{.name = "1 mm noise"},
                                     {.name = "1 mm noise, 20 % gaps", .gaps = 0.2},
                                     {.name = "soft tissue", .soft_tissue = 1.0},
                                     {.name = "soft tissue, 20 % gaps", .soft_tissue = 1.0, .gaps = 0.2}};
  for (const auto& world : worlds) {
    const auto scores = compare(model, world, subjects);
    const bool noise_only = world.soft_tissue == 0.0;
    print_note(fmt::format("least squares, {}", world.name), scores.least_squares.text());
    print_note(fmt::format("direct marker control, {}", world.name), scores.control.text());
    const auto& smoother = scores.smoother;
    const double covered = smoother.share(smoother.one, smoother.determined),
                 covered_two = smoother.share(smoother.two, smoother.determined);
    const double wanted = noise_only ? 0.6 : 1.02;
    print_row(
        smoother.rms_deg() <= wanted * scores.least_squares.rms_deg() && covered >= 60.0 &&
            covered_two >= 88.0,
        fmt::format("smoother, {}", world.name),
        fmt::format("angles that all determine <= {} x least squares; 60 / 88 % within 1 / 2 SD or more",
                    wanted),
        smoother.text());
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("estimators", run_check);

}  // namespace
