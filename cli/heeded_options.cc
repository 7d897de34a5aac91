// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/heeded_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "cli/word_list.h"
#include "kinemark/core/text.h"

namespace kinemark::cli {
namespace {

using Kinds = unsigned;

constexpr Kinds one(AnalysisKind kind) { return 1U << static_cast<unsigned>(kind); }

constexpr Kinds kList = one(AnalysisKind::list), kMarkers = one(AnalysisKind::markers),
                kSeveral = one(AnalysisKind::several), kSegments = one(AnalysisKind::segments),
                kMotion = one(AnalysisKind::motion), kTables = one(AnalysisKind::tables),
                kMarkersAround = one(AnalysisKind::around), kMotionAround = one(AnalysisKind::around_motion),
                kAround = kMarkersAround | kMotionAround;
constexpr Kinds kRecordings = kMarkers | kSeveral | kSegments, kMotions = kMotion | kTables,
                kMeasures = kMarkers | kSeveral | kMotion, kDrawn = kMarkers | kSegments | kMotion;

/// Options, and the analyses that heed them. An option that is in no line is heeded by none.
struct Heeded {
  std::string_view names;
  Kinds kinds;
};

constexpr std::array kHeeded = {
    Heeded{"IN MOTION output", kRecordings | kMotions | kAround},
    Heeded{"start end", kRecordings | kMotions | kMarkersAround},
    Heeded{"list", kList},
    Heeded{"rate unit edits drop rename frames up rotate doubtful noise", kRecordings | kMarkersAround},
    Heeded{"select refits", kRecordings | kMotion | kMarkersAround},
    Heeded{"level", kRecordings | kMotion | kAround},
    Heeded{"around window bin spikes clock-offset clock-sd", kAround},
    Heeded{"trials", kMarkers | kSeveral},
    Heeded{"measures region between", kMeasures},
    Heeded{"model setup no-error-bars torques cutoff", kMotions},
    Heeded{"forces", kDrawn | kTables},
    Heeded{"bodies point", kTables},
    Heeded{"couple normalize", kMotion},
    Heeded{"segments definition static vsk subject trial", kSegments},
    Heeded{"events gait-marker write-events write-cycles", kDrawn | kSeveral},
    Heeded{"figures figure-formats report norm angle-angle", kDrawn | kSeveral},
    Heeded{"angles", kMarkers | kSeveral},
    Heeded{"channels high-pass low-pass envelope rms max write-envelopes emg emg-high-pass emg-low-pass "
           "emg-envelope emg-rms emg-max write-emg write-emg-cycles participants "
           "jobs",
           kMarkers | kSeveral},
};

/// "walk.c3d is {}"
const char* what_is(AnalysisKind kind) {
  switch (kind) {
    case AnalysisKind::list:
      return "not needed for --list";
    case AnalysisKind::markers:
      return "a recording of markers";
    case AnalysisKind::several:
      return "one of several recordings";
    case AnalysisKind::segments:
      return "a recording whose segments are asked for";
    case AnalysisKind::motion:
      return "a motion that is measured";
    case AnalysisKind::tables:
      return "a motion whose tables go into a folder";
    case AnalysisKind::around:
      return "a recording that is averaged around events";
    case AnalysisKind::around_motion:
      return "a motion that is averaged around events";
  }
  return "";
}

Kinds heeded_by(std::string_view name) {
  const auto line =
      std::ranges::find_if(kHeeded, [&](const Heeded& heeded) { return has_word(heeded.names, name); });
  return line == kHeeded.end() ? 0U : line->kinds;
}

/// "recordings and measures of a motion"
std::string names_of(Kinds kinds) {
  std::vector<std::string> of;
  const auto add = [&](Kinds all, const char* name) {
    if ((kinds & all) != all) return false;
    of.emplace_back(name);
    return true;
  };
  add(kList, "--list");
  if (!add(kRecordings, "recordings")) {
    add(kMarkers, "measures of markers");
    add(kSegments, "segments");
  }
  if (!add(kMotions, "motions")) {
    add(kMotion, "measures of a motion");
    add(kTables, "tables of a motion");
  }
  add(kAround, "averages around events");
  return join(of, " and ");
}

}  // namespace

Status check_heeded(const CLI::App& command, AnalysisKind kind, const std::string& input) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const bool positional = option->get_lnames().empty();
    const std::string name = positional ? option->get_name() : option->get_lnames().front();
    const auto kinds = heeded_by(name);
    if ((kinds & one(kind)) == 0 && kind == AnalysisKind::list)
      return fail(Code::usage,
                  fmt::format("--list takes nothing else; {}{} was given", positional ? "" : "--", name));
    if ((kinds & one(kind)) == 0)
      return fail(Code::usage, fmt::format("{}{} is an option for {}; {} is {}", positional ? "" : "--", name,
                                           names_of(kinds), input, what_is(kind)));
  }
  return {};
}

}  // namespace kinemark::cli
