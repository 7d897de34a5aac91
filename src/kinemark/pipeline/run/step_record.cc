// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/step_record.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kLargestRecord = 64UL << 20;  // bytes

Result<std::vector<HashedFile>> hashed(const std::vector<fs::path>& files, const fs::path& base) {
  std::vector<HashedFile> out;
  for (const auto& file : files) {
    const auto hash = hash_file(base / file);
    if (!hash) return std::unexpected(hash.error());
    out.emplace_back(file.string(), hash->hex);
  }
  return out;
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Json files_json(const std::vector<HashedFile>& files) {
  Json out = Json::array();
  for (const auto& [file, hash] : files) out.push_back({{"file", file}, {"xxh3", hash}});
  return out;
}

std::vector<HashedFile> files_of(const Json& json) {
  std::vector<HashedFile> out;
  for (const auto& each : json) out.emplace_back(each.at("file"), each.at("xxh3"));
  return out;
}

std::unexpected<Error> no_record(const std::string& name) {
  return fail(Code::bad_input,
              fmt::format("{}: is no record of a step as 'kinemark run' writes it; delete it", name));
}

/// The record of a step, or one of nothing where there is none.
Result<StepRecord> read_record(const fs::path& path, bool& found) {
  found = is_there(path);
  if (!found) return StepRecord{};
  const auto text = io::read_text(path, kLargestRecord);
  if (!text) return std::unexpected(text.error());
  return parse_record(*text, path.string());
}

/// The first output whose content is not as recorded, or empty; one that is gone is not in the way.
Result<std::string> changed_output(const StepRecord& record, const fs::path& base) {
  for (const auto& [file, hash] : record.outputs) {
    if (!is_there(base / file)) continue;
    const auto now = hash_file(base / file);
    if (!now) return std::unexpected(now.error());
    if (now->hex != hash) return file;
  }
  return std::string();
}

bool all_there(const std::vector<fs::path>& files, const fs::path& base) {
  for (const auto& file : files)
    if (!is_there(base / file)) return false;
  return true;
}

}  // namespace

std::string record_text(const StepRecord& record) {
  Json json;
  json["step"] = record.done ? "done" : "begun";
  json["version"] = record.version;
  json["words"] = record.words;
  json["inputs"] = files_json(record.inputs);
  json["outputs"] = files_json(record.outputs);
  json["exit_status"] = record.exit_status;
  json["said"] = record.said;
  return json_text(json) + "\n";
}

Result<StepRecord> parse_record(const std::string& text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    StepRecord record;
    record.done = json.at("step") == "done";
    record.version = json.at("version");
    record.words = json.at("words").get<std::vector<std::string>>();
    record.inputs = files_of(json.at("inputs"));
    record.outputs = files_of(json.at("outputs"));
    const Json& status = json.at("exit_status");
    if (status != 0 && status != 1) return no_record(name);
    record.exit_status = status == 1 ? 1 : 0;
    record.said = json.at("said").get<std::vector<std::string>>();
    return record;
  } catch (const Json::exception&) {
    return no_record(name);
  }
}

Result<FoundState> find_state(const RunStep& step, const fs::path& base) {
  FoundState out;
  bool recorded = false;
  auto record = read_record(base / step.record, recorded);
  if (!record) return std::unexpected(record.error());
  if (!recorded) {
    for (const auto& file : step.outputs)
      if (is_there(base / file)) {
        out.state = StepState::occupied;
        out.sentence =
            fmt::format("{}: is there, and no run made it; move it away, or give --force", file.string());
        return out;
      }
    return out;
  }
  if (!record->done) return out;
  const auto changed = changed_output(*record, base);
  if (!changed) return std::unexpected(changed.error());
  if (!changed->empty()) {
    out.state = StepState::occupied;
    out.sentence =
        fmt::format("{}: was changed since the run made it; move it away, or give --force", *changed);
    return out;
  }
  const auto inputs = hashed(step.inputs, base);
  if (!inputs) return std::unexpected(inputs.error());
  if (record->version != kVersion || record->words != step.words || record->inputs != *inputs ||
      !all_there(step.outputs, base))
    return out;
  out.state = StepState::current;
  out.record = std::move(*record);
  return out;
}

Result<StepRecord> mark_begun(const RunStep& step, const fs::path& base) {
  StepRecord record{.version = kVersion, .words = step.words};
  auto inputs = hashed(step.inputs, base);
  if (!inputs) return std::unexpected(inputs.error());
  record.inputs = std::move(*inputs);
  if (auto s = io::write_text(base / step.record, record_text(record), true); !s)
    return std::unexpected(s.error());
  return record;
}

Status mark_done(const RunStep& step, const fs::path& base, StepRecord record) {
  for (const auto& file : step.outputs)
    if (!is_there(base / file))
      return fail(Code::bad_input, fmt::format("{}: was not written by '{}'", file.string(), step.name));
  auto outputs = hashed(step.outputs, base);
  if (!outputs) return std::unexpected(outputs.error());
  record.outputs = std::move(*outputs);
  record.done = true;
  return io::write_text(base / step.record, record_text(record), true);
}

}  // namespace kinemark::pipeline
