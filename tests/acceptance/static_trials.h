// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Static trials to judge: of laboratories, beside a walk of the session where there is one, and of simulated
// subjects.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::testing_support {

/// A static trial, the body that it is judged against, and its movement where there is one.
struct StaticCase {
  std::string name;
  motion::StandingBody body;
  data::Trajectories still;
  std::optional<data::Trajectories> movement;
  motion::FoundationJudgement clean = {};  ///< of the trial as it is
};

/// The judgement of a recording in place of the case's static trial.
[[nodiscard]] motion::FoundationJudgement judge(const StaticCase& c, const data::Trajectories& still);

/// A static trial of a file, judged by its markers' names, beside a movement where one is named.
[[nodiscard]] StaticCase recorded_case(const std::filesystem::path& still,
                                       const std::filesystem::path& movement);

/// Of five laboratories, each beside a walk of the session.
[[nodiscard]] std::vector<StaticCase> cases_beside_a_walk(const std::filesystem::path& data);

/// Files, below the data folder, in which somebody stands still or moves, with no movement beside them.
[[nodiscard]] const std::vector<std::string>& lone_recordings();

/// Subjects of our own: another size for every segment, sides a little unlike, markers placed by hand. By
/// names they come with a movement.
[[nodiscard]] StaticCase simulated_case(std::uint64_t seed, bool by_names);

/// Three normal numbers, drawn in order.
[[nodiscard]] Eigen::Vector3d some_vector(Random& random);

/// The recording with one marker moved in all frames.
[[nodiscard]] data::Trajectories with_shift(const data::Trajectories& still, std::int64_t marker,
                                            const Eigen::Vector3d& shift);

/// The recording with two markers exchanged in all frames.
[[nodiscard]] data::Trajectories with_exchange(const data::Trajectories& still, std::int64_t first,
                                               std::int64_t second);

}  // namespace kinemark::testing_support
