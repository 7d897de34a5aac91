// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/step_record.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>
#include <system_error>

#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kLargestReport = 256UL << 20;  // bytes

/// A text of an object, empty when it is none.
std::string text_in(const nlohmann::json& object, const char* key) {
  if (!object.is_object()) return "";
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kLargestRecord = 64UL << 20;  // bytes

Result<std::vector<HashedFile>> hashed(const std::vector<fs::path>& files, const fs::path& base) {
  std::vector<HashedFile> out;
  for (const auto& file : files) {
    const auto hash = io::hash_file(base / file);
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
    const auto now = io::hash_file(base / file);
    if (!now) return std::unexpected(now.error());
    if (now->hex != hash) return file;
  }
  return std::string();
}

bool all_there(const StepRecord& record, const std::vector<fs::path>& outputs, const fs::path& base) {
  return std::ranges::all_of(outputs, [&](const auto& file) { return is_there(base / file); }) &&
         std::ranges::all_of(record.outputs, [&](const auto& file) { return is_there(base / file.first); });
}

bool holds(const std::vector<HashedFile>& files, const std::string& name) {
  return std::ranges::find(files, name, &HashedFile::first) != files.end();
}

/// Whether the files of the step, and those that its results named, are as they were.
Result<bool> same_inputs(const StepRecord& record, const RunStep& step, const fs::path& base) {
  const auto own = hashed(step.inputs, base);
  if (!own) return std::unexpected(own.error());
  if (record.inputs.size() < own->size() || !std::equal(own->begin(), own->end(), record.inputs.begin()))
    return false;
  for (std::size_t i = own->size(); i < record.inputs.size(); ++i) {
    const auto hash = io::hash_file(base / record.inputs[i].first);
    if (!hash || hash->hex != record.inputs[i].second) return false;
  }
  return true;
}

/// Results of the last time that stayed: beside those of this time they would tell of another.
Status remove_stale(const std::vector<HashedFile>& before, const std::vector<HashedFile>& now,
                    const fs::path& base) {
  for (const auto& [file, hash] : before) {
    if (holds(now, file) || !is_there(base / file)) continue;
    const auto content = io::hash_file(base / file);
    if (!content || content->hex != hash) continue;
    std::error_code error;
    if (!fs::remove(base / file, error) || error)
      return fail(Code::io,
                  fmt::format("{}: is of the last time and cannot be removed ({})", file, error.message()));
  }
  return {};
}

}  // namespace

std::vector<std::filesystem::path> written_files(const std::vector<std::string>& said) {
  constexpr std::string_view kWrote = "wrote ";
  std::vector<std::filesystem::path> files;
  for (const auto& line : said)
    if (line.starts_with(kWrote)) files.emplace_back(line.substr(kWrote.size()));
  return files;
}

std::vector<HashedFile> named_inputs(const std::vector<std::filesystem::path>& results,
                                     const std::filesystem::path& base) {
  std::vector<HashedFile> files;
  for (const auto& result : results) {
    if (result.extension() != ".json") continue;
    const auto text = io::read_text(base / result, kLargestReport);
    if (!text) continue;
    const auto json = nlohmann::json::parse(*text, nullptr, false);
    if (!json.is_object() || !json.contains("inputs") || !json["inputs"].is_array()) continue;
    for (const auto& input : json["inputs"]) {
      const auto path = text_in(input, "path"), hash = text_in(input, "hash");
      if (text_in(input, "hash_kind") == "XXH3-64" && !path.empty() && !hash.empty())
        files.emplace_back(path, hash);
    }
  }
  return files;
}

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
  const auto same = same_inputs(*record, step, base);
  if (!same) return std::unexpected(same.error());
  if (record->version != kVersion || record->words != step.words || !*same ||
      !all_there(*record, step.outputs, base))
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
  bool recorded = false;
  if (auto last = read_record(base / step.record, recorded)) record.outputs = std::move(last->outputs);
  if (auto s = io::write_text(base / step.record, record_text(record), true); !s)
    return std::unexpected(s.error());
  return record;
}

Status mark_done(const RunStep& step, const fs::path& base, StepRecord record) {
  for (const auto& file : step.outputs)
    if (!is_there(base / file))
      return fail(Code::bad_input, fmt::format("{}: was not written by '{}'", file.string(), step.name));
  auto files = step.outputs;
  const auto written = written_files(record.said);
  for (const auto& file : written)
    if (std::ranges::find(files, file) == files.end() && is_there(base / file)) files.push_back(file);
  auto outputs = hashed(files, base);
  if (!outputs) return std::unexpected(outputs.error());
  // A command that was told to be quiet does not say what it wrote.
  if (!written.empty())
    if (auto s = remove_stale(record.outputs, *outputs, base); !s) return s;
  record.outputs = std::move(*outputs);
  for (auto& input : named_inputs(files, base))
    if (!holds(record.inputs, input.first)) record.inputs.push_back(std::move(input));
  record.done = true;
  return io::write_text(base / step.record, record_text(record), true);
}

}  // namespace kinemark::pipeline
