// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Paths of objects in the files that we write, shared by reader and writer. docs/formats/nwb.md
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/derivatives.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::io::internal {

/// What NWB, which demands a date, a subject and an age, is given where there is none.
inline constexpr const char* kUnknownDate = "1970-01-01T00:00:00+00:00";
inline constexpr const char* kUnknownSubject = "unknown";
inline constexpr const char* kUnknownAge = "P0D/";  ///< no younger than 0 days
inline constexpr const char* kModule = "/processing/behavior";
inline constexpr const char* kPosition = "Position";
inline constexpr const char* kPose = "PoseEstimation";
inline constexpr const char* kSkeletons = "Skeletons";
inline constexpr const char* kMethod = "Method";
inline constexpr const char* kCovariance = "Covariance";
inline constexpr const char* kOffset = "SampleOffset";
inline constexpr const char* kUnfiltered = "Unfiltered";
inline constexpr const char* kResidual = "Residual";
inline constexpr const char* kCameras = "Cameras";
inline constexpr const char* kChannels = "Channels";
inline constexpr const char* kAcquisition = "/acquisition";
inline constexpr const char* kIntervals = "/intervals";
inline constexpr const char* kUnitsTable = "/units";
inline constexpr const char* kElectrodes = "/general/extracellular_ephys/electrodes";
inline constexpr const char* kUnloaded = "plates_unloaded";
inline constexpr const char* kMarkersTable = "markers";
inline constexpr const char* kChannelsTable = "channels";
inline constexpr const char* kAnalogTable = "analog_channels";
inline constexpr const char* kEventsTable = "events";
inline constexpr const char* kPlatesTable = "force_plates";
inline constexpr const char* kMethodsTable = "methods";
inline constexpr const char* kCalibrationTable = "calibration";
inline constexpr const char* kProvenanceTable = "provenance";
inline constexpr const char* kSourcesTable = "sources";

inline constexpr std::array kStates = {data::SampleState::missing,      data::SampleState::measured,
                                       data::SampleState::interpolated, data::SampleState::model_filled,
                                       data::SampleState::upsampled,    data::SampleState::rejected};

/// One array of data::Derivatives and the container that holds it in the file.
struct Rate {
  const char* container;
  const char* unit;
  const char* description;
  Array<double> data::Derivatives::* values;
};
inline constexpr std::array kRates = {
    Rate{"Velocity", "meters/second", "velocity (x, y, z)", &data::Derivatives::velocity},
    Rate{"VelocitySD", "meters/second", "standard deviation of velocity (x, y, z)",
         &data::Derivatives::velocity_sd},
    Rate{"Acceleration", "meters/second^2", "acceleration (x, y, z)", &data::Derivatives::acceleration},
    Rate{"AccelerationSD", "meters/second^2", "standard deviation of acceleration (x, y, z)",
         &data::Derivatives::acceleration_sd},
    Rate{"Jerk", "meters/second^3", "jerk (x, y, z)", &data::Derivatives::jerk},
    Rate{"JerkSD", "meters/second^3", "standard deviation of jerk (x, y, z)", &data::Derivatives::jerk_sd}};

/// Names of groups for names of markers: HDF5 and NWB do not allow / : and some others in them. Unique.
[[nodiscard]] std::vector<std::string> series_names(const std::vector<std::string>& markers);

}  // namespace kinemark::io::internal
