// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/survey.h"

namespace {

using namespace kinemark::io;

/// The same records with right checks, or the fuzzer would never see behind a checksum.
Bytes sealed(std::span<const std::byte> bytes) {
  Bytes out(bytes.begin(), bytes.end());
  std::size_t begin = 0;
  std::uint64_t before = 0;
  for (std::size_t at = internal::kMagic.size(); at + internal::kCheckBytes <= out.size();) {
    internal::Cursor head(std::span<const std::byte>(out).subspan(at));
    const auto op = head.u8();
    const std::uint64_t length = head.u64();
    if (length > out.size() - at - internal::kRecordHead) break;
    if (op == internal::kCheck && length == 8) {
      before = internal::check_value(std::span<const std::byte>(out).subspan(begin, at - begin), before);
      for (std::size_t i = 0; i < 8; ++i)
        out[at + internal::kRecordHead + i] = static_cast<std::byte>(before >> (8 * i));
      begin = at + internal::kCheckBytes;
    }
    at += internal::kRecordHead + length;
  }
  return out;
}

/// Nothing is returned that is not in the file, and every byte is either used or reported as left out.
void read_all(std::span<const std::byte> bytes, bool skip_damage) {
  const auto open = [&] {
    return RecordingReader::open(std::make_unique<MemorySource>(bytes, "fuzz.mcap"),
                                 {.skip_damage = skip_damage});
  };
  auto reader = open();
  if (!reader) return;
  std::size_t data = 0;
  RecordingMessage message;
  while (true) {
    const auto more = reader->next(message);
    if (!more) std::abort();
    if (!*more) break;
    data += message.data.size();
    if (message.channel >= reader->channels().size()) std::abort();
  }
  std::uint64_t left_out = 0;
  for (const RecordingDamage& damage : reader->damage()) left_out += damage.bytes;
  if (data > bytes.size() || left_out > bytes.size() || reader->kept_until() > bytes.size()) std::abort();
  if (reader->end() == RecordingEnd::closed && reader->kept_until() != bytes.size()) std::abort();
  if (const auto survey = survey_recording(*open()); !survey) std::abort();
  const auto counts = read_counts(*open());
  if (counts && !counts->counts.validate()) std::abort();
  if (counts && counts->counts.counts.size() > 32 * bytes.size() + (64U << 20)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  read_all(bytes, false);
  read_all(bytes, true);
  const Bytes right = sealed(bytes);
  read_all(right, false);
  read_all(right, true);
  return 0;
}
