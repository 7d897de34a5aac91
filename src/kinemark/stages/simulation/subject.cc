// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/subject.h"

#include <utility>

#include "kinemark/core/parallel.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"
#include "kinemark/stages/simulation/internal/dropout.h"
#include "kinemark/stages/simulation/internal/motion.h"
#include "kinemark/stages/simulation/internal/segments.h"
#include "kinemark/stages/simulation/internal/soft_tissue.h"
#include "kinemark/stages/simulation/internal/streams.h"

namespace kinemark::simulation {
namespace {

constexpr std::int64_t kGrain = 64;
constexpr std::uint64_t kDrawsPerFrame = 6;  // three Gaussians of two uniforms each

// Coordinates through time (n x F), continuous from the default pose on.
Eigen::MatrixXd coordinates_through_time(const model::Model& model, const Eigen::MatrixXd& states) {
  Eigen::MatrixXd q(model.coordinate_count(), states.cols());
  Eigen::VectorXd near(model.coordinate_count()), now(model.coordinate_count());
  for (int c = 0; c < model.coordinate_count(); ++c)
    near[c] = model.description().coordinates[static_cast<std::size_t>(c)].default_value;
  for (Eigen::Index f = 0; f < states.cols(); ++f) {
    model::coordinates_from_state(model, states.col(f), near, now);
    q.col(f) = near = now;
  }
  return q;
}

data::JointMotion describe_truth(const model::Model& model, const TimeBase& time, const Eigen::MatrixXd& q) {
  data::JointMotion truth;
  data::set_coordinates(model.description(), truth);
  for (const auto& marker : model.description().markers) truth.markers.push_back(marker.name);
  truth.time = time;
  truth.q.assign(q.data(), q.data() + q.size());
  truth.q_sd.assign(truth.q.size(), 0.0);
  truth.determined.assign(truth.q.size(), 1);
  truth.status.assign(static_cast<std::size_t>(time.frames), data::FrameStatus::converged);
  return truth;
}

}  // namespace

Eigen::VectorXd soft_tissue_rms_m(const model::Model& model) {
  return internal::tissue_amplitudes(internal::Segments(model));
}

Result<SimulatedSubject> simulate_subject(const model::Model& model, const SubjectOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (model.marker_count() == 0)
    return fail(Code::bad_input, "the model \"" + model.description().name +
                                     "\" has no markers; a simulated recording needs at least one");
  const TimeBase time{.rate_hz = options.rate_hz, .t0_s = 0.0, .frames = options.frames()};
  const std::int64_t markers = model.marker_count();

  const internal::Motion motion(model, options);
  Eigen::MatrixXd states(model.state_count(), time.frames);
  parallel_for(time.frames, kGrain, options.threads, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) states.col(f) = motion.state(time.time_s(f));
  });
  const Eigen::MatrixXd q = coordinates_through_time(model, states);

  const internal::Segments segments(model);
  std::vector<Eigen::Matrix3Xd> slides;
  if (options.soft_tissue > 0.0)
    slides = internal::tissue_displacements(segments, q, 2.0 * motion.stride_hz(), options);
  const internal::Lost gaps = internal::random_gaps(time.frames, markers, options);
  const internal::Lost hidden = internal::lines_of_sight(model, segments, states, options);

  SimulatedSubject out;
  out.truth = describe_truth(model, time, q);
  out.true_markers = data::Trajectories::all_missing(out.truth.markers, time);
  out.markers = data::Trajectories::all_missing(out.truth.markers, time);
  out.truth.marker_error.assign(out.markers.x_in_world.size(), 0.0);
  parallel_for(time.frames, kGrain, options.threads, [&](std::int64_t begin, std::int64_t end) {
    model::Workspace w(model);
    std::vector<Random> noise;
    for (std::int64_t m = 0; m < markers; ++m) {
      noise.push_back(internal::stream(options.seed, internal::Draw::noise, static_cast<std::size_t>(m)));
      noise.back().seek(static_cast<std::uint64_t>(begin) * kDrawsPerFrame);
    }
    for (std::int64_t f = begin; f < end; ++f) {
      model::kinematics(model, w, states.col(f));
      for (std::int64_t m = 0; m < markers; ++m) {
        const auto i = static_cast<std::size_t>(m);
        const std::size_t sample = out.markers.index(f, m);
        out.true_markers.x(f, m) = w.marker.col(m);
        out.true_markers.state[sample] = data::SampleState::measured;

        Eigen::Vector3d error;
        for (int axis = 0; axis < 3; ++axis) error[axis] = options.noise_sd_m * noise[i].gaussian();
        if (const int s = segments.of_marker[i]; s >= 0 && !slides.empty()) {
          const int body = segments.all[static_cast<std::size_t>(s)].body;
          error += w.rotation[static_cast<std::size_t>(body)] * slides[i].col(f);
        }
        Eigen::Map<Eigen::Vector3d> recorded_error(out.truth.marker_error.data() + 3 * sample);
        if (gaps[sample] != 0 || hidden[sample] != 0) {
          recorded_error.setConstant(NAN);
          continue;
        }
        out.markers.x(f, m) = w.marker.col(m) + error;
        out.markers.state[sample] = data::SampleState::measured;
        recorded_error = out.markers.x(f, m) - out.true_markers.x(f, m);
      }
    }
  });
  return out;
}

}  // namespace kinemark::simulation
