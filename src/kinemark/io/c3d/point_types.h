// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {

/// A parameter of POINT that lists labels of one kind of point.
struct C3dPointType {
  std::string_view list;      ///< "ANGLES"
  std::string_view singular;  ///< "ANGLE": units are in ANGLE_UNITS, and TYPE_GROUPS pairs both
  data::ChannelKind kind;     ///< what its points are
};

/// What Vicon, Qualisys and Visual3D write.
inline constexpr std::array<C3dPointType, 6> kC3dPointTypes = {
    {{"ANGLES", "ANGLE", data::ChannelKind::angle},
     {"FORCES", "FORCE", data::ChannelKind::force},
     {"MOMENTS", "MOMENT", data::ChannelKind::moment},
     {"POWERS", "POWER", data::ChannelKind::power},
     {"SCALARS", "SCALAR", data::ChannelKind::scalar},
     {"MODELED_MARKERS", "MODELED_MARKER", data::ChannelKind::modeled_marker}}};

/// Separate markers from points of another kind: those that a list of kC3dPointTypes, or of
/// POINT:TYPE_GROUPS, names move from trial.markers.names to trial.channels, and the layout learns which are
/// which.
void sort_points(const C3dParameters& parameters, C3dLayout& layout, data::Trial& trial);

}  // namespace kinemark::io
