// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/markers/marker_file.h"

namespace kinemark::io {

/// What a recording may hold beside names, positions, which samples are missing, rate and first frame.
enum class Part : std::uint8_t {
  provenance,    ///< states and methods of samples that were not measured
  covariance,    ///< of samples
  sample_times,  ///< of samples that were not taken at the time of their frame
  residuals,     ///< of reconstruction, and which cameras saw a sample
  channels,      ///< points that are no markers
  analog,        ///< channels
  events,
  force_plates,
  groups,       ///< of parameters that nothing here reads
  filters,      ///< that markers went through, and their samples from before
  calibration,  ///< what the calibration of the cameras leaves unknown of all positions
};
inline constexpr std::size_t kParts = 11;  ///< number of them

/// How much of a part a format keeps.
enum class Kept : std::uint8_t { none, in_part, whole };

/// One format of marker files: a row of the table that messages, help and documentation are made from.
struct MarkerFormat {
  /// True for the beginning of such a file, as read_begin() gives it.
  using Recognise = bool (*)(std::string_view begin);
  /// Reads a file; `box_m` around the samples, where the reader knows it.
  using Read = Result<data::Trial> (*)(const std::filesystem::path& path, const MarkerReadOptions& options,
                                       Eigen::AlignedBox3d& box_m);
  /// Writes a file, whole or not at all.
  using Write = Status (*)(const std::filesystem::path& path, const data::Trial& trial,
                           const MarkerWriteOptions& options);

  std::string_view name;       ///< "C3D"
  std::string_view extension;  ///< ".c3d", in small letters
  Recognise begins = nullptr;  ///< true for the beginning of such a file; null: the extension tells
  Read read = nullptr;         ///< null: not read. `box_m` around the samples, where the reader knows it
  Write write = nullptr;       ///< null: not written
  bool stores_rate = true;     ///< false: a rate must be given to read it
  bool may_lack_unit = false;  ///< true: the unit of its coordinates may be given to read it
  bool mostly_others =
      false;             ///< true: most files of this ending hold something else; looked for in no folder
  bool one_file = true;  ///< false: several files, which `convert` alone writes; `write` refuses them
  std::array<Kept, kParts> kept{};  ///< of each part, by the writer
  std::string_view precision;       ///< of coordinates in a file that is written, for the documentation

  /// How much of a part the writer keeps.
  [[nodiscard]] Kept keeps(Part part) const { return kept[static_cast<std::size_t>(part)]; }
};

/// All formats, each once; the first that recognises a file reads it.
[[nodiscard]] std::span<const MarkerFormat> marker_formats();

/// The format that is written under an extension (small letters, with its dot), or null.
[[nodiscard]] const MarkerFormat* written_format(std::string_view extension);

/// Extensions of files that are read, each once, in the order of the table.
[[nodiscard]] std::vector<std::string> read_extensions();

/// Extensions of files that are written, of formats of one file.
[[nodiscard]] std::vector<std::string> written_extensions();

}  // namespace kinemark::io
