// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Direct marker control on a live stream: frames of markers go in one by one, poses come out a moment later.
// The stream is a simulated subject; in a laboratory it is whatever your cameras send.
#include <cmath>
#include <cstdio>

#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/simulation/subject.h"

using namespace kinemark;

int main() {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const auto subject =
      simulation::simulate_subject(model, {.motion = simulation::MotionKind::tai_chi, .duration_s = 3.0})
          .value();
  const data::Trajectories& stream = subject.markers;

  // The order of the names is the order of the columns of every frame. A known marker noise gives error bars
  // from the first frame on; left at 0 it is estimated on the way.
  auto tracker =
      motion::OnlineTracker::create(model, stream.names, stream.time.rate_hz, {.marker_noise_sd_m = 0.001});
  if (!tracker) return std::fprintf(stderr, "%s\n", tracker.error().message.c_str()), 1;
  std::printf("poses follow their frames by %lld frames\n", static_cast<long long>(tracker->delay_frames()));

  // Every pose that is ready: q in rad and m, its velocity v, acceleration a and forces tau. The pointer is
  // valid until the next call.
  std::int64_t poses = 0;
  double squares = 0.0;
  const auto fetch = [&]() -> Status {
    for (;;) {
      const auto pose = tracker->next();
      if (!pose) return std::unexpected(pose.error());
      if (*pose == nullptr) return {};
      for (Eigen::Index c = 0; c < (*pose)->q.size(); ++c) {
        const double error = (*pose)->q[c] - subject.truth.q[subject.truth.index((*pose)->frame, c)];
        squares += error * error;
      }
      ++poses;
    }
  };

  Eigen::Matrix3Xd frame(3, stream.markers());  // one column a marker, m; NaN where it is not seen
  for (std::int64_t f = 0; f < stream.frames(); ++f) {
    for (std::int64_t m = 0; m < stream.markers(); ++m) frame.col(m) = stream.x(f, m);
    const auto pushed = tracker->push(stream.time.time_s(f), frame);
    const auto fetched = pushed ? fetch() : pushed;
    if (!fetched) return std::fprintf(stderr, "%s\n", fetched.error().message.c_str()), 1;
  }
  tracker->finish();  // no more frames: what is on the way comes out
  if (const auto fetched = fetch(); !fetched)
    return std::fprintf(stderr, "%s\n", fetched.error().message.c_str()), 1;

  const double rms = std::sqrt(squares / static_cast<double>(poses * subject.truth.size()));
  std::printf("%lld poses, RMS error of a coordinate %.4f (rad or m)\n", static_cast<long long>(poses), rms);
  return poses == stream.frames() ? 0 : 1;
}
