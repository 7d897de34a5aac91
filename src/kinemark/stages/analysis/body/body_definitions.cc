// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/body_definitions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/stages/analysis/body/balance.h"
#include "kinemark/stages/analysis/body/coupling.h"

namespace kinemark::analysis {
namespace {

using data::Quantity;
using Eigen::VectorXd;
using View = const BodyView&;

constexpr std::string_view kJoint = "joint", kCoupling = "coupling", kBody = "body";
constexpr std::string_view kDefinition = "definition";
constexpr std::string_view kWinter = "Winter 2009, Biomechanics and Motor Control, ch. 6";
constexpr std::string_view kChang = "Chang, Van Emmerik & Hamill 2008";
constexpr std::string_view kHof = "Hof, Gazendam & Sinke 2005";
constexpr std::string_view kHerr = "Herr & Popovic 2008";

VectorXd angle(View v) { return v.of(v.series.q, v.a); }
VectorXd velocity(View v) { return v.of(v.series.v, v.a); }
VectorXd acceleration(View v) { return v.of(v.series.a, v.a); }

// Kinetics of the stretch, over mass where that is asked for.
double per_mass(View v, double value) { return v.normalized ? value / v.record.mass_kg : value; }
VectorXd power(View v) { return v.of(v.series.tau, v.a).cwiseProduct(v.of(v.series.v, v.a)); }

// Time integral of the part of the power that has the sign; 0: all of it. Trapezoids.
double work(View v, int sign) {
  VectorXd p = power(v);
  if (!p.allFinite()) return kNaN;
  if (sign > 0) p = p.cwiseMax(0.0);
  if (sign < 0) p = p.cwiseMin(0.0);
  const double ends = 0.5 * (p[0] + p[p.size() - 1]);
  return per_mass(v, (p.sum() - ends) / v.record.time.rate_hz);
}

// Nothing where a value is not known.
VectorXd if_known(VectorXd x) { return x.allFinite() ? std::move(x) : VectorXd(); }
VectorXd over_mass(View v, VectorXd x) {
  if (v.normalized) x /= v.record.mass_kg;
  return if_known(std::move(x));
}
VectorXd moments(View v) { return over_mass(v, v.of(v.series.tau, v.a)); }
VectorXd powers(View v) { return over_mass(v, power(v)); }

double share(View v, std::size_t pattern) {
  return coordination_shares(v.of(v.series.q, v.a), v.of(v.series.q, v.b))[pattern];
}

bool has_centre(View v) { return v.series.centre.rows() > 0; }
auto centre(View v) { return v.series.centre.middleRows(v.first, v.count); }

// Horizontal velocities, one behind the other.
VectorXd level_velocities(View v) {
  if (!has_centre(v)) return {};
  const auto level = level_of(v.record.up);
  VectorXd out(3 * v.count);
  for (std::int64_t f = 0; f < v.count; ++f)
    out.segment<3>(3 * f) << level(v.series.centre_velocity.row(v.first + f)), 0.0;
  return out;
}

VectorXd heights(View v) { return has_centre(v) ? VectorXd(centre(v) * v.record.up) : VectorXd(); }

VectorXd speeds(View v) {
  if (!has_centre(v)) return {};
  return v.series.centre_velocity.middleRows(v.first, v.count).rowwise().norm();
}

// Mass, mean speed and mean height of the mass centre: what an angular momentum is compared with.
double momentum_scale(View v) {
  if (!v.normalized) return 1.0;
  const double speed = v.series.centre_velocity.middleRows(v.first, v.count).rowwise().norm().mean();
  double ground = std::numeric_limits<double>::infinity();
  for (const auto& foot : v.series.outline)
    for (const auto& point : foot)
      ground = std::min(ground, (point.middleRows(v.first, v.count) * v.record.up).minCoeff());
  const double height = (centre(v) * v.record.up).mean() - ground;
  return std::isfinite(height) ? v.record.mass_kg * speed * height : kNaN;
}

VectorXd momentum(View v, Eigen::Index axis) {
  if (v.series.momentum.rows() == 0) return {};
  return if_known(v.series.momentum.col(axis).segment(v.first, v.count) / momentum_scale(v));
}
VectorXd momentum_size(View v) {
  if (v.series.momentum.rows() == 0) return {};
  return if_known(v.series.momentum.middleRows(v.first, v.count).rowwise().norm() / momentum_scale(v));
}

// Of the frames in which something stands.
double mean_of(const VectorXd& margins) {
  double sum = 0.0, count = 0.0;
  for (const double m : margins)
    if (!std::isnan(m)) sum += m, count += 1.0;
  return count > 0.0 ? sum / count : kNaN;
}
VectorXd margins(View v) { return stability_margins(v.series, v.record, v.contact, v.first, v.count); }

constexpr BodyDefinition of_coordinate(std::string_view id, Quantity quantity, std::string_view title,
                                       std::string_view formula, Pick pick, VectorXd (*curve)(View),
                                       int sign = 0, bool approximate = true) {
  return {.what = {id, kJoint, quantity, title, formula, kDefinition},
          .scope = BodyScope::coordinate,
          .sign = sign,
          .approximate = approximate,
          .pick = pick,
          .curve = curve};
}
constexpr BodyDefinition of_torque(std::string_view id, Quantity quantity, std::string_view title,
                                   std::string_view formula, Pick pick, VectorXd (*curve)(View)) {
  return {.what = {id, kJoint, quantity, title, formula, kWinter},
          .scope = BodyScope::torque,
          .approximate = true,
          .pick = pick,
          .curve = curve};
}
constexpr BodyDefinition of_work(std::string_view id, std::string_view title, std::string_view formula,
                                 double (*value)(View), int sign) {
  return {.what = {id, kJoint, Quantity::energy, title, formula, kWinter},
          .scope = BodyScope::torque,
          .sign = sign,
          .approximate = sign != 0,
          .formula = value};
}
constexpr BodyDefinition of_pair(std::string_view id, Quantity quantity, std::string_view title,
                                 std::string_view formula, std::string_view source, double (*value)(View),
                                 bool turns = false) {
  return {.what = {id, kCoupling, quantity, title, formula, source},
          .scope = BodyScope::pair,
          .turns = turns,
          .approximate = true,
          .formula = value};
}
constexpr BodyDefinition of_body(std::string_view id, Quantity quantity, std::string_view title,
                                 std::string_view formula, std::string_view source, BodyScope scope,
                                 double (*value)(View), int sign) {
  return {.what = {id, kBody, quantity, title, formula, source},
          .scope = scope,
          .sign = sign,
          .approximate = sign > 0 || scope == BodyScope::support,
          .formula = value};
}
constexpr BodyDefinition of_body(std::string_view id, Quantity quantity, std::string_view title,
                                 std::string_view formula, std::string_view source, BodyScope scope,
                                 Pick pick, VectorXd (*curve)(View), int sign) {
  return {.what = {id, kBody, quantity, title, formula, source},
          .scope = scope,
          .sign = sign,
          .approximate = sign > 0 || scope == BodyScope::support,
          .pick = pick,
          .curve = curve};
}

constexpr std::array kDefinitions{
    of_coordinate("joint_range", Quantity::angle, "Range of motion", "largest less smallest value",
                  Pick::range, angle, 1),
    of_coordinate("joint_minimum", Quantity::angle, "Smallest value", "min q", Pick::smallest, angle),
    of_coordinate("joint_minimum_time", Quantity::time, "Time of the smallest value",
                  "from the beginning of the span", Pick::time_of_smallest, angle),
    of_coordinate("joint_maximum", Quantity::angle, "Largest value", "max q", Pick::largest, angle),
    of_coordinate("joint_maximum_time", Quantity::time, "Time of the largest value",
                  "from the beginning of the span", Pick::time_of_largest, angle),
    BodyDefinition{.what = {"joint_mean", kJoint, Quantity::angle, "Mean value", "mean q", kDefinition},
                   .formula = [](View v) { return v.of(v.series.q, v.a).mean(); }},
    of_coordinate("joint_peak_velocity", Quantity::angular_velocity, "Peak velocity", "max |dq/dt|",
                  Pick::size, velocity, 1),
    of_coordinate("joint_peak_acceleration", Quantity::angular_acceleration, "Peak acceleration",
                  "max |d2q/dt2|", Pick::size, acceleration, 1, false),
    of_torque("joint_moment_maximum", Quantity::moment, "Largest moment", "max tau", Pick::largest, moments),
    of_torque("joint_moment_minimum", Quantity::moment, "Smallest moment", "min tau", Pick::smallest,
              moments),
    of_torque("joint_power_maximum", Quantity::power, "Largest power generated", "max tau dq/dt",
              Pick::largest, powers),
    of_torque("joint_power_minimum", Quantity::power, "Largest power absorbed", "min tau dq/dt",
              Pick::smallest, powers),
    of_work(
        "joint_work_positive", "Positive work", "integral of max(0, tau dq/dt)",
        [](View v) { return work(v, 1); }, 1),
    of_work(
        "joint_work_negative", "Negative work", "integral of min(0, tau dq/dt)",
        [](View v) { return work(v, -1); }, -1),
    of_work(
        "joint_work_net", "Net work", "integral of tau dq/dt", [](View v) { return work(v, 0); }, 0),
    of_pair(
        "relative_phase", Quantity::angle, "Continuous relative phase",
        "circular mean of phase(first) - phase(second) by the analytic signal; positive: the first leads",
        "Lamb & Stoeckl 2014",
        [](View v) { return relative_phase(v.of(v.series.q, v.a), v.of(v.series.q, v.b)).mean; }, true),
    of_pair("phase_locking", Quantity::ratio, "Phase locking",
            "length of the mean vector of the relative phase, 0 to 1", "Lachaux et al. 1999",
            [](View v) { return relative_phase(v.of(v.series.q, v.a), v.of(v.series.q, v.b)).locking; }),
    BodyDefinition{
        .what = {"coupling_lag", kCoupling, Quantity::time, "Lag of the best cross-correlation",
                 "of the second behind the first, up to a quarter of the span", "Li & Caldwell 1999"},
        .scope = BodyScope::pair,
        .approximate = true,
        .pick = Pick::time_of_largest,
        .curve = [](View v) -> VectorXd {
          return correlations(v.of(v.series.q, v.a), v.of(v.series.q, v.b)).cwiseAbs();
        },
        .formula =
            [](View v) {
              return cross_correlation(v.of(v.series.q, v.a), v.of(v.series.q, v.b)).lag /
                     v.record.time.rate_hz;
            }},
    of_pair(
        "coupling_correlation", Quantity::ratio, "Correlation at that lag", "Pearson's", "Li & Caldwell 1999",
        [](View v) { return cross_correlation(v.of(v.series.q, v.a), v.of(v.series.q, v.b)).correlation; }),
    of_pair("coupling_in_phase", Quantity::share, "Both alike",
            "share of steps within 22.5 deg of 45 deg in the angle-angle plane", kChang,
            [](View v) { return share(v, 0); }),
    of_pair("coupling_anti_phase", Quantity::share, "Both contrary",
            "share of steps within 22.5 deg of 135 deg", kChang, [](View v) { return share(v, 1); }),
    of_pair("coupling_first", Quantity::share, "The first alone", "share of steps within 22.5 deg of 0 deg",
            kChang, [](View v) { return share(v, 2); }),
    of_pair("coupling_second", Quantity::share, "The second alone",
            "share of steps within 22.5 deg of 90 deg", kChang, [](View v) { return share(v, 3); }),
    of_body("com_vertical_range", Quantity::length, "Vertical range of the mass centre",
            "highest less lowest", kDefinition, BodyScope::body, Pick::range, heights, 1),
    of_body("com_speed", Quantity::speed, "Mean level speed of the mass centre",
            "mean size of the horizontal velocity in time", kDefinition, BodyScope::body, Pick::mean_size,
            level_velocities, 1),
    of_body("com_peak_speed", Quantity::speed, "Peak speed of the mass centre", "max |v|", kDefinition,
            BodyScope::body, Pick::largest, speeds, 1),
    of_body("margin_of_stability", Quantity::length, "Least margin of stability",
            "of the extrapolated mass centre inside what the feet stand on; negative: outside", kHof,
            BodyScope::support, Pick::smallest, margins, 0),
    of_body(
        "margin_of_stability_mean", Quantity::length, "Mean margin of stability",
        "over the frames in which a foot stands", kHof, BodyScope::support,
        [](View v) { return mean_of(margins(v)); }, 0),
    of_body(
        "margin_lateral", Quantity::length, "Least lateral margin of stability",
        "from the extrapolated mass centre to the outermost point of the standing foot", kHof,
        BodyScope::side, Pick::smallest,
        [](View v) { return lateral_margins(v.series, v.record, v.contact, v.side, v.first, v.count); }, 0),
    of_body(
        "angular_momentum_range_x", Quantity::angular_momentum, "Range of the angular momentum, x",
        "of the whole body about its mass centre, along the world's x", kHerr, BodyScope::body, Pick::range,
        [](View v) { return momentum(v, 0); }, 1),
    of_body(
        "angular_momentum_range_y", Quantity::angular_momentum, "Range of the angular momentum, y",
        "likewise along y", kHerr, BodyScope::body, Pick::range, [](View v) { return momentum(v, 1); }, 1),
    of_body(
        "angular_momentum_range_z", Quantity::angular_momentum, "Range of the angular momentum, z",
        "likewise along z", kHerr, BodyScope::body, Pick::range, [](View v) { return momentum(v, 2); }, 1),
    of_body("angular_momentum_peak", Quantity::angular_momentum, "Peak angular momentum",
            "max |L| about the mass centre", kHerr, BodyScope::body, Pick::largest, momentum_size, 1),
};

}  // namespace

std::span<const BodyDefinition> body_definitions() { return kDefinitions; }

const BodyDefinition* find_body_definition(std::string_view id) {
  for (const auto& definition : kDefinitions)
    if (definition.what.id == id) return &definition;
  return nullptr;
}

double BodyDefinition::value(const BodyView& view) const {
  if (formula != nullptr) return formula(view);
  const double found = picked(pick, curve(view));
  return is_instant() ? found / view.record.time.rate_hz : found;
}

data::Quantity quantity_of(const BodyDefinition& definition, bool is_rotation, bool normalized) {
  const auto quantity = definition.what.quantity;
  if (normalized && quantity == Quantity::power) return Quantity::power_per_mass;
  if (normalized && quantity == Quantity::energy) return Quantity::energy_per_mass;
  if (normalized && quantity == Quantity::angular_momentum) return Quantity::ratio;
  if (definition.scope == BodyScope::pair) return quantity;
  if (!is_rotation && quantity == Quantity::angle) return Quantity::length;
  if (!is_rotation && quantity == Quantity::angular_velocity) return Quantity::speed;
  if (!is_rotation && quantity == Quantity::angular_acceleration) return Quantity::acceleration;
  if (!is_rotation && quantity == Quantity::moment)
    return normalized ? Quantity::acceleration : Quantity::force;
  if (normalized && quantity == Quantity::moment) return Quantity::moment_per_mass;
  return quantity;
}

}  // namespace kinemark::analysis
