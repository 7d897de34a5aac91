// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/around_table.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/pipeline/files/table_cell.h"

namespace kinemark::pipeline {
namespace {

using analysis::AroundBin;
using analysis::AroundCurve;
using analysis::AroundOptions;

/// The shortest text that reads back exactly; empty where not determined.
std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

/// An edge of a bin without the rounding of its last digits: 0.28, not 0.28000000000000003.
std::string edge(double value_s) { return fmt::format("{:.12g}", value_s); }

/// Every bin of every curve by `add(curve, bin, its number, how many of its unit an SI unit is)`.
template <class Add>
void over_bins(const std::vector<AroundCurve>& curves, const Add& add) {
  for (const auto& curve : curves)
    for (std::size_t k = 0; k < curve.bins.size(); ++k)
      add(curve, curve.bins[k], static_cast<std::int64_t>(k), data::shown_unit(curve.quantity));
}

}  // namespace

std::string around_csv(const std::vector<AroundCurve>& curves, const AroundOptions& options,
                       const RecordingName& recording) {
  std::string out =
      name_columns() +
      ",events,subject,curve,from_s,to_s,mean,sd,low,high,level,unit,count,missing,used,outside" +
      more_columns(recording) + "\n";
  const auto first = name_cells(recording), last = more_cells(recording);
  over_bins(curves,
            [&](const AroundCurve& curve, const AroundBin& bin, std::int64_t k, const data::Unit& unit) {
              const auto shown = [&unit](double si) { return exact(unit.per_si * si); };
              out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}{}\n", first,
                                 table_cell(curve.events), table_cell(curve.subject), curve.id,
                                 edge(options.edge_s(k)), edge(options.edge_s(k + 1)), shown(bin.mean),
                                 shown(bin.sd), shown(bin.low), shown(bin.high), exact(options.level),
                                 unit.name, bin.count, bin.missing, curve.used, curve.outside, last);
            });
  return out;
}

nlohmann::ordered_json around_json(const std::vector<AroundCurve>& curves, const AroundOptions& options) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& curve : curves) {
    const auto unit = data::shown_unit(curve.quantity);
    const auto shown = [&unit](double si) { return json_number(unit.per_si * si); };
    auto bins = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < curve.bins.size(); ++k) {
      const auto& bin = curve.bins[k];
      bins.push_back({{"from_s", options.edge_s(static_cast<std::int64_t>(k))},
                      {"to_s", options.edge_s(static_cast<std::int64_t>(k) + 1)},
                      {"mean", shown(bin.mean)},
                      {"sd", shown(bin.sd)},
                      {"low", shown(bin.low)},
                      {"high", shown(bin.high)},
                      {"count", bin.count},
                      {"missing", bin.missing}});
    }
    out.push_back({{"events", curve.events},
                   {"subject", curve.subject},
                   {"curve", curve.id},
                   {"unit", unit.name},
                   {"level", options.level},
                   {"used", curve.used},
                   {"outside", curve.outside},
                   {"bins", std::move(bins)}});
  }
  return out;
}

io::NwbTable around_nwb(const std::vector<AroundCurve>& curves, const AroundOptions& options,
                        const RecordingName& recording) {
  io::NwbTable out{.name = "around", .description = "averages around events, one bin a row", .columns = {}};
  const auto text = [&](const char* name, const char* what, const auto& of) {
    io::NwbColumn column{.name = name, .description = what};
    over_bins(curves, [&](const AroundCurve& curve, const AroundBin&, std::int64_t, const data::Unit& unit) {
      column.texts.emplace_back(of(curve, unit));
    });
    out.columns.push_back(std::move(column));
  };
  const auto number = [&](const char* name, const char* what, const auto& of) {
    io::NwbColumn column{.name = name, .description = what};
    over_bins(curves, [&](const AroundCurve& curve, const AroundBin& bin, std::int64_t k,
                          const data::Unit& unit) { column.numbers.push_back(of(curve, bin, k, unit)); });
    out.columns.push_back(std::move(column));
  };
  using Curve = AroundCurve;
  using Bin = AroundBin;
  using Unit = data::Unit;
  text("file", "recording", [&](const Curve&, const Unit&) { return recording.file; });
  text("events", "events that are averaged over", [](const Curve& c, const Unit&) { return c.events; });
  text("subject", "marker, coordinate or unit", [](const Curve& c, const Unit&) { return c.subject; });
  text("curve", "what of it", [](const Curve& c, const Unit&) { return c.id; });
  text("unit", "unit of mean, sd, low and high",
       [](const Curve&, const Unit& u) { return std::string(u.name); });
  number("from_s", "start of the bin after the event, s",
         [&](const Curve&, const Bin&, std::int64_t k, const Unit&) { return options.edge_s(k); });
  number("to_s", "end of the bin after the event, s",
         [&](const Curve&, const Bin&, std::int64_t k, const Unit&) { return options.edge_s(k + 1); });
  const auto member = [&](const char* name, const char* what, double AroundBin::* of) {
    number(name, what, [of](const Curve&, const Bin& bin, std::int64_t, const Unit& unit) {
      return unit.per_si * (bin.*of);
    });
  };
  member("mean", "mean over the events", &AroundBin::mean);
  member("sd", "standard deviation between events, N - 1", &AroundBin::sd);
  member("low", "lower end of the mean's interval", &AroundBin::low);
  member("high", "upper end of the mean's interval", &AroundBin::high);
  const auto count = [&](const char* name, const char* what, const auto& of) {
    number(name, what, [of](const Curve& c, const Bin& bin, std::int64_t, const Unit&) {
      return static_cast<double>(of(c, bin));
    });
  };
  number("level", "coverage of the interval",
         [&](const Curve&, const Bin&, std::int64_t, const Unit&) { return options.level; });
  count("count", "events with a value in the bin", [](const Curve&, const Bin& bin) { return bin.count; });
  count("missing", "events without one", [](const Curve&, const Bin& bin) { return bin.missing; });
  count("used", "events whose window is in the recording", [](const Curve& c, const Bin&) { return c.used; });
  count("outside", "events whose window leaves it", [](const Curve& c, const Bin&) { return c.outside; });
  return out;
}

std::string around_text(const std::vector<AroundCurve>& curves, const AroundOptions& options) {
  std::string out, last;
  for (const auto& curve : curves) {
    if (curve.events != last)
      out += fmt::format("{}Around {}: {} used, {} outside\n", out.empty() ? "" : "\n", curve.events,
                         curve.used, curve.outside);
    last = curve.events;
    const AroundBin *least = nullptr, *most = nullptr;
    for (const auto& bin : curve.bins) {
      if (!std::isfinite(bin.mean)) continue;
      if (least == nullptr || bin.mean < least->mean) least = &bin;
      if (most == nullptr || bin.mean > most->mean) most = &bin;
    }
    const auto unit = data::shown_unit(curve.quantity);
    const std::string name =
        curve.id == "rate" ? "unit " + curve.subject : fmt::format("{} {}", curve.subject, curve.id);
    if (least == nullptr) {
      out += fmt::format("  {:<24} not determined\n", name);
      continue;
    }
    const auto at_s = [&](const AroundBin* bin) {
      return options.edge_s(bin - curve.bins.data()) + 0.5 * options.bin_s;
    };
    out += fmt::format("  {:<24} {:.4g} {} at {:+.3f} s to {:.4g} {} at {:+.3f} s\n", name,
                       unit.per_si * least->mean, unit.name, at_s(least), unit.per_si * most->mean, unit.name,
                       at_s(most));
  }
  return out;
}

}  // namespace kinemark::pipeline
