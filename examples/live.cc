// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint angles of a device: frames of markers go in as they come, angles with their standard deviations come
// out a moment later. Whoever has a device writes a Source; this one plays a simulated subject, so that
// angles can be compared with the truth.
#include <cmath>
#include <cstdio>
#include <utility>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

namespace {

/// Stands for a device: says what it knows beforehand, and gives one frame after the other.
class Cameras final : public kinemark::stream::Source {
 public:
  explicit Cameras(kinemark::Trajectories markers)
      : Source({.name = "cameras", .markers = markers.names, .rate_hz = markers.time.rate_hz}),
        markers_(std::move(markers)) {}

  /// A device would wait here for its next frame, and fail with a sentence where it is lost.
  kinemark::Result<bool> next(kinemark::stream::Frame& frame) override {
    if (next_ == markers_.frames()) return false;
    frame.number = next_;
    frame.time_s = markers_.time.time_s(next_);
    frame.clear(markers_.names.size());  // a marker that is not seen stays missing
    for (std::int64_t m = 0; m < markers_.markers(); ++m) {
      if (!markers_.present(next_, m)) continue;
      for (int axis = 0; axis < 3; ++axis)
        frame.x_in_world[static_cast<std::size_t>(3 * m + axis)] = markers_.x(next_, m)[axis];
      frame.state[static_cast<std::size_t>(m)] = kinemark::SampleState::measured;
    }
    ++next_;
    return true;
  }

 private:
  kinemark::Trajectories markers_;
  std::int64_t next_ = 0;
};

}  // namespace

int main() {
  const auto model = kinemark::Model::compile(kinemark::pipeline::human_model().value()).value();
  const auto subject = kinemark::simulation::simulate_subject(
                           model, {.motion = kinemark::simulation::MotionKind::tai_chi, .duration_s = 3.0})
                           .value();
  Cameras cameras(subject.markers);

  // What is called with the angles of each frame: q in rad and m, NaN as long as no marker is seen, q_sd
  // their standard deviations, NaN where the markers do not determine them; rates and torques stand beside
  // them.
  std::int64_t poses = 0, known = 0, within = 0;
  double squares = 0.0;
  const auto take = [&](const auto& pose) {
    ++poses;
    for (Eigen::Index c = 0; c < pose.q.size(); ++c) {
      if (pose.determined[static_cast<std::size_t>(c)] == 0) continue;
      const double error = pose.q[c] - subject.truth.q[subject.truth.index(pose.frame, c)];
      squares += error * error;
      within += std::abs(error) < 2.0 * pose.q_sd[c];
      ++known;
    }
  };

  // A known marker noise gives standard deviations from the first frame on; left at 0 it is estimated on the
  // way.
  const auto angles = kinemark::live(model, cameras.facts(), take, {.marker_noise_sd_m = 0.001});
  if (!angles) return std::fprintf(stderr, "%s\n", angles.error().message.c_str()), 1;
  std::printf("angles follow their frames by %lld frames\n",
              static_cast<long long>((*angles)->delay_frames()));
  for (kinemark::stream::Frame frame;;) {
    const auto more = cameras.next(frame);
    if (!more) return std::fprintf(stderr, "%s\n", more.error().message.c_str()), 1;
    if (!*more) break;
    if (const auto taken = (*angles)->push(frame); !taken)
      return std::fprintf(stderr, "%s\n", taken.error().message.c_str()), 1;
  }
  if (const auto last = (*angles)->finish(); !last)  // what is on the way comes out
    return std::fprintf(stderr, "%s\n", last.error().message.c_str()), 1;

  std::printf(
      "%lld frames, RMS error of a coordinate %.4f (rad or m), %.0f %% within two standard deviations\n",
      static_cast<long long>(poses), std::sqrt(squares / static_cast<double>(known)),
      100.0 * static_cast<double>(within) / static_cast<double>(known));
  return poses == subject.markers.frames() ? 0 : 1;
}
