// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

namespace kinemark::io::osim {

/// Convert a model of the first versions (before 2.0) to the structure of 2.0, in place: the contents of the
/// dynamics engine move into the model, SimbodyBody and its like become Body, and the degrees of freedom of a
/// joint
/// (DofSet, TransformAxisSet) become a CustomJoint's SpatialTransform. Does nothing to newer models.
void modernise(pugi::xml_node model);

}  // namespace kinemark::io::osim
