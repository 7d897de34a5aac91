// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_nwb.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {
namespace {

using data::Measure;

io::NwbColumn column_called(const std::string& name, const std::string& description) {
  return {.name = name, .description = description, .texts = {}, .numbers = {}};
}

// One row of a table: of which recording, and which of its measures.
struct Row {
  const RecordingName* name;
  std::vector<const Measure*> measures;
};

// Columns that say whose row it is; those of the participants' table and of trials behind.
struct WhoseColumns {
  std::vector<io::NwbColumn> first, more;
};

WhoseColumns whose_columns(const std::vector<Row>& rows) {
  WhoseColumns out{
      .first = {column_called("file", "name of the recording"),
                column_called("participant", "who was recorded; empty: not known"),
                column_called("session", "when; empty: not known"), column_called("trial", "which trial"),
                column_called("subject", "marker, joint, plate or channel; empty: the whole body"),
                column_called("context", "Left, Right, or kind of movement; empty: none"),
                column_called("region", "name of the span; empty: the whole recording")},
      .more = {}};
  for (const auto& [column, value] : rows.front().name->more)
    out.more.push_back(column_called(column, fmt::format("'{}' of the participants' table", column)));
  const std::size_t people = out.more.size();
  for (const auto& column : rows.front().name->spans.columns)
    out.more.push_back(column_called(column, fmt::format("'{}' of the trial", column)));
  for (const auto& row : rows) {
    const auto& one = *row.measures.front();
    std::size_t k = 0;
    for (const auto* text : {&row.name->file, &row.name->participant, &row.name->session, &row.name->trial,
                             &one.subject, &one.context, &one.region})
      out.first[k++].texts.push_back(*text);
    for (std::size_t m = 0; m < people; ++m)
      out.more[m].texts.push_back(m < row.name->more.size() ? row.name->more[m].second : std::string());
    for (std::size_t m = people; m < out.more.size(); ++m)
      out.more[m].texts.push_back(span_cell(*row.name, one.region, m - people));
  }
  for (auto& column : out.more) {
    const bool numbers = std::ranges::all_of(
        column.texts, [](const std::string& text) { return text.empty() || parse_number(text).has_value(); });
    if (!numbers || std::ranges::all_of(column.texts, &std::string::empty)) continue;
    for (const auto& text : column.texts) column.numbers.push_back(text.empty() ? kNaN : *parse_number(text));
    column.texts.clear();
  }
  return out;
}

double cycle_of(const Measure& measure) {
  return measure.cycle < 0 ? kNaN : static_cast<double>(measure.cycle);
}

// Title, unit, formula and source.
std::string description_of(const std::string& id) {
  const auto* known = workflow::find_measure(id);
  if (known == nullptr) return id;
  const auto& what = known->what;
  const auto unit = data::shown_unit(what.quantity).name;
  return fmt::format("{}{}: {} ({})", what.title, unit.empty() ? "" : fmt::format(", {}", unit), what.formula,
                     what.source);
}

std::vector<Row> rows_of(const std::vector<NamedMeasures>& recordings, bool one_each) {
  std::vector<Row> out;
  for (const auto& recording : recordings) {
    // A measure that a row has already, of a stretch of the same name, begins another row.
    std::map<std::tuple<std::string, std::string, std::string, std::int64_t>, std::vector<std::size_t>> index;
    for (const auto& measure : recording.measures) {
      if (one_each) {
        out.push_back({&recording.name, {&measure}});
        continue;
      }
      auto& positions = index[{measure.subject, measure.context, measure.region, measure.cycle}];
      const auto lacks = [&](std::size_t row) {
        return std::ranges::find(out[row].measures, measure.id, [](const Measure* m) { return m->id; }) ==
               out[row].measures.end();
      };
      const auto place = std::ranges::find_if(positions, lacks);
      if (place != positions.end()) {
        out[*place].measures.push_back(&measure);
        continue;
      }
      positions.push_back(out.size());
      out.push_back({&recording.name, {&measure}});
    }
  }
  return out;
}

io::NwbTable wide_table(const std::vector<Row>& rows, const std::vector<std::string>& ids) {
  io::NwbTable out{
      .name = "measures",
      .description = "measures of movement, a row for each recording, subject, context, region and cycle",
      .columns = {}};
  auto whose = whose_columns(rows);
  out.columns = std::move(whose.first);
  auto cycle = column_called("cycle", "number of the cycle, from 0; NaN: none"),
       start = column_called("start_s", "first time of the span, s, on the recording's clock"),
       end = column_called("end_s", "last time of the span, s"),
       share = column_called("share_not_measured",
                             "largest share, 0 to 1, of samples that were missing, filled or rejected");
  for (const auto& row : rows) {
    cycle.numbers.push_back(cycle_of(*row.measures.front()));
    double first = kNaN, last = kNaN, most = 0.0;
    for (const auto* one : row.measures) {
      first = std::fmin(first, one->start_s), last = std::fmax(last, one->end_s);
      most = std::max(most, one->share_not_measured);
    }
    start.numbers.push_back(first), end.numbers.push_back(last), share.numbers.push_back(most);
  }
  for (auto* column : {&cycle, &start, &end, &share}) out.columns.push_back(std::move(*column));
  for (auto& column : whose.more) out.columns.push_back(std::move(column));
  for (const auto& id : ids) {
    const auto what = description_of(id);
    std::array columns{column_called(id, what),
                       column_called(id + "_low", "lower end of the interval of " + what),
                       column_called(id + "_high", "upper end of the interval of " + what),
                       column_called(id + "_error_sd", "one standard deviation of the error of " + what)};
    for (const auto& row : rows) {
      const auto found = std::ranges::find(row.measures, id, [](const Measure* m) { return m->id; });
      const Measure none{.value = kNaN};
      const Measure& one = found == row.measures.end() ? none : **found;
      const double per_si = data::shown_unit(one.quantity).per_si;
      std::size_t k = 0;
      for (const double value : {one.value, one.interval.low, one.interval.high, one.sd})
        columns[k++].numbers.push_back(per_si * value);
    }
    for (auto& column : columns) out.columns.push_back(std::move(column));
  }
  return out;
}

io::NwbTable tidy_table(const std::vector<Row>& rows) {
  io::NwbTable out{.name = "measures_tidy",
                   .description = "the same measures, one a row, with how each was found",
                   .columns = {}};
  auto whose = whose_columns(rows);
  out.columns = std::move(whose.first);
  const auto numbers = [&](const char* name, const char* what, const auto& value) {
    auto column = column_called(name, what);
    for (const auto& row : rows) column.numbers.push_back(value(*row.measures.front()));
    out.columns.push_back(std::move(column));
  };
  const auto texts = [&](const char* name, const char* what, const auto& text) {
    auto column = column_called(name, what);
    for (const auto& row : rows) column.texts.emplace_back(text(*row.measures.front()));
    out.columns.push_back(std::move(column));
  };
  const auto in_unit = [](double (*value)(const Measure&)) {
    return [value](const Measure& m) { return data::shown_unit(m.quantity).per_si * value(m); };
  };
  numbers("cycle", "number of the cycle, from 0; NaN: none", cycle_of);
  numbers("start_s", "first time of the span, s", [](const Measure& m) { return m.start_s; });
  numbers("end_s", "last time of the span, s", [](const Measure& m) { return m.end_s; });
  texts("measure", "id; the table measure_definitions says what it is",
        [](const Measure& m) { return m.id; });
  numbers("value", "in the unit of the row; NaN: not determined",
          in_unit([](const Measure& m) { return m.value; }));
  texts("unit", "of the values of the row",
        [](const Measure& m) { return data::shown_unit(m.quantity).name; });
  numbers("low", "lower end of the interval; NaN: none",
          in_unit([](const Measure& m) { return m.interval.low; }));
  numbers("high", "upper end of the interval; NaN: none",
          in_unit([](const Measure& m) { return m.interval.high; }));
  numbers("level", "coverage of the interval", [](const Measure& m) { return m.interval.level; });
  texts("interval", "none, two-sided, at most or at least",
        [](const Measure& m) { return data::to_string(m.interval.kind); });
  texts("approximate", "whether the interval is known to cover less in some movements",
        [](const Measure& m) { return m.interval.approximate ? "yes" : "no"; });
  numbers("sd", "one standard deviation; NaN: not known", in_unit([](const Measure& m) { return m.sd; }));
  numbers("uncorrected", "value before its bias was removed; NaN: nothing was",
          in_unit([](const Measure& m) { return m.uncorrected; }));
  numbers("share_not_measured", "share of samples that were missing, filled or rejected, 0 to 1",
          [](const Measure& m) { return m.share_not_measured; });
  texts("method", "how it was found", [](const Measure& m) { return m.method; });
  texts("remark", "what must be known of it", [](const Measure& m) { return m.remark; });
  for (auto& column : whose.more) out.columns.push_back(std::move(column));
  return out;
}

io::NwbTable definitions_table(const std::vector<std::string>& ids) {
  io::NwbTable out{
      .name = "measure_definitions",
      .description = "what each measure is",
      .columns = {column_called("measure", "id"), column_called("title", "what people call it"),
                  column_called("unit", "of its values; empty: a number without unit"),
                  column_called("formula", "how it is computed"), column_called("source", "paper or book")}};
  for (const auto& id : ids) {
    const auto* known = workflow::find_measure(id);
    const auto what = known != nullptr ? known->what : data::MeasureDefinition{.id = id};
    std::size_t k = 0;
    for (const auto text :
         {what.id, what.title, data::shown_unit(what.quantity).name, what.formula, what.source})
      out.columns[k++].texts.emplace_back(text);
  }
  return out;
}

// Events with their deviations; no columns where there are none.
io::NwbTable events_table(const std::vector<NamedMeasures>& recordings) {
  io::NwbTable out{.name = "movement_events",
                   .description = "events of feet, or of the markers' own movements, with their deviations",
                   .columns = {}};
  const auto column = [&](const char* name, const char* what, auto value) {
    auto made = column_called(name, what);
    for (const auto& recording : recordings)
      for (const auto& event : recording.events) {
        if constexpr (std::is_convertible_v<decltype(value(recording, event)), double>)
          made.numbers.push_back(value(recording, event));
        else
          made.texts.push_back(value(recording, event));
      }
    if (!made.texts.empty() || !made.numbers.empty()) out.columns.push_back(std::move(made));
  };
  using Of = const NamedMeasures&;
  using Event = const EventRow&;
  column("file", "name of the recording", [](Of of, Event) { return of.name.file; });
  column("subject", "marker that moves; empty: a foot", [](Of, Event e) { return e.subject; });
  column("context", "Left, Right, or empty", [](Of, Event e) { return e.context; });
  column("region", "name of the span; empty: the whole recording", [](Of, Event e) { return e.region; });
  column("label", "what happens", [](Of, Event e) { return e.label; });
  column("time_s", "when, s, on the clock of the recording", [](Of, Event e) { return e.time_s; });
  column("frame", "number of the nearest frame", [](Of, Event e) { return static_cast<double>(e.frame); });
  column("sd_s", "one standard deviation of the time, s; NaN: not known", [](Of, Event e) { return e.sd_s; });
  column("source", "plate, kinematics or file", [](Of, Event e) { return e.source; });
  column("method", "how it was found", [](Of, Event e) { return e.method; });
  return out;
}

}  // namespace

std::vector<io::NwbTable> measure_tables(const std::vector<NamedMeasures>& recordings) {
  std::vector<std::string> ids;
  for (const auto& recording : recordings)
    for (const auto& measure : recording.measures)
      if (std::ranges::find(ids, measure.id) == ids.end()) ids.push_back(measure.id);
  if (ids.empty()) return {};
  std::vector out{wide_table(rows_of(recordings, false), ids), tidy_table(rows_of(recordings, true)),
                  definitions_table(ids)};
  if (auto events = events_table(recordings); !events.columns.empty()) out.push_back(std::move(events));
  return out;
}

ResultFile nwb_file(std::filesystem::path target, std::vector<NamedMeasures> recordings,
                    const std::vector<data::InputFile>& inputs, const JobSettings& settings,
                    data::Beside beside) {
  io::NwbMetadata metadata{.session_description = "measures of movement"};
  std::set<std::string> participants;
  for (const auto& recording : recordings) participants.insert(recording.name.participant);
  if (participants.size() == 1) metadata.subject_id = *participants.begin();
  metadata.version = std::string(kVersion);
  metadata.command = settings.command_line;
  metadata.seed = settings.seed;
  for (const auto& input : inputs) metadata.sources.push_back({input.path, input.bytes, input.hash});
  return {.target = std::move(target),
          .write = [recordings = std::move(recordings), metadata, beside = std::move(beside)](
                       const std::filesystem::path& staged, const std::string& set) -> Status {
            auto named = metadata;
            named.set = set;
            return io::write_nwb_tables(staged, measure_tables(recordings), named, false, &beside);
          }};
}

}  // namespace kinemark::pipeline
