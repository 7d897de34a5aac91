// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/table_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/seal.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io::internal {
namespace {

constexpr std::int64_t kMaxHeaderLines = 10'000;

/// Keys of the SIMM header that stand before a blank instead of "=".
constexpr std::array<std::string_view, 5> kSimmKeys{"name", "datacolumns", "datarows", "otherdata", "range"};

/// "key=value", "datarows 73"; anything else is free text with an empty key.
std::pair<std::string_view, std::string_view> split_pair(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals != std::string_view::npos) return {trim(line.substr(0, equals)), trim(line.substr(equals + 1))};
  const std::size_t blank = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view word = line.substr(0, blank);
  if (std::ranges::find(kSimmKeys, lower(word)) == kSimmKeys.end()) return {"", line};
  return {word, trim(line.substr(blank))};
}

bool is_numbers_only(std::string_view line) {
  Cells cells(line, Separator::blanks);
  double ignored = 0.0;
  Cell kind = cells.next(ignored);
  while (kind == Cell::number) kind = cells.next(ignored);
  return kind == Cell::none;
}

bool begins_with_time(std::string_view line) {
  return lower(line.substr(0, std::min(line.find_first_of(" \t,"), line.size()))) == "time";
}

Status read_data_type(std::string_view value, std::int64_t line, TableHeader& header) {
  const std::string type = lower(value);
  if (type == "double") return {};
  if (type == "unitvec3") {
    header.width = 3;
    return {};
  }
  const auto size = type.starts_with("vec") ? parse_number(std::string_view(type).substr(3)) : std::nullopt;
  if (size && *size >= 2.0 && *size <= 12.0 && *size == static_cast<double>(static_cast<int>(*size))) {
    header.width = static_cast<std::size_t>(*size);
    return {};
  }
  if (type == "quaternion") {
    header.width = 4;
    header.is_orientations = true;
    return {};
  }
  return fail(Code::not_supported, fmt::format("line {}: DataType '{}' is not read; expected double or Vec3",
                                               line, excerpt(value)));
}

Status read_pair(std::string_view line, std::int64_t number, TableHeader& header) {
  const auto [key, value] = split_pair(line);
  const std::string word = lower(key);
  header.pairs.emplace_back(name_of_bytes(key), name_of_bytes(value));
  if (word == "name") {
    header.name = name_of_bytes(value);
  } else if (word == "nrows" || word == "datarows") {
    header.rows = parse_number(value);
  } else if (word == "ncolumns" || word == "datacolumns") {
    header.columns = parse_number(value);
  } else if (word == "datatype") {
    return read_data_type(value, number, header);
  } else if (word == "indegrees") {
    const std::string answer = lower(value);
    if (answer == "yes" || answer == "y" || answer == "true" || answer == "1")
      header.in_degrees = true;
    else if (answer == "no" || answer == "n" || answer == "false" || answer == "0")
      header.in_degrees = false;
    else
      return fail(Code::bad_input,
                  fmt::format("line {}: inDegrees is '{}'; expected yes or no", number, excerpt(value)));
  }
  return {};
}

/// OpenSim writes a sentence beside inDegrees; old files hold the sentence alone.
std::optional<bool> degrees_by_sentence(const TableHeader& header) {
  for (const auto& [key, value] : header.pairs) {
    if (!key.empty()) continue;
    const std::string sentence = lower(value);
    if (sentence.starts_with("angles are in degrees")) return true;
    if (sentence.starts_with("angles are in radians")) return false;
  }
  return std::nullopt;
}

/// Lines up to 'endheader', or to the line of labels where there is no header; `labels` is that line.
Status read_pairs(Lines& lines, TableHeader& header, std::string_view& labels) {
  std::string_view line;
  bool first = true;
  while (lines.number() < kMaxHeaderLines && lines.next(line)) {
    if (auto status = check_header_line(line, lines.number()); !status) return status;
    const std::string_view text = trim(line);
    if (text.empty()) continue;
    if (lower(text) == "endheader") {
      do {
        if (!lines.next(line))
          return fail(Code::bad_input,
                      fmt::format("line {}: the file ends where the line of labels was expected",
                                  lines.number() + 1));
      } while (is_blank(line));
      labels = line;
      return {};
    }
    if (first && begins_with_time(text)) {
      header.warnings.push_back("there is no header; the first line is taken for the labels");
      labels = line;
      return {};
    }
    if (first && split_pair(text).first.empty())
      header.name = name_of_bytes(text);
    else if (!first && is_numbers_only(text))
      return fail(Code::bad_input,
                  fmt::format("line {}: numbers stand before the line 'endheader' of a MOT or STO table",
                              lines.number()));
    else if (auto status = read_pair(text, lines.number(), header); !status)
      return status;
    first = false;
  }
  if (first) return fail(Code::bad_input, "the file is empty; expected a MOT or STO table");
  return fail(
      Code::bad_input,
      fmt::format("there is no line 'endheader' in {} lines; expected a MOT or STO table", lines.number()));
}

/// "hip_flexion" of "/jointset/hip/hip_flexion/value", as OpenSim 4 writes states; empty: no such label.
std::string_view coordinate_in_path(std::string_view label) {
  constexpr std::string_view kJoints = "/jointset/", kValue = "/value";
  if (!label.starts_with(kJoints) || !label.ends_with(kValue)) return {};
  label.remove_prefix(kJoints.size());
  label.remove_suffix(std::min(kValue.size(), label.size()));
  const auto slash = label.find('/');
  if (slash == std::string_view::npos) return {};
  const auto name = label.substr(slash + 1);
  return name.find('/') == std::string_view::npos ? name : std::string_view();
}

/// Values of states get the names of their coordinates, as motions have them.
void name_coordinates(std::vector<std::string>& labels, TableHeader& header) {
  std::size_t named = 0;
  std::string example;
  std::unordered_set<std::string> taken(labels.begin(), labels.end());
  for (auto& label : labels) {
    const std::string name(coordinate_in_path(label));
    if (name.empty() || !taken.insert(name).second) continue;
    if (named++ == 0) example = fmt::format("'{}' as '{}'", excerpt(label), excerpt(name));
    label = name;
  }
  if (named > 0)
    header.warnings.push_back(
        fmt::format("{} of an OpenSim state file; read is {}{}",
                    named == 1 ? "1 label is a path" : fmt::format("{} labels are paths", named), example,
                    named > 1 ? ", the others likewise" : ""));
}

Status read_labels(std::string_view line, std::int64_t number, TableHeader& header) {
  if (auto status = check_header_line(line, number); !status) return status;
  if (line.find('\t') == std::string_view::npos) header.separator = Separator::blanks;
  Cells cells(line, header.separator);
  std::vector<std::string> labels;
  for (std::string_view label; cells.next_text(label);) {
    if (label.size() > 2 && label.front() == '"' && label.back() == '"')
      label = label.substr(1, label.size() - 2);
    labels.push_back(name_of_bytes(label));
  }
  while (!labels.empty() && labels.back().empty()) labels.pop_back();
  if (labels.empty() || lower(labels[0]) != "time")
    return fail(Code::bad_input, fmt::format("line {}: the first column is '{}'; expected 'time'", number,
                                             labels.empty() ? "" : excerpt(labels[0])));
  name_coordinates(labels, header);
  std::unordered_map<std::string_view, std::size_t> seen;
  for (std::size_t i = 1; i < labels.size(); ++i) {
    if (labels[i].empty())
      return fail(Code::bad_input, fmt::format("line {}, column {}: the column has no label", number, i + 1));
    if (const auto [it, is_new] = seen.emplace(labels[i], i + 1); !is_new)
      return fail(Code::bad_input, fmt::format("line {}: label '{}' occurs twice (columns {} and {})", number,
                                               excerpt(labels[i]), it->second, i + 1));
    if (header.width == 1) header.columns_named.emplace_back(labels[i]);
    for (std::size_t k = 1; header.width > 1 && k <= header.width; ++k)
      header.columns_named.push_back(fmt::format("{}_{}", labels[i], k));
  }
  if (header.columns && *header.columns != static_cast<double>(labels.size()))
    header.warnings.push_back(fmt::format("header says {} columns, {} are labelled; the labels are used",
                                          *header.columns, labels.size()));
  return {};
}

}  // namespace

bool is_written_by_us(std::string_view key) {
  static constexpr std::array<std::string_view, 14> kKeys{
      "name",        "version",  "nrows",     "ncolumns",       "indegrees", "datatype", "range",
      "datacolumns", "datarows", "otherdata", "opensimversion", "datarate",  kSetKey,    kSumKey};
  return std::ranges::find(kKeys, lower(key)) != kKeys.end();
}

Result<TableHeader> parse_table_header(Lines& lines) {
  TableHeader header;
  std::string_view labels;
  if (auto status = read_pairs(lines, header, labels); !status) return std::unexpected(status.error());
  if (!header.in_degrees) header.in_degrees = degrees_by_sentence(header);
  if (auto status = read_labels(labels, lines.number(), header); !status)
    return std::unexpected(status.error());
  std::string_view line;
  for (Lines ahead = lines; ahead.next(line) && is_blank(line);) lines = ahead;
  return header;
}

}  // namespace kinemark::io::internal
