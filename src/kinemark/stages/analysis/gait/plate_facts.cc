// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/plate_contacts.h"

namespace kinemark::analysis {
namespace {

constexpr double kGravity_m_per_s2 = 9.81;
constexpr double kShareBegins = 0.03, kShareBears = 0.3, kShareSurely = 0.1;  // of a plate's largest load
constexpr double kAway_m = 0.3;
constexpr double kLightest_kg = 2.0, kHeaviest_kg = 400.0;
// Steps of one walk bear 0.8 to 1.2 of the body's weight over half a stride.
constexpr double kLeastShare = 0.6, kMostShare = 1.6;

ContactLoads loads_of(const LoadedPlate& plate) {
  const double most = plate.most_n();
  return {.begins_n = kShareBegins * most, .bears_n = kShareBears * most, .surely_n = kShareSurely * most};
}

std::string nobody_stands(const LoadedPlate& plate, const GaitPaths& paths) {
  std::vector<double> away;
  for (const auto& contact : plate.contacts(paths.rate_hz, {}))
    if (const double m = plate.distance_to_feet(contact, paths, {}); std::isfinite(m)) away.push_back(m);
  if (away.empty() || std::ranges::min(away) < kAway_m) return {};
  return fmt::format(
      "{} is loaded where no foot stands: the nearer one is {:.0f} mm from the force or more; its corners, "
      "or "
      "the axes or the clock of plates and markers, are other ones",
      plate.wrench().name, 1e3 * std::ranges::min(away));
}

}  // namespace

std::vector<double> borne_masses(const data::Wrenches& plates, const GaitPaths& paths,
                                 const Eigen::Matrix3d& upright, double stride_s) {
  std::vector<double> out;
  if (!std::isfinite(stride_s)) return out;
  const auto frames = std::min(plates.frames(), paths.frames());
  for (const auto& wrench : plates.items) {
    const LoadedPlate plate(wrench, frames, upright);
    const auto loads = loads_of(plate);
    for (const auto& contact : plate.contacts(paths.rate_hz, loads)) {
      const auto side = plate.foot_of(contact, paths, loads);
      if (!side || !plate.bears_whole(contact, paths.foot(*side))) continue;
      double impulse = 0.0;
      for (auto f = contact.first; f <= contact.last; ++f) impulse += plate.load(f) / paths.rate_hz;
      out.push_back(impulse / (0.5 * stride_s * kGravity_m_per_s2));
    }
  }
  return out;
}

std::vector<std::string> contradicted_plates(const data::Wrenches& plates, const GaitPaths& paths,
                                             const Eigen::Matrix3d& upright, double stride_s,
                                             double mass_kg) {
  std::vector<std::string> out;
  const auto frames = std::min(plates.frames(), paths.frames());
  for (const auto& wrench : plates.items)
    if (auto said = nobody_stands(LoadedPlate(wrench, frames, upright), paths); !said.empty())
      out.push_back(std::move(said));
  const auto masses = borne_masses(plates, paths, upright, stride_s);
  if (masses.empty()) return out;
  const double borne = math::median(masses), share = borne / mass_kg;
  if (std::isfinite(mass_kg) && (share < kLeastShare || share > kMostShare))
    out.push_back(
        fmt::format("the steps on plates bear {:.3g} kg, {:.2g} times the mass of the body as it is stated, "
                    "{:.3g} kg: the "
                    "unit or the scale of the forces is another one, or the mass is",
                    borne, share, mass_kg));
  else if (!std::isfinite(mass_kg) && (borne < kLightest_kg || borne > kHeaviest_kg))
    out.push_back(fmt::format(
        "the steps on plates bear {:.3g} kg, which is nobody's mass: the unit or the scale of the "
        "forces is another one",
        borne));
  return out;
}

}  // namespace kinemark::analysis
