// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the acceptance programs on the tai chi recording share.
#pragma once

#include <filesystem>

#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/v3d.h"
#include "studies/taichi/landmarks.h"
#include "support/test_data.h"

namespace kinemark::acceptance {

inline constexpr double kMillimetres = 1e3;

inline data::ModelDescription human() {
  return io::read_osim(testing_support::project_folder() / "models/human.osim").value();
}

/// Of a study that ran at 179 Hz (UMONS-TAICHI).
inline Result<io::V3dFile> read_tai_chi(const std::filesystem::path& data) {
  return io::read_v3d(data / "motionmachine-taichi/taichi.v3d", {.rate_hz = 179.0});
}

inline data::Trajectories tai_chi_landmarks(const std::filesystem::path& data) {
  return studies::prepare_landmarks(read_tai_chi(data).value().trial.markers).value();
}

}  // namespace kinemark::acceptance
