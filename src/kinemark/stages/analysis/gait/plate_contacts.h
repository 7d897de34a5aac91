// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What loads a force plate, and which foot it is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

/// Loads that make a contact, N.
struct ContactLoads {
  double begins_n = 20.0;  ///< above it a contact begins, below half of it it ends
  double bears_n = 100.0;  ///< a contact that never bears more is no step
  double surely_n = 50.0;  ///< above it the centre of pressure means something
};

/// Frames with a load: first to last.
struct PlateSpan {
  std::int64_t first = 0, last = 0;
};

/// A plate and its load, with z up by `upright`.
class LoadedPlate {
 public:
  LoadedPlate(const data::Wrench& wrench, std::int64_t frames, const Eigen::Matrix3d& upright);

  /// N, upwards, less the unloaded plate's; NaN where not measured.
  [[nodiscard]] double load(std::int64_t frame) const { return load_[static_cast<std::size_t>(frame)]; }
  [[nodiscard]] double most_n() const;                       ///< the largest load; 0 of none
  [[nodiscard]] double noise_n() const { return noise_n_; }  ///< SD of the unloaded plate
  [[nodiscard]] const data::Wrench& wrench() const { return wrench_; }
  /// Centre of pressure, m.
  [[nodiscard]] Eigen::Vector3d centre(std::int64_t frame) const;
  /// A contact begins above it, N.
  [[nodiscard]] double begins(const ContactLoads& loads) const;

  /// Contacts of 0.15 to 3 s that begin and end within the recording.
  [[nodiscard]] std::vector<PlateSpan> contacts(double rate_hz, const ContactLoads& loads) const;
  /// The foot under which the force stays in nine of ten frames, where it is one alone.
  [[nodiscard]] std::optional<data::Side> foot_of(const PlateSpan& contact, const GaitPaths& paths,
                                                  const ContactLoads& loads) const;
  /// Whether heel and toe lie within the plate in the middle of the contact; true where its corners are not
  /// known.
  [[nodiscard]] bool bears_whole(const PlateSpan& contact, const FootPaths& foot) const;
  /// Median distance from the centre of pressure to the nearer foot, m, over the frames of a contact in which
  /// both are seen; NaN of fewer than five.
  [[nodiscard]] double distance_to_feet(const PlateSpan& contact, const GaitPaths& paths,
                                        const ContactLoads& loads) const;

 private:
  [[nodiscard]] double share_beside(const PlateSpan& contact, const FootPaths& foot,
                                    const ContactLoads& loads) const;

  const data::Wrench& wrench_;
  Eigen::Matrix3d upright_;
  std::vector<double> load_;
  double noise_n_ = 0.0;
};

}  // namespace kinemark::analysis
