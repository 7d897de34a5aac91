// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::io::osim {

/// "/ground" or "/bodyset/<name>".
[[nodiscard]] std::string body_path(const data::ModelDescription& description, int body_idx);

/// Append one joint to a JointSet's objects. What OpenSim has no form for is refused, see format_osim().
[[nodiscard]] Status write_joint(pugi::xml_node objects, const data::ModelDescription& description,
                                 const data::JointDescription& joint);

/// Index of the joint that is the first half of the scapulothoracic joint `winging`, if both still are what
/// split() makes and nothing else uses the body between them; else -1.
[[nodiscard]] int find_sliding_half(const data::ModelDescription& description,
                                    const data::JointDescription& winging);

}  // namespace kinemark::io::osim
