// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as a journal: operations that check(), and come back from what is written of them, or one
// sentence. Bytes behind the last newline change nothing.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/edits/edit_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = io::parse_edits(text, "fuzz_edits.jsonl");
  if (!read) {
    if (read.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (read->whole_bytes > size || (read->whole_bytes < size) != (read->notes.size() == 1)) std::abort();
  std::string again = io::with_sum(io::format_recording(read->list.recording)) + "\n";
  for (const auto& edit : read->list.edits) {
    if (!edit.check()) std::abort();
    again += io::with_sum(io::format_edit(edit)) + "\n";
  }
  const auto back = io::parse_edits(again, "again");
  if (!back || back->list.edits.size() != read->list.edits.size()) std::abort();
  for (std::size_t i = 0; i < back->list.edits.size(); ++i)
    if (!back->list.edits[i].same_as(read->list.edits[i])) std::abort();
  const auto a = read->list.edits_in_force(), b = back->list.edits_in_force();
  if (!a || !b || io::digest_of(*a) != io::digest_of(*b)) std::abort();
  return 0;
}
