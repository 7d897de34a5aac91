// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/function_edit.h"

#include <cmath>
#include <string_view>

#include "kinemark/io/osim/internal/format_xml.h"

namespace kinemark::io::osim {

void multiply_function(XmlFile& file, pugi::xml_node function, double factor) {
  if (factor == 1.0) return;
  if (std::string_view(function.name()) == "MultiplierFunction") {
    set_numbers(function, "scale", {factor * file.number(function, "scale", 1.0)});
    return;
  }
  pugi::xml_node multiplier = function.parent().insert_child_before("MultiplierFunction", function);
  if (const auto name = function.attribute("name")) {
    multiplier.append_attribute("name").set_value(name.value());
    function.remove_attribute("name");
  }
  multiplier.append_child("function").append_move(function);
  append_number(multiplier, "scale", factor);
}

std::optional<double> ratio_of(const math::ScalarFunction& before, const math::ScalarFunction& after) {
  std::optional<double> ratio;
  for (const double x : {0.0, 0.1, -0.4, 0.9, -1.7}) {
    const double a = before(x).f, b = after(x).f;
    if (a == 0.0 && b == 0.0) continue;
    if (a == 0.0 || !std::isfinite(b / a)) return std::nullopt;
    if (ratio && std::abs(*ratio - b / a) > 1e-9 * std::abs(*ratio)) return std::nullopt;
    if (!ratio) ratio = b / a;
  }
  return ratio;
}

}  // namespace kinemark::io::osim
