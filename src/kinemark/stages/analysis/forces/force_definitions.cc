// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/forces/contacts.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/forces/sway.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

using data::Quantity;
using View = const ForceView&;

constexpr std::string_view kForce = "ground reaction", kSway = "sway";
constexpr std::string_view kWinter = "Winter 2009, Biomechanics and Motor Control, ch. 5";
constexpr std::string_view kPrieto = "Prieto et al. 1996", kDefinition = "definition";

double duration(View v) { return static_cast<double>(v.load.size()) / v.rate_hz; }
double sway_time(View v) { return static_cast<double>(v.pressure.rows() - 1) / v.rate_hz; }

BrakingPropulsion travel(View v) {
  if (v.travel.isZero()) return {};
  return braking_propulsion(v.force * v.travel, v.rate_hz);
}

constexpr ForceDefinition step(std::string_view id, Quantity quantity, std::string_view title,
                               std::string_view formula, std::string_view source, double (*value)(View)) {
  return {.what = {id, kForce, quantity, title, formula, source}, .scope = ForceScope::step, .value = value};
}
constexpr ForceDefinition sway(std::string_view id, Quantity quantity, std::string_view title,
                               std::string_view formula, double (*value)(View)) {
  return {.what = {id, kSway, quantity, title, formula, kPrieto}, .scope = ForceScope::sway, .value = value};
}

constexpr std::array kDefinitions{
    step("grf_contact_time", Quantity::time, "Contact time", "load above 20 N until it is below 10 N",
         kDefinition, duration),
    step("grf_peak", Quantity::force, "Peak load", "largest vertical force", kWinter,
         [](View v) { return v.load.maxCoeff(); }),
    step("grf_first_peak", Quantity::force, "First hump of the load", "Fz1: largest in the first half",
         kWinter, [](View v) { return load_humps(v.load).first; }),
    step("grf_valley", Quantity::force, "Valley of the load", "least between the humps", kWinter,
         [](View v) { return load_humps(v.load).valley; }),
    step("grf_second_peak", Quantity::force, "Second hump of the load", "Fz2: largest in the second half",
         kWinter, [](View v) { return load_humps(v.load).second; }),
    step("grf_loading_rate", Quantity::force_rate, "Loading rate",
         "mean slope from 20 to 80 % of the first peak", "Milner et al. 2006",
         [](View v) { return loading_rate(v.load, v.rate_hz); }),
    step("grf_impulse", Quantity::impulse, "Vertical impulse", "time integral of the load", kWinter,
         [](View v) { return v.load.sum() / v.rate_hz; }),
    step("grf_braking_impulse", Quantity::impulse, "Braking impulse",
         "time integral of the force against the direction of travel", kWinter,
         [](View v) { return travel(v).braking; }),
    step("grf_propulsion_impulse", Quantity::impulse, "Propulsion impulse",
         "time integral of the force along the direction of travel", kWinter,
         [](View v) { return travel(v).propulsion; }),
    sway("cop_path", Quantity::length, "Path of the centre of pressure", "TOTEX: sum of steps",
         [](View v) { return path_length(v.pressure); }),
    sway("cop_velocity", Quantity::speed, "Mean velocity of the centre of pressure", "MVELO: path over time",
         [](View v) { return path_length(v.pressure) / sway_time(v); }),
    sway("cop_ellipse_area", Quantity::area, "95 % ellipse of the centre of pressure",
         "AREA-CE: 2 pi F(0.95; 2, n - 2) sqrt(s1^2 s2^2 - s12^2)",
         [](View v) { return ellipse_area(v.pressure); }),
    sway("cop_mean_distance", Quantity::length, "Mean distance of the centre of pressure",
         "MDIST: from its mean", [](View v) { return mean_distance(v.pressure); }),
    sway("cop_mean_frequency", Quantity::frequency, "Mean frequency of the centre of pressure",
         "MFREQ: MVELO / (2 pi MDIST)", [](View v) { return mean_frequency(v.pressure, sway_time(v)); }),
    sway("cop_range_first", Quantity::length, "Range of the centre of pressure, first level axis",
         "largest less smallest along x, or along y where x is up",
         [](View v) { return v.pressure.col(0).maxCoeff() - v.pressure.col(0).minCoeff(); }),
    sway("cop_range_second", Quantity::length, "Range of the centre of pressure, second level axis",
         "likewise along z, or along y where z is up",
         [](View v) { return v.pressure.col(1).maxCoeff() - v.pressure.col(1).minCoeff(); }),
};

}  // namespace

std::span<const ForceDefinition> force_definitions() { return kDefinitions; }

const ForceDefinition* find_force_definition(std::string_view id) {
  for (const auto& definition : kDefinitions)
    if (definition.what.id == id) return &definition;
  return nullptr;
}

}  // namespace kinemark::analysis
