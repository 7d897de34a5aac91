// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the light of an LED changes in the readings of a rig, and what the dark slots of a recording hold.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Light of an LED relative to those that the rig was calibrated with, with its standard deviation.
struct Light {
  double value = 1.0;  ///< > 0
  double sd = 0.0;     ///< >= 0
};

/// Stray light of an LED of light 1: the part of the offsets that grows with an LED's light, counts.
struct StrayLight {
  Eigen::Vector4d counts;  ///< of channels +x, -x, +y, -y
  double sd_counts = 0.0;  ///< of each channel, as far as it is not an error of the offset
  double share_sd = 0.0;   ///< of a factor that the counts of all channels and cameras have in common
  bool known = false;      ///< measured; else half of the offset, give or take
};
/// Offset less dark counts. Where dark counts are not known the stray light lies between none and all of the
/// offset, by a share that all channels have in common: half of it, with the standard deviation of an even
/// chance over that range, and 1 count of each channel by itself.
[[nodiscard]] StrayLight stray_light(const data::Detector& detector);

/// The rig as an LED of that light shows it: with light s, offsets are dark counts + s stray light. The
/// covariance becomes that of these offsets: s times the error of the offsets, |s - 1| times that of the
/// stray light, and the stray light times the error of s, which all cameras share. Of light 1 +- 0 it is the
/// same rig.
///
/// O(square of the parameters).
[[nodiscard]] data::Rig with_light(const data::Rig& rig, const Light& light);

/// What one camera reads in the dark slots of a recording.
struct DarkSlot {
  Eigen::Vector4d counts;   ///< means of the four channels, flicker of the room left out
  double sd_counts = 0.0;   ///< of each of these means
  Eigen::Vector2d flicker;  ///< cosine and sine at the room's frequency, counts, all channels alike
};
/// Least squares over all frames. No value without a dark slot, with fewer than 16 frames, where rate and
/// flicker cannot be told apart, and where a channel stands at 0 in a twentieth of the frames (its mean is
/// too high there). O(frames).
/// @param flicker_hz  of the room's lamps
[[nodiscard]] std::optional<DarkSlot> dark_slot(const data::Counts& counts, std::int64_t camera,
                                                double flicker_hz = 120.0);

/// Sets dark_counts of every camera of the rig from the dark slots of a recording; leaves a camera alone that
/// dark_slot() finds nothing for.
void find_dark_counts(const data::Counts& counts, data::Rig& rig);

/// The same, and offsets begin at the dark counts: a pedestal that nothing accounts for draws all points
/// towards the middle, by several per cent where an LED is dim. For a rig that is not calibrated yet.
void begin_in_the_dark(const data::Counts& counts, data::Rig& rig);

/// Amplifiers drift: where the dark slots of a recording surely read other counts than the rig's dark counts,
/// by kDrifted_counts or more in some channel, dark counts and offsets of that camera become those of the
/// recording, and the covariance of its offsets that of both.
/// @return  per camera, the largest change of a channel, counts; 0 where nothing was changed
std::vector<double> follow_dark_counts(const data::Counts& counts, data::Rig& rig);
inline constexpr double kDrifted_counts = 0.3;  ///< moves a point by some 0.03 mm in the middle of the room

}  // namespace kinemark::camera
