// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io::osim {

/// Write the differences between two descriptions into the elements of a model, in place: masses, frames of
/// joints, translation functions, radii, points of loops, markers; joints of another kind; bodies, joints and
/// markers that are new. What is the same is not touched.
///
/// Not every difference has a place in an old document. Read the result back and compare (difference_of()).
///
/// @param model   element that `before` was read from; its offset frames may have been moved since
/// @return        fails as write_joint() for a joint that OpenSim has no form for
[[nodiscard]] Status edit_model(XmlFile& file, pugi::xml_node model, const data::ModelDescription& before,
                                const data::ModelDescription& after);

}  // namespace kinemark::io::osim
