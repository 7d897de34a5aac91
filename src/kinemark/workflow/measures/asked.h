// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is asked of measures, of which those of a motion share a part, and which of it is of paths, of
// walking, of plates, of muscles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/forces/force_measures.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/workflow/measures/emg_channels.h"

namespace kinemark::workflow {

/// What of a recording is measured: all that it holds, or what one command is about.
enum class MeasuresOf : std::uint8_t {
  everything,  ///< `analyze`
  paths,       ///< `measure`: paths of markers
  walking,     ///< `gait`: feet, steps, force plates
  muscles,     ///< `emg`: electromyograms
};

/// The command for measures of this kind, without "kinemark".
[[nodiscard]] const char* command_of(MeasuresOf of);

/// What is asked of measures, be it of markers or of a motion.
struct MeasureChoice {
  std::vector<std::string> measures;  ///< ids; empty: those that apply
  std::vector<std::string> regions;   ///< parse_region()
  std::vector<std::string> between;   ///< labels of events: regions_between()
  std::int64_t refits = 99;           ///< behind each interval; 0: no intervals
  double level = 0.95;                ///< of the intervals
};

/// What has to be found besides measures. Each makes the verb look for it, even where no measure needs it.
struct MeasureNeeds {
  bool events = false;  ///< events and cycles: of walking, where there is none of the markers' movements
  bool own_movements =
      false;               ///< events and cycles are those of the markers' movements, even where feet step
  bool walking = false;    ///< walking is asked for by name: what it lacks is said
  bool strides = false;    ///< cycles of walking are needed: without them the verb fails
  bool emg = false;        ///< electromyograms are asked for by name
  bool envelopes = false;  ///< envelopes are needed: without them the verb fails
};

/// What is asked of measure(), gait() and emg().
struct MeasureOptions : MeasureChoice {
  MeasuresOf of = MeasuresOf::everything;  ///< measures of others are not taken
  std::vector<data::Region> spans = {};    ///< that are measured besides those of the options
  analysis::GaitOptions gait = {};  ///< whose events, which markers are feet; the rest of it is filled in
  EmgChoice emg = {};               ///< which channels
  double noise_sd_m = 0.0;          ///< of positions, per axis; 0: found from the samples
  std::uint64_t seed = 1;           ///< of refits
  int threads = 1;                  ///< 0: all cores. Any number gives the same bits.
  bool keep_doubtful = false;       ///< samples that screening rejects are measured too
  bool curves = false;              ///< curves of paths for figures
  MeasureNeeds needs = {};          ///< what else has to be found
};

/// The options, sorted by the stage that measures: made once, before a recording is read.
struct AskedMeasures {
  MeasureOptions options;                ///< as they were given
  analysis::PathMeasureOptions path;     ///< without regions
  analysis::GaitOptions gait;            ///< without regions
  analysis::ForceMeasureOptions plates;  ///< without regions and events
  analysis::EmgOptions emg;              ///< without stretches
  bool paths = true;                     ///< whether paths are measured
  bool walking = true;                   ///< whether walking is measured, where there is any
  bool by_name = false;                  ///< walking is asked for: what it lacks has to be said
  bool forces = true;                    ///< whether plates are measured, where there are any
  bool forces_by_name = false;           ///< plates are asked for
  bool muscles = true;                   ///< whether EMG are measured, where there are any
  bool muscles_by_name = false;          ///< EMG are asked for

  /// Whether forces of plates have a use.
  [[nodiscard]] bool uses_forces() const { return walking || forces; }
};

/// What measures are taken from.
enum class MeasureKind : std::uint8_t {
  path,    ///< of a marker
  gait,    ///< of walking
  plates,  ///< of force plates
  emg,     ///< of electromyograms
  motion,  ///< of a body model's motion: `dynamics`
};

/// A measure that there is.
struct KnownMeasure {
  MeasureKind kind = MeasureKind::path;  ///< what it is taken from
  data::MeasureDefinition what;          ///< its line in `--list`

  /// Whether the command for measures of this kind takes it.
  [[nodiscard]] bool is_of(MeasuresOf of) const;
};

/// All, in the order in which they are shown.
[[nodiscard]] const std::vector<KnownMeasure>& known_measures();
/// One by its id, or nothing.
[[nodiscard]] const KnownMeasure* find_measure(std::string_view id);

/// What a measure is taken from, by its id or the word for all of a kind ("gait", "plates", "emg"); nothing
/// for one that does not exist.
[[nodiscard]] std::optional<MeasureKind> kind_of_measure(std::string_view id);

/// Code::usage for a measure that does not exist or is not of `options.of`, and as
/// analysis::PathMeasureOptions::check() and analysis::EnvelopeOptions::check().
[[nodiscard]] Result<AskedMeasures> asked_measures(const MeasureOptions& options);

}  // namespace kinemark::workflow
