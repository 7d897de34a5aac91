// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "studies/common/study_table.h"
#include "studies/poizner/arm_study.h"
#include "studies/poizner/as_built_study.h"
#include "studies/poizner/still_tree_study.h"
#include "studies/poizner/wheel_study.h"

namespace kinemark::studies {

/// What `kinemark study poizner` is asked to do.
struct PoiznerJob {
  std::vector<std::uint64_t> seeds{1};  ///< one rig each
  bool as_built = false;                ///< rigs with the faults of 1986; else such as a workshop would build
  int threads = 0;
};

/// The four turns of the wheel: two orientations, without and with the glint.
inline constexpr int kWheels = 4;
[[nodiscard]] simulation::WheelOptions study_wheel_options(int wheel);
[[nodiscard]] std::string_view wheel_name(int wheel);

/// Results of one rig.
struct PoiznerSeed {
  std::uint64_t seed = 0;
  double chi2_per_dof = 0.0;
  StillOutcome tree;
  std::vector<WheelOutcome> wheels;
  ArmOutcome arm;
};

struct PoiznerStudy {
  std::vector<PoiznerSeed> seeds;        ///< none of rigs as built
  std::vector<AsBuiltOutcome> as_built;  ///< rigs as built
  /// `classic` is the method of 1986: median over seeds. `ours`: worst over seeds; pooled where the quantity
  /// says so. `expected`: of the rigs whose result `ours` is.
  StudyTable table;
};

/// Run S1, S2 and S3 by both methods for every seed. About 1 s a seed on one thread. `progress` counts seeds.
[[nodiscard]] Result<PoiznerStudy> study_poizner(const PoiznerJob& job, const Progress& progress = {});

}  // namespace kinemark::studies
