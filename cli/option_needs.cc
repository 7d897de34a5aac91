// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/option_needs.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "cli/word_list.h"
#include "kinemark/core/number.h"

namespace kinemark::cli {
namespace {

constexpr std::string_view kGiven = "+", kNotGiven = "-", kNotZero = "!0";

/// Options that count with a choice alone: where the option `choice` has one of the values, or is given, is
/// not given, or is not 0.
struct Need {
  std::string_view commands;  ///< with commas between
  std::string_view options;
  std::string_view choice;
  std::string_view values;
  std::string_view of;           ///< what they are for
  std::string_view unless = {};  ///< an option that frees them of this need where it is given
};

constexpr std::array kNeeds = {
    Need{"clean", "max-gap max-gap-sd", "gaps", "auto linear cubic pchip walk rigid regression pca",
         "gaps that are filled"},
    Need{"clean", "cutoff without-unfiltered", "filter", "auto kalman butterworth gcv savgol classic",
         "positions that are smoothed"},
    Need{"clean", "order", "filter", "auto kalman butterworth gcv savgol",
         "filters that have a choice of it"},
    Need{"clean", "cutoff-rule uncorrected-cutoff", "filter", "butterworth", "the filter butterworth"},
    Need{"clean", "cutoff-rule", "cutoff", kNotGiven, "a cut-off that is found"},
    Need{"convert", "to jobs keep-going", "merge", kNotGiven, "recordings that stay several"},
    Need{"joints", "sides", "method", "score sara gamage gamage-plain cylinder",
         "score, sara, gamage, gamage-plain and cylinder"},
    Need{"joints", "kind", "method", "articulated score gamage gamage-plain",
         "articulated, score, gamage and gamage-plain"},
    Need{"joints", "no-continuity soft-tissue", "method", "articulated", "the articulated method"},
    Need{"scale", "joint-prior", "joints", kGiven, "functional joint centres"},
    Need{"scale", "start end", "markers", kGiven, "the motion"},
    Need{"ik,track", "image-noise min-likelihood person", "images", kGiven, "images"},
    Need{"ik,track", "geometry", "report", kGiven, "the page"},
    Need{"ik", "loss-scale", "loss", "huber cauchy", "the losses huber and cauchy"},
    Need{"ik", "loss coordinate-weight", "estimator", "least-squares", "least squares"},
    Need{"ik", "calibration sensor sensors-up heading orientation-noise max-orientation-rms", "orientations",
         kGiven, "orientations"},
    Need{"ik", "rig images image-noise min-likelihood person jobs keep-going loss loss-scale estimator",
         "orientations", kNotGiven, "markers alone"},
    Need{"ik",
         "rate unit edits select drop rename frames rotate forces weight noise max-rms "
         "max-offset setup tasks coordinate-weight locations torques",
         "orientations", kNotGiven, "markers", "markers"},
    Need{"measure,gait,emg,segments,dynamics,analyze", "level", "refits", kNotZero, "intervals"},
    Need{"dynamics", "level refits", "no-error-bars", kNotGiven, "intervals"},
    Need{"gait", "noise", "refits", kNotZero, "intervals"},
    Need{"segments", "level", "report", kGiven, "the measures of a gait report"},
    Need{"calibrate", "align warp-degree no-crosstalk no-escalate", "method", "bundle scan",
         "the methods bundle and scan"},
    Need{"calibrate", "sides frames-per-pose", "method", "bundle", "the tree of the method bundle"},
    Need{"calibrate", "warp-degree no-crosstalk no-escalate", "align", kNotGiven, "a rig that is calibrated"},
    Need{"reconstruct", "flicker order half-gain longest-gap", "method", "smoother", "the method smoother"},
    Need{"reconstruct", "calibrated-offsets", "method", "smoother frames", "the methods smoother and frames"},
    Need{"simulate subject", "soft-tissue-common", "soft-tissue", kNotZero, "skin that moves"},
    Need{"simulate arm,simulate macaque", "interpolation", "upsample", kGiven,
         "frames that the recorder makes"},
    Need{"simulate arm", "planar", "stagger", kNotZero, "markers beside the bone"},
    Need{"simulate arm", "pose-correlated", "missing", kNotZero, "samples that are lost"},
    Need{"simulate rig", "pose", "scene", "tree", "the scene tree"},
    Need{"simulate rig", "turned leds glint", "scene", "wheel", "the scene wheel"},
    Need{"simulate rig", "markers marker z-up keep-place", "scene", "markers", "the scene markers"},
    Need{"simulate rig", "rate", "highest-rate", kNotGiven, "a rate of one's own"},
    Need{"groups spm,groups band,groups norm,groups retest", "force", "output", kGiven,
         "a table that is written"},
    Need{"study poizner,study macaque,study taichi", "force", "figures", kGiven, "a page that is written"},
    Need{"study poizner,study macaque,study taichi", "seed", "seeds", kNotGiven, "a single seed"},
    Need{"study taichi", "rate", "data", kGiven, "a recording"},
    Need{"study taichi", "seed seeds", "data", kNotGiven, "simulated subjects"},
    Need{"serve", "force", "record", kGiven, "a recording that is written"},
    Need{"help", "COMMAND man man-pages", "formats", kNotGiven, "commands"},
    Need{"help", "COMMAND man", "man-pages", kNotGiven, "one command"},
    Need{"help", "force", "man-pages", kGiven, "pages that are written"},
};

/// Options that every command takes, and those that have no use for them.
struct Useless {
  std::string_view option;
  std::string_view commands;  ///< with commas between
  std::string_view why;
};

constexpr std::array kUseless = {
    Useless{"seed",
            "calibrate,reconstruct,recover,validate,groups band,groups norm,groups retest,help,completion",
            "nothing in it is random"},
    Useless{"json", "serve,help,completion", "its result is no JSON"},
    Useless{"force", "validate,completion", "it writes no file"},
};

bool is_among(std::string_view names, std::string_view name) {
  return fmt::format(",{},", names).find(fmt::format(",{},", name)) != std::string::npos;
}

/// "simulate rig"
std::string words_of(const CLI::App& command) {
  std::string words;
  for (const CLI::App* at = &command; at->get_parent() != nullptr; at = at->get_parent())
    words = at->get_name() + (words.empty() ? "" : " ") + words;
  return words;
}

/// The option of that long name, or the argument of that name, of the command or of all commands.
const CLI::Option* find_option(const CLI::App& command, std::string_view name) {
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
    for (const auto& spelled : {fmt::format("--{}", name), std::string(name)})
      if (const auto* option = at->get_option_no_throw(spelled)) return option;
  return nullptr;
}

std::string shown(const CLI::Option& option) {
  const auto& names = option.get_lnames();
  return names.empty() ? option.get_name() : "--" + names.front();
}

std::string value_of(const CLI::Option& option) {
  return option.count() > 0 && !option.results().empty() ? option.results().back() : option.get_default_str();
}

bool is_met(const Need& need, const CLI::Option& choice) {
  if (need.values == kGiven || need.values == kNotGiven)
    return (choice.count() > 0) == (need.values == kGiven);
  if (need.values == kNotZero) return parse_number(value_of(choice)) != 0.0;
  return has_word(need.values, value_of(choice));
}

std::string state_of(const Need& need, const CLI::Option& choice) {
  if (need.values == kGiven) return "is not given";
  return need.values == kNotGiven ? "is given too" : "is " + value_of(choice);
}

Status check_need(const Need& need, const CLI::App& command, const CLI::Option& choice) {
  if (is_met(need, choice)) return {};
  for (std::string_view rest = need.options; !rest.empty();) {
    const auto name = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), name.size() + 1));
    const auto* option = find_option(command, name);
    if (option != nullptr && option->count() > 0)
      return fail(Code::usage, fmt::format("{} is for {}; {} {}", shown(*option), need.of, shown(choice),
                                           state_of(need, choice)));
  }
  return {};
}

}  // namespace

Status check_needs_of(std::string_view words, const CLI::App& command) {
  for (const auto& need : kNeeds) {
    if (!is_among(need.commands, words)) continue;
    const auto* choice = find_option(command, need.choice);
    if (choice == nullptr) continue;
    const auto* unless = need.unless.empty() ? nullptr : find_option(command, need.unless);
    if (unless != nullptr && unless->count() > 0) continue;
    if (auto s = check_need(need, command, *choice); !s) return s;
  }
  return {};
}

Status check_needs(const CLI::App& command) {
  const auto words = words_of(command);
  if (auto s = check_needs_of(words, command); !s) return s;
  for (const auto& useless : kUseless) {
    const auto* option = find_option(command, useless.option);
    if (is_among(useless.commands, words) && option != nullptr && option->count() > 0)
      return fail(Code::usage,
                  fmt::format("{} is not for 'kinemark {}': {}", shown(*option), words, useless.why));
  }
  return {};
}

}  // namespace kinemark::cli
