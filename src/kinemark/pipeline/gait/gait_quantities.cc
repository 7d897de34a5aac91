// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_quantities.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace kinemark::pipeline {
namespace {

using data::Quantity;
using data::Side;

/// An angle of the grid.
struct Place {
  std::string_view key, title, up, down;
  std::int64_t row, column;
  std::string_view signed_names;  // with blanks between; whose positive values are `up`
  std::string_view other_names;   // of the same angle, whose sign depends on the model
};

// Names of Plug-in Gait are given with a point before the component, for "x", " x" and "_tilt" alike.
constexpr std::array kPositions = {
    Place{"pelvis_tilt", "Pelvic tilt", "anterior", "posterior", 0, 0, "PelvisAngles.x PelvisAngles.tilt",
          "pelvis_tilt"},
    Place{"pelvis_obliquity", "Pelvic obliquity", "up", "down", 0, 1, "PelvisAngles.y PelvisAngles.obliquity",
          "pelvis_list"},
    Place{"pelvis_rotation", "Pelvic rotation", "internal", "external", 0, 2,
          "PelvisAngles.z PelvisAngles.rotation", "pelvis_rotation"},
    Place{"hip_flexion", "Hip flexion", "flexion", "extension", 1, 0,
          "HipAngles.x HipAngles.flexion hip_flexion", ""},
    Place{"hip_adduction", "Hip adduction", "adduction", "abduction", 1, 1,
          "HipAngles.y HipAngles.adduction hip_adduction", ""},
    Place{"hip_rotation", "Hip rotation", "internal", "external", 1, 2,
          "HipAngles.z HipAngles.rotation hip_rotation", ""},
    Place{"knee_flexion", "Knee flexion", "flexion", "extension", 2, 0,
          "KneeAngles.x KneeAngles.flexion knee_flexion", "knee_angle"},
    Place{"knee_varus", "Knee varus", "varus", "valgus", 2, 1,
          "KneeAngles.y KneeAngles.varus knee_varus knee_adduction", ""},
    Place{"knee_rotation", "Knee rotation", "internal", "external", 2, 2,
          "KneeAngles.z KneeAngles.rotation knee_rotation", ""},
    Place{"ankle_dorsiflexion", "Ankle dorsiflexion", "dorsi", "plantar", 3, 0,
          "AnkleAngles.x AnkleAngles.dorsiflexion ankle_dorsiflexion ankle_angle", ""},
    Place{"subtalar_inversion", "Subtalar inversion", "inversion", "eversion", 3, 1,
          "subtalar_inversion subtalar_angle", ""},
    Place{"foot_progression", "Foot progression", "internal", "external", 3, 2,
          "FootProgressAngles.z FootProgressAngles.progression foot_progression", ""},
};

/// Parts of names of kinetics.
constexpr std::array kJoints = {"Hip", "Knee", "Ankle"};
constexpr std::int64_t kPowersFrom = 4;  // rows of coordinates' powers
constexpr std::array kPlanes = {"sagittal", "frontal", "transverse"};

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

std::string_view without_subject(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos || colon + 1 == name.size() ? name : name.substr(colon + 1);
}

// What a name of a coordinate's torque or power ends in.
std::string_view ending_of_kinetics(std::string_view name) {
  for (const std::string_view ending : {"_moment", "_force", "_power"})
    if (name.ends_with(ending)) return ending;
  return {};
}

struct Split {
  std::string base;
  std::optional<Side> side;
};

Split split(std::string_view name) {
  name = without_subject(name);
  const auto ending = ending_of_kinetics(name);
  const auto stem = name.substr(0, name.size() - ending.size());
  for (const auto side : data::kBothSides) {
    const char small = side == Side::left ? 'l' : 'r', large = side == Side::left ? 'L' : 'R';
    if (stem.size() > 2 && stem[stem.size() - 2] == '_' && stem.back() == small)
      return {std::string(stem.substr(0, stem.size() - 2)) + std::string(ending), side};
    if (name.size() > 1 && name[0] == large && is_upper(name[1])) return {std::string(name.substr(1)), side};
  }
  return {std::string(name), std::nullopt};
}

bool is_among(std::string_view words, std::string_view word) {
  for (std::size_t begin = 0; begin < words.size();) {
    const auto end = std::min(words.find(' ', begin), words.size());
    if (words.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

// "KneeAngles x" and "KneeAngles_flexion" as the table of places has them.
std::string dotted(std::string base) {
  if (!is_upper(base[0])) return base;
  const auto last = base.find_last_of(" _");
  if (last == std::string::npos) return base;
  base[last] = '.';
  if (base.substr(0, last).ends_with("AnglesV")) base.erase(last - 1, 1);  // as older software calls them
  return base;
}

// "ThoraxAngles y" as "Thorax angles y".
std::string spelled(std::string_view base) {
  std::string out;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const bool begins = i > 0 && is_upper(base[i]) && !is_upper(base[i - 1]) && base[i - 1] != ' ';
    if (begins) out += ' ';
    out += base[i] == '_' ? ' '
           : begins       ? static_cast<char>(std::tolower(static_cast<unsigned char>(base[i])))
                          : base[i];
  }
  if (!out.empty()) out[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(out[0])));
  return out;
}

const Place* place_of(const std::string& name, bool& same_sign) {
  for (const auto& place : kPositions)
    for (const auto names : {place.signed_names, place.other_names})
      if (is_among(names, name) || (place.key == name && names == place.other_names)) {
        same_sign = is_among(place.signed_names, name);
        return &place;
      }
  return nullptr;
}

bool is_kinetic(Quantity quantity) {
  switch (quantity) {
    case Quantity::force:
    case Quantity::moment:
    case Quantity::power:
    case Quantity::moment_per_mass:
    case Quantity::power_per_mass:
      return true;
    default:
      return false;
  }
}

bool is_power(Quantity quantity) {
  return quantity == Quantity::power || quantity == Quantity::power_per_mass;
}

/// Components of moments by name, and what those of the other sign are called.
struct MomentAxis {
  std::string_view name, opposite;  // as tables call it, and the other sign of it
  std::string_view up, down;        // on the axis of a figure
  std::int64_t column;
};
constexpr std::array kMomentAxes = {
    MomentAxis{"extension", "flexion", "extension", "flexion", 0},
    MomentAxis{"plantarflexion", "dorsiflexion", "plantar", "dorsi", 0},
    MomentAxis{"abduction", "adduction", "abduction", "adduction", 1},
    MomentAxis{"valgus", "varus", "valgus", "varus", 1},
    MomentAxis{"eversion", "inversion", "eversion", "inversion", 1},
    MomentAxis{"external_rotation", "internal_rotation", "external", "internal", 2},
};

// "extension" of "HipMoment_extension": its column, and both signs; false for another word.
bool name_moment_axis(std::string_view word, GaitQuantity& out) {
  for (const auto& axis : kMomentAxes) {
    if (word != axis.name && word != axis.opposite) continue;
    out.column = axis.column;
    out.up = word == axis.name ? axis.up : axis.down;
    out.down = word == axis.name ? axis.down : axis.up;
    out.title += ", " + std::string(kPlanes[static_cast<std::size_t>(axis.column)]);
    return true;
  }
  return false;
}

// "HipMoment x", "HipMoment_extension": a joint, moment or power, a component.
bool name_joint_kinetics(const std::string& base, Quantity quantity, GaitQuantity& out) {
  for (std::size_t j = 0; j < kJoints.size(); ++j)
    for (const std::string_view what : {"Moment", "Power"}) {
      const std::string begin = kJoints[j] + std::string(what);
      if (!base.starts_with(begin)) continue;
      out.title = std::string(kJoints[j]) + (is_power(quantity) ? " power" : " moment");
      out.row = is_power(quantity) ? 3 : static_cast<std::int64_t>(j);
      const char axis = base.size() > begin.size() + 1 ? base[begin.size() + 1] : ' ';
      if (is_power(quantity)) {
        out.column = static_cast<std::int64_t>(j);
        out.up = "generated", out.down = "absorbed";
        return true;
      }
      if (base.size() > begin.size() + 2 && base[begin.size()] == '_' &&
          name_moment_axis(std::string_view(base).substr(begin.size() + 1), out))
        return true;
      if (axis < 'x' || axis > 'z' || base.size() != begin.size() + 2) return out.row = -1, true;
      out.column = axis - 'x';
      out.title += ", " + std::string(kPlanes[static_cast<std::size_t>(axis - 'x')]);
      return true;
    }
  return false;
}

// The moment or the power along a coordinate.
void name_coordinate_kinetics(const std::string& base, Quantity quantity, GaitQuantity& out) {
  const auto ending = ending_of_kinetics(base);
  const std::string stem = base.substr(0, base.size() - ending.size());
  const auto of = gait_quantity(stem, Quantity::angle);
  out.title = of.title + (is_power(quantity) ? ", power" : ", moment");
  // Moments stand as those of hip, knee and ankle do, powers below all of them.
  if (of.part == SheetPart::kinematics && of.row > 0) {
    out.row = is_power(quantity) ? kPowersFrom + of.row : of.row - 1;
    out.column = of.column;
  }
  if (is_power(quantity))
    out.up = "generated", out.down = "absorbed";
  else if (of.same_sign)
    out.up = of.up, out.down = of.down;
}

}  // namespace

std::string name_without_side(std::string_view name) { return split(name).base; }

GaitQuantity gait_quantity(std::string_view name, Quantity quantity) {
  const auto [base, side] = split(name);
  GaitQuantity out{.key = base, .title = spelled(base), .side = side};
  if (base.empty()) return out;
  if (is_kinetic(quantity)) {
    out.part = SheetPart::kinetics;
    if (base == "vertical_ground_reaction") {
      out.title = "Vertical ground reaction", out.row = 4;
    } else if (!name_joint_kinetics(base, quantity, out) && !ending_of_kinetics(base).empty()) {
      name_coordinate_kinetics(base, quantity, out);
    }
    return out;
  }
  if (const auto* place = place_of(dotted(base), out.same_sign)) {
    out.key = place->key, out.title = place->title;
    out.part = SheetPart::kinematics, out.row = place->row, out.column = place->column;
    if (out.same_sign) out.up = place->up, out.down = place->down;
  }
  return out;
}

}  // namespace kinemark::pipeline
