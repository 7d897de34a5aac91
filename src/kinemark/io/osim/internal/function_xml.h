// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pugixml.hpp>

#include "kinemark/io/osim/internal/xml_file.h"
#include "kinemark/math/scalar_function.h"

namespace kinemark::io::osim {

/// The element with the function that `owner` holds under the property `property`, in either spelling:
/// `<property><SimmSpline/></property>` or `<SimmSpline name="property"/>`. Empty if there is none.
[[nodiscard]] pugi::xml_node find_function(pugi::xml_node owner, const char* property);

/// Constant, LinearFunction, PolynomialFunction, Sine, SimmSpline (NaturalCubicSpline and natCubicSpline are
/// its old names and not natural splines at all), PiecewiseLinearFunction, and MultiplierFunction around any
/// of them. Any other kind is noted in `file` and the constant 0 returned.
[[nodiscard]] math::ScalarFunction read_function(XmlFile& file, pugi::xml_node element);

/// Append the function to `owner` as the property `property`, so that read_function() gives the same values
/// back, bit for bit.
void write_function(pugi::xml_node owner, const char* property, const math::ScalarFunction& function);

}  // namespace kinemark::io::osim
