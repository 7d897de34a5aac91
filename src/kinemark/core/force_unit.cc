// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/force_unit.h"

#include <algorithm>
#include <array>
#include <string>

#include "kinemark/core/length_unit.h"

namespace kinemark {
namespace {

struct ForceWord {
  std::string_view word;
  double newtons;
};

constexpr double kKilogramForce = 9.80665;       // standard gravity, CGPM 1901
constexpr double kPoundForce = 4.4482216152605;  // of 0.45359237 kg
// Longer words before those that begin them.
constexpr std::array kForces = {ForceWord{"kilonewtons", 1e3},
                                ForceWord{"kilonewton", 1e3},
                                ForceWord{"newtons", 1.0},
                                ForceWord{"newton", 1.0},
                                ForceWord{"poundsforce", kPoundForce},
                                ForceWord{"poundforce", kPoundForce},
                                ForceWord{"pounds", kPoundForce},
                                ForceWord{"pound", kPoundForce},
                                ForceWord{"kgf", kKilogramForce},
                                ForceWord{"lbf", kPoundForce},
                                ForceWord{"lbs", kPoundForce},
                                ForceWord{"dan", 10.0},
                                ForceWord{"kn", 1e3},
                                ForceWord{"dn", 0.1},
                                ForceWord{"mn", 1e-3},
                                ForceWord{"nt", 1.0},
                                ForceWord{"kp", kKilogramForce},
                                ForceWord{"kg", kKilogramForce},
                                ForceWord{"lb", kPoundForce},
                                ForceWord{"n", 1.0}};

/// Letters alone, in small letters: "N.mm" is "nmm".
std::string letters_of(std::string_view unit) {
  std::string out;
  for (const char c : unit) {
    if (c >= 'a' && c <= 'z') out += c;
    if (c >= 'A' && c <= 'Z') out += static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

/// The same without the sign of a product, "Nxm": no unit of length begins with an x.
std::optional<double> length_in(std::string_view rest) {
  if (rest.starts_with('x')) rest.remove_prefix(1);
  return rest.empty() ? std::nullopt : metres_per_unit(rest);
}

}  // namespace

std::optional<double> newtons_per_unit(std::string_view unit) {
  if (unit.find("MN") != std::string_view::npos) return std::nullopt;
  const std::string letters = letters_of(unit);
  const auto* found = std::ranges::find(kForces, letters, &ForceWord::word);
  return found == kForces.end() ? std::nullopt : std::optional(found->newtons);
}

std::optional<double> newton_metres_per_unit(std::string_view unit) {
  if (unit.find("MN") != std::string_view::npos) return std::nullopt;
  const std::string letters = letters_of(unit);
  if (letters == "j" || letters == "joule" || letters == "joules") return 1.0;
  for (const auto& [word, newtons] : kForces) {
    if (letters.starts_with(word))
      if (const auto metres = length_in(std::string_view(letters).substr(word.size())))
        return newtons * *metres;
    if (letters.ends_with(word))
      if (const auto metres =
              metres_per_unit(std::string_view(letters).substr(0, letters.size() - word.size())))
        return newtons * *metres;
  }
  return std::nullopt;
}

}  // namespace kinemark
