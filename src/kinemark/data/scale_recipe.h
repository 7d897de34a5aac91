// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace kinemark::data {

/// Two markers whose distance is compared.
struct MarkerPair {
  std::string first, second;  ///< names in the model
};

/// A body that grows with others, along the axes that count.
struct ScaledBody {
  std::string body;                                ///< name in the model
  Eigen::Vector3d axes = Eigen::Vector3d::Ones();  ///< of the body; 1 where it is scaled, else 0
};

/// One factor for several bodies: the mean over its pairs of measured over model distance.
struct ScaleMeasurement {
  std::string name;                ///< in reports
  std::vector<MarkerPair> pairs;   ///< averaged
  std::vector<ScaledBody> bodies;  ///< bodies and axes that the factor applies to
};

/// Factors of one body.
struct BodyFactors {
  std::string body;                                   ///< name in the model
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();  ///< > 0, along the axes of the body
};

/// Where scale factors come from.
enum class ScaleStep : std::uint8_t { measurements, manual };

/// How a general model becomes that of a subject: factors from distances of marker pairs, or given by hand,
/// and a mass. As made, it changes nothing.
struct ScaleRecipe {
  std::vector<ScaleMeasurement> measurements;  ///< factors from distances between markers
  std::vector<BodyFactors> manual;             ///< factors as given
  /// Later steps replace the factors of earlier ones.
  std::vector<ScaleStep> order{ScaleStep::measurements, ScaleStep::manual};
  double mass_kg = 0.0;                     ///< of the subject; 0: as the factors make it
  bool preserve_mass_distribution = false;  ///< masses keep their ratios; else they grow with the volume
  double first_time_s = -std::numeric_limits<double>::infinity();  ///< distances are averaged from here
  double last_time_s = std::numeric_limits<double>::infinity();    ///< to here, both included

  /// Whether anything has to be measured in a recording.
  [[nodiscard]] bool measures() const {
    return !measurements.empty() && std::ranges::find(order, ScaleStep::measurements) != order.end();
  }
};

}  // namespace kinemark::data
