// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/segments.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/data/finding.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/workflow/foundations/foundation_gate.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/exchanged_labels.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/vertical.h"
#include "kinemark/workflow/segments/internal/modelled_points.h"
#include "kinemark/workflow/segments/subject_values.h"

namespace kinemark::workflow {
namespace {

// What a reader of angles must know of them.

/// Angles of a static trial jump against those of walks where the tibia is turned.
void note_static_angles(const analysis::SegmentMotion& motion, std::vector<std::string>& warnings) {
  constexpr double kSeen_rad = 0.1 * std::numbers::pi / 180.0;
  std::vector<std::string> turns;
  for (const auto& p : motion.parameters)
    if (p.name.ends_with("TibialTorsion") && std::abs(p.value) > kSeen_rad)
      turns.push_back(fmt::format("{} {:.1f} deg", p.name, p.value * 180.0 / std::numbers::pi));
  if (!turns.empty())
    warnings.push_back(
        fmt::format("Knee rotation of a static trial contains the tibia's torsion, that of a walk does not: "
                    "beside a walk "
                    "it jumps by {}.",
                    fmt::join(turns, ", ")));
}

/// Choices about the static trial that nobody stated.
void note_choices(const analysis::SegmentDefinition& definition, const analysis::SegmentMotion& motion,
                  std::vector<std::string>& warnings) {
  for (const auto& used : motion.parameters) {
    const auto p =
        std::ranges::find(definition.parameters, used.name, &analysis::SegmentDefinition::Parameter::name);
    if (!used.assumed || p == definition.parameters.end() || p->choices.empty()) continue;
    warnings.push_back(fmt::format(
        "{} is assumed to be {:g}: no file tells; --subject {}={:g} is the other.", used.name, used.value,
        used.name, p->choices.front() == used.value ? p->choices.back() : p->choices.front()));
  }
}

/// Cross-talk of angles for which the definition asks, with a warning where it is suspicious.
void find_cross_talk(const analysis::SegmentDefinition& definition, SegmentsFound& found) {
  for (const auto& series : found.motion.angles) {
    const auto a =
        std::ranges::find(definition.angles, series.name, &analysis::SegmentDefinition::Angle::name);
    if (a == definition.angles.end() || !a->cross_talk) continue;
    const auto talk = analysis::find_cross_talk(series);
    if (!talk) continue;
    found.cross_talk.emplace_back(series.name, *talk);
    if (talk->suspicious()) found.remarks.warnings.push_back(talk->sentence(series.name));
  }
}

/// Trials beside the recording, screened, and markers of all with modelled points where some stand in for
/// markers.
struct SegmentTrials {
  std::optional<data::Trial> still;          ///< none: there is none, or it is the recording
  std::map<std::string, data::Trial> shown;  ///< by the names that the definition has for them
  std::list<MarkersAndModelled> modelled;    ///< stays where it is: the input points into it
};

const std::string& where_of(const SegmentsOptions& options) {
  return options.where.empty() ? options.name : options.where;
}

bool is_own_static(const data::Recording& recording, const SegmentsOptions& options) {
  return options.static_trial == &recording;
}

/// The trial of a recording without what screening leaves out.
Result<data::Trial> screened(const data::Recording& recording, const SegmentsOptions& options,
                             const std::string& name, std::vector<std::string>& sentences) {
  auto trial = recording.trial;
  if (auto s = leave_out_defects(trial, !options.drop_doubtful, recording.edits.swapped, sentences); !s)
    return fail_at(name, s.error());
  return trial;
}

/// The recording into `found`, those beside it into `trials`.
Status screen_all(const data::Recording& recording, const SegmentsOptions& options, SegmentTrials& trials,
                  SegmentsFound& found) {
  found.used = recording;
  if (auto s = leave_out_defects(found.used.trial, !options.drop_doubtful, recording.edits.swapped,
                                 found.screening.recording);
      !s)
    return fail_at(where_of(options), s.error());
  if (options.static_trial != nullptr && !is_own_static(recording, options)) {
    auto still = screened(*options.static_trial, options, options.static_name, found.screening.static_trial);
    if (!still) return std::unexpected(still.error());
    trials.still = std::move(*still);
  }
  for (const auto& [name, shown] : options.trials) {
    check(shown != nullptr, "segments() needs a recording for each trial");
    auto trial = screened(*shown, options, name, found.screening.trials.emplace_back());
    if (!trial) return std::unexpected(trial.error());
    trials.shown[name] = std::move(*trial);
  }
  return {};
}

/// Exchanged pairs of the recording itself, before anything is built on it or blamed beside it: exchanged
/// back unless doubtful samples are kept.
/// @return the markers as they should be named
Result<data::Trajectories> judge_moving(const data::Recording& recording, const SegmentsOptions& options,
                                        SegmentsFound& found) {
  auto& used = found.used.trial;
  if (is_own_static(recording, options)) return used.markers;
  const auto pairs = judge_recording(options.name, used.markers,
                                     options.drop_doubtful ? "all is computed with them exchanged back"
                                                           : "what is computed from them is not so",
                                     found.remarks);
  if (!pairs) return std::unexpected(pairs.error());
  std::vector<data::Finding> swaps;
  for (const auto& pair : *pairs)
    swaps.push_back({.kind = data::FindingKind::label_swap,
                     .subject = pair.marker,
                     .partner = pair.partner,
                     .first_frame = 0,
                     .last_frame = used.markers.frames() - 1,
                     .frames = {},
                     .detail = {},
                     .description = {}});
  auto named = used;
  if (auto s = exchange_back(named, swaps); !s) return fail_at(where_of(options), s.error());
  if (options.drop_doubtful) used = named;
  return std::move(named.markers);
}

/// The static trial by the names of its markers, and against the recording, before anything is built on it.
Status judge_static(const SegmentsOptions& options, const SegmentTrials& trials,
                    const data::Trajectories& recorded, SegmentsFound& found) {
  if (options.static_trial == nullptr) return {};
  const auto& still = trials.still ? trials.still->markers : recorded;
  std::vector<const data::Trajectories*> movements;
  if (trials.still) movements.push_back(&recorded);
  auto judgement = judge_static_trial(options.static_name, motion::body_of_names(still.names), still,
                                      movements, found.remarks);
  if (!judgement) return std::unexpected(judgement.error());
  found.static_trial = std::move(*judgement);
  return {};
}

Eigen::Vector3d up_of(const data::Recording& recording) {
  if (recording.up) return *recording.up;
  if (const auto plates = vertical_of_plates(recording.trial)) return plates->up;
  if (const auto screen_up = vertical_of_screen(recording.trial)) return screen_up->up;
  return Eigen::Vector3d::UnitZ();
}

/// Takes markers of one trial after the other.
class PointTaker {
 public:
  PointTaker(const analysis::SegmentDefinition& definition, std::list<MarkersAndModelled>& modelled,
             analysis::SegmentInput& input, std::vector<std::string>& warnings)
      : wanted_(names_of_points(definition)), modelled_(modelled), input_(input), warnings_(warnings) {}

  const data::Trajectories* take(const data::Trial& trial, const std::string& name) {
    const auto* markers = with_modelled(trial, name);
    for (auto& [wanted, theirs] : suffixed_names(trial.markers.names, wanted_))
      input_.aliases.try_emplace(wanted, theirs);
    return markers;
  }

 private:
  const data::Trajectories* with_modelled(const data::Trial& trial, const std::string& name) {
    auto found = with_modelled_points(trial, wanted_);
    if (!found) return &trial.markers;
    warnings_.push_back(fmt::format("{}: not measured, taken as a model of the file has them: {}", name,
                                    fmt::join(found->points, ", ")));
    modelled_.push_back(std::move(*found));
    return &modelled_.back().markers;
  }

  std::set<std::string> wanted_;
  std::list<MarkersAndModelled>& modelled_;
  analysis::SegmentInput& input_;
  std::vector<std::string>& warnings_;
};

/// Markers of all trials, and names of outputs in them. A sentence for each trial with modelled points that
/// stand in for markers.
/// @param own_static  the recording is its own static trial
/// @return            points into `recording` and `trials`, which must outlive it
analysis::SegmentInput points_of(const analysis::SegmentDefinition& definition,
                                 const SegmentsOptions& options, bool own_static,
                                 const data::Trial& recording, SegmentTrials& trials,
                                 std::vector<std::string>& warnings) {
  analysis::SegmentInput input;
  PointTaker taker(definition, trials.modelled, input, warnings);
  input.markers = taker.take(recording, options.name);
  if (own_static) input.static_trial = input.markers;
  if (trials.still) input.static_trial = taker.take(*trials.still, options.static_name);
  for (const auto& [name, trial] : trials.shown) input.trials[name] = taker.take(trial, name);
  return input;
}

/// What is known of the subject: given, then of its file, of the recording, of the static trial.
void find_values(const analysis::SegmentDefinition& definition, const SegmentsOptions& options,
                 const SegmentTrials& trials, SegmentsFound& found, analysis::SegmentInput& input) {
  input.given = options.given;
  const auto take = [&](std::vector<analysis::SubjectValue> values) {
    mend_units(values, definition, found.remarks.warnings);
    std::ranges::move(values, std::back_inserter(input.known));
  };
  take(options.known);
  take(subject_values(found.used.trial, definition));
  input.zeros_doubtful = measures_offsets(found.used.trial);
  if (!trials.still) return;
  take(subject_values(*trials.still, definition));
  input.zeros_doubtful = input.zeros_doubtful || measures_offsets(*trials.still);
}

Status find_loads(const analysis::SegmentDefinition& definition, const SegmentsOptions& options,
                  const analysis::SegmentInput& input, const analysis::SegmentOptions& how,
                  SegmentsFound& found) {
  if (!found.used.plates || input.static_trial == input.markers) return {};
  auto loads = analysis::find_joint_loads(definition, input, *found.used.plates,
                                          {.segments = how, .refits = options.refits, .seed = options.seed});
  if (!loads) return std::unexpected(loads.error());
  found.loads = std::move(*loads);
  std::ranges::copy(found.loads.warnings, std::back_inserter(found.remarks.warnings));
  return {};
}

/// Angles, what the recording's own outputs say of them, loads.
Status compute(const analysis::SegmentDefinition& definition, const SegmentsOptions& options,
               analysis::SegmentInput& input, SegmentsFound& found) {
  const analysis::SegmentOptions how{
      .noise_sd_m = options.noise_sd_m, .up = up_of(found.used), .threads = options.threads};
  auto motion = analysis::compute_segments(definition, input, how);
  if (!motion) return std::unexpected(motion.error());
  found.motion = std::move(*motion);
  if (found.motion.noise) {
    input.noise = &*found.motion.noise;
    std::ranges::move(input.noise->sentences(), std::back_inserter(found.remarks.warnings));
  }
  auto comparison = compare_outputs(definition, input, how, found.motion, found.used.trial);
  if (!comparison) return std::unexpected(comparison.error());
  found.comparison = std::move(*comparison);
  return find_loads(definition, options, input, how, found);
}

}  // namespace

Result<SegmentsFound> segments(const analysis::SegmentDefinition& definition,
                               const data::Recording& recording, const SegmentsOptions& options) {
  SegmentsFound found;
  SegmentTrials trials;
  add_contradictions(recording.contradicted, found.remarks.gates);
  if (auto s = screen_all(recording, options, trials, found); !s) return std::unexpected(s.error());
  const auto named = judge_moving(recording, options, found);
  if (!named) return std::unexpected(named.error());
  if (auto s = judge_static(options, trials, *named, found); !s) return std::unexpected(s.error());
  auto input = points_of(definition, options, is_own_static(recording, options), found.used.trial, trials,
                         found.remarks.warnings);
  find_values(definition, options, trials, found, input);
  if (auto s = compute(definition, options, input, found); !s) return fail_at(where_of(options), s.error());
  auto& warnings = found.remarks.warnings;
  std::ranges::copy(found.motion.warnings, std::back_inserter(warnings));
  // What was computed from pairs that stay exchanged differs by that, whatever parameter makes it less.
  const bool as_named = std::ranges::any_of(found.remarks.gates, [&](const data::Gate& gate) {
    return gate.name == "recording" && !gate.passed && !options.drop_doubtful;
  });
  if (as_named) found.comparison.explanation = {};
  if (!as_named) std::ranges::move(found.comparison.findings(), std::back_inserter(warnings));
  if (is_own_static(recording, options)) note_static_angles(found.motion, warnings);
  if (input.static_trial != nullptr) note_choices(definition, found.motion, warnings);
  find_cross_talk(definition, found);
  return found;
}

}  // namespace kinemark::workflow
