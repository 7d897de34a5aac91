// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/derivatives.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/metadata.h"

// Neurodata Without Borders 2 (HDF5): one file holds positions, states, methods, covariances, true sample
// times, derivatives with standard deviations, filters and provenance, analog channels, events and force
// plates. docs/formats/nwb.md says where each one is. A build without HDF5 (KINEMARK_NWB=OFF) answers every
// call with Code::not_supported.
namespace kinemark::data {
struct FieldSamples;
struct Neural;
}  // namespace kinemark::data

namespace kinemark::io {

/// What one NWB file holds.
struct NwbFile {
  /// Positions, m, with their provenance; in files of ours also residuals, points that are no markers, analog
  /// channels, events and force plates; of files of others, under `unread`, how many series are left out.
  /// What names the file (source, format, warnings) is left empty.
  data::Trial trial;
  std::optional<data::Derivatives> derivatives;  ///< where the file has them
  NwbMetadata metadata;                          ///< who, when, how
  std::vector<std::string>
      warnings;  ///< irregularities of the file and parts that could not be used, one sentence each
};

/// Read marker positions and what belongs to them. Files of write_nwb() come back bit by bit: of a trial all
/// but its groups of parameters. Of other files
/// every SpatialSeries and PoseEstimationSeries (ndx-pose) with two or three coordinates in a length unit is
/// a marker; those that do not share the clock of the largest group are left out with a warning. Uneven
/// timestamps become sample_offset_s; NaN, infinite and zero-confidence samples are missing. Time and memory
/// are bounded by the size of the file. Not an NWB file, or no positions: Code::bad_input; units that are no
/// lengths: Code::not_supported; cannot be opened: Code::io.
///
/// HDF5 does not survive every damaged file. It reads in a process of its own, the program kinemark-nwb, with
/// at most 5 s of processor time and 2 s more for each MB of the file, 1 GB of memory and 256 times the
/// file's size more; what ends that process is one sentence here (Code::bad_input). The program is looked for
/// beside the one that runs, in
/// ../libexec/kinemark from there, and where the environment says KINEMARK_NWB_READER; Code::not_supported
/// where it is not. Our own files carry a digest of their content: one that does not fit is Code::bad_input,
/// none a warning.
[[nodiscard]] Result<NwbFile> read_nwb(const std::filesystem::path& path);

/// Options of write_nwb() and NwbWriter.
struct NwbWriteOptions {
  bool force = false;   ///< replace a file that exists
  int compression = 4;  ///< deflate level, 0 (none) to 9; bytes are shuffled and checksummed in any case
  /// Also a PoseEstimation of the extension ndx-pose, which shares the data of Position. Who reads the file
  /// with pynwb then needs that extension.
  bool ndx_pose = false;
  /// The file becomes a copy of the one that this is of, with what is written in place of our positions from
  /// before: what it holds besides movement stays as it is, byte for byte, date and person too. Null, or of
  /// no file: a file of its own. A copy that cannot be made: Code::bad_input or Code::io.
  const data::Beside* beside = nullptr;
};

/// Write a whole recording; the file appears complete or not at all. `derivatives` may be null.
/// Code::bad_input: invalid trajectories, no frames, no markers, metadata that NWB does not allow; Code::io:
/// the disk.
[[nodiscard]] Status write_nwb(const std::filesystem::path& path, const data::Trajectories& trajectories,
                               const data::Derivatives* derivatives = nullptr,
                               const NwbMetadata& metadata = {}, const NwbWriteOptions& options = {});

/// The same of a whole trial: also its residuals, points that are no markers, analog channels, events, force
/// plates, the time in which nobody loads them, and the number of its first frame. Groups of parameters of a
/// C3D file have no room.
[[nodiscard]] Status write_nwb(const std::filesystem::path& path, const data::Trial& trial,
                               const data::Derivatives* derivatives = nullptr,
                               const NwbMetadata& metadata = {}, const NwbWriteOptions& options = {});

/// Contents of a file, declared before its samples are written.
struct NwbOutline {
  std::vector<std::string> names;                      ///< M, unique
  TimeBase time;                                       ///< F = time.frames
  bool method = false;                                 ///< which method made a sample
  bool covariance = false;                             ///< of positions
  bool unfiltered = false;                             ///< positions as they were before the filter
  bool velocity = false, velocity_sd = false;          ///< which of them there are
  bool acceleration = false, acceleration_sd = false;  ///< which of them there are
  bool jerk = false, jerk_sd = false;                  ///< which of them there are
  bool filters = false;  ///< the filter of each marker, as trajectories or derivatives name it
  /// Whether samples have times of their own: none, one offset a marker, one a sample.
  enum class Offsets : std::uint8_t {
    none,
    per_marker,
    per_sample
  } offsets = Offsets::none;  ///< of this recording

  /// The outline of an existing recording.
  static NwbOutline of(const data::Trajectories& trajectories, const data::Derivatives* derivatives);
};

/// Writes a recording piece by piece, any frames of any markers in any order, so that memory is bounded by
/// the caller's piece. Samples that are never written read as missing. Without commit() no file appears.
/// Several writers may work in threads of their own where HDF5 was built with its lock (H5_HAVE_THREADSAFE,
/// as in Debian).
class NwbWriter {
 public:
  /// Errors as write_nwb().
  static Result<NwbWriter> create(const std::filesystem::path& path, const NwbOutline& outline,
                                  const NwbMetadata& metadata = {}, const NwbWriteOptions& options = {});
  NwbWriter(NwbWriter&& other) noexcept;             ///< takes the open file over
  NwbWriter& operator=(NwbWriter&& other) noexcept;  ///< closes its own and takes the other over
  ~NwbWriter();

  /// Write frames [first_frame, first_frame + piece.frames()) of the markers that `piece` names. Its arrays
  /// and `derivatives` must hold what the outline declares and fit the outline's names and frames (else
  /// ContractError); its clock is not looked at. Pieces of whole multiples of 4096 frames are fastest.
  [[nodiscard]] Status write(const data::Trajectories& piece, const data::Derivatives* derivatives = nullptr,
                             std::int64_t first_frame = 0);
  /// Write what `trial` holds besides positions, once, before commit(). Its markers are those of the outline
  /// (else ContractError); its positions are not looked at.
  [[nodiscard]] Status write_signals(const data::Trial& trial);
  /// Write what a session holds beside movement, once, before commit(): units, intervals, and field
  /// potentials as samples; the envelopes of `neural` are not looked at.
  [[nodiscard]] Status write_neural(const data::Neural& neural,
                                    const std::vector<data::FieldSamples>& fields);
  /// Write names of methods and filters and the digest of all that is there, close, sync, and put the file
  /// into its place. @param set  of files that it belongs to, in place of the metadata's; empty: as there
  [[nodiscard]] Status commit(const std::string& set = {});

 private:
  struct Open;
  explicit NwbWriter(std::unique_ptr<Open> open);
  std::unique_ptr<Open> open_;
};

}  // namespace kinemark::io
