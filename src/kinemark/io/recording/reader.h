// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/c3d/byte_source.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io {

/// How a recording ends.
enum class RecordingEnd : std::uint8_t {
  closed,   ///< by close(), summary intact
  open,     ///< after a whole group: the recorder was stopped, or is still recording
  cut,      ///< within a record
  damaged,  ///< by bytes that do not match their checksum or make no sense
};
[[nodiscard]] std::string_view to_string(RecordingEnd end);  ///< "closed", "open", "cut", "damaged"

/// A stretch of the file that was not used.
struct RecordingDamage {
  std::uint64_t offset = 0;  ///< of its first byte
  std::uint64_t bytes = 0;   ///< of the damaged piece
  std::string what;          ///< one sentence
};

/// Options of RecordingReader.
struct RecordingReadOptions {
  /// Go on after damage where the chain of checksums can be taken up again; else stop before it.
  bool skip_damage = false;
};

/// Reads a recording message by message. Every message handed out has passed its checksum. Damage is not an
/// error: reading ends there, and end() and damage() report it. Memory: at most about 40 MB, and never more
/// than the file is
/// long, whatever the file claims.
class RecordingReader {
 public:
  /// Code::io when the file cannot be opened; Code::bad_input when it is no recording or its header is
  /// damaged; Code::not_supported for MCAP files of other programs.
  static Result<RecordingReader> open(const std::filesystem::path& path,
                                      const RecordingReadOptions& options = {});
  /// The same from any bytes.
  static Result<RecordingReader> open(std::unique_ptr<ByteSource> source,
                                      const RecordingReadOptions& options = {});

  /// The next message, or false at the end. `out.data` is valid until the first message of the next group is
  /// asked for. Code::io when the disk fails.
  [[nodiscard]] Result<bool> next(RecordingMessage& out);
  /// True after the last message of a group: what was appended together.
  [[nodiscard]] bool group_ends() const { return next_pending_ == pending_.size(); }

  /// Channels and metadata met so far; complete after the last message.
  [[nodiscard]] const std::vector<RecordingChannel>& channels() const { return channels_; }
  [[nodiscard]] const std::vector<RecordingMetadata>& metadata() const { return metadata_; }  ///< met so far
  [[nodiscard]] const std::string& name() const { return source_->name(); }  ///< of the file, for messages
  [[nodiscard]] std::uint64_t size() const { return source_->size(); }       ///< bytes of the file
  [[nodiscard]] std::int64_t messages() const { return messages_; }          ///< handed out so far
  /// What follows is valid once next() has returned false.
  [[nodiscard]] RecordingEnd end() const { return end_; }
  /// empty without skip_damage, but for the last
  [[nodiscard]] const std::vector<RecordingDamage>& damage() const { return damage_; }
  /// Bytes from the beginning up to where reading ended.
  [[nodiscard]] std::uint64_t kept_until() const { return group_; }

 private:
  struct Schema {
    std::string name, encoding, text;
    friend bool operator==(const Schema&, const Schema&) = default;
  };
  enum class Found : std::uint8_t { group, data_end, end_of_file, cut, damaged };
  struct Group {
    Found found = Found::damaged;
    std::size_t bytes = 0;    ///< of the group's records, check record left out
    std::uint64_t check = 0;  ///< checksum in the check record
    std::string what;
  };

  RecordingReader(std::unique_ptr<ByteSource> source, const RecordingReadOptions& options);
  Result<std::span<const std::byte>> view(std::uint64_t offset, std::size_t bytes);
  Result<Group> scan_group(std::uint64_t begin, std::uint64_t seed);
  Status read_group();
  Status read_summary();
  Status skip_damage(std::string what, RecordingEnd end);
  Result<std::uint64_t> find_next_group(std::uint64_t from);
  void stop(RecordingEnd end, std::string what);
  std::string take_records(std::span<const std::byte> records);
  std::string take_record(std::uint8_t op, std::span<const std::byte> content);
  std::string take_channel(std::span<const std::byte> content);
  std::string take_message(std::span<const std::byte> content);

  std::unique_ptr<ByteSource> source_;
  RecordingReadOptions options_;
  Bytes window_;
  std::uint64_t window_offset_ = 0;
  std::uint64_t group_ = 0;  ///< where the next group begins
  std::uint64_t check_ = 0;
  bool done_ = false;
  bool skipped_ = false;  ///< damage came before: declarations may be among what was lost
  std::uint64_t search_budget_ = 0;
  RecordingEnd end_ = RecordingEnd::open;
  std::vector<RecordingDamage> damage_;
  std::vector<RecordingChannel> channels_;
  std::vector<RecordingMetadata> metadata_;
  std::unordered_map<std::uint16_t, Schema> schemas_;
  std::unordered_map<std::uint16_t, std::uint16_t> channel_of_id_;
  std::vector<RecordingMessage> pending_;
  std::size_t next_pending_ = 0;
  std::int64_t messages_ = 0;
};

}  // namespace kinemark::io
