// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_norms.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/pipeline/gait/gait_quantities.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

constexpr double kNormDeviations = 2.0;  // to each side of a mean, as gait laboratories draw a band

/// Columns that make a band; the first that a row has count.
struct BandColumns {
  std::string_view first, second, meaning;
};
constexpr std::array kBandColumns = {
    BandColumns{"one_low", "one_high", "band of one further curve, at all points at once"},
    BandColumns{"low", "high", "band as in the file"},
    BandColumns{"mean", "sd", "mean \u00b1 2 SD at each point"}};

/// A band at one row.
struct Ends {
  double low, high;
  std::string_view meaning;
};

/// A table and what its columns are.
class NormTable {
 public:
  explicit NormTable(const io::TidyTable& table) : table_(table) {
    for (const auto& columns : kBandColumns)
      if (has(columns.first) && has(columns.second)) pairs_.push_back(&columns);
  }

  [[nodiscard]] Result<GaitNorms> read() {
    if (pairs_.empty())
      return fail(Code::bad_input,
                  fmt::format("{}: a norm has columns one_low and one_high, low and high, or mean and sd; "
                              "'kinemark groups band' makes them of curves",
                              table_.name));
    if (!has("percent") && !has("measure"))
      return fail(Code::bad_input,
                  fmt::format("{}: a norm of curves has a column percent, one of measures a column measure",
                              table_.name));
    for (std::int64_t r = 0; r < table_.rows(); ++r)
      if (auto s = read_row(r); !s) return std::unexpected(s.error());
    if (out_.curves.empty() && out_.measures.empty())
      return fail(Code::bad_input, fmt::format("{}: no line has both ends of a band", table_.name));
    for (auto& curve : out_.curves) sort_points(curve);
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool has(std::string_view column) const { return table_.find(column) >= 0; }
  [[nodiscard]] std::string cell(std::int64_t row, std::string_view column) const {
    return has(column) ? table_(row, table_.find(column)) : std::string();
  }
  [[nodiscard]] std::unexpected<Error> wrong(std::int64_t row, const std::string& what) const {
    return fail(Code::bad_input, fmt::format("{}: line {}: {}", table_.name, table_.line_of[at(row)], what));
  }
  [[nodiscard]] Result<std::optional<Side>> side_of_row(std::int64_t row) const {
    const auto text = cell(row, "context");
    if (text.empty()) return std::optional<Side>();
    for (const auto side : data::kBothSides)
      if (text == data::to_string(side)) return std::optional(side);
    return wrong(row, fmt::format("context is '{}'; expected Left, Right or nothing", text));
  }
  [[nodiscard]] Result<double> number(std::int64_t row, std::string_view column) const {
    return has(column) ? table_.number(row, table_.find(column)) : kNaN;
  }

  // The first pair of ends that the row has; nothing for a row without any.
  [[nodiscard]] Result<std::optional<Ends>> ends_of(std::int64_t row) const {
    for (const auto* columns : pairs_) {
      const auto first = number(row, columns->first), second = number(row, columns->second);
      for (const auto* one : {&first, &second})
        if (!*one) return std::unexpected(one->error());
      if (std::isnan(*first) || std::isnan(*second)) continue;
      const bool by_deviation = columns->first == "mean";
      const Ends out{.low = by_deviation ? *first - kNormDeviations * *second : *first,
                     .high = by_deviation ? *first + kNormDeviations * *second : *second,
                     .meaning = columns->meaning};
      if (out.low <= out.high) return std::optional(out);
      return wrong(row, by_deviation ? fmt::format("the deviation {:g} is negative", *second)
                                     : fmt::format("the band's lower end {:g} is above its upper end {:g}",
                                                   out.low, out.high));
    }
    return std::optional<Ends>();
  }

  [[nodiscard]] Status read_row(std::int64_t row) {
    const auto found = ends_of(row);
    if (!found) return std::unexpected(found.error());
    if (!*found) return {};
    const auto& ends = **found;
    const auto mean = number(row, "mean");
    if (!mean) return std::unexpected(mean.error());
    const auto side = side_of_row(row);
    if (!side) return std::unexpected(side.error());
    if (const auto measure = cell(row, "measure"); !measure.empty())
      return add_measure(row, {.id = measure,
                               .side = *side,
                               .unit = cell(row, "unit"),
                               .low = ends.low,
                               .high = ends.high,
                               .source = source_of(row)});
    const auto place = number(row, "percent");
    if (!place) return std::unexpected(place.error());
    if (!(*place >= 0.0 && *place <= 100.0))
      return wrong(row, fmt::format("percent is '{}'; expected 0 to 100", cell(row, "percent")));
    return add_point(row, *side, *place, {.low = ends.low, .high = ends.high, .mean = *mean}, ends.meaning);
  }

  [[nodiscard]] Status add_measure(std::int64_t row, NormMeasure measure) {
    for (const auto& other : out_.measures)
      if (other.id == measure.id && other.side == measure.side)
        return wrong(row, fmt::format("measure {} comes twice", measure.id));
    out_.measures.push_back(std::move(measure));
    return {};
  }

  [[nodiscard]] Status add_point(std::int64_t row, std::optional<Side> side, double place, const NormAt& band,
                                 std::string_view meaning) {
    const auto name = name_of(row), unit = cell(row, "unit");
    auto curve = std::ranges::find_if(
        out_.curves, [&](const NormCurve& one) { return one.name == name && one.side == side; });
    if (curve == out_.curves.end()) {
      out_.curves.push_back({.name = name,
                             .side = side,
                             .unit = unit,
                             .meaning = std::string(meaning),
                             .source = source_of(row)});
      curve = std::prev(out_.curves.end());
    }
    if (curve->unit != unit)
      return wrong(row, fmt::format("{} is in '{}' here and in '{}' above", name, unit, curve->unit));
    if (std::ranges::find(curve->at, place) != curve->at.end())
      return wrong(row, fmt::format("percent {:g} of {} comes twice", place, name));
    // Ends of another meaning would make a band of two kinds: there is none there.
    const bool same = curve->meaning == meaning;
    curve->at.push_back(place);
    curve->low.push_back(same ? band.low : kNaN);
    curve->high.push_back(same ? band.high : kNaN);
    curve->mean.push_back(band.mean);
    return {};
  }

  [[nodiscard]] std::string source_of(std::int64_t row) const {
    const auto stated = cell(row, "source");
    return stated.empty() ? std::filesystem::path(table_.name).filename().string() : stated;
  }
  [[nodiscard]] std::string name_of(std::int64_t row) const {
    for (const std::string_view column : {"curve", "group"})
      if (const auto name = cell(row, column); !name.empty()) return name;
    return std::filesystem::path(table_.name).stem().string();
  }

  static void sort_points(NormCurve& curve) {
    std::vector<std::size_t> order(curve.at.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return curve.at[i]; });
    for (auto* values : {&curve.low, &curve.high, &curve.mean, &curve.at}) {
      std::vector<double> sorted;
      for (const auto i : order) sorted.push_back((*values)[i]);
      *values = std::move(sorted);
    }
  }

  const io::TidyTable& table_;
  std::vector<const BandColumns*> pairs_;  // that the table has, in the order in which they count
  GaitNorms out_;
};

std::string in_small(std::string_view text) {
  std::string out;
  for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_norm_of(const NormCurve& norm, const GaitQuantity& curve, const std::string& bare, Side side) {
  const auto of = gait_quantity(norm.name, data::Quantity::angle);
  const auto stated = norm.side ? norm.side : of.side;
  if (stated && *stated != side) return false;
  if (name_without_side(norm.name) == bare) return true;
  if (curve.same_sign && of.same_sign && of.key == curve.key) return true;
  return curve.same_sign && in_small(norm.name) == in_small(curve.title);
}

}  // namespace

Result<GaitNorms> gait_norms_of(const io::TidyTable& table) { return NormTable(table).read(); }

Result<GaitNorms> read_gait_norms(std::span<const std::filesystem::path> files) {
  GaitNorms out;
  for (const auto& file : files) {
    const auto table = io::read_tidy_csv(file);
    if (!table) return std::unexpected(table.error());
    auto norms = gait_norms_of(*table);
    if (!norms) return std::unexpected(norms.error());
    std::ranges::move(norms->curves, std::back_inserter(out.curves));
    std::ranges::move(norms->measures, std::back_inserter(out.measures));
  }
  return out;
}

const NormCurve* find_norm(const GaitNorms& norms, const std::string& id, Side side) {
  const auto curve = gait_quantity(id, data::Quantity::angle);
  const auto bare = name_without_side(id);
  const auto found = std::ranges::find_if(
      norms.curves, [&](const NormCurve& norm) { return is_norm_of(norm, curve, bare, side); });
  return found == norms.curves.end() ? nullptr : &*found;
}

NormAt norm_at(const NormCurve& norm, double percent) {
  const auto after = std::ranges::lower_bound(norm.at, percent) - norm.at.begin();
  if (after == std::ssize(norm.at) || (after == 0 && percent < norm.at.front())) return {};
  if (norm.at[at(after)] == percent)
    return {.low = norm.low[at(after)], .high = norm.high[at(after)], .mean = norm.mean[at(after)]};
  const auto a = at(after - 1), b = at(after);
  const double later = (percent - norm.at[a]) / (norm.at[b] - norm.at[a]);
  // std::lerp() may return the other end where one is missing.
  const auto between = [later](double from, double to) { return (1.0 - later) * from + later * to; };
  return {.low = between(norm.low[a], norm.low[b]),
          .high = between(norm.high[a], norm.high[b]),
          .mean = between(norm.mean[a], norm.mean[b])};
}

}  // namespace kinemark::pipeline
