// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/function_xml.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/io/osim/internal/format_xml.h"

namespace kinemark::io::osim {

using math::ScalarFunction;

namespace {

constexpr std::size_t kMaxKnots = 10000;

double finite_number(XmlFile& file, pugi::xml_node element, const char* child, double fallback) {
  const double value = file.number(element, child, fallback);
  if (!std::isfinite(value)) file.note(element.child(child), "must be finite");
  return value;
}

ScalarFunction read_polynomial(XmlFile& file, pugi::xml_node element) {
  auto coefficients = file.numbers(element, "coefficients");
  if (coefficients.size() > 100) {
    file.note(element, fmt::format("has {} coefficients; at most 100 are read", coefficients.size()));
    return ScalarFunction::constant(0.0);
  }
  std::ranges::reverse(coefficients);  // the file has the highest power first
  return ScalarFunction::polynomial(std::move(coefficients));
}

ScalarFunction read_linear(XmlFile& file, pugi::xml_node element) {
  const auto coefficients = file.numbers(element, "coefficients");
  if (coefficients.empty()) return {};  // OpenSim's default, the identity
  if (coefficients.size() != 2)
    file.note(element, fmt::format("has {} coefficients; need slope and offset", coefficients.size()));
  return ScalarFunction::linear(coefficients.front(), coefficients.back());
}

ScalarFunction read_knots(XmlFile& file, pugi::xml_node element, bool smooth) {
  auto x = file.numbers(element, "x"), y = file.numbers(element, "y");
  if (x.size() > kMaxKnots) {
    file.note(element, fmt::format("has {} knots; at most {} are read", x.size(), kMaxKnots));
    return ScalarFunction::constant(0.0);
  }
  auto f = smooth ? ScalarFunction::simm_spline(std::move(x), std::move(y))
                  : ScalarFunction::piecewise_linear(std::move(x), std::move(y));
  if (!f) file.note(element, f.error().message);
  return f.value_or(ScalarFunction::constant(0.0));
}

bool is_function(std::string_view tag) {
  return tag.ends_with("Function") || tag.ends_with("Spline") || tag == "Constant" || tag == "Sine";
}

}  // namespace

pugi::xml_node find_function(pugi::xml_node owner, const char* property) {
  if (const pugi::xml_node wrapper = owner.child(property)) return first_element(wrapper);
  if (const pugi::xml_node named = owner.find_child_by_attribute("name", property)) return named;
  return owner.find_child([](pugi::xml_node child) { return is_function(child.name()); });
}

ScalarFunction read_function(XmlFile& file, pugi::xml_node element) {
  double factor = 1.0;
  while (std::string_view(element.name()) == "MultiplierFunction") {
    factor *= finite_number(file, element, "scale", 1.0);
    const pugi::xml_node inner = find_function(element, "function");
    if (!inner) {
      file.note(element, "has no function inside");
      return ScalarFunction::constant(0.0);
    }
    element = inner;
  }
  const std::string_view tag = element.name();
  ScalarFunction f;
  if (tag == "Constant") {
    f = ScalarFunction::constant(finite_number(file, element, "value", 0.0));
  } else if (tag == "LinearFunction") {
    f = read_linear(file, element);
  } else if (tag == "PolynomialFunction") {
    f = read_polynomial(file, element);
  } else if (tag == "Sine") {
    f = ScalarFunction::sine(
        finite_number(file, element, "amplitude", 1.0), finite_number(file, element, "omega", 1.0),
        finite_number(file, element, "phase", 0.0), finite_number(file, element, "offset", 0.0));
  } else if (tag == "SimmSpline" || tag == "NaturalCubicSpline" || tag == "natCubicSpline") {
    f = read_knots(file, element, true);
  } else if (tag == "PiecewiseLinearFunction") {
    f = read_knots(file, element, false);
  } else {
    file.note(element, fmt::format("functions of the kind {} are not supported here", tag),
              Code::not_supported);
    return ScalarFunction::constant(0.0);
  }
  return factor == 1.0 ? f : f.scaled(factor);
}

void write_function(pugi::xml_node owner, const char* property, const ScalarFunction& function) {
  pugi::xml_node holder = owner.append_child(property);
  if (function.factor() != 1.0) {
    pugi::xml_node multiplier = holder.append_child("MultiplierFunction");
    holder = multiplier.append_child("function");
    append_number(multiplier, "scale", function.factor());
  }
  const auto& c = function.coefficients();
  switch (function.kind()) {
    case ScalarFunction::Kind::constant:
      append_number(holder.append_child("Constant"), "value", c[0]);
      break;
    case ScalarFunction::Kind::polynomial:
      append_numbers(holder.append_child(c.size() == 2 ? "LinearFunction" : "PolynomialFunction"),
                     "coefficients", {c.rbegin(), c.rend()});
      break;
    case ScalarFunction::Kind::sine: {
      const pugi::xml_node sine = holder.append_child("Sine");
      append_number(sine, "amplitude", c[0]);
      append_number(sine, "omega", c[1]);
      append_number(sine, "phase", c[2]);
      append_number(sine, "offset", c[3]);
      break;
    }
    case ScalarFunction::Kind::simm_spline:
    case ScalarFunction::Kind::natural_spline:
    case ScalarFunction::Kind::piecewise_linear: {
      const bool smooth = function.kind() == ScalarFunction::Kind::simm_spline;
      const pugi::xml_node knots = holder.append_child(smooth ? "SimmSpline" : "PiecewiseLinearFunction");
      append_numbers(knots, "x", function.knots_x());
      append_numbers(knots, "y", function.knots_y());
      break;
    }
  }
}

}  // namespace kinemark::io::osim
