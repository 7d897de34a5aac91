// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/poizner/arm_study.h"
#include "kinemark/pipeline/poizner/still_tree_study.h"
#include "kinemark/pipeline/poizner/wheel_study.h"

namespace kinemark::pipeline {

/// What `kinemark study poizner` is asked to do.
struct PoiznerJob {
  std::vector<std::uint64_t> seeds{1};  ///< one rig each
  int threads = 0;
};

/// "3", "1-10" or "1,4,7-9"; 1000 seeds at most.
[[nodiscard]] Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text);

/// One line of the table. Values that nobody gave are absent.
struct StudyRow {
  std::string quantity, unit;
  std::optional<double> paper;    ///< Poizner, Wooten & Salot (1986)
  std::optional<double> classic;  ///< their method on the simulated rig: median over seeds
  double ours = 0.0;              ///< worst over seeds; pooled where the quantity says so
  std::optional<double> limit;  ///< Cramer-Rao, or the standard deviation that came with the estimate: median
  std::optional<double> at_least, at_most;
  [[nodiscard]] bool pass() const {
    return !(at_least && !(ours >= *at_least)) && !(at_most && !(ours <= *at_most));
  }
};

/// The four turns of the wheel: two orientations, without and with the glint.
inline constexpr int kWheels = 4;
[[nodiscard]] simulation::WheelOptions study_wheel_options(int wheel);
[[nodiscard]] std::string_view wheel_name(int wheel);

/// Everything that one rig gave.
struct PoiznerSeed {
  std::uint64_t seed = 0;
  double chi2_per_dof = 0.0;
  StillOutcome tree;
  std::vector<WheelOutcome> wheels;
  ArmOutcome arm;
};

struct PoiznerStudy {
  std::vector<PoiznerSeed> seeds;
  std::vector<StudyRow> rows;
  [[nodiscard]] bool pass() const;
};

/// Run S1, S2 and S3 by both methods for every seed. About 1 s a seed on one thread. `progress` counts seeds.
[[nodiscard]] Result<PoiznerStudy> study_poizner(const PoiznerJob& job, const Progress& progress = {});

/// {"seeds": [...], "rows": [{quantity, unit, paper, classic, ours, limit, bound, pass}], "pass": ...}; bound
/// is a number (at most) or [at least, at most]; what is absent is null.
[[nodiscard]] nlohmann::ordered_json study_json(const PoiznerStudy& study);
/// The table for people.
[[nodiscard]] std::string study_table(const PoiznerStudy& study);

}  // namespace kinemark::pipeline
