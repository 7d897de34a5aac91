// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/retest_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/pipeline/groups/groups_tables.h"

namespace kinemark::pipeline {
namespace {

constexpr std::string_view kBy[] = {"measure", "subject", "context", "region"};

/// Values of one subject in one session.
struct Cell {
  double sum = 0.0, variance = 0.0;  ///< variance: of the noise, of all values
  std::int64_t count = 0;
};

/// One measure as it is collected.
struct Collected {
  std::string name, unit;
  std::vector<std::string> subjects, sessions;                ///< in the order of the tables
  std::map<std::pair<std::size_t, std::size_t>, Cell> cells;  ///< subject, session
  bool has_noise = true;
};

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::ranges::find(names, name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

/// Columns of a table, as indices.
struct Where {
  std::int64_t subject = 0, session = 0, value = 0, sd = -1, unit = -1;
  std::vector<std::int64_t> by;
};

Result<Where> columns_in(const io::TidyTable& table, const RetestJob& job) {
  Where out;
  for (const auto& [column, name, option] :
       {std::tuple{&out.subject, &job.subject, "--subject"},
        std::tuple{&out.session, &job.session, "--session"}, std::tuple{&out.value, &job.value, "--value"}}) {
    const auto found = column_of(table, *name, option);
    if (!found) return std::unexpected(found.error());
    *column = *found;
  }
  out.sd = table.find(job.sd);
  if (out.sd < 0 && job.sd != RetestJob().sd)
    return std::unexpected(column_of(table, job.sd, "--sd").error());
  out.unit = table.find("unit");
  if (!job.by.empty()) {
    auto by = columns_of(table, job.by, "--by");
    if (!by) return std::unexpected(by.error());
    out.by = std::move(*by);
    return out;
  }
  for (const auto name : kBy)
    if (const auto at = table.find(name); at >= 0 && at != out.subject && at != out.session)
      out.by.push_back(at);
  return out;
}

Status collect(const io::TidyTable& table, const RetestJob& job, std::vector<Collected>& collected,
               std::map<std::string, std::size_t>& index) {
  const auto columns = columns_in(table, job);
  if (!columns) return std::unexpected(columns.error());
  const auto rows = rows_where(table, job.where);
  if (!rows) return std::unexpected(rows.error());
  for (const auto row : *rows) {
    const auto name = joined_cells(table, row, columns->by);
    const auto [at, is_new] = index.try_emplace(name, collected.size());
    const std::string unit = columns->unit < 0 ? "" : table(row, columns->unit);
    if (is_new) collected.push_back({.name = name.empty() ? job.value : name, .unit = unit});
    Collected& measure = collected[at->second];
    const auto line = table.line_of[static_cast<std::size_t>(row)];
    if (unit != measure.unit)
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: is in '{}', other values of {} in '{}'", table.name, line,
                              printable(unit, 20), printable(measure.name, 60), printable(measure.unit, 20)));
    const auto value = table.number(row, columns->value);
    if (!value) return std::unexpected(value.error());
    const Result<double> sd = columns->sd < 0 ? Result<double>(kNaN) : table.number(row, columns->sd);
    if (!sd) return std::unexpected(sd.error());
    if (*sd < 0.0)
      return fail(Code::bad_input, fmt::format("{}: line {}: {} is negative", table.name, line, job.sd));
    const std::string &who = table(row, columns->subject), &when = table(row, columns->session);
    if (who.empty() || when.empty())
      return fail(Code::bad_input, fmt::format("{}: line {}: {} is blank", table.name, line,
                                               who.empty() ? job.subject : job.session));
    Cell& cell = measure.cells[{place_of(measure.subjects, who), place_of(measure.sessions, when)}];
    if (std::isnan(*value)) continue;
    cell.sum += *value;
    cell.variance += *sd * *sd;
    ++cell.count;
    measure.has_noise = measure.has_noise && !std::isnan(*sd);
  }
  return {};
}

analysis::RepeatedMeasure repeated(const Collected& measure) {
  analysis::RepeatedMeasure out{.subjects = std::ssize(measure.subjects),
                                .sessions = std::ssize(measure.sessions)};
  for (std::size_t i = 0; i < measure.subjects.size(); ++i)
    for (std::size_t j = 0; j < measure.sessions.size(); ++j) {
      const auto cell = measure.cells.find({i, j});
      const bool there = cell != measure.cells.end() && cell->second.count > 0;
      const auto count = there ? static_cast<double>(cell->second.count) : 1.0;
      out.values.push_back(there ? cell->second.sum / count : kNaN);
      if (measure.has_noise) out.noise_sd.push_back(there ? std::sqrt(cell->second.variance) / count : 0.0);
    }
  return out;
}

std::string bounded(const analysis::Bounded& b) {
  return fmt::format("{:.3g} [{:.3g} to {:.3g}]", b.value, b.low, b.high);
}

nlohmann::ordered_json bounded_json(const analysis::Bounded& b) {
  return {{"value", json_number(b.value)}, {"low", json_number(b.low)}, {"high", json_number(b.high)}};
}

}  // namespace

Result<RetestOutcome> run_retest(const RetestJob& job) {
  if (auto s = check_table_name(job.output, "tests of measures"); !s) return std::unexpected(s.error());
  std::vector<Collected> collected;
  std::map<std::string, std::size_t> index;
  for (const auto& input : job.inputs) {
    const auto table = io::read_tidy_csv(input);
    if (!table) return std::unexpected(table.error());
    if (auto s = collect(*table, job, collected, index); !s) return std::unexpected(s.error());
  }
  RetestOutcome outcome;
  for (const auto& measure : collected) {
    auto tested = analysis::reliability(repeated(measure), job.level);
    if (tested)
      outcome.measures.push_back({measure.name, measure.unit, *tested});
    else if (tested.error().code == Code::usage)
      return std::unexpected(tested.error());
    else
      outcome.warnings.push_back(fmt::format("{}: {}", printable(measure.name, 60), tested.error().message));
  }
  if (outcome.measures.empty())
    return fail(Code::bad_input,
                outcome.warnings.empty() ? "no measure was given" : outcome.warnings.front());
  auto written = write_table_of_groups(job.output, job.inputs, job, retest_csv(outcome), retest_json(outcome),
                                       "the tests");
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return outcome;
}

std::string retest_text(const RetestOutcome& outcome) {
  std::string out;
  for (const auto& measure : outcome.measures) {
    const auto& r = measure.reliability;
    const std::string unit = measure.unit.empty() ? "" : " " + measure.unit;
    out +=
        fmt::format("{}: {} subjects{}; intervals of {:g} %\n", printable(measure.name, 60), r.subjects,
                    r.left_out > 0 ? fmt::format(" ({} with a value missing are left out)", r.left_out) : "",
                    100.0 * r.level);
    out += fmt::format("  ICC(2,1) {}, ICC(3,1) {}\n", bounded(r.agreement), bounded(r.consistency));
    out += fmt::format("  SEM {}{}, MDC95 {:.3g}{}\n", bounded(r.sem), unit, r.mdc, unit);
    if (std::isfinite(r.noise))
      out += fmt::format("  measurement noise {:.3g}{}; without it SEM {:.3g}{}, ICC(3,1) {:.3g}\n", r.noise,
                         unit, r.sem_movement, unit, r.consistency_movement);
  }
  return out;
}

std::string retest_csv(const RetestOutcome& outcome) {
  std::string out =
      "measure,unit,subjects,left_out,mean,icc_2_1,icc_2_1_low,icc_2_1_high,icc_3_1,icc_3_1_low,icc_3_1_high,"
      "sem,"
      "sem_low,sem_high,sem_agreement,mdc,noise,sem_without_noise,icc_3_1_without_noise,level\n";
  for (const auto& [name, unit, r] : outcome.measures) {
    out += fmt::format("{},{},{},{}", table_cell(name), table_cell(unit), r.subjects, r.left_out);
    for (const double value :
         {r.mean, r.agreement.value, r.agreement.low, r.agreement.high, r.consistency.value,
          r.consistency.low, r.consistency.high, r.sem.value, r.sem.low, r.sem.high, r.sem_agreement, r.mdc,
          r.noise, r.sem_movement, r.consistency_movement, r.level})
      out += "," + table_cell(value);
    out += "\n";
  }
  return out;
}

nlohmann::ordered_json retest_json(const RetestOutcome& outcome) {
  nlohmann::ordered_json out;
  out["measures"] = nlohmann::ordered_json::array();
  for (const auto& [name, unit, r] : outcome.measures)
    out["measures"].push_back({{"measure", name},
                               {"unit", unit},
                               {"subjects", r.subjects},
                               {"left_out", r.left_out},
                               {"level", r.level},
                               {"mean", json_number(r.mean)},
                               {"icc_2_1", bounded_json(r.agreement)},
                               {"icc_3_1", bounded_json(r.consistency)},
                               {"sem", bounded_json(r.sem)},
                               {"sem_agreement", json_number(r.sem_agreement)},
                               {"mdc", json_number(r.mdc)},
                               {"noise", json_number(r.noise)},
                               {"sem_without_noise", json_number(r.sem_movement)},
                               {"icc_3_1_without_noise", json_number(r.consistency_movement)}});
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
