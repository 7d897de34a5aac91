// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/curve_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/groups/groups_tables.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kMostValues = 200'000'000;
constexpr std::size_t kNameShown = 60;

/// A curve before all of its points are known.
struct Curve {
  std::string group, subject, name;
  std::map<double, double> values;  ///< by where
};

/// Curves in the order in which they came.
class Collection {
 public:
  Curve& of(const std::string& group, const std::string& subject, const std::string& name) {
    const auto [at, is_new] = index_.try_emplace(std::pair{group, name}, curves_.size());
    if (is_new) curves_.push_back({group, subject, name, {}});
    return curves_[at->second];
  }
  [[nodiscard]] std::vector<Curve>& curves() { return curves_; }

 private:
  std::map<std::pair<std::string, std::string>, std::size_t> index_;
  std::vector<Curve> curves_;
};

bool names_columns(const CurveColumns& columns) {
  const CurveColumns plain;
  return !columns.group.empty() || !columns.subject.empty() || !columns.curve.empty() ||
         columns.at != plain.at || columns.value != plain.value || !columns.where.empty();
}

std::string name_of_file(const io::TidyTable& table) {
  return std::filesystem::path(table.name).stem().string();
}

Status add_numbers(const io::TidyTable& table, const CurveColumns& columns, Collection& collection) {
  if (names_columns(columns))
    return fail(Code::usage,
                fmt::format("{}: its first line holds numbers, not names, so that no column can be "
                            "named",
                            table.name));
  for (std::int64_t row = 0; row < table.rows(); ++row) {
    const auto name = fmt::to_string(row + 1);
    Curve& curve = collection.of(name_of_file(table), name, name);
    for (std::int64_t c = 0; c < table.width; ++c) {
      const auto value = table.number(row, c);
      if (!value) return std::unexpected(value.error());
      curve.values[static_cast<double>(c)] = *value;
    }
  }
  return {};
}

Result<std::vector<std::int64_t>> naming_columns(const io::TidyTable& table, const CurveColumns& columns) {
  if (!columns.curve.empty()) return columns_of(table, columns.curve, "--curve");
  std::vector<std::int64_t> out;
  for (const auto name : kCurveColumns)
    if (const auto at = table.find(name); at >= 0) out.push_back(at);
  return out;
}

// Where a table holds cycles and their mean, as `--write-cycles` writes it, the mean is no further
// curve.
void leave_out_means(const io::TidyTable& table, std::vector<std::int64_t>& rows,
                     std::vector<std::string>& warnings) {
  const auto cycle = table.find("cycle");
  const auto is_mean = [&](std::int64_t row) { return table(row, cycle) == "mean"; };
  if (cycle < 0 || std::ranges::all_of(rows, is_mean)) return;
  if (std::erase_if(rows, is_mean) > 0)
    warnings.push_back(fmt::format(
        "{}: lines of the mean of cycles are left out; --where cycle=mean takes them alone", table.name));
}

Status add_lines(const io::TidyTable& table, const CurveColumns& columns, CurveGroups& out,
                 Collection& collection) {
  const auto at = column_of(table, columns.at, "--at");
  if (!at) return std::unexpected(at.error());
  const auto value = column_of(table, columns.value, "--value");
  if (!value) return std::unexpected(value.error());
  std::int64_t group = -1, subject = -1;
  for (const auto& [name, column, option] :
       {std::tuple{&columns.group, &group, "--group"}, std::tuple{&columns.subject, &subject, "--subject"}}) {
    if (name->empty()) continue;
    const auto found = column_of(table, *name, option);
    if (!found) return std::unexpected(found.error());
    *column = *found;
  }
  const auto naming = naming_columns(table, columns);
  if (!naming) return std::unexpected(naming.error());
  auto rows = rows_where(table, columns.where);
  if (!rows) return std::unexpected(rows.error());
  leave_out_means(table, *rows, out.warnings);
  auto& unit = out.unit;
  auto its_unit = unit_of(table, *rows);
  if (!its_unit) return std::unexpected(its_unit.error());
  if (!unit.empty() && !its_unit->empty() && *its_unit != unit)
    return fail(Code::bad_input,
                fmt::format("{}: is in '{}', the file before in '{}'", table.name, *its_unit, unit));
  if (unit.empty()) unit = *its_unit;
  for (const auto row : *rows) {
    const auto where = table.number(row, *at), number = table.number(row, *value);
    if (!where) return std::unexpected(where.error());
    if (!number) return std::unexpected(number.error());
    const auto line = table.line_of[static_cast<std::size_t>(row)];
    if (std::isnan(*where))
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: {} is blank; need a number", table.name, line, columns.at));
    const std::string who = subject < 0 ? "" : table(row, subject);
    Curve& curve = collection.of(
        group < 0 ? name_of_file(table) : table(row, group), who,
        who.empty() ? joined_cells(table, row, *naming) : who + "\n" + joined_cells(table, row, *naming));
    if (!curve.values.try_emplace(*where, *number).second)
      return fail(
          Code::bad_input,
          fmt::format("{}: line {}: curve '{}' has a second value at {:g}; name what tells curves apart "
                      "with --curve",
                      table.name, line, printable(joined_cells(table, row, *naming), kNameShown), *where));
  }
  return {};
}

// One curve for each subject and group, in the order in which they came.
std::vector<Curve> mean_of_subjects(std::vector<Curve>& curves, std::vector<std::string>& warnings) {
  Collection means;
  std::map<std::pair<std::string, std::string>, std::map<double, std::int64_t>> counts;
  std::map<std::pair<std::string, std::string>, std::int64_t> cycles;
  for (const Curve& curve : curves) {
    Curve& mean = means.of(curve.group, curve.subject, curve.subject);
    auto& count = counts[{curve.group, curve.subject}];
    ++cycles[{curve.group, curve.subject}];
    for (const auto& [where, value] : curve.values) {
      auto& sum = mean.values.try_emplace(where, kNaN).first->second;
      if (std::isnan(value)) continue;
      sum = std::isnan(sum) ? value : sum + value;
      ++count[where];
    }
  }
  for (Curve& mean : means.curves())
    for (auto& [where, value] : mean.values)
      if (const auto count = counts[{mean.group, mean.subject}][where]; count > 0)
        value /= static_cast<double>(count);
  const auto most = std::ranges::max_element(cycles, {}, [](const auto& c) { return c.second; });
  if (most->second > 1)
    warnings.push_back(fmt::format("{} curves are averaged to {}, one for each subject in each group",
                                   curves.size(), means.curves().size()));
  return std::move(means.curves());
}

Result<std::vector<double>> common_points(const std::vector<Curve>& curves) {
  std::map<double, std::int64_t> counts;
  for (const Curve& curve : curves)
    for (const auto& [where, value] : curve.values) ++counts[where];
  if (counts.size() < 2) return fail(Code::bad_input, "the curves have a single point; need two or more");
  std::vector<double> out;
  for (const auto& [where, count] : counts) out.push_back(where);
  if (out.size() * curves.size() > kMostValues)
    return fail(Code::bad_input,
                fmt::format("{} curves with {} different points in all; time-normalise them first",
                            curves.size(), out.size()));
  // Curves of 101 and of 100 points have few points in common: nobody would want these compared.
  const auto longest = std::ranges::max_element(curves, {}, [](const Curve& c) { return c.values.size(); });
  if (2 * longest->values.size() < out.size() + 1)
    return fail(Code::bad_input,
                fmt::format("no curve has more than {} of the {} different points; time-normalise "
                            "the curves to the same points first",
                            longest->values.size(), out.size()));
  return out;
}

void fill(const Curve& curve, const std::vector<double>& at, data::CycleCurves& into) {
  into.cycles.push_back(curve.name);
  for (const double where : at) {
    const auto found = curve.values.find(where);
    into.values.push_back(found == curve.values.end() ? kNaN : found->second);
  }
}

}  // namespace

Result<CurveGroups> make_curve_groups(const std::vector<io::TidyTable>& tables, const CurveColumns& columns) {
  CurveGroups out;
  Collection collection;
  const bool numbers = !tables.empty() && tables.front().columns.empty();
  for (const auto& table : tables) {
    if (table.columns.empty() != numbers)
      return fail(Code::bad_input, fmt::format("{} has names of columns, {} has none; need the same of all",
                                               (numbers ? table : tables.front()).name,
                                               (numbers ? tables.front() : table).name));
    if (numbers && table.width != tables.front().width)
      return fail(Code::bad_input, fmt::format("{} has {} points a curve, {} has {}", table.name, table.width,
                                               tables.front().name, tables.front().width));
    if (auto s =
            numbers ? add_numbers(table, columns, collection) : add_lines(table, columns, out, collection);
        !s)
      return std::unexpected(s.error());
  }
  auto curves = std::move(collection.curves());
  if (curves.empty()) return fail(Code::bad_input, "no curves were given");
  if (!columns.subject.empty()) curves = mean_of_subjects(curves, out.warnings);
  auto at = common_points(curves);
  if (!at) return std::unexpected(at.error());
  out.at = std::move(*at);
  out.at_name = numbers ? "point" : columns.at;
  for (const Curve& curve : curves) {
    auto group = std::ranges::find(out.names, curve.group);
    if (group == out.names.end()) {
      group = out.names.insert(out.names.end(), curve.group);
      out.curves.push_back(
          {.id = columns.value, .quantity = data::Quantity::ratio, .points = std::ssize(out.at)});
    }
    fill(curve, out.at, out.curves[static_cast<std::size_t>(group - out.names.begin())]);
  }
  return out;
}

Result<CurveGroups> read_curve_groups(const std::vector<std::filesystem::path>& files,
                                      const CurveColumns& columns) {
  std::vector<io::TidyTable> tables;
  for (const auto& file : files) {
    auto table = io::read_tidy_csv(file);
    if (!table) return std::unexpected(table.error());
    for (const auto& before : tables)
      if (columns.group.empty() && name_of_file(before) == name_of_file(*table))
        return fail(Code::usage,
                    fmt::format("{} and {}: two groups of the same name; rename one or use --group",
                                before.name, table->name));
    tables.push_back(std::move(*table));
  }
  return make_curve_groups(tables, columns);
}

Status pair_curves(CurveGroups& groups) {
  if (groups.curves.size() != 2)
    return fail(Code::bad_input,
                fmt::format("a paired comparison takes two groups; there are {}", groups.curves.size()));
  auto &first = groups.curves[0], &second = groups.curves[1];
  data::CycleCurves one = first, other = second;
  for (auto* half : {&one, &other}) {
    half->cycles.clear();
    half->values.clear();
  }
  const auto points = std::ssize(groups.at);
  for (std::size_t i = 0; i < first.cycles.size(); ++i) {
    const auto partner = std::ranges::find(second.cycles, first.cycles[i]);
    if (partner == second.cycles.end()) continue;
    const auto copy = [points](const data::CycleCurves& from, std::int64_t curve, data::CycleCurves& to) {
      to.cycles.push_back(from.cycles[static_cast<std::size_t>(curve)]);
      const auto begin = from.values.begin() + curve * points;
      to.values.insert(to.values.end(), begin, begin + points);
    };
    copy(first, static_cast<std::int64_t>(i), one);
    copy(second, partner - second.cycles.begin(), other);
  }
  const auto left_out = std::ssize(first.cycles) + std::ssize(second.cycles) - 2 * std::ssize(one.cycles);
  if (one.cycles.empty())
    return fail(Code::bad_input,
                fmt::format("no curve of '{}' has a partner of the same name in '{}'; name what pairs "
                            "them with --subject",
                            printable(groups.names[0], kNameShown), printable(groups.names[1], kNameShown)));
  if (left_out > 0)
    groups.warnings.push_back(fmt::format("{} curves without a partner are left out", left_out));
  first = std::move(one);
  second = std::move(other);
  return {};
}

}  // namespace kinemark::pipeline
