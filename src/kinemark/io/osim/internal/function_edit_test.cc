// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/function_edit.h"

#include <gtest/gtest.h>

#include "kinemark/io/osim/internal/function_xml.h"

namespace kinemark::io::osim {
namespace {

using math::ScalarFunction;

/// The function in an axis, times the factors one after the other, and how many multipliers it then has.
std::pair<ScalarFunction, int> multiplied(const char* function, std::initializer_list<double> factors) {
  auto file = XmlFile::parse(std::string("<axis>") + function + "</axis>", "axis.xml").value();
  for (const double factor : factors)
    multiply_function(file, find_function(file.document(), "function"), factor);
  const pugi::xml_node found = find_function(file.document(), "function");
  int multipliers = 0;
  for (pugi::xml_node node = found; std::string_view(node.name()) == "MultiplierFunction";
       node = first_element(node.child("function")))
    ++multipliers;
  return {read_function(file, found), multipliers};
}

TEST(MultiplyFunction, puts_one_multiplier_around_however_often) {
  for (const char* function :
       {"<LinearFunction name='function'><coefficients>2 1</coefficients></LinearFunction>",
        "<function><LinearFunction><coefficients>2 1</coefficients></LinearFunction></function>"}) {
    const auto [f, multipliers] = multiplied(function, {1.5, 2.0});
    EXPECT_EQ(multipliers, 1) << function;
    EXPECT_NEAR(f(0.5).f, 6.0, 1e-15) << function;
  }
}

TEST(MultiplyFunction, a_factor_of_one_changes_nothing) {
  EXPECT_EQ(multiplied("<Constant name='function'><value>3</value></Constant>", {1.0}).second, 0);
}

TEST(RatioOf, is_the_factor_between_two_functions) {
  const auto line = ScalarFunction::linear(0.3, 0.1);
  EXPECT_NEAR(ratio_of(line, line.scaled(1.7)).value(), 1.7, 1e-14);
  EXPECT_NEAR(ratio_of(ScalarFunction(), ScalarFunction::linear(2.0, 0.0)).value(), 2.0, 1e-14);
  EXPECT_EQ(ratio_of(line, line).value(), 1.0);
}

TEST(RatioOf, there_is_none_between_others_and_for_zero) {
  EXPECT_FALSE(ratio_of(ScalarFunction::linear(1.0, 0.0), ScalarFunction::linear(1.0, 0.1)));
  EXPECT_FALSE(ratio_of(ScalarFunction::linear(1.0, 1.0), ScalarFunction::linear(1.0, 2.0)));
  EXPECT_FALSE(ratio_of(ScalarFunction::constant(0.0), ScalarFunction::constant(0.0)));
}

}  // namespace
}  // namespace kinemark::io::osim
