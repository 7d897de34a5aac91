// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which foot bears what force plates measure, and when nobody measures what a foot bears.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/kinetics/chain_dynamics.h"

namespace kinemark::analysis {

/// Points of a foot that touch the floor, in F frames.
struct FootTrack {
  std::string name;                      ///< as sentences call it
  std::vector<Eigen::MatrixX3d> points;  ///< each F x 3, m; NaN where not known
};

/// What a foot bears.
struct FloorLoad {
  /// A stretch of load on one plate.
  struct Contact {
    std::size_t plate = 0;              ///< of the wrenches
    std::int64_t first = 0, count = 0;  ///< frames
  };
  WrenchTrack wrench;             ///< on the foot; 0 where it bears nothing
  std::vector<bool> known;        ///< F: false where it is on the floor and no plate tells its load alone
  std::vector<Contact> contacts;  ///< that are its own, by time
};

/// Loads of all feet.
struct FloorLoads {
  std::vector<FloorLoad> feet;     ///< as given
  std::vector<std::string> notes;  ///< a sentence each
};

/// Give each stretch of load on a plate (20 N for 0.05 s, from and to 5 N) to the foot whose points are
/// nearest to the centre of pressure.
///
/// A foot is on the floor where one of its points moves slower than 0.4 m/s. Its load is not known where it
/// is on the floor more than 0.1 s away from a contact of its own; where both feet are on one plate; in a
/// contact during which one of its points lies outside of the plates that it loads for a fifth of the time,
/// by more than 30 mm; and where a plate that bears it was not measured. A contact with no foot within 0.15 m
/// is nobody's.
///
/// @param plates  forces that were not cut off at a threshold, F frames; nothing is concluded from corners
///                that are not known
/// @param up      unit vector against gravity
[[nodiscard]] FloorLoads find_floor_loads(const data::Wrenches& plates, std::span<const FootTrack> feet,
                                          const Eigen::Vector3d& up);

}  // namespace kinemark::analysis
