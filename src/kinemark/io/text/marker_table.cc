// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/marker_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/marker_rows.h"
#include "kinemark/io/text/internal/time_column.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kNamed = 8;
constexpr std::array<std::string_view, 3> kTranslations{"_tx", "_ty", "_tz"};
constexpr std::array<std::string_view, 3> kParts{"_1", "_2",
                                                 "_3"};  // of a vector, as read_table() names them

/// The name of a marker whose three columns begin here; empty: none does.
std::string_view marker_at(const std::vector<std::string>& columns, std::size_t c,
                           const std::array<std::string_view, 3>& ends) {
  if (c + 2 >= columns.size() || !columns[c].ends_with(ends[0])) return {};
  const auto name = std::string_view(columns[c]).substr(0, columns[c].size() - ends[0].size());
  for (std::size_t k = 1; k < 3; ++k)
    if (columns[c + k].size() != columns[c].size() || !columns[c + k].starts_with(name) ||
        !columns[c + k].ends_with(ends[k]))
      return {};
  return name;
}

bool holds_vectors(const data::Table& table) {
  return std::ranges::any_of(table.header, [](const auto& pair) {
    return internal::lower(pair.first) == "datatype" && internal::lower(pair.second) == "vec3";
  });
}

Result<double> metres_of(const data::Table& table) {
  for (const auto& [key, value] : table.header) {
    if (internal::lower(key) != "units") continue;
    if (const auto metres = metres_per_unit(value)) return *metres;
    return fail(Code::bad_input,
                fmt::format("Units is '{}'; expected m, cm or mm", internal::excerpt(value)));
  }
  return 1.0;
}

Status settle_time(const data::Table& table, data::Trial& trial) {
  const auto place = [](std::size_t row) { return fmt::format("row {}", row + 1); };
  const auto clock = internal::even_clock({.time_s = table.time_s,
                                           .resolution_s = 0.0,
                                           .stated = {},
                                           .most_frames = 2 * table.rows() + 1'000'000,
                                           .place = place},
                                          trial.warnings);
  if (!clock) return std::unexpected(clock.error());
  // Such a table never states a rate.
  std::erase_if(trial.warnings,
                [](const std::string& warning) { return warning.starts_with("header gives no rate"); });
  internal::spread_rows(trial.markers, *clock);
  return {};
}

Result<data::Trial> trial_of(const data::Table& table) {
  const auto metres = metres_of(table);
  if (!metres) return std::unexpected(metres.error());
  const auto& ends = holds_vectors(table) ? kParts : kTranslations;
  data::Trial trial;
  trial.format = "STO";
  trial.units_in_file = *metres == 1.0 ? "m" : *metres == 0.01 ? "cm" : "mm";
  trial.warnings = table.warnings;
  std::vector<std::size_t> first;
  std::vector<std::string> unread;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const auto name = marker_at(table.columns, c, ends);
    if (name.empty()) {
      unread.push_back(fmt::format("'{}'", internal::excerpt(table.columns[c])));
      continue;
    }
    trial.markers.names.emplace_back(name);
    first.push_back(c);
    c += 2;
  }
  if (first.empty() || table.rows() == 0)
    return fail(Code::bad_input,
                "holds no positions of markers; expected three columns a marker, such as LASI_tx, LASI_ty "
                "and LASI_tz, or vectors (DataType=Vec3)");
  if (!unread.empty())
    trial.warnings.push_back(fmt::format("{} of {} columns are no positions of markers and are not read: {}",
                                         unread.size(), table.columns.size(), join_some(unread, kNamed)));
  const auto markers = first.size();
  trial.markers.time.frames = table.rows();
  trial.markers.x_in_world.assign(3 * at(table.rows()) * markers, kNaN);
  trial.markers.state.assign(at(table.rows()) * markers, data::SampleState::missing);
  for (std::int64_t r = 0; r < table.rows(); ++r)
    for (std::size_t m = 0; m < markers; ++m) {
      std::array<double, 3> x{};
      for (std::size_t k = 0; k < 3; ++k) x[k] = *metres * table(r, static_cast<std::int64_t>(first[m] + k));
      if (!std::ranges::all_of(x, [](double v) { return std::isfinite(v); })) continue;
      const std::size_t sample = at(r) * markers + m;
      std::ranges::copy(x, trial.markers.x_in_world.begin() + static_cast<std::ptrdiff_t>(3 * sample));
      trial.markers.state[sample] = data::SampleState::measured;
    }
  if (auto s = settle_time(table, trial); !s) return std::unexpected(s.error());
  return trial;
}

}  // namespace

bool begins_marker_table(std::string_view begin) {
  if (begin.find("endheader") == std::string_view::npos) return false;
  internal::Lines lines(begin);
  std::string_view line;
  bool vectors = false, ended = false;
  while (lines.next(line)) {
    const std::string word = internal::lower(line);
    vectors = vectors || word.starts_with("datatype=vec3");
    if (ended && !internal::is_blank(line)) break;
    ended = ended || word.starts_with("endheader");
  }
  if (vectors || !ended) return vectors;
  std::vector<std::string> labels;
  internal::Cells cells(line, line.find('\t') == std::string_view::npos ? internal::Separator::blanks
                                                                        : internal::Separator::tab);
  for (std::string_view cell; cells.next_text(cell);)
    if (!cell.empty()) labels.emplace_back(cell);
  if (labels.empty() || internal::lower(labels.front()) != "time") return false;
  labels.erase(labels.begin());
  const bool is_cut = line.data() + line.size() == begin.data() + begin.size();
  if (is_cut && !labels.empty()) labels.pop_back();
  if (is_cut) labels.resize(labels.size() - labels.size() % 3);
  for (std::size_t c = 0; c < labels.size(); c += 3)
    if (marker_at(labels, c, kTranslations).empty()) return false;
  return !labels.empty();
}

Result<data::Trial> parse_marker_table(std::string_view text, std::string_view name) {
  const auto table = parse_table(text, name);
  if (!table) return std::unexpected(table.error());
  auto trial = trial_of(*table);
  if (!trial) return fail_at(name, trial.error());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_marker_table(const std::filesystem::path& path) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_marker_table(*text, path.string());
}

}  // namespace kinemark::io
