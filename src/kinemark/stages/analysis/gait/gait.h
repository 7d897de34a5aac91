// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Walking in a recording: events, cycles, spatiotemporal measures, each with what it is worth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/gait/gait_events.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/stages/analysis/gait/gait_kind.h"
#include "kinemark/stages/analysis/gait/gait_markers.h"
#include "kinemark/stages/analysis/path/path_noise.h"

namespace kinemark::analysis {

/// What is measured of walking, and how.
struct GaitOptions {
  std::vector<MarkerRole> markers;         ///< roles of gait_roles(); others by their usual names
  EventChoice choice = EventChoice::best;  ///< whose events
  std::vector<std::string> measures;       ///< ids of gait_definitions(); empty: all that can be told
  std::vector<data::Region> regions;       ///< of whole cycles; empty: the whole recording
  std::int64_t refits = 99;           ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double noise_sd_m = 0.0;            ///< per axis; 0: found from the samples
  double level = 0.95;                ///< of the intervals, above 0.5 to 0.9999
  std::uint64_t seed = 1;             ///< of the refits
  int threads = 1;                    ///< 0: all cores; any number gives the same bits
  std::optional<Eigen::Vector3d> up;  ///< of length 1; none: where the pelvis stands above the feet
};

/// What a recording tells of walking besides its markers.
struct GaitEvidence {
  const data::Wrenches* plates =
      nullptr;                      ///< on the recording's clock, not cut off at a threshold; may be absent
  std::vector<data::Event> events;  ///< the file's own
  double mass_kg = kNaN;            ///< of the body, as the file or somebody states it; NaN: nobody does
};

/// Walking.
struct Gait {
  std::vector<data::GaitEvent> events;  ///< ascending in time, with SDs
  std::vector<GaitCycle> cycles;        ///< by side and time
  std::vector<data::Measure> measures;  ///< by region, in the order of gait_definitions(), left before right
  GaitKind kind;                        ///< walk, run or sprint, on ground or belt, which way
  std::string person;                   ///< before the colon of the markers' names; empty: one person
  bool treadmill = false;               ///< the ground moves under the feet: kind.belt
  double belt_speed_m_per_s = 0.0;      ///< of a treadmill
  std::vector<Agreement> agreement;     ///< between sources
  bool out_of_step = false;             ///< plates and markers do not run on one clock
  std::vector<PathNoise> noises;        ///< that intervals rest on, of feet and pelvis; empty: no refits
  std::vector<std::string>
      contradicted;                ///< numbers that events or measures rest on and that contradict each
                                   ///< other, a sentence each; all of them are among the notes, too
  std::vector<std::string> notes;  ///< kind, markers, sources, what is hidden or missing; a sentence each
};

/// Find events, cycles and measures of walking (docs/theory/gait.md).
///
/// Intervals are the pivot of refits: marker noise of its own colour through the smoother, errors of the
/// method and of plates drawn with their SDs, all measures computed again.
///
/// @return  Code::usage for an unknown measure (callers tell what else there is) or role; Code::bad_input as
///          find_gait_markers() and GaitSmoother::create(), where `best` or `kinematics` is asked for and the
///          recording holds no locomotion, with the reason, where there is no event, and where the
///          pelvis stands above the feet along another axis than `up`.
[[nodiscard]] Result<Gait> analyze_gait(const data::Trajectories& markers, const GaitEvidence& evidence,
                                        const GaitOptions& options);

/// Numbers of a walk that contradict each other, one sentence each.
struct Contradictions {
  std::vector<std::string> names;   ///< of markers and sides, where the markers show a gait
  std::vector<std::string> plates;  ///< of force plates, likewise
  std::vector<std::string> labels;  ///< of single events of the file, or of all of them
};

/// What analyze_gait() says of numbers that contradict each other, without measuring: the file's events among
/// themselves and against those of the markers, names of sides, heel and toe against where the markers are,
/// forces of plates against feet and mass. Labels among themselves alone where no feet are found.
[[nodiscard]] Contradictions contradictions_of(const data::Trajectories& markers,
                                               const GaitEvidence& evidence);

/// What noise does to the time of an event: root mean square over the refits that find it. NaN where more
/// than a tenth do not: those that do are then no sample of all.
/// @param moved_s  by how much each refit moves it, s; NaN: not found there
[[nodiscard]] double event_noise(std::span<const double> moved_s);

}  // namespace kinemark::analysis
