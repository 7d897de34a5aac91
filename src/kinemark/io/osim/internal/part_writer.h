// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>
#include <string>

#include "kinemark/data/model_description.h"

namespace kinemark::io::osim {

/// Append a body to a BodySet's objects.
void write_body(pugi::xml_node objects, const data::BodyDescription& body);
/// Mass, mass centre and inertia of a body into its element; numbers that are there already are replaced.
void set_mass(pugi::xml_node node, const data::BodyDescription& body);
/// Append a marker to a MarkerSet's objects, in the structure of 4.0.
void write_marker(pugi::xml_node objects, const data::ModelDescription& description,
                  const data::MarkerDescription& marker);

/// OpenSim 4 refuses names with blanks and the characters \ * + /; it turned them into '_' itself when it
/// read older files.
void make_legal(std::string& name);
/// The description with such names throughout.
[[nodiscard]] data::ModelDescription with_legal_names(data::ModelDescription description);

}  // namespace kinemark::io::osim
