// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/internal/rated_motion.h"

#include <fmt/core.h>

#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/data/resample_forces.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/workflow/prepare/axes.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow::internal {
namespace {

Status check_given(const model::Model& model, const GivenMotion& given) {
  const auto& motion = given.motion;
  if (auto s = motion.validate(); !s) return s;
  const auto& coordinates = model.description().coordinates;
  bool same = motion.coordinates.size() == coordinates.size();
  for (std::size_t c = 0; same && c < coordinates.size(); ++c)
    same = motion.coordinates[c] == coordinates[c].name;
  if (!same)
    return fail(Code::bad_input,
                fmt::format("its coordinates are not those of model '{}'", model.description().name));
  if (!given.is_filled.empty() && given.is_filled.size() != motion.q.size())
    return fail(Code::bad_input, fmt::format("{} of its {} numbers are said to be filled or not",
                                             given.is_filled.size(), motion.q.size()));
  return {};
}

void low_pass(double cutoff_hz, data::JointMotion& motion) {
  constexpr int kOrder = 3;
  const auto sections = math::butterworth_lowpass(kOrder, cutoff_hz / motion.time.rate_hz);
  std::vector<double> x(at(motion.frames()));
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    for (std::int64_t f = 0; f < motion.frames(); ++f) x[at(f)] = motion.q[motion.index(f, c)];
    math::filter_both_ways(sections, static_cast<int>(motion.frames() / 2), x);
    for (std::int64_t f = 0; f < motion.frames(); ++f) motion.q[motion.index(f, c)] = x[at(f)];
  }
}

/// Coupled coordinates follow those that drive them.
void couple(const model::Model& model, RatedMotion& rated) {
  auto& motion = rated.motion;
  for (const int c : model.coordinate_order()) {
    const auto& coordinate = model.coordinates()[at(c)];
    if (coordinate.source < 0) continue;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto to = motion.index(f, c), from = motion.index(f, coordinate.source);
      motion.q[to] = coordinate.coupling(motion.q[from]).f;
      rated.is_filled[to] = rated.is_filled[from];
    }
  }
}

/// Coordinates that somebody measured, as if each were the path of a marker along x.
data::Trajectories as_paths(const RatedMotion& rated) {
  const auto& motion = rated.motion;
  auto paths = data::Trajectories::all_missing(motion.coordinates, motion.time);
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      if (rated.is_filled[i] != 0 || motion.determined[i] == 0) continue;
      paths.x(f, c) = Eigen::Vector3d(motion.q[i], 0.0, 0.0);
      paths.state[paths.index(f, c)] = data::SampleState::measured;
    }
  return paths;
}

/// Rates of frames that were made between others are those of what made them, not of the movement.
Status refuse_made_frames(const RatedMotion& rated) {
  const auto factor = made_factor(as_paths(rated));
  if (!factor) return std::unexpected(factor.error());
  if (*factor == 1) return {};
  return fail(
      Code::bad_input,
      fmt::format("{} of every {} frames were interpolated between the others, which come at {:g} "
                  "Hz; their rates are not those of the movement. Solve the motion from the measured "
                  "frames of its recording ('kinemark clean --upsampled decimate' leaves them), or give "
                  "--cutoff",
                  *factor - 1, *factor, rated.motion.time.rate_hz / *factor));
}

Status check_cutoff(double cutoff_hz, double rate_hz) {
  if (!(cutoff_hz >= 0.0) || !std::isfinite(cutoff_hz))
    return fail(Code::usage, fmt::format("cut-off is {} Hz; need 0 (none) or more", cutoff_hz));
  if (cutoff_hz >= 0.5 * rate_hz)
    return fail(Code::usage, fmt::format("a cut-off of {:g} Hz needs more than {:g} Hz; the motion has {:g}",
                                         cutoff_hz, 2.0 * cutoff_hz, rate_hz));
  return {};
}

}  // namespace

Result<RatedMotion> rate_motion(const model::Model& model, const GivenMotion& given, double cutoff_hz) {
  if (auto s = check_given(model, given); !s) return fail_at(given.names.motion, s.error());
  if (auto s = check_cutoff(cutoff_hz, given.motion.time.rate_hz); !s) return std::unexpected(s.error());
  RatedMotion rated{.motion = given.motion, .is_filled = given.is_filled, .errors = {}};
  auto& motion = rated.motion;
  for (auto* found_anew : {&motion.qd, &motion.qdd, &motion.tau, &motion.tau_sd}) found_anew->clear();
  if (rated.is_filled.empty()) rated.is_filled.assign(motion.q.size(), 0);
  if (motion.determined.empty()) motion.determined.assign(motion.q.size(), 1);
  if (cutoff_hz > 0.0) {
    low_pass(cutoff_hz, motion);
    motion.q_sd.clear();
  } else if (auto s = refuse_made_frames(rated); !s) {
    return fail_at(given.names.motion, s.error());
  }
  couple(model, rated);
  for (std::size_t i = 0; i < motion.q.size(); ++i)
    motion.determined[i] = motion.determined[i] != 0 && rated.is_filled[i] == 0 &&
                           (motion.q_sd.empty() || !std::isnan(motion.q_sd[i]));
  auto errors = motion::estimate_rates(model, motion);
  if (!errors) return fail_at(given.names.motion, errors.error());
  rated.errors = std::move(*errors);
  return rated;
}

Result<TorquesFound> find_torques(const model::Model& model, const GivenMotion& given, RatedMotion& rated,
                                  const motion::DynamicsOptions& options) {
  TorquesFound found;
  auto& motion = rated.motion;
  if (given.forces) {
    if (auto s = given.forces->validate(); !s) return fail_at(given.names.forces, s.error());
    found.forces = resample(*given.forces, motion.time);
    if (auto s = check_forces(*found.forces, {}, model); !s) return fail_at(given.names.forces, s.error());
  }
  auto account = add_torques(model, motion, found.forces ? &*found.forces : nullptr, options, &rated.errors);
  if (!account)
    return given.forces ? fail_at(given.names.forces, account.error()) : std::unexpected(account.error());
  found.account = std::move(*account);
  return found;
}

}  // namespace kinemark::workflow::internal
