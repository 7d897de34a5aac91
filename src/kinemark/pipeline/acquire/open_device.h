// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/clock.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// Open the device that an address names: "sim:rig?...", "replay:FILE?...". Nothing runs yet.
/// @param seed   of a simulation, where its address has none
/// @param clock  by which blocks are said to have come; nullptr: the machine's
/// Code::usage for an address of no device, for a setting that is none or out of range; Code::device where
/// there is no such device, or it cannot be had now.
[[nodiscard]] Result<std::unique_ptr<stream::Device>> open_device(
    std::string_view uri, std::uint64_t seed = 1, std::shared_ptr<stream::HostClock> clock = nullptr);

/// The devices that are there, whether they can be opened now or not; simulations come last.
[[nodiscard]] std::vector<stream::DeviceInfo> enumerate_devices();

}  // namespace kinemark::pipeline
