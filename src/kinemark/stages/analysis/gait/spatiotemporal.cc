// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/spatiotemporal.h"

#include <array>
#include <cmath>

namespace kinemark::analysis {
namespace {

using data::Quantity;
using Cycles = std::span<const GaitCycle>;

constexpr std::string_view kGait = "gait", kDefinition = "definition";
constexpr std::string_view kPrints = "Whittle 2007, Gait Analysis, ch. 2";

// Mean and SD (N - 1) of what can be told of each cycle.
template <class Of>
double mean_of(Cycles cycles, Of of) {
  double sum = 0.0, count = 0.0;
  for (const auto& cycle : cycles)
    if (const double x = of(cycle); std::isfinite(x)) sum += x, count += 1.0;
  return count > 0.0 ? sum / count : kNaN;
}
template <class Of>
double sd_of(Cycles cycles, Of of) {
  const double mean = mean_of(cycles, of);
  double sum = 0.0, count = 0.0;
  for (const auto& cycle : cycles)
    if (const double x = of(cycle); std::isfinite(x)) sum += (x - mean) * (x - mean), count += 1.0;
  return count > 2.0 ? std::sqrt(sum / (count - 1.0)) : kNaN;
}

double duration(const GaitCycle& c) { return c.end_s - c.start_s; }
double stance(const GaitCycle& c) { return c.off_s - c.start_s; }
double length(const GaitCycle& c) { return c.stride_length(); }
double width(const GaitCycle& c) { return c.step_width(); }

double speed(Cycles cycles) {
  double way = 0.0, time = 0.0;
  for (const auto& c : cycles)
    if (const double l = c.stride_length(); std::isfinite(l)) way += l, time += duration(c);
  return time > 0.0 ? way / time : kNaN;
}

constexpr std::array kDefinitions{
    GaitDefinition{{"gait_speed", kGait, Quantity::speed, "Walking speed",
                    "lengths of all strides over their durations, against the ground or the belt", kPrints},
                   GaitScope::body,
                   GaitError::moves,
                   speed},
    GaitDefinition{
        {"cadence", kGait, Quantity::rate, "Cadence", "steps a minute: 2 / mean stride time", kPrints},
        GaitScope::body,
        GaitError::moves,
        [](Cycles c) { return 2.0 / mean_of(c, duration); }},
    GaitDefinition{
        {"step_width", kGait, Quantity::length, "Step width",
         "of a heel's print from the line between those of the other foot; negative: crossing", kPrints},
        GaitScope::body,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, width); }},
    GaitDefinition{{"stride_time", kGait, Quantity::time, "Stride time",
                    "from a strike of the foot to its next", kPrints},
                   GaitScope::each_side,
                   GaitError::moves,
                   [](Cycles c) { return mean_of(c, duration); }},
    GaitDefinition{
        {"stride_length", kGait, Quantity::length, "Stride length",
         "from a print of the heel to its next; heel's mean place from 20 to 45 % of stance", kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, length); }},
    GaitDefinition{
        {"step_time", kGait, Quantity::time, "Step time", "from the other foot's strike to this one's",
         kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, [](const GaitCycle& x) { return x.other_strike_s - x.start_s; }); },
        true},
    GaitDefinition{{"step_length", kGait, Quantity::length, "Step length",
                    "from the other heel's print to this one's, along the other foot's stride", kPrints},
                   GaitScope::each_side,
                   GaitError::moves,
                   [](Cycles c) { return mean_of(c, [](const GaitCycle& x) { return x.step_length(); }); },
                   true},
    GaitDefinition{
        {"stance_time", kGait, Quantity::time, "Stance time", "from foot strike to foot off", kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, stance); }},
    GaitDefinition{
        {"swing_time", kGait, Quantity::time, "Swing time", "from foot off to the next foot strike", kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, [](const GaitCycle& x) { return x.end_s - x.off_s; }); }},
    GaitDefinition{
        {"stance_share", kGait, Quantity::share, "Stance, share of the stride", "stance time / stride time",
         kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, [](const GaitCycle& x) { return stance(x) / duration(x); }); }},
    GaitDefinition{
        {"double_support", kGait, Quantity::time, "First double support",
         "from the foot's strike to the other's foot off", kPrints},
        GaitScope::each_side,
        GaitError::moves,
        [](Cycles c) { return mean_of(c, [](const GaitCycle& x) { return x.other_off_s - x.start_s; }); }},
    GaitDefinition{{"single_support", kGait, Quantity::time, "Single support",
                    "from the other's foot off to its strike", kPrints},
                   GaitScope::each_side,
                   GaitError::moves,
                   [](Cycles c) {
                     return mean_of(c, [](const GaitCycle& x) { return x.other_strike_s - x.other_off_s; });
                   }},
    GaitDefinition{{"double_support_share", kGait, Quantity::share, "Double support, share of the stride",
                    "both double supports of a stride / stride time", kPrints},
                   GaitScope::each_side,
                   GaitError::moves,
                   [](Cycles c) {
                     return mean_of(c, [](const GaitCycle& x) {
                       return (x.other_off_s - x.start_s + x.off_s - x.other_strike_s) / duration(x);
                     });
                   }},
    GaitDefinition{{"stride_time_sd", kGait, Quantity::time, "SD of stride times",
                    "between the strides recorded, N - 1; three at least", kDefinition},
                   GaitScope::each_side,
                   GaitError::raises_or_hides,
                   [](Cycles c) { return sd_of(c, duration); }},
    GaitDefinition{{"step_width_sd", kGait, Quantity::length, "SD of step widths",
                    "between the steps recorded, N - 1; three at least", kDefinition},
                   GaitScope::body,
                   GaitError::raises,
                   [](Cycles c) { return sd_of(c, width); }},
};

}  // namespace

Pivoted GaitDefinition::interval(double value, std::span<const double> deviations, double level) const {
  switch (error) {
    case GaitError::raises:
      return pivot_of_square(value, deviations, level);
    case GaitError::raises_or_hides:
      return wide_pivot_of_square(value, deviations, level);
    case GaitError::moves:
      break;
  }
  return pivot(value, deviations, level);
}

std::span<const GaitDefinition> gait_definitions() { return kDefinitions; }

const GaitDefinition* find_gait_definition(std::string_view id) {
  for (const auto& definition : kDefinitions)
    if (definition.what.id == id) return &definition;
  return nullptr;
}

}  // namespace kinemark::analysis
