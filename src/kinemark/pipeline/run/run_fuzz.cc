// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a run file whose steps are in order and whose subjects have names, or what is wrong.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/pipeline/run/run_file.h"
#include "kinemark/pipeline/run/step_record.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.starts_with("{")) {
    const auto record = pipeline::parse_record(std::string(text), "fuzz.step.json");
    if (record && !pipeline::parse_record(pipeline::record_text(*record), "again.step.json")) std::abort();
    return 0;
  }
  const auto file = pipeline::parse_run_file(text, "fuzz.toml");
  if (!file) return file.error().message.empty() ? std::abort(), 0 : 0;
  if (file->steps.empty() || file->steps.size() > pipeline::kSteps.size() || file->subjects.empty())
    std::abort();
  for (const auto& subject : file->subjects)
    if (subject.name.empty() || subject.name.find('/') != std::string::npos) std::abort();
  return 0;
}
