// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <pugixml.hpp>

#include "kinemark/io/osim/internal/xml_file.h"
#include "kinemark/math/scalar_function.h"

namespace kinemark::io::osim {

/// Multiply a function by a factor, in place and as OpenSim does: a MultiplierFunction gets another scale,
/// every other function one around it. A factor of 1 changes nothing.
void multiply_function(XmlFile& file, pugi::xml_node function, double factor);

/// The number that makes `before` to `after`, which differ by a factor alone. No value when they differ in
/// another way, or are zero.
[[nodiscard]] std::optional<double> ratio_of(const math::ScalarFunction& before,
                                             const math::ScalarFunction& after);

}  // namespace kinemark::io::osim
