// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/metavars.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "cli/word_list.h"

namespace kinemark::cli {
namespace {

/// Long names of options, or names of positional arguments, in words; what their values are.
struct Values {
  std::string_view names;
  const char* metavar;
};

constexpr std::array kValues = {
    Values{"FILE IN MOTION INPUT OUT output model markers static setup tasks forces rig nominal data report "
           "figures "
           "segments skeleton edits joints record certificate key orientations calibration plan",
           "FILE"},
    Values{"out man-pages geometry", "FOLDER"},
    Values{"rate cutoff half-gain resample", "HZ"},
    Values{"duration start end max-gap longest-gap", "S"},
    Values{"step", "MS"},
    Values{"conversion", "US"},
    Values{"noise level-bound max-rms max-offset max-gap-sd place-prior joint-prior stagger skin loss-scale",
           "MM"},
    Values{"sides", "M"},
    Values{"image-noise", "PX"},
    Values{"mass", "KG"},
    Values{"accuracy turned orientation-noise max-orientation-rms", "DEG"},
    Values{"omega", "RAD/S"},
    Values{"damping", "KG^-1/2"},
    Values{"size-prior", "PERCENT"},
    Values{"crosstalk dim dropout-random dropout-sight missing soft-tissue-common min-likelihood", "SHARE"},
    Values{"imperfection misalignment soft-tissue ripple", "FACTOR"},
    Values{"threads seed jobs frames max-frames frames-per-pose leds bits order person pose port upsample "
           "warp-degree",
           "N"},
    Values{"seeds", "N-N"},
    Values{"cutoff-rule detector estimator filter flicker gaps interpolation kind loss method "
           "upsampled scene SHELL",
           "NAME"},
    Values{"lock marker level bodies", "NAME"},
    Values{"COMMAND", "NAME"},
    Values{"bind", "ADDRESS"},
    Values{"weight coordinate-weight rest intensity", "NAME=VALUE"},
    Values{"images", "CAMERA=FILE"},
    Values{"sensor", "SENSOR=BODY"},
    Values{"heading", "SENSOR:AXIS"},
    Values{"sensors-up", "AXIS"},
    Values{"occlude", "LED:CAMERA:FRAMES"},
    Values{"posture", "KP,KD"},
    Values{"rotate", "\"AXIS DEG\""},
};

/// Types as CLI11 calls them when nobody names the value.
bool is_type(const std::string& name) {
  constexpr std::array<std::string_view, 5> kTypes = {"TEXT", "FLOAT", "INT", "UINT", ""};
  return std::ranges::find(kTypes, name) != kTypes.end();
}

/// What a check adds to the name of the type ("INT in [0 - 8]") is said by the description or by the refusal.
/// How many checks there were: the parser tells their end by an exception.
int quieten_checks(CLI::Option& option) {
  int count = 0;
  try {
    for (;; ++count) option.get_validator(count)->description("");
  } catch (const CLI::OptionNotFound&) {
    return count;
  }
}

void name_value(CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return;
  (void)quieten_checks(option);
  if (!is_type(option.get_type_name())) return;
  const std::string name = option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
  const bool is_number = option.get_type_name() == "FLOAT",
             is_count = option.get_type_name() == "INT" || option.get_type_name() == "UINT";
  // Lengths of segments, where they are no file.
  if (name == "segments" && is_number) {
    option.type_name("MM");
    return;
  }
  if (name == "sides" && !is_number) {
    option.type_name("NAME");
    return;
  }
  if (name == "markers" && is_count) {  // how many, where they are no file
    option.type_name("N");
    return;
  }
  const auto values = std::ranges::find_if(kValues, [&](const Values& v) { return has_word(v.names, name); });
  if (values != kValues.end()) option.type_name(values->metavar);
}

}  // namespace

void name_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) name_value(*option);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) name_values(*command);
}

}  // namespace kinemark::cli
