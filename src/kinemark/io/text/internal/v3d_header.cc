// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/v3d_header.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "kinemark/core/utf8.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kRows = 5;
enum Row : std::uint8_t { source, signal, type, folder, component };
constexpr std::array<std::string_view, kRows> kRowNames{"source files", "signal names", "signal types",
                                                        "folders", "components"};
using Slot = V3dHeader::Slot;

/// Cells of one header row, the first (ITEM or blank) apart.
struct HeaderRow {
  std::string_view first;
  std::vector<std::string_view> cells;
};

Result<std::array<HeaderRow, kRows>> split(Lines& lines) {
  std::array<HeaderRow, kRows> rows;
  for (std::size_t r = 0; r < kRows; ++r) {
    std::string_view line;
    if (!lines.next(line))
      return fail(Code::bad_input,
                  fmt::format("line {}: the file ends; expected the row of {} of a Visual3D export, five "
                              "header rows in all",
                              r + 1, kRowNames[r]));
    if (auto status = check_header_line(line, lines.number()); !status)
      return std::unexpected(status.error());
    Cells cells(line, Separator::tab);
    std::string_view cell;
    cells.next_text(rows[r].first);
    while (cells.next_text(cell)) rows[r].cells.push_back(cell);
    // Tabs at the end of a row stand for no column.
    while (!rows[r].cells.empty() && rows[r].cells.back().empty()) rows[r].cells.pop_back();
  }
  if (lower(rows[component].first) != "item")
    return fail(Code::bad_input, fmt::format("line 5, column 1: '{}'; expected ITEM, as row 5 of a Visual3D "
                                             "text export begins",
                                             excerpt(rows[component].first)));
  for (const Row r : {source, signal, type, folder})
    if (rows[r].cells.size() != rows[component].cells.size())
      return fail(Code::bad_input,
                  fmt::format("line {}: {} {}; row 5 has {} components", r + 1, rows[r].cells.size(),
                              kRowNames[r], rows[component].cells.size()));
  return rows;
}

Slot::Kind kind_of(std::string_view type) {
  if (type == "LANDMARK" || type == "TARGET") return Slot::Kind::point;
  return type == "LINK_MODEL_BASED" ? Slot::Kind::angle : Slot::Kind::unread;
}

/// Gathers the columns of each signal.
class Gatherer {
 public:
  explicit Gatherer(V3dHeader& header) : header_(header) {}

  Status add(const std::array<HeaderRow, kRows>& rows, std::size_t column) {
    const auto cell = [&](Row r) { return rows[r].cells[column]; };
    Slot slot{.kind = kind_of(cell(type))};
    if (slot.kind == Slot::Kind::unread) {
      ++unread_[std::string(cell(type))];
    } else if (cell(source) != rows[source].cells.front()) {
      ++other_files_;
      slot.kind = Slot::Kind::unread;
    } else {
      const auto axis = lower(cell(component));
      if (axis.size() != 1 || axis < "x" || axis > "z")
        return at(component, column, fmt::format("component '{}'; expected X, Y or Z", excerpt(axis)));
      if (name_of_bytes(cell(signal)).empty()) return at(signal, column, "the signal has no name");
      slot.axis = axis.front() - 'x';
      auto& names = slot.kind == Slot::Kind::point ? header_.points : header_.angles;
      auto& components = components_[static_cast<std::size_t>(slot.kind)];
      const auto [known, is_new] =
          indices_.try_emplace({slot.kind, cell(signal)}, static_cast<std::int32_t>(names.size()));
      if (is_new) {
        names.push_back(name_of_bytes(cell(signal)));
        components.push_back(0);
      }
      slot.signal = known->second;
      auto& seen = components[static_cast<std::size_t>(slot.signal)];
      if ((seen & (1U << static_cast<unsigned>(slot.axis))) != 0)
        return at(component, column,
                  fmt::format("{} of signal '{}' ({}) occurs twice", cell(component), excerpt(cell(signal)),
                              excerpt(cell(type))));
      seen |= 1U << static_cast<unsigned>(slot.axis);
    }
    header_.slots.push_back(slot);
    return {};
  }

  Status finish() {
    for (const auto& [key, index] : indices_)
      if (components_[static_cast<std::size_t>(key.first)][static_cast<std::size_t>(index)] != 7)
        return fail(Code::bad_input,
                    fmt::format("line 5: signal '{}' has not all of X, Y and Z", excerpt(key.second)));
    // Two spellings may become one name in UTF-8.
    for (const auto* names : {&header_.points, &header_.angles}) {
      auto sorted = *names;
      std::ranges::sort(sorted);
      if (const auto duplicate = std::ranges::adjacent_find(sorted); duplicate != sorted.end())
        return fail(Code::bad_input, fmt::format("line 2: signal '{}' occurs twice", excerpt(*duplicate)));
    }
    if (header_.points.empty())
      return fail(Code::bad_input,
                  "line 3: no signal is of type LANDMARK or TARGET; one at least was expected");
    for (const auto& [name, columns] : unread_)
      if (warnings_left_ > 0) {
        --warnings_left_;
        header_.warnings.push_back(
            fmt::format("{} columns of type '{}' are not read", columns, excerpt(name)));
      }
    if (other_files_ > 0)
      header_.warnings.push_back(
          fmt::format("{} columns come from other recordings than the first, '{}', and are not read",
                      other_files_, excerpt(header_.recorded_as)));
    return {};
  }

 private:
  static Status at(Row row, std::size_t column, const std::string& what) {
    return fail(Code::bad_input, fmt::format("line {}, column {}: {}", row + 1, column + 2, what));
  }

  V3dHeader& header_;
  std::map<std::pair<Slot::Kind, std::string_view>, std::int32_t> indices_;
  std::array<std::vector<unsigned>, 3> components_;  ///< bits of axes seen, by kind
  std::map<std::string, std::int64_t> unread_;
  std::int64_t other_files_ = 0;
  int warnings_left_ = 8;
};

}  // namespace

Result<V3dHeader> parse_v3d_header(Lines& lines) {
  const auto rows = split(lines);
  if (!rows) return std::unexpected(rows.error());
  V3dHeader header;
  const auto columns = (*rows)[component].cells.size();
  if (columns > 0) header.recorded_as = name_of_bytes((*rows)[source].cells.front());
  Gatherer gatherer(header);
  for (std::size_t c = 0; c < columns; ++c)
    if (auto status = gatherer.add(*rows, c); !status) return std::unexpected(status.error());
  if (auto status = gatherer.finish(); !status) return std::unexpected(status.error());
  return header;
}

}  // namespace kinemark::io::internal
