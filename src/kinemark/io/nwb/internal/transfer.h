// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What was read of an HDF5 file, through a pipe from the process that read it to the one that asked.
#pragma once

#include <optional>

#include "kinemark/data/neural.h"
#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/pose_table.h"

namespace kinemark::io::internal {

/// Write a file, or why there is none, to a descriptor; false when that is closed on the other side.
[[nodiscard]] bool send(int fd, const Result<NwbFile>& file);
[[nodiscard]] bool send(int fd, const Result<PoseTable>& table);
[[nodiscard]] bool send(int fd, const Result<data::Neural>& neural);
[[nodiscard]] bool send(int fd, const Result<Carried>& carried);

/// The same from a descriptor, to its end. Whatever comes is checked: nothing where it is not what send()
/// writes, or claims more than `most_bytes`.
[[nodiscard]] std::optional<Result<NwbFile>> receive(int fd, std::size_t most_bytes);
[[nodiscard]] std::optional<Result<PoseTable>> receive_poses(int fd, std::size_t most_bytes);
[[nodiscard]] std::optional<Result<data::Neural>> receive_neural(int fd, std::size_t most_bytes);
[[nodiscard]] std::optional<Result<Carried>> receive_carried(int fd, std::size_t most_bytes);

}  // namespace kinemark::io::internal
