// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/html_text.h"
#include "kinemark/core/text.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/gait/gait_tables.h"

namespace kinemark::pipeline {
namespace {

using data::Side;

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light; }
body { margin: 0 auto; padding: 1.2rem 1rem 3rem; max-width: 56rem; background: #ffffff; color: #1a1a1a;
  font: 15px/1.45 "Source Sans 3", "Segoe UI", Helvetica, Arial, sans-serif; }
h1 { font-size: 1.5rem; margin: 0 0 .2rem; }
h2 { font-size: 1.1rem; margin: 1.6rem 0 .4rem; border-bottom: 1px solid #c9c9c9; padding-bottom: .15rem; }
p { margin: .3rem 0; }
.quiet { color: #555555; font-size: .88rem; }
figure { margin: .6rem 0; break-inside: avoid; }
figure svg { width: 100%; height: auto; display: block; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; break-inside: avoid; }
caption { text-align: left; color: #555555; padding-bottom: .2rem; }
th, td { text-align: left; padding: .18rem .7rem .18rem 0; border-bottom: 1px solid #e3e3e3; vertical-align: top; }
thead th { border-bottom: 1px solid #8a8a8a; }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
th.left { box-shadow: inset 0 -3px 0 LEFT; } th.right { box-shadow: inset 0 -3px 0 RIGHT; }
.judged { display: block; color: #555555; font-size: .82rem; white-space: normal; }
.judged.beyond { color: #1a1a1a; font-weight: 600; }
ul { margin: .3rem 0; padding-left: 1.2rem; }
code { font-size: .85rem; overflow-wrap: anywhere; }
@page { size: A4; margin: 12mm; }
@media print { body { padding: 0; font-size: 11px; max-width: none; } h2 { break-after: avoid; } }
)css";

std::string style() {
  std::string out(kStyle);
  for (const auto& [word, side] : {std::pair{"LEFT", Side::left}, std::pair{"RIGHT", Side::right}})
    out.replace(out.find(word), std::string_view(word).size(), side_colour(side));
  return out;
}

std::string list_of(const std::vector<std::string>& sentences) {
  std::string out = "<ul>\n";
  for (const auto& sentence : sentences) out += fmt::format("<li>{}</li>\n", html_text(sentence));
  return out + "</ul>\n";
}

std::string measure_cell(const MeasureRow& row, std::size_t column) {
  const auto& judgement = row.judgement[column];
  const bool beyond = judgement == "below" || judgement == "above";
  return fmt::format("<td class=\"number\">{}{}</td>", html_text(row.value[column]),
                     judgement.empty() ? ""
                                       : fmt::format("<span class=\"judged{}\">{}</span>",
                                                     beyond ? " beyond" : "", html_text(judgement)));
}

std::string measures_section(const GaitSheet& sheet) {
  const auto rows = measure_rows(sheet);
  if (rows.empty()) return {};
  const bool regions = std::ranges::any_of(rows, [](const MeasureRow& row) { return !row.region.empty(); });
  const bool norms = std::ranges::any_of(rows, [](const MeasureRow& row) { return !row.norm.empty(); });
  double level = kNaN;
  for (const auto& measure : sheet.measures)
    if (measure.interval.kind != data::IntervalKind::none) level = measure.interval.level;
  std::vector<std::string> sources;
  for (const auto& norm : sheet.norms)
    if (std::ranges::find(sources, norm.source) == sources.end()) sources.push_back(norm.source);
  std::string out = "<h2 id=\"measures\">Time and distance</h2>\n<table>\n<caption>";
  out += std::isfinite(level) ? fmt::format("In brackets the {:g} % interval.", 100.0 * level)
                              : "Without intervals.";
  if (norms) out += html_text(fmt::format(" Norm: {}.", join(sources, "; ")));
  if (sheet.treadmill) out += " On a treadmill: lengths and speed are those on its belt.";
  out += fmt::format(
      "</caption>\n<thead><tr>{}<th>Measure</th><th>Unit</th><th class=\"left\">Left</th>"
      "<th class=\"right\">Right</th><th>Both</th>{}</tr></thead>\n<tbody>\n",
      regions ? "<th>Region</th>" : "", norms ? "<th>Norm</th>" : "");
  for (const auto& row : rows) {
    out += fmt::format("<tr>{}<th scope=\"row\">{}</th><td>{}</td>",
                       regions ? fmt::format("<td>{}</td>", html_text(row.region)) : "", html_text(row.title),
                       html_text(row.unit));
    for (std::size_t column = 0; column < 3; ++column) out += measure_cell(row, column);
    out += norms ? fmt::format("<td class=\"number\">{}</td></tr>\n", html_text(row.norm)) : "</tr>\n";
  }
  return out + "</tbody>\n</table>\n";
}

std::string degrees(double value) {
  return std::isfinite(value) ? fmt::format("{:.1f}", value) : std::string("\u2013");
}

std::string deviation_section(const GaitDeviation& deviation) {
  if (deviation.scores.empty()) return {};
  std::string out =
      "<h2 id=\"deviation\">Deviation from the norm</h2>\n<table>\n<caption>Movement Analysis Profile: root "
      "mean "
      "square over the cycle of the mean curve less the norm\u2019s mean, deg; the Gait Profile Score is the "
      "root "
      "mean square of nine of a side, of fifteen of both (Baker et al. 2009, Gait &amp; Posture "
      "30:265\u2013269). No interval is given.</caption>\n<thead><tr><th>Variable</th>"
      "<th class=\"left\">Left</th><th class=\"right\">Right</th></tr></thead>\n<tbody>\n";
  const auto row = [&](const std::string& title, const std::string& left, const std::string& right) {
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        html_text(title), left, right);
  };
  for (const auto& score : deviation.scores)
    row(score.title, degrees(score.value_deg[0]), degrees(score.value_deg[1]));
  if (std::isfinite(deviation.side_deg[0]) || std::isfinite(deviation.side_deg[1]))
    row("Gait Profile Score", degrees(deviation.side_deg[0]), degrees(deviation.side_deg[1]));
  out += "</tbody>\n</table>\n";
  if (std::isfinite(deviation.both_deg))
    out += fmt::format("<p>Gait Profile Score of both sides: {:.1f} deg.</p>\n", deviation.both_deg);
  else
    out += fmt::format(
        "<p>No Gait Profile Score of both sides: without curve or norm at every point are {}.</p>\n",
        html_text(join(deviation.lacking)));
  return out;
}

std::string events_section(const GaitSheet& sheet) {
  if (sheet.events.empty()) return {};
  std::string out =
      "<h2 id=\"events\">Events</h2>\n<table>\n<thead><tr><th>Foot</th><th>Event</th><th>Time (s)</th><th>SD "
      "(s)</th><th>By</th></tr></thead>\n<tbody>\n";
  for (const auto& event : sheet.events)
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"number\">{:.3f}</td><td class=\"number\">{}</td>"
        "<td>{}</td></tr>\n",
        data::to_string(event.side), data::to_string(event.what), event.time_s,
        std::isfinite(event.sd_s) ? fmt::format("{:.3f}", event.sd_s) : "", html_text(event.method));
  return out + "</tbody>\n</table>\n";
}

std::string figures_section(std::span<const GaitFigure> figures) {
  if (figures.empty()) return {};
  std::string out = "<h2 id=\"figures\">Over the gait cycle</h2>\n";
  for (const auto& figure : figures)
    out += fmt::format("<figure id=\"{}\">\n{}</figure>\n", html_text(figure.name),
                       report::figure_svg(figure.figure));
  return out;
}

std::string reading_section(const GaitSheet& sheet, const GaitPageFacts& facts) {
  bool own = false;
  for (const auto& panel : sheet.panels)
    for (const auto& side : panel.sides) own = own || (side && side->own.array().isFinite().any());
  std::vector<std::string> words{
      "0 % is a foot\u2019s strike, 100 % its next one; each curve is of the cycles of its own side.",
      "The band about a mean is one standard deviation between cycles: how the person varies."};
  words.emplace_back(
      own ? "Dotted lines hold 95 % of the error of one curve by its measurement alone, from the noise of "
            "markers as their samples show it: a recording that was filtered shows less than it had, and "
            "skin "
            "that moves and markers put elsewhere are not in it. Where the lines would be no wider than the "
            "line of the mean, their width stands at the panel instead."
          : "How exact the angles are is not known: their file tells no standard deviations.");
  if (!norms_in_words(sheet).empty())
    words.push_back(
        fmt::format("Norm: {}. Outside of it somewhere is not yet outside of what is usual: a band "
                    "for each point by itself is left by most curves at some point.",
                    norms_in_words(sheet)));
  std::string out = "<h2 id=\"reading\">How to read it</h2>\n" + list_of(words);
  out += fmt::format("<p class=\"quiet\">kinemark {}</p>\n", html_text(kVersion));
  if (!facts.command_line.empty())
    out += fmt::format("<p class=\"quiet\"><code>{}</code></p>\n", html_text(facts.command_line));
  for (const auto& input : facts.inputs)
    out += fmt::format("<p class=\"quiet\">{}{}</p>\n", html_text(input.path),
                       input.hash.empty() ? ""
                                          : fmt::format(", {} bytes, {} {}", input.bytes,
                                                        html_text(input.hash_kind), html_text(input.hash)));
  return out;
}

std::string heading(const GaitSheet& sheet, const GaitPageFacts& facts) {
  // Of kinetics alone no angle is drawn.
  const bool angles = std::ranges::any_of(
      sheet.panels, [](const SheetPanel& panel) { return panel.what.part != SheetPart::kinetics; });
  std::string feet;
  for (const auto side : data::kBothSides)
    feet += (feet.empty() ? "" : "; ") + sentence_of(sheet.feet[data::index_of(side)], side);
  return fmt::format("<h1>Gait report: {}</h1>\n<p>{}.</p>\n<p class=\"quiet\">Angles: {}.</p>\n",
                     html_text(sheet.trial), html_text(feet), angles ? html_text(facts.angles_from) : "none");
}

}  // namespace

std::string gait_page(const GaitSheet& sheet, const GaitDeviation& deviation,
                      std::span<const GaitFigure> figures, const GaitPageFacts& facts) {
  std::vector<std::string> remarks = sheet.remarks;
  for (const auto& warning : facts.warnings)
    if (std::ranges::find(remarks, warning) == remarks.end()) remarks.push_back(warning);
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>Gait report: {}</title>\n<style>{}</style>\n"
      "</head>\n<body>\n",
      html_text(sheet.trial), style());
  out += heading(sheet, facts) + figures_section(figures) + measures_section(sheet) +
         deviation_section(deviation);
  out += events_section(sheet);
  if (!remarks.empty())
    out += "<h2 id=\"remarks\">To be known</h2>\n<div class=\"quiet\">\n" + list_of(remarks) + "</div>\n";
  return out + reading_section(sheet, facts) + "</body>\n</html>\n";
}

}  // namespace kinemark::pipeline
