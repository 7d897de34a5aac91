// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Acclaim's pair of files: a skeleton (.asf) and its motion (.amc).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Options of read_amc().
struct AmcReadOptions {
  double rate_hz = 0.0;  ///< of the frames, which the file does not tell; must be a rate
  std::filesystem::path
      skeleton;  ///< .asf; empty: the one beside the file (skeleton_beside()), if there is one
};

/// Read an AMC file with its skeleton: the root ("root") and the far end of every bone ("lfemur_end") as
/// points in metres, the angles of every bone as a channel "lfemur_angles_XYZ" in degrees, about the bone's
/// own axes, which stay, in the order of the name. Without a skeleton there are no points, and the root's
/// position is a channel too.
///
/// The skeleton's `length` names no unit: inches divided by it, as CMU has it, or else what makes the
/// skeleton of the first frame nearest to the size of a person (inches or centimetres times it, centimetres,
/// metres, millimetres); a warning says which. A bone that a frame leaves out is missing in it, with all that
/// hangs from it.
///
/// Code::usage without a rate. Code::bad_input, with file and line, for a bone that the skeleton does not
/// have, too few or too many numbers, text where a number belongs, a skeleton whose bones do not hang
/// together, no frame; Code::not_supported for bones that change their length. Memory: the texts, and 25
/// bytes a point and frame, of which there are at most as many as bytes.
[[nodiscard]] Result<data::Trial> read_amc(const std::filesystem::path& path, const AmcReadOptions& options);

/// The same from memory; `asf`: the skeleton's text, if there is one. Names stand for the files in messages.
[[nodiscard]] Result<data::Trial> parse_amc(std::string_view amc, std::string_view amc_name,
                                            std::optional<std::string_view> asf, std::string_view asf_name,
                                            double rate_hz);

/// The .asf that belongs to an .amc: of its name, of its name up to the last "_" (02.asf of 02_05.amc), or
/// the only one in its folder; empty when there is none of these.
[[nodiscard]] std::filesystem::path skeleton_beside(const std::filesystem::path& amc);

}  // namespace kinemark::io
