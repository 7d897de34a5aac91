// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/address_settings.h"
#include "kinemark/stream/clock.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// "sim:rig?scene=wheel|sign|tree&leds=N&cameras=1|2&rate=HZ&seconds=S&speed=FACTOR|fast&clock_ppm=P&dark&
/// buffer=S&unplug_at=S&unplug_for=S&dark_led=N&bright_led=N&noisy_channel=N&afterglow=SHARE&seed=N": the
/// simulated rig as it comes. The rig and, with `seconds`, the counts are those that `simulate rig` draws
/// with the same seed, scene, LEDs and rate.
/// @param seed  where the address has none
[[nodiscard]] Result<std::unique_ptr<stream::Device>> open_sim_rig(AddressSettings settings,
                                                                   std::uint64_t seed,
                                                                   std::shared_ptr<stream::HostClock> clock);

}  // namespace kinemark::pipeline
