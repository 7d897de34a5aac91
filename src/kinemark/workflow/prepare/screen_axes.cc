// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/screen_axes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "kinemark/core/number.h"
#include "kinemark/data/foreign_group.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::workflow {
namespace {

constexpr std::string_view kPointGroup = "POINT", kAcross = "X_SCREEN", kUp = "Y_SCREEN";

void put(data::ForeignGroup& group, std::string_view name, const std::string& letters) {
  auto at = std::ranges::find_if(
      group.parameters, [&](const data::ForeignParameter& p) { return data::foreign_name(p.name) == name; });
  if (at == group.parameters.end())
    at =
        group.parameters.insert(at, {.name = std::string(name), .dims = {}, .values = {}, .description = {}});
  at->type = -1;
  at->dims = {static_cast<std::uint8_t>(letters.size())};
  at->values.clear();
  for (const char c : letters) at->values.push_back(static_cast<std::byte>(c));
}

}  // namespace

std::string letters_of_axis(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) > 1.0 - 1e-12) return std::string(axis[i] < 0.0 ? "-" : "+") + "XYZ"[i];
  return "";
}

std::optional<Eigen::Vector3d> screen_up(const data::Trial& trial) {
  for (const auto& group : trial.foreign) {
    if (data::foreign_name(group.name) != kPointGroup) continue;
    for (const auto& p : group.parameters) {
      if (data::foreign_name(p.name) != kUp || p.type != -1) continue;
      std::string text;
      for (const std::byte b : p.values) text += static_cast<char>(b);
      const auto axis = parse_axis(trim(text));
      if (axis) return *axis;
    }
  }
  return std::nullopt;
}

void set_screen_up(data::Trial& trial, const Eigen::Vector3d& axis) {
  auto group = std::ranges::find_if(
      trial.foreign, [](const data::ForeignGroup& g) { return data::foreign_name(g.name) == kPointGroup; });
  if (group == trial.foreign.end())
    group =
        trial.foreign.insert(group, {.name = std::string(kPointGroup), .description = {}, .parameters = {}});
  Eigen::Index up = 0;
  axis.cwiseAbs().maxCoeff(&up);
  put(*group, kUp, letters_of_axis(axis));
  put(*group, kAcross, letters_of_axis(Eigen::Vector3d::Unit((up + 1) % 3)));
}

}  // namespace kinemark::workflow
