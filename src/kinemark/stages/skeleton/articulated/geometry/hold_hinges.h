// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Hinges: joints whose position along their axis the motion leaves open.
#pragma once

#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

namespace kinemark::skeleton::articulated {

/// The motion does not show where a hinge's centre lies along its axis. Refits the geometry with each of
/// these joints held at the point of its axis that is nearest to the markers of both segments; noise and
/// weights stay.
void hold_hinges(const ChainSamples& samples, const std::vector<HingeAxis>& hinges, FittedChain& fit);

}  // namespace kinemark::skeleton::articulated
