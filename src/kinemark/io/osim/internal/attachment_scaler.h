// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <pugixml.hpp>
#include <span>

#include "kinemark/data/model_description.h"
#include "kinemark/data/muscle_path.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// Stretch what hangs on the bodies and is not part of a description, in place, as OpenSim's ScaleTool does:
/// path points, surfaces that paths bend around, display geometry, stations, offset frames. Contact geometry
/// keeps its place and size, as it does there.
///
/// @param factors  one per body of the description, along its axes
void scale_attachments(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description,
                       std::span<const Eigen::Vector3d> factors);

/// Multiply the lengths at rest of what owns a path (optimal fibre, tendon slack, resting and slack length)
/// by the path's ratio.
void scale_rest_lengths(XmlFile& file, pugi::xml_node model, std::span<const data::PathScale> paths);

}  // namespace kinemark::io::osim
