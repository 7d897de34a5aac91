// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A/D boards that Linux drives by comedi.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"

namespace kinemark::stream {

/// Open a board, "/dev/comedi0". Its analog inputs, four by four, are cameras; each LED has a scan of its
/// own, which begins with the first conversion. Codes of more than 15 bits lose their lowest ones. When the
/// kernel's buffer ran over, the scans begin again and frames are numbered on by the host's clock.
/// Code::device when there is no board, no permission, another program on it, or no inputs that can be
/// scanned; Code::not_supported without libcomedi.
[[nodiscard]] Result<std::unique_ptr<Device>> open_comedi(const std::string& path);

/// Boards that are there: /dev/comedi0 and so on. `state` says why one cannot be opened.
[[nodiscard]] std::vector<DeviceInfo> list_comedi(const std::filesystem::path& devices = "/dev");

}  // namespace kinemark::stream
