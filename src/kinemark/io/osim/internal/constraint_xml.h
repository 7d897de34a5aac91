// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// Reads one constraint into the description: CoordinateCouplerConstraint, PointConstraint, and
/// WeldConstraint as three points. A disabled one is passed over, any other type leaves a warning that it is
/// not enforced.
void read_constraint(XmlFile& file, FrameTable& frames, pugi::xml_node node,
                     data::ModelDescription& description);

}  // namespace kinemark::io::osim
