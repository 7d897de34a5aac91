// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/poizner/study_poizner_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <nlohmann/json.hpp>

#include "kinemark/core/parallel.h"
#include "kinemark/pipeline/poizner/study_rows.h"

namespace kinemark::pipeline {
namespace {

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Result<PoiznerSeed> study_seed(std::uint64_t seed) {
  auto rig = calibrate_rig(seed);
  if (!rig) return fail_at(fmt::format("seed {}", seed), rig.error());
  PoiznerSeed out{
      .seed = seed, .chi2_per_dof = rig->bundle.report.chi2_per_dof, .tree = {}, .wheels = {}, .arm = {}};
  auto tree = study_still_tree(*rig);
  if (!tree) return fail_at(fmt::format("seed {}", seed), tree.error());
  out.tree = std::move(*tree);
  for (int wheel = 0; wheel < kWheels; ++wheel) {
    auto turned = study_wheel(*rig, study_wheel_options(wheel));
    if (!turned) return fail_at(fmt::format("seed {}", seed), turned.error());
    out.wheels.push_back(std::move(*turned));
  }
  auto arm = study_arm(*rig);
  if (!arm) return fail_at(fmt::format("seed {}", seed), arm.error());
  out.arm = std::move(*arm);
  return out;
}

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "-"; }

std::string bound(const StudyRow& row) {
  if (row.at_least && row.at_most) return fmt::format("{:.4g} to {:.4g}", *row.at_least, *row.at_most);
  if (row.at_least) return fmt::format(">= {:.4g}", *row.at_least);
  return row.at_most ? fmt::format("<= {:.4g}", *row.at_most) : "-";
}

}  // namespace

Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text) {
  constexpr std::size_t kMost = 1000;
  std::vector<std::uint64_t> out;
  const auto wrong = [&] {
    return fail(
        Code::usage,
        fmt::format("--seeds: '{}'; numbers and ranges such as 1-10 or 1,4,7-9 were expected, {} at most",
                    text, kMost));
  };
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    const auto part = text.substr(at, comma - at);
    const auto dash = part.find('-');
    const auto first = number(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : number(part.substr(dash + 1));
    if (!first || !last || *last < *first || *last - *first >= kMost ||
        out.size() + (*last - *first) >= kMost)
      return wrong();
    for (std::uint64_t seed = *first; seed <= *last; ++seed) out.push_back(seed);
    at = comma + 1;
  }
  return out;
}

simulation::WheelOptions study_wheel_options(int wheel) {
  simulation::WheelOptions out;
  out.turned_deg = wheel % 2 == 0 ? 8.0 : 35.0;
  out.glint_share = wheel < 2 ? 0.0 : 0.04;
  return out;
}

std::string_view wheel_name(int wheel) {
  constexpr std::array<std::string_view, kWheels> kNames{"wheel at 8 deg", "wheel at 35 deg",
                                                         "wheel at 8 deg, glint", "wheel at 35 deg, glint"};
  return kNames[static_cast<std::size_t>(wheel)];
}

bool PoiznerStudy::pass() const {
  return std::ranges::all_of(rows, [](const StudyRow& row) { return row.pass(); });
}

Result<PoiznerStudy> study_poizner(const PoiznerJob& job, const Progress& progress) {
  if (job.seeds.empty()) return fail(Code::usage, "the study needs one seed or more");
  const auto count = static_cast<std::int64_t>(job.seeds.size());
  std::vector<Result<PoiznerSeed>> outcomes(job.seeds.size());
  std::atomic<std::int64_t> done = 0;
  std::atomic<bool> stopped = false;
  parallel_for(count, 1, job.threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last && !stopped; ++i) {
      if (progress && !progress(done, count)) {
        stopped = true;
        break;
      }
      outcomes[static_cast<std::size_t>(i)] = study_seed(job.seeds[static_cast<std::size_t>(i)]);
      ++done;
    }
  });
  if (stopped) return fail(Code::cancelled, "the study was stopped");
  PoiznerStudy out;
  for (auto& outcome : outcomes) {
    if (!outcome) return std::unexpected(outcome.error());
    out.seeds.push_back(std::move(*outcome));
  }
  out.rows = study_rows(out.seeds);
  return out;
}

nlohmann::ordered_json study_json(const PoiznerStudy& study) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  Json rows = Json::array();
  for (const auto& row : study.rows) {
    const Json limits =
        row.at_least ? Json::array({value(row.at_least), value(row.at_most)}) : value(row.at_most);
    rows.push_back({{"quantity", row.quantity},
                    {"unit", row.unit},
                    {"paper", value(row.paper)},
                    {"classic", value(row.classic)},
                    {"ours", row.ours},
                    {"limit", value(row.limit)},
                    {"bound", limits},
                    {"pass", row.pass()}});
  }
  Json seeds = Json::array();
  for (const auto& seed : study.seeds) seeds.push_back(seed.seed);
  return {{"seeds", seeds}, {"rows", rows}, {"pass", study.pass()}};
}

std::string study_table(const PoiznerStudy& study) {
  std::string out = fmt::format("{:<62} {:>6} {:>8} {:>8} {:>8} {:>8} {:>12}\n", "", "unit", "paper",
                                "classic", "ours", "limit", "bound");
  for (const auto& row : study.rows)
    out += fmt::format("{:<62} {:>6} {:>8} {:>8} {:>8} {:>8} {:>12} {}\n", row.quantity, row.unit,
                       cell(row.paper), cell(row.classic), cell(row.ours), cell(row.limit), bound(row),
                       row.pass() ? "" : "FAILS");
  return out;
}

}  // namespace kinemark::pipeline
