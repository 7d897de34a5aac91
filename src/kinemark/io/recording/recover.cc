// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/recover.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/encoder.h"
#include "kinemark/io/recording/survey.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kFlushBytes = 1U << 20;

/// Copies what a reader gives, declarations before the messages that need them.
class Copy {
 public:
  Copy(RecordingReader& reader, OutputFile& file) : reader_(reader), file_(file) { encoder_.begin(bytes_); }

  Status run() {
    RecordingMessage message;
    while (true) {
      const auto more = reader_.next(message);
      if (!more) return std::unexpected(more.error());
      if (auto s = declare(); !s) return s;
      if (!*more) break;
      group_.push_back(message);
      if (!reader_.group_ends()) continue;
      if (auto s = encoder_.add_messages(group_, bytes_); !s) return s;
      group_.clear();
      if (auto s = flush(kFlushBytes); !s) return s;
    }
    return {};
  }

  Status finish(const RecordingMetadata* note) {
    if (note != nullptr)
      if (auto s = encoder_.add_metadata(*note, bytes_); !s) return s;
    encoder_.finish(bytes_);
    return flush(0);
  }

 private:
  Status declare() {
    for (; metadata_ < reader_.metadata().size(); ++metadata_)
      if (auto s = encoder_.add_metadata(reader_.metadata()[metadata_], bytes_); !s) return s;
    for (; channels_ < reader_.channels().size(); ++channels_)
      if (auto index = encoder_.add_channel(reader_.channels()[channels_], bytes_); !index)
        return std::unexpected(index.error());
    return {};
  }

  Status flush(std::size_t at_least) {
    if (bytes_.size() < at_least) return {};
    if (auto s = file_.write(bytes_); !s) return s;
    bytes_.clear();
    return {};
  }

  RecordingReader& reader_;
  OutputFile& file_;
  RecordingEncoder encoder_;
  Bytes bytes_;
  std::vector<RecordingMessage> group_;
  std::size_t metadata_ = 0, channels_ = 0;
};

RecordingMetadata note_on(const RecoverReport& report, const std::filesystem::path& in) {
  RecordingMetadata note{"kinemark.recovered", {}};
  note.values["original"] = in.filename().string();
  note.values["end"] = to_string(report.end);
  note.values["messages"] = fmt::format("{}", report.messages);
  note.values["bytes_left_out"] = fmt::format("{}", report.bytes_left_out);
  for (std::size_t i = 0; i < report.warnings.size(); ++i)
    note.values[fmt::format("warning_{}", i + 1)] = report.warnings[i];
  return note;
}

}  // namespace

Result<RecoverReport> recover_recording(const std::filesystem::path& in, const std::filesystem::path& out,
                                        bool force) {
  auto reader = RecordingReader::open(in, {.skip_damage = true});
  if (!reader) return std::unexpected(reader.error());
  std::error_code absent;
  if (std::filesystem::equivalent(in, out, absent))
    return fail(
        Code::usage,
        fmt::format("{}: would be replaced by what is recovered from it; need another name", out.string()));
  auto file = OutputFile::create(out, force);
  if (!file) return std::unexpected(file.error());
  Copy copy(*reader, *file);
  if (auto s = copy.run(); !s) return std::unexpected(s.error());
  RecoverReport report{.messages = reader->messages(),
                       .end = reader->end(),
                       .damage = reader->damage(),
                       .warnings = describe_end(*reader)};
  for (const RecordingDamage& damage : report.damage) report.bytes_left_out += damage.bytes;
  const RecordingMetadata note = note_on(report, in);
  if (auto s = copy.finish(report.warnings.empty() ? nullptr : &note); !s) return std::unexpected(s.error());
  if (auto s = file->commit(); !s) return std::unexpected(s.error());
  return report;
}

}  // namespace kinemark::io
