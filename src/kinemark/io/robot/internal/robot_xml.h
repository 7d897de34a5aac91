// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <pugixml.hpp>
#include <string>

#include "kinemark/data/model_description.h"

namespace kinemark::io::robot {

/// "1 2 3", to the last bit.
[[nodiscard]] std::string numbers(const Eigen::Vector3d& v);
/// One number, to the last bit.
[[nodiscard]] std::string number(double value);

/// Sets an attribute that is new.
void set(pugi::xml_node node, const char* name, const std::string& value);

/// The document as text.
[[nodiscard]] std::string text_of(const pugi::xml_document& document);

/// What MuJoCo needs to be told where a body has no mass or an inertia that none can have: attributes of its
/// <compiler>. Sentences of what that changes go to `lost`.
void set_bounds(pugi::xml_node compiler, const data::ModelDescription& model, std::vector<std::string>& lost);

/// The inertia to write: the body's own, or, where its moments are not above 0, with those at a millionth of
/// the largest (1e-9 kg m^2 where there is none).
[[nodiscard]] Eigen::Matrix3d positive_inertia(const data::BodyDescription& body);

}  // namespace kinemark::io::robot
