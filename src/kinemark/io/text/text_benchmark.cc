// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Text in memory to arrays. bytes_per_second is the speed; `error_m` and `missing` show that it was read
// right.
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text/trc.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

/// 40 markers at 240 Hz, 2 % of the samples missing.
data::Trial long_trial(std::int64_t frames) {
  data::Trial trial;
  std::vector<std::string> names;
  for (int m = 0; m < 40; ++m) names.push_back(fmt::format("marker{}", m));
  trial.markers = data::Trajectories::all_missing(std::move(names), {240.0, 0.0, frames});
  Random random(7, 0);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < trial.markers.markers(); ++m) {
      if (random.uniform() < 0.02) continue;
      for (double& x : trial.markers.x(f, m)) x = random.uniform(-2.0, 2.0);
      trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
    }
  return trial;
}

std::string trc_text(const data::Trial& trial, int decimals) {
  const testing_support::ScratchFolder scratch;
  if (!write_trc(scratch / "x.trc", trial, {.decimals = decimals})) return {};
  return read_text(scratch / "x.trc").value_or("");
}

void BM_ParseTrc(benchmark::State& state) {
  const auto truth = long_trial(state.range(0));
  const std::string text = trc_text(truth, static_cast<int>(state.range(1)));
  data::Trial trial;
  for (auto _ : state) {
    auto parsed = parse_trc(text, "x.trc");
    if (!parsed) return state.SkipWithError(parsed.error().message.c_str());
    trial = std::move(*parsed);
  }
  double error_m = 0.0;
  for (std::size_t i = 0; i < truth.markers.x_in_world.size(); ++i)
    if (const double x = truth.markers.x_in_world[i]; !std::isnan(x))
      error_m = std::max(error_m, std::abs(x - trial.markers.x_in_world[i]));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["error_m"] = error_m;
  state.counters["missing"] =
      static_cast<double>(trial.markers.count_missing() - truth.markers.count_missing());
  state.counters["MB"] = static_cast<double>(text.size()) * 1e-6;
}
BENCHMARK(BM_ParseTrc)
    ->ArgNames({"frames", "decimals"})
    ->Args({2'000, 5})
    ->Args({90'000, 5})
    ->Args({90'000, -1})
    ->Unit(benchmark::kMillisecond);

void BM_WriteTrc(benchmark::State& state) {
  const auto trial = long_trial(20'000);
  const testing_support::ScratchFolder scratch;
  for (auto _ : state)
    if (!write_trc(scratch / "x.trc", trial, {.force = true, .decimals = static_cast<int>(state.range(0))}))
      return state.SkipWithError("cannot write");
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(scratch / "x.trc")));
}
BENCHMARK(BM_WriteTrc)->ArgName("decimals")->Arg(5)->Arg(-1)->Unit(benchmark::kMillisecond);

void BM_ParseTable(benchmark::State& state) {
  data::Table truth;
  for (int c = 0; c < 40; ++c) truth.columns.push_back(fmt::format("coordinate{}", c));
  Random random(7, 1);
  for (std::int64_t r = 0; r < state.range(0); ++r) {
    truth.time_s.push_back(static_cast<double>(r) / 240.0);
    for (int c = 0; c < 40; ++c) truth.values.push_back(random.uniform(-180.0, 180.0));
  }
  const testing_support::ScratchFolder scratch;
  if (!write_table(scratch / "x.mot", truth, {.decimals = 8})) return state.SkipWithError("cannot write");
  const std::string text = read_text(scratch / "x.mot").value_or("");
  data::Table table;
  for (auto _ : state) {
    auto parsed = parse_table(text, "x.mot");
    if (!parsed) return state.SkipWithError(parsed.error().message.c_str());
    table = std::move(*parsed);
  }
  double error = 0.0;
  for (std::size_t i = 0; i < truth.values.size(); ++i)
    error = std::max(error, std::abs(truth.values[i] - table.values[i]));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.counters["error"] = error;
}
BENCHMARK(BM_ParseTable)->ArgName("rows")->Arg(50'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinemark::io
