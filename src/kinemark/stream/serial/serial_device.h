// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The rig on a microcontroller as a device: docs/formats/serial-rig.md.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"
#include "kinemark/stream/serial/frame_decoder.h"

namespace kinemark::stream {

/// Open the rig on a serial line and ask what it is. A board that starts again when it is opened has 4 s to
/// answer. Code::device when there is no line, no permission, another program on it, or no rig.
[[nodiscard]] Result<std::unique_ptr<Device>> open_serial(const std::string& path);

/// Lines that could have a rig: those of /dev/serial/by-id, whose names survive another socket, then
/// /dev/ttyACM* and /dev/ttyUSB* that are not among them. `state` says why one cannot be opened. Nothing is
/// sent to them.
[[nodiscard]] std::vector<DeviceInfo> list_serial(const std::filesystem::path& devices = "/dev");

}  // namespace kinemark::stream
