// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Shoulder, elbow and wrist of the macaque's sleeve from its markers, at 60 Hz and handed on as 240 Hz,
// without skin and with 2 to 10 mm of it: what error bars hold, and when skin is said. Then the report's own
// method there. `accept_skeleton whole_arm RECORDINGS SEED [PART...]`; PART: 60, 240, none, skin, report; all
// without.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/recording.h"
#include "kinemark/math/statistics.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/simulation/upsample.h"
#include "kinemark/workflow/joints/joints.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using Eigen::Vector3d;
using testing_support::print_row;

constexpr double kMm = 1e3;
constexpr int kHandedOn = 4;
constexpr std::array kPoints{"shoulder", "elbow", "wrist"};

/// One point of the arm over all recordings.
struct Tally {
  double numbers = 0.0, in_1sd = 0.0, in_2sd = 0.0, squares_m2 = 0.0, frames = 0.0, beyond = 0.0;
  std::vector<double> stated_m;

  void add(const Vector3d& error, const Eigen::Matrix3d& C) {
    for (int i = 0; i < 3; ++i) {
      const double z = std::abs(error(i)) / std::sqrt(C(i, i));
      numbers += 1.0;
      in_1sd += z < 1.0 ? 1.0 : 0.0;
      in_2sd += z < 1.96 ? 1.0 : 0.0;
      beyond += z > 5.0 ? 1.0 : 0.0;
    }
    squares_m2 += error.squaredNorm();
    frames += 1.0;
    stated_m.push_back(std::sqrt(C.trace()));
  }
  [[nodiscard]] double one() const { return 100.0 * in_1sd / numbers; }
  [[nodiscard]] double two() const { return 100.0 * in_2sd / numbers; }
  [[nodiscard]] double rms_m() const { return std::sqrt(squares_m2 / frames); }
  [[nodiscard]] double stated() const { return math::median(stated_m); }
};

/// A point between four frames of the cameras, by the cubic through them.
Vector3d between(const std::array<Vector3d, 4>& x, double t) {
  return -t * (t - 1.0) * (t - 2.0) / 6.0 * x[0] + (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 * x[1] -
         (t + 1.0) * t * (t - 2.0) / 2.0 * x[2] + (t + 1.0) * t * (t - 1.0) / 6.0 * x[3];
}

/// Where a point truly is in a frame of the recorder.
Vector3d truth_at(const Array<double>& x, std::int64_t frames, std::int64_t f, int factor) {
  const auto from = std::clamp<std::int64_t>(f / factor, 1, frames - 3);
  std::array<Vector3d, 4> four;
  for (std::size_t i = 0; i < 4; ++i)
    four[i] = Eigen::Map<const Vector3d>(x.data() + 3 * (from - 1 + static_cast<std::int64_t>(i)));
  return between(four, static_cast<double>(f) / factor - static_cast<double>(from));
}

struct Cell {
  std::array<Tally, 3> of;
  int recordings = 0, said = 0, none_seen = 0;
};

void measure(const simulation::LimbRecording& limb, int factor, Cell& cell) {
  data::Recording recording;
  recording.trial.markers =
      factor == 1 ? limb.markers : simulation::upsample(limb.markers, {.factor = factor}).value();
  workflow::JointsOptions options;
  options.segments = limb.layout;
  const auto found = workflow::joints(recording, options).value();
  const auto& skeleton = found.skeleton;
  ++cell.recordings;
  cell.said += skeleton.joints[0].skin.verdict == data::SkinVerdict::follows ? 1 : 0;
  cell.none_seen += skeleton.joints[0].skin.verdict == data::SkinVerdict::none_seen ? 1 : 0;
  const auto frames = limb.markers.frames();
  const auto skip = static_cast<std::int64_t>(factor);
  for (const auto& end : skeleton.ends)
    // The shoulder has one error in a recording.
    for (std::int64_t f = 0; f < (end.stays() ? 1 : skeleton.frames()); ++f) {
      if (end.state[at(f)] == data::CentreState::undetermined) continue;
      const Vector3d x(end.centre_in_world.data() + 3 * f);
      const Vector3d truth =
          end.stays() ? Vector3d(Vector3d::Zero()) : truth_at(limb.end_in_world, frames, f, factor);
      cell.of[end.stays() ? 0 : 2].add(x - truth,
                                       math::unpack_symmetric3(end.covariance_in_world.data() + 6 * f));
    }
  for (std::int64_t f = 0; f + skip < skeleton.frames(); ++f)
    if (skeleton.state[skeleton.index(f, 0)] != data::CentreState::undetermined)
      cell.of[1].add(skeleton.centre(f, 0) - truth_at(limb.centre_in_world, frames, f, factor),
                     skeleton.centre_covariance(f, 0));
}

simulation::SleeveOptions sleeve_of(int i, int recordings, std::uint64_t seed, bool skin) {
  simulation::SleeveOptions out{.tip = true, .seed = seed + static_cast<std::uint64_t>(i)};
  if (skin) out.skin_m = 0.002 + 0.008 * i / std::max(recordings - 1, 1);
  return out;
}

/// Bounds are those of twenty recordings; of fewer wider by two standard errors of what a recording adds.
void show(const std::string& what, const Cell& cell, bool skin) {
  const double more = cell.recordings >= 20 ? 0.0 : 60.0 / std::sqrt(static_cast<double>(cell.recordings));
  for (std::size_t p = 0; p < kPoints.size(); ++p) {
    const Tally& t = cell.of[p];
    const double ratio = t.stated() / t.rms_m();
    const std::string name = fmt::format("{}: {}", what, kPoints[p]);
    print_row(
        t.one() >= 60.0 - more && t.one() <= 75.0 + more && t.two() >= 90.0 - more && t.two() <= 98.0 + more,
        name + ", coverage", "60-75 and 90-98 %",
        fmt::format("{:.0f} and {:.0f} % of {:.0f} numbers in {} recordings, {:.0f} beyond 5 SD", t.one(),
                    t.two(), t.numbers, cell.recordings, t.beyond));
    print_row(ratio >= 0.7 / (1.0 + 0.01 * more) && ratio <= 1.5 * (1.0 + 0.01 * more),
              name + ", stated over true", "0.7 to 1.5",
              fmt::format("{:.2f}: {:.2f} mm stated, {:.2f} true", ratio, kMm * t.stated(), kMm * t.rms_m()));
  }
  const int n = cell.recordings;
  print_row(skin ? 10 * cell.said >= 9 * n : 10 * cell.said <= n, what + ": skin is said",
            skin ? "in 9 of 10 and more" : "in 1 of 10 at most",
            fmt::format("in {} of {}; none seen in {}", cell.said, n, cell.none_seen));
}

/// The report's method finds its own set of markers and frames.
void report(int recordings, std::uint64_t seed) {
  double worst_median = 0.0, answered = 0.0, frames = 0.0;
  int ran = 0, named = 0;
  for (int i = 0; i < recordings; ++i) {
    const auto limb = simulation::simulate_sleeve(sleeve_of(i, recordings, seed, false)).value();
    data::Recording recording;
    recording.trial.markers = limb.markers;
    workflow::JointsOptions options;
    options.segments = limb.layout;
    options.method = "constant-distance";
    const auto found = workflow::joints(recording, options);
    if (!found || found->skeleton.joints.empty()) continue;
    ++ran;
    const auto& skeleton = found->skeleton;
    named += std::ranges::any_of(skeleton.warnings,
                                 [](const auto& w) { return w.contains("no two frames show all"); });
    std::vector<double> errors;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
      frames += 1.0;
      if (skeleton.state[skeleton.index(f, 0)] == data::CentreState::undetermined) continue;
      answered += 1.0;
      errors.push_back(
          (skeleton.centre(f, 0) - Eigen::Map<const Vector3d>(limb.centre_in_world.data() + 3 * f)).norm());
    }
    worst_median = std::max(worst_median, math::median(errors));
  }
  print_row(ran == recordings && named == recordings, "the report's method on the sleeve",
            "runs and says on which markers",
            fmt::format(
                "{} of {} ran, {} said it; {:.0f} % of the frames answered; median error {:.1f} mm at worst",
                ran, recordings, named, 100.0 * answered / std::max(frames, 1.0), kMm * worst_median));
}

int run_check(int argc, char** argv) {
  const int recordings = argc > 1 ? std::max(1, std::atoi(argv[1])) : 20;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
  const std::vector<std::string> parts(argv + std::min(argc, 3), argv + argc);
  const auto named = [&](const char* part) { return std::ranges::find(parts, part) != parts.end(); };
  const auto wanted = [&](const char* part, const char* other) { return named(part) || !named(other); };
  const bool alone = parts.size() == 1 && named("report");
  for (const int factor : {1, kHandedOn}) {
    if (alone || !wanted(factor == 1 ? "60" : "240", factor == 1 ? "240" : "60")) continue;
    for (const bool skin : {false, true}) {
      if (!wanted(skin ? "skin" : "none", skin ? "none" : "skin")) continue;
      Cell cell;
      for (int i = 0; i < recordings; ++i)
        measure(simulation::simulate_sleeve(sleeve_of(i, recordings, seed + (skin ? 1000 : 0), skin)).value(),
                factor, cell);
      show(fmt::format("sleeve, {} Hz, {}", 60 * factor, skin ? "skin of 2 to 10 mm" : "no skin"), cell,
           skin);
    }
  }
  if (parts.empty() || named("report")) report(std::min(recordings, 10), seed);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("whole_arm", run_check);

}  // namespace
