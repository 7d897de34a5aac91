// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/marker_sets.h"
#include "kinemark/io/recording/reader.h"
#include "kinemark/io/vsk/vsk.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"

namespace kinemark::pipeline {

/// What `kinemark info` is asked to do. The options of a recording are for marker files alone; the rate of
/// one that tells none stays unknown where none is given, and doubtful samples are kept unless they are to be
/// dropped.
struct InfoJob : JobSettings, RecordingOptions {
  std::filesystem::path file;           ///< to look at
  const model::Model* model = nullptr;  ///< beside which tables of its coordinates are held; null: none
  bool find_exchanges = false;  ///< warn of labels of markers that are not theirs in some frames, and of what
                                ///< is odd about force plates
};

/// Of points that are no markers.
struct ChannelFacts {
  std::string name, kind, unit;  ///< as data::Channels has them
  double rate_hz = 0.0;          ///< values a second
  std::int64_t missing = 0;      ///< frames without a value
};

/// Of one inertial sensor, segment or rigid body.
struct SensorFacts {
  std::string name;                            ///< as the file says
  std::int64_t missing = 0;                    ///< frames without an orientation
  std::optional<std::array<double, 4>> first;  ///< its first orientation, w x y z; none: it has none
};

/// Of orientations, in a file of their own or beside markers.
struct OrientationFacts {
  std::int64_t frames = 0;                                      ///< F
  double rate_hz = 0.0, first_time_s = 0.0, last_time_s = 0.0;  ///< of its clock
  std::int64_t missing = 0;                                     ///< sensor frames
  std::vector<SensorFacts> sensors;                             ///< in the order of the file
};

/// Of a marker file (.c3d, .trc, .nwb, .csv, .v3d).
struct MarkerFileFacts {
  std::string format, units, software;           ///< as data::Trial has them
  std::int64_t points = 0, frames = 0;           ///< M and F
  std::optional<double> rate_hz;                 ///< none: the file does not tell it
  std::int64_t first_frame = 1, last_frame = 0;  ///< in the file's own counting
  std::int64_t missing = 0;                      ///< marker frames
  std::size_t analog_channels = 0;               ///< how many there are
  double analog_rate_hz = 0.0;                   ///< of each channel; 0 without
  std::size_t force_plates = 0, events = 0;      ///< how many there are
  std::vector<std::string> labels;               ///< of the markers
  std::vector<std::string> computed;             ///< those of them that a model made of others, or middles
  std::vector<std::string> unlabelled;           ///< those of them that nobody named
  std::optional<data::FoundMarkerSet> set;       ///< that they are of; none: no set known here
  std::vector<ChannelFacts> channels;            ///< points that are no markers
  std::string up;  ///< "z, by the force plates": which way is up; empty: nothing says it
  std::optional<OrientationFacts> orientations;  ///< that the file holds besides; none: it has none
  std::string
      calibration_error;  ///< what the calibration leaves unknown of positions; empty: nothing says it
  std::vector<data::BesideObject> beside;  ///< what the file holds besides movement
  std::string filtered;                    ///< by what markers were smoothed, and whether the samples
                                           ///< from before are there; empty: the file tells of no filter
};

/// Of a table (.mot, .sto).
struct TableFacts {
  std::int64_t rows = 0;                            ///< how many there are
  std::optional<double> first_time_s, last_time_s;  ///< none: no rows
  bool in_degrees = false;                          ///< as the file says
  std::vector<std::string> labels;                  ///< columns without the time
};

/// Of a body model (.osim).
struct ModelFacts {
  std::string name;                                                           ///< as the file says
  std::size_t joints = 0, markers = 0, couplings = 0, point_constraints = 0;  ///< how many there are
  double mass_kg = 0.0;                                                       ///< of all bodies
  std::vector<std::string> labels;                                            ///< of the coordinates
  std::vector<std::string> body_names;                                        ///< in the order of the file
  std::vector<std::string> notes;  ///< inertias that no body has and that no torque shows
};

/// Of the counts in a recording.
struct CountsFacts {
  std::int64_t frames = 0;                             ///< F
  double rate_hz = 0.0, first_time_s = 0.0;            ///< frames a second, and time of the first
  std::string rig;                                     ///< its name; empty when not told
  bool dark_slot = false;                              ///< a slot of each frame has no LED
  std::int64_t saturated = 0, occluded = 0, lost = 0;  ///< observations
  std::vector<std::string> cameras, labels;            ///< labels: of the LEDs
};

/// Of a recording (.mcap).
struct RecordingFacts {
  io::RecordingEnd end = io::RecordingEnd::closed;  ///< how it ends
  std::uint64_t bytes = 0;                          ///< size of the file
  std::int64_t messages = 0;                        ///< of all channels
  std::vector<std::string> channels, metadata;      ///< topics and names
  std::optional<CountsFacts> counts;                ///< when it holds any
};

/// By the kind of the file.
using FileFacts =
    std::variant<MarkerFileFacts, TableFacts, OrientationFacts, ModelFacts, RecordingFacts, io::Vsk>;

/// What `kinemark info` found.
struct InfoOutcome : JobOutcome {
  std::filesystem::path file;             ///< as asked
  FileFacts facts;                        ///< what it holds
  std::vector<std::string> contradicted;  ///< its numbers against what else is known, the worst first
};

/// Read a file, by its ending, and say what it holds and what is odd about it. Writes nothing. Fails as the
/// reader of its format.
[[nodiscard]] Result<InfoOutcome> run_info(const InfoJob& job);

}  // namespace kinemark::pipeline
