// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::io {

/// A file that the samples were made from.
struct NwbSource {
  std::string file;        ///< name as given
  std::int64_t bytes = 0;  ///< size
  std::string xxh3;        ///< XXH3 checksum of the content, 16 hexadecimal digits; empty when not known
};

/// Metadata of an NWB file. Every field is optional.
struct NwbMetadata {
  std::string identifier;  ///< unique name of the recording; empty: made from everything else in this struct
  std::string session_description = "marker trajectories";  ///< one sentence
  std::string session_start;  ///< ISO 8601 with time zone; empty: not known, written as 1970-01-01
  std::string created;        ///< when the file was made, likewise; empty: as session_start
  std::string reference_frame = "laboratory frame of the source file, right-handed, metres";  ///< in words
  std::string subject_id;  ///< empty: not known
  std::string species;     ///< Latin name, "Homo sapiens"
  std::string sex;         ///< "F", "M", "U" (unknown) or "O" (other)
  std::string age;         ///< ISO 8601 duration, "P34Y"

  std::string recorder;                                      ///< program that recorded it; empty: not known
  std::string software = "kinemark";                         ///< what wrote the file
  std::string version;                                       ///< of the software
  std::string command;                                       ///< what made the file, as it was typed
  std::vector<NwbSource> sources;                            ///< files that went in
  std::vector<std::pair<std::string, std::string>> options;  ///< name and value, as they were used
  std::string set;                                           ///< of files that it belongs to; empty: none
  std::optional<std::uint64_t> seed;                         ///< of random numbers, where any were drawn
};

}  // namespace kinemark::io
