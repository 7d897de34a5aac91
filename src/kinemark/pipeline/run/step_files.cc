// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/step_files.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "kinemark/io/file.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kLargestReport = 256UL << 20;  // bytes

/// A text of an object, empty when it is none.
std::string text_in(const nlohmann::json& object, const char* key) {
  if (!object.is_object()) return "";
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
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

}  // namespace kinemark::pipeline
