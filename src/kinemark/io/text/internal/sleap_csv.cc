// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/sleap_csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/internal/csv_line.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kFewValues = 100'000, kValuesPerByte = 20;  // more than that, nothing explains
constexpr std::size_t kPeopleShown = 8;
constexpr double kMostFrames = 1e9;

/// Columns of a node; kNone where there is none.
struct Node {
  std::size_t x = kNone, y = kNone, score = kNone;
};

/// A point that was seen.
struct Sighting {
  std::int64_t frame = 0;
  std::size_t node = 0;
  double x = kNaN, y = kNaN;
};

class Parser {
 public:
  explicit Parser(const KeypointsOptions& options) : options_(options) {}

  Status header(Lines& lines) {
    std::string_view line;
    if (!lines.next(line)) return fail(Code::bad_input, "is empty");
    if (auto s = check_header_line(line, lines.number()); !s) return s;
    if (!split_csv(line, cells_)) return wrong(lines, "a quote is not closed");
    width_ = cells_.size();
    std::map<std::string, std::size_t, std::less<>> index;
    for (std::size_t c = 0; c < width_; ++c)
      if (auto s = label(c, index, lines); !s) return s;
    if (frame_ == kNone) return wrong(lines, "labels no column frame_idx");
    if (nodes_.empty()) return wrong(lines, "labels no point: expected columns such as nose.x and nose.y");
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (nodes_[n].x == kNone || nodes_[n].y == kNone)
        return wrong(lines, fmt::format("point '{}' has no column {}", excerpt(names_[n]),
                                        nodes_[n].x == kNone ? 'x' : 'y'));
    auto sorted = names_;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      return wrong(lines, fmt::format("point '{}' occurs twice", excerpt(*twice)));
    return {};
  }

  Status row(std::string_view line, const Lines& lines) {
    if (!split_csv(line, cells_)) return wrong(lines, "a quote is not closed");
    if (cells_.size() != width_)
      return wrong(lines, fmt::format("has {} cells; the header has {}", cells_.size(), width_));
    const auto number = parse_number(cells_[frame_]);
    if (!number || *number != std::floor(*number) || *number < 0.0 || *number > kMostFrames)
      return wrong(lines, fmt::format("frame_idx is '{}'; need a frame, from 0", excerpt(cells_[frame_])));
    const auto frame = static_cast<std::int64_t>(*number);
    const auto track = track_of(track_ == kNone ? std::string() : cells_[track_]);
    if (const auto [at, is_new] = line_of_.try_emplace({track, frame}, lines.number()); !is_new)
      return wrong(lines, twice(track, frame, at->second));
    last_frame_ = std::max(last_frame_, frame);
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (auto s = point(n, frame, track, lines); !s) return s;
    return {};
  }

  Result<Keypoints> finish(std::size_t bytes) {
    if (last_frame_ < 0) return fail(Code::bad_input, "has a header but no frames");
    const auto chosen = choose();
    if (!chosen) return std::unexpected(chosen.error());
    const auto values = static_cast<std::size_t>(last_frame_ + 1) * nodes_.size() * 2;
    if (values > kFewValues && values > kValuesPerByte * bytes)
      return fail(Code::bad_input,
                  fmt::format("frames up to {}, of which almost none shows anybody", last_frame_));
    Keypoints out{.names = names_, .image = std::vector<double>(values, kNaN)};
    for (const auto& seen : sightings_[*chosen]) {
      const auto at = 2 * (static_cast<std::size_t>(seen.frame) * nodes_.size() + seen.node);
      out.image[at] = seen.x;
      out.image[at + 1] = seen.y;
    }
    return out;
  }

 private:
  static std::unexpected<Error> wrong(const Lines& lines, const std::string& what) {
    return fail(Code::bad_input, fmt::format("line {}: {}", lines.number(), what));
  }

  Status label(std::size_t c, std::map<std::string, std::size_t, std::less<>>& index, const Lines& lines) {
    const std::string& cell = cells_[c];
    std::size_t* column = cell == "frame_idx" ? &frame_ : cell == "track" ? &track_ : nullptr;
    const auto dot = cell.rfind('.');
    const bool of_instance = cell.starts_with("instance.") || cell.starts_with("tracking");
    if (column == nullptr && !of_instance && dot != std::string::npos && dot > 0) {
      const std::string_view what = std::string_view(cell).substr(dot + 1);
      if (what != "x" && what != "y" && what != "score") return {};
      const auto [at, is_new] = index.try_emplace(cell.substr(0, dot), nodes_.size());
      if (is_new) {
        nodes_.emplace_back();
        names_.push_back(name_of_bytes(at->first));
      }
      Node& node = nodes_[at->second];
      column = what == "x" ? &node.x : what == "y" ? &node.y : &node.score;
    }
    if (column == nullptr) return {};
    if (*column != kNone) return wrong(lines, fmt::format("two columns are called '{}'", excerpt(cell)));
    *column = c;
    return {};
  }

  /// Index of a track in the order in which they come.
  std::size_t track_of(const std::string& name) {
    const auto [at, is_new] = track_index_.try_emplace(name, tracks_.size());
    if (is_new) {
      tracks_.push_back(name);
      sightings_.emplace_back();
    }
    return at->second;
  }

  [[nodiscard]] std::string twice(std::size_t track, std::int64_t frame, std::int64_t line) const {
    if (tracks_[track].empty())
      return fmt::format(
          "shows another animal without a track in frame {}, as line {} does: which is which is not known; "
          "export it with tracks",
          frame, line);
    return fmt::format("is of track '{}' in frame {}, as line {} is", excerpt(tracks_[track]), frame, line);
  }

  Status point(std::size_t n, std::int64_t frame, std::size_t track, const Lines& lines) {
    double x = kNaN, y = kNaN, score = kNaN;
    for (const auto& [column, value] :
         {std::pair{nodes_[n].x, &x}, {nodes_[n].y, &y}, {nodes_[n].score, &score}}) {
      if (column == kNone) continue;
      const auto read = cells_[column].empty() ? std::optional(kNaN) : parse_number(cells_[column]);
      if (!read || std::isinf(*read))
        return wrong(lines,
                     fmt::format("column {} is '{}'; need a number", column + 1, excerpt(cells_[column])));
      *value = *read;
    }
    if (std::isnan(x) != std::isnan(y))
      return wrong(lines, fmt::format("point '{}' has {}", excerpt(names_[n]),
                                      std::isnan(x) ? "y but not x" : "x but not y"));
    // A point that a person labelled has no score.
    if (std::isnan(x) || score < options_.min_likelihood) return {};
    sightings_[track].push_back({.frame = frame, .node = n, .x = x, .y = y});
    return {};
  }

  [[nodiscard]] Result<std::size_t> choose() const {
    if (options_.person) {
      if (*options_.person < 1 || std::cmp_greater(*options_.person, tracks_.size()))
        return fail(Code::bad_input,
                    fmt::format("has no track {}; it has {}", *options_.person, tracks_.size()));
      return static_cast<std::size_t>(*options_.person - 1);
    }
    if (tracks_.size() == 1) return 0;
    std::vector<std::string> shown;
    for (std::size_t i = 0; i < tracks_.size(); ++i)
      shown.push_back(tracks_[i].empty() ? fmt::format("{} (without a name)", i + 1)
                                         : fmt::format("{} ('{}')", i + 1, excerpt(tracks_[i])));
    return fail(Code::not_supported, fmt::format("shows {} tracks; choose one with --person: {}",
                                                 tracks_.size(), join_some(shown, kPeopleShown)));
  }

  const KeypointsOptions& options_;
  std::vector<std::string> cells_, names_, tracks_;
  std::vector<Node> nodes_;
  std::vector<std::vector<Sighting>> sightings_;  // of each track
  std::map<std::string, std::size_t, std::less<>> track_index_;
  std::map<std::pair<std::size_t, std::int64_t>, std::int64_t> line_of_;  // of a track in a frame
  std::size_t width_ = 0, frame_ = kNone, track_ = kNone;
  std::int64_t last_frame_ = -1;
};

}  // namespace

bool begins_sleap_csv(std::string_view begin) {
  Lines lines(begin);
  std::string_view line;
  std::vector<std::string> cells;
  if (!lines.next(line) || !check_header_line(line, 1)) return false;
  if (!split_csv(line, cells)) return false;
  const auto has = [&](auto&& is) { return std::ranges::any_of(cells, is); };
  return has([](const std::string& cell) { return cell == "frame_idx"; }) &&
         has([](const std::string& cell) { return cell.ends_with(".x"); }) &&
         !has([](const std::string& cell) { return cell.ends_with(".z"); });
}

Result<Keypoints> parse_sleap_csv(std::string_view text, const KeypointsOptions& options) {
  Parser parser(options);
  Lines lines(text);
  if (auto s = parser.header(lines); !s) return std::unexpected(s.error());
  std::string_view line;
  while (lines.next(line)) {
    if (is_blank(line)) continue;
    if (auto s = parser.row(line, lines); !s) return std::unexpected(s.error());
  }
  return parser.finish(text.size());
}

}  // namespace kinemark::io::internal
