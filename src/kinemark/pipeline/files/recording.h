// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording as it is to be used: read, edited, selected, turned. Every job that reads markers opens them
// here, with the same options in the same order.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/recording.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::pipeline {

/// What becomes of samples that are surely swapped, stuck or false.
enum class Doubtful : std::uint8_t {
  drop,  ///< they are not used
  keep,  ///< they are used like all others
};

[[nodiscard]] std::string_view to_string(Doubtful doubtful);  ///< "drop" or "keep"
/// The choice of that name. Anything else: Code::usage.
[[nodiscard]] Result<Doubtful> parse_doubtful(std::string_view name);

/// How a recording is to be used, asked alike of every job that reads one.
struct RecordingOptions {
  double rate_hz = 0.0;  ///< of a file that tells none; any other refuses it; 0: not given
  std::string unit;  ///< of coordinates, of a table that states none; any other refuses it; empty: not given
  std::filesystem::path edits = io::kEditsBeside;  ///< journal applied first; "beside": the recording's own,
                                                   ///< where there is one; "none" or empty: none
  workflow::Selection selection;                   ///< markers, names, frames
  workflow::AxesChoice axes;                       ///< which way is up, or a rotation
  std::optional<Doubtful> doubtful;                ///< none: as the job does by itself

  /// Whether doubtful samples are left out, by a job that does so by itself or does not.
  [[nodiscard]] bool drops_doubtful(bool by_itself) const {
    return doubtful ? *doubtful == Doubtful::drop : by_itself;
  }
  /// Whether nothing is asked for: the recording is used as it is, with the journal beside it or without.
  [[nodiscard]] bool empty() const;
  /// What can be said without a recording: Code::usage.
  [[nodiscard]] Status check() const;
};

/// A recording to open, and what a job needs of it.
struct RecordingSource {
  std::filesystem::path path;               ///< any marker file
  std::filesystem::path skeleton = {};      ///< .asf of an .amc; empty: the one beside it
  io::RateRule rate = io::RateRule::given;  ///< what becomes of the rate that is given
  bool needs_samples = false;               ///< refuse a file without markers or without frames
  bool record = false;                      ///< size and checksum, which reads the file once more
  bool plates = false;                      ///< forces of its plates are wanted
  double contact_force_n = 0.0;             ///< below which a plate is empty (io::PlateOptions); 0: never
  std::filesystem::path forces = {};        ///< file that holds them instead; empty: its own plates
  workflow::HeldFacts facts = {};           ///< what the job rests on
  bool one_time = false;                    ///< the job needs the markers of a frame at one time
  bool turns = true;                        ///< false: the job itself turns it, into the axes of a model
  bool force = false;                       ///< apply edits of another recording too
  std::uint64_t seed = 1;                   ///< of fills among the edits
  int threads = 1;                          ///< 0: all cores. Any number gives the same bits.
};

/// A recording as it is to be used, and the files that it is of.
using Recording = io::RecordingInput;

/// The recording as its files have it: the first half of open_recording(), for jobs that do something in
/// between. Code::usage as RecordingOptions::check(); else as io::read_recording().
[[nodiscard]] Result<Recording> read_recording(const RecordingSource& source,
                                               const RecordingOptions& options);

/// What was read as the options ask for it: edits of its journal, then workflow::prepare(). Fails as these,
/// naming the file.
[[nodiscard]] Status prepare_recording(const RecordingSource& source, const RecordingOptions& options,
                                       Recording& recording);

/// read_recording(), then prepare_recording().
[[nodiscard]] Result<Recording> open_recording(const RecordingSource& source,
                                               const RecordingOptions& options);

/// Apply a journal to a recording, whose edits and notes say what was done. Fails as io::read_journal() and
/// workflow::apply_edits(), naming journal and line; the recording is then as it was.
/// @param seed     of fills
/// @param threads  0: all cores. Any number gives the same bits.
[[nodiscard]] Result<io::Journal> take_edits(const io::EditsSource& source, data::Recording& recording,
                                             std::uint64_t seed = 1, int threads = 1);

/// The same as options of a run's record: how many are in force and what they come to, and the regions; none
/// where there was no journal.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> edit_options(const data::EditsInForce& edits,
                                                                            const io::Journal& journal);

/// The files that opening a recording reads, as io::files_of().
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording,
                                                          const RecordingOptions& options);

/// Code::usage where a journal is named for several recordings: it is of one of them.
[[nodiscard]] Status check_for_several(const RecordingOptions& options);

}  // namespace kinemark::pipeline
