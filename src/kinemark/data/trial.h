// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/channels.h"
#include "kinemark/data/foreign_group.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::data {

/// Analog channels sampled evenly: S samples, K channels, in the unit that each channel names.
struct AnalogChannels {
  std::vector<std::string> names;  ///< K
  std::vector<std::string> units;  ///< K, as stated in the file ("V", "N", "Nmm"), may be empty
  double rate_hz = 0.0;            ///< of each channel
  std::int64_t samples = 0;        ///< S
  Array<double> values;            ///< S x K
};

/// A labelled instant (an event).
struct Event {
  std::string label;    ///< "Foot Strike"
  std::string context;  ///< "Left", "Right", "General" or empty
  double time_s = 0.0;  ///< on the trial's clock
};

/// One force plate; its channels are indices into AnalogChannels.
struct ForcePlate {
  int number = 1;                                             ///< as the file counts, from 1
  int type = 0;                                               ///< C3D type 1 to 7
  std::array<Eigen::Vector3d, 4> corners_in_world{};          ///< m
  Eigen::Vector3d origin_in_plate = Eigen::Vector3d::Zero();  ///< m, as the file gives it
  std::vector<int> channel_idx;                               ///< zero-based
  std::vector<double> calibration;  ///< CAL_MATRIX as the file gives it, column by column; may be empty
  int calibration_rows = 0;         ///< of `calibration`, 0 without
  /// FPCOPPOLY, 2 x 6, column by column: how the centre of pressure of a Kistler plate is off, mm; may be
  /// empty.
  std::vector<double> pressure_correction;
  double metres_per_unit = 1e-3;  ///< of the lengths in channels, and moments, that state no unit
};

/// Error of positions that a calibration leaves: one displacement of space for the whole recording, drawn
/// once, sum of w[k] displacement(k) with standard normal w. It is part of the samples' covariance, and
/// unlike noise it is the same in every frame. Lengths in the axes of the fields; functions:
/// calibration_error.h.
struct CalibrationError {
  static constexpr std::size_t kMostFields = 12;   ///< that a recording holds
  static constexpr int kTerms = 20;                ///< of a polynomial of degree 3 in x, y, z
  using Field = Eigen::Matrix<double, kTerms, 3>;  ///< displacement in x, y, z by each term, m

  Eigen::Vector3d middle_in_world = Eigen::Vector3d::Zero();       ///< m
  Eigen::Matrix3d world_from_field = Eigen::Matrix3d::Identity();  ///< turns
  double scale_m = 1.0;       ///< position / scale is what polynomials are of, > 0
  std::vector<Field> fields;  ///< m, largest first; empty: not known

  [[nodiscard]] bool known() const { return !fields.empty(); }  ///< there are fields
};

/// An object of a file that is no movement: spikes, voltages, trials, a subject, a device.
struct BesideObject {
  std::string path;                 ///< within its file: "/units"
  std::string type;                 ///< "Units", "ElectricalSeries", or what kind of object it is
  std::vector<std::int64_t> shape;  ///< of its samples or values, rows of a table; empty: it has none
  std::string unit;                 ///< of its values, as the file says; empty: none
  double rate_hz = 0.0;             ///< of its samples; 0: none, or uneven times
  std::string lost;                 ///< why it does not go along, or not all of it; empty: it does
};

/// What a file holds besides movement. It goes along, untouched, into a file of the same format.
struct Beside {
  std::string file;                   ///< where it is; empty: nowhere
  std::string room;                   ///< group of the file in which a new result finds its names free
  std::vector<BesideObject> objects;  ///< in the order of their paths; none: the file is all movement
};

/// What one marker file holds, in SI units.
struct Trial {
  std::string source;            ///< file name as given
  std::string format;            ///< "C3D", "TRC"
  std::string units_in_file;     ///< length unit of the file: "mm", "m", or empty when it is not stated
  std::string software;          ///< the program that wrote the file, or empty
  std::int64_t first_frame = 1;  ///< number of the first frame in the file's own counting
  Trajectories markers;          ///< t0 is (first_frame - 1) / rate for C3D, the first time written for TRC
  Array<float>
      residual_m;  ///< F x M reconstruction residual, NaN where not measured; empty when the file has none
  CalibrationError calibration_error;  ///< of the markers' positions
  Array<std::uint8_t>
      camera_mask;            ///< F x M bit c set: camera c + 1 saw the marker; empty when the file has none
  Channels channels;          ///< points that are no markers; never cleaned, filled or fitted
  AnalogChannels analog;      ///< no channels: the file has none
  std::vector<Event> events;  ///< in the order of the file
  std::vector<ForcePlate> force_plates;  ///< in the order of the file
  /// First and last time, on the trial's clock, of frames in which the file says that nobody loads its plates
  /// (FORCE_PLATFORM:ZERO); the first after the last: it says none.
  std::array<double, 2> unloaded_s = {0.0, -1.0};
  std::vector<ForeignGroup> foreign;  ///< what only a C3D file can keep, and nothing here reads
  /// What the file holds and a trial does not, in words ("derivatives of markers"): no conversion carries it.
  std::vector<std::string> unread;
  Beside beside;                      ///< what the file holds besides movement (NWB)
  std::vector<std::string> warnings;  ///< irregularities of the file, one sentence each

  /// number of the last frame in the file's own counting
  [[nodiscard]] std::int64_t last_frame() const { return first_frame + markers.frames() - 1; }
  /// Markers are valid and all other arrays have their documented shapes.
  [[nodiscard]] Status validate() const;
};

/// The first and the last frame, from 0, in which nobody loads the plates; none: the file says none, or not
/// all of them are in the trial.
[[nodiscard]] std::optional<std::array<std::int64_t, 2>> unloaded_frames(const Trial& trial);

}  // namespace kinemark::data
