// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// read_nwb(), read_neural() and read_pose_table(): what the program that reads sends of a file.
#include "kinemark/io/nwb/internal/apart.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/pose_table.h"

namespace kinemark::io {
namespace {

internal::ApartJob job_of(const std::filesystem::path& path, std::vector<std::string> what) {
  return {.file = path, .name = path.string(), .what = std::move(what), .undone = "Nothing was read."};
}

}  // namespace

Result<NwbFile> read_nwb(const std::filesystem::path& path) {
  return internal::run_apart<NwbFile>(job_of(path, {}), internal::receive);
}

Result<data::Neural> read_neural(const std::filesystem::path& path) {
  return internal::run_apart<data::Neural>(job_of(path, {"neural"}), internal::receive_neural);
}

Result<data::Neural> read_neural_lanes(const std::filesystem::path& path) {
  return internal::run_apart<data::Neural>(job_of(path, {"lanes"}), internal::receive_neural);
}

Result<PoseTable> read_pose_table(const std::filesystem::path& path) {
  return internal::run_apart<PoseTable>(job_of(path, {"poses"}), internal::receive_poses);
}

}  // namespace kinemark::io
