// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "studies/taichi/study_taichi.h"

namespace kinemark::studies {

struct TaiChiFiles {
  std::filesystem::path data;  ///< recording of the 21 landmarks; empty: simulated subjects
  double rate_hz = 0.0;        ///< for a file that stores none; 0: 179, as the tai chi data were recorded
  std::vector<std::uint64_t> seeds{1};  ///< of the simulated subjects
  int threads = 1;
};

/// Read the recording, if one is named, and study it with kinemark's own human.
[[nodiscard]] Result<TaiChiStudy> run_study_taichi(const TaiChiFiles& files, const Progress& progress = {});

}  // namespace kinemark::studies
