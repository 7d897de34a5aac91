// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/csv_line.h"
#include "kinemark/io/text/internal/sleap_csv.h"
#include "kinemark/io/text/keypoints_csv.h"
#include "kinemark/io/text_input.h"

namespace kinemark::io {
namespace {

using internal::excerpt;

/// Columns of one point; 0, the column of frame numbers, where there is none.
struct Columns {
  std::size_t x = 0, y = 0, likelihood = 0;
};

class KeypointsParser {
 public:
  KeypointsParser(const KeypointsOptions& options, Keypoints& out) : options_(options), out_(out) {}

  Status header(internal::Lines& lines) {
    if (auto s = next_header(lines, "scorer"); !s) return s;
    const std::size_t width = cells_.size();
    std::vector<std::string> people;
    if (auto s = next_header(lines, "bodyparts", &people); !s) return s;
    if (auto s = choose(people, width, lines); !s) return s;
    const auto names = cells_;
    if (auto s = next_header(lines, "coords"); !s) return s;
    if (names.size() != width || cells_.size() != width)
      return fail(Code::bad_input,
                  fmt::format("the lines scorer, bodyparts and coords have {}, {} and {} cells", width,
                              names.size(), cells_.size()));
    if (width < 2) return fail(Code::bad_input, "names no point");
    std::map<std::string, std::size_t, std::less<>> index;
    for (std::size_t c = 1; c < width; ++c) {
      if (!people.empty() && people[c] != person_) continue;
      if (name_of_bytes(names[c]).empty())
        return wrong(lines, fmt::format("column {} belongs to no point", c + 1));
      const auto [at, is_new] = index.try_emplace(names[c], columns_.size());
      if (is_new) {
        columns_.emplace_back();
        out_.names.push_back(name_of_bytes(names[c]));
      }
      auto& point = columns_[at->second];
      std::size_t* const column = cells_[c] == "x"            ? &point.x
                                  : cells_[c] == "y"          ? &point.y
                                  : cells_[c] == "likelihood" ? &point.likelihood
                                                              : nullptr;
      if (column == nullptr)
        return wrong(lines,
                     fmt::format("column {} is '{}'; need x, y or likelihood", c + 1, excerpt(cells_[c])));
      if (*column != 0)
        return wrong(lines, fmt::format("point '{}' has two columns {}", excerpt(names[c]), cells_[c]));
      *column = c;
    }
    // Two spellings may become one name in UTF-8.
    auto sorted = out_.names;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      return wrong(lines, fmt::format("point '{}' occurs twice", excerpt(*twice)));
    for (std::size_t m = 0; m < columns_.size(); ++m)
      if (columns_[m].x == 0 || columns_[m].y == 0)
        return wrong(lines, fmt::format("point '{}' has no column {}", excerpt(out_.names[m]),
                                        columns_[m].x == 0 ? 'x' : 'y'));
    width_ = width;
    return {};
  }

  Status row(std::string_view line, const internal::Lines& lines) {
    if (!internal::split_csv(line, cells_)) return wrong(lines, "a quote is not closed");
    if (cells_.size() != width_)
      return wrong(lines, fmt::format("has {} cells; the header has {}", cells_.size(), width_));
    const auto number = parse_number(cells_[0]);
    if (!number || *number != static_cast<double>(frames_))
      return wrong(lines,
                   fmt::format("begins with '{}'; need frame {}: frames are counted from 0 without a gap",
                               excerpt(cells_[0]), frames_));
    ++frames_;
    for (std::size_t m = 0; m < columns_.size(); ++m)
      if (auto s = point(columns_[m], m, lines); !s) return s;
    return {};
  }

  Status finish() const {
    return frames_ > 0 ? Status() : fail(Code::bad_input, "has a header but no frames");
  }

 private:
  static std::unexpected<Error> wrong(const internal::Lines& lines, const std::string& what) {
    return fail(Code::bad_input, fmt::format("line {}: {}", lines.number(), what));
  }

  /// The person whose columns are read, of those whose names stand above the columns.
  Status choose(const std::vector<std::string>& people, std::size_t width, const internal::Lines& lines) {
    if (people.empty()) return {};
    if (people.size() != width)
      return wrong(
          lines, fmt::format("the lines scorer and individuals have {} and {} cells", width, people.size()));
    std::vector<std::string> names;
    for (std::size_t c = 1; c < width; ++c)
      if (std::ranges::find(names, people[c]) == names.end()) names.push_back(people[c]);
    if (options_.person) {
      if (*options_.person < 1 || std::cmp_greater(*options_.person, names.size()))
        return fail(Code::bad_input,
                    fmt::format("has no person {}; it has {}", *options_.person, names.size()));
      person_ = names[static_cast<std::size_t>(*options_.person - 1)];
      return {};
    }
    if (names.size() > 1) {
      std::vector<std::string> shown;
      for (std::size_t i = 0; i < names.size(); ++i)
        shown.push_back(fmt::format("{} ('{}')", i + 1, excerpt(names[i])));
      return fail(Code::not_supported, fmt::format("shows {} people; choose one with --person: {}",
                                                   names.size(), join_some(shown, 8)));
    }
    if (!names.empty()) person_ = names.front();
    return {};
  }

  /// Cells of the next line, which begins with this word; a line of individuals before it goes to `people`.
  Status next_header(internal::Lines& lines, std::string_view word,
                     std::vector<std::string>* people = nullptr) {
    std::string_view line;
    if (!lines.next(line)) return fail(Code::bad_input, fmt::format("ends before a line '{}'", word));
    if (auto s = internal::check_header_line(line, lines.number()); !s) return s;
    if (!internal::split_csv(line, cells_)) return wrong(lines, "a quote is not closed");
    if (cells_[0] == word) return {};
    if (people != nullptr && cells_[0] == "individuals") {
      *people = cells_;
      return next_header(lines, word);
    }
    return wrong(lines, fmt::format("begins with '{}'; need '{}'", excerpt(cells_[0]), word));
  }

  Status point(const Columns& columns, std::size_t m, const internal::Lines& lines) {
    double x = kNaN, y = kNaN, likelihood = 1.0;
    for (const auto& [column, value] :
         {std::pair{columns.x, &x}, {columns.y, &y}, {columns.likelihood, &likelihood}}) {
      if (column == 0) continue;
      const auto read = cells_[column].empty() ? std::optional(kNaN) : parse_number(cells_[column]);
      if (!read || std::isinf(*read))
        return wrong(lines,
                     fmt::format("column {} is '{}'; need a number", column + 1, excerpt(cells_[column])));
      *value = *read;
    }
    if (std::isnan(x) != std::isnan(y))
      return wrong(lines, fmt::format("point '{}' has {}", excerpt(out_.names[m]),
                                      std::isnan(x) ? "y but not x" : "x but not y"));
    if (likelihood < 0.0 || likelihood > 1.0)
      return wrong(lines, fmt::format("point '{}' has a likelihood of {}; need 0 to 1",
                                      excerpt(out_.names[m]), likelihood));
    const bool seen = likelihood >= options_.min_likelihood;
    out_.image.push_back(seen ? x : kNaN);
    out_.image.push_back(seen ? y : kNaN);
    return {};
  }

  const KeypointsOptions& options_;
  Keypoints& out_;
  std::vector<std::string> cells_;
  std::vector<Columns> columns_;
  std::string person_;
  std::size_t width_ = 0;
  std::int64_t frames_ = 0;
};

}  // namespace

Status KeypointsOptions::check() const {
  if (person && *person < 0)
    return fail(Code::usage, fmt::format("person {} cannot be; need a number from 0", *person));
  if (min_likelihood >= 0.0 && min_likelihood <= 1.0) return {};
  return fail(Code::usage, fmt::format("the least likelihood is {}; need 0 to 1", min_likelihood));
}

Result<Keypoints> parse_keypoints_csv(std::string_view text, const std::string& name,
                                      const KeypointsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (internal::begins_sleap_csv(text)) {
    auto read = internal::parse_sleap_csv(text, options);
    if (!read) return fail_at(name, read.error());
    return read;
  }
  Keypoints keypoints;
  KeypointsParser parser(options, keypoints);
  internal::Lines lines(text);
  if (auto s = parser.header(lines); !s) return fail_at(name, s.error());
  std::string_view line;
  while (lines.next(line)) {
    if (internal::is_blank(line)) continue;
    if (auto s = parser.row(line, lines); !s) return fail_at(name, s.error());
  }
  if (auto s = parser.finish(); !s) return fail_at(name, s.error());
  return keypoints;
}

Result<Keypoints> read_keypoints_csv(const std::filesystem::path& path, const KeypointsOptions& options) {
  const auto text = read_lines_of_text(path);
  if (!text) return std::unexpected(text.error());
  return parse_keypoints_csv(*text, path.string(), options);
}

}  // namespace kinemark::io
