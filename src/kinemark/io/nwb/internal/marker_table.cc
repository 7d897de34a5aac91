// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/marker_table.h"

#include <utility>

#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

void add_filters(const std::vector<data::FilterUsed>& filters, std::vector<Column>& columns) {
  if (filters.empty()) return;
  Column name{.name = "filter", .description = "filter that it went through"};
  Column order{.name = "filter_order", .description = "order of the filter"};
  Column cutoff{.name = "filter_cutoff_hz",
                .description = "-3 dB of the whole filter, Hz; NaN where it has none"};
  Column noise{.name = "filter_noise_sd_m",
               .description = "noise found in the samples, per axis, m; NaN when unknown"};
  for (const data::FilterUsed& f : filters) {
    name.texts.push_back(f.method);
    order.integers.push_back(f.order);
    cutoff.numbers.push_back(f.cutoff_hz);
    noise.numbers.push_back(f.noise_sd_m);
  }
  for (auto* c : {&name, &order, &cutoff, &noise}) columns.push_back(std::move(*c));
}

}  // namespace

void write_marker_table(Output& out, hid_t module, const MarkerTable& table) {
  const std::size_t markers = table.names.size();
  std::vector<Column> columns{
      {.name = "marker", .description = "name of the marker", .texts = table.names},
      {.name = "series", .description = "name of its series", .texts = table.series_names},
      {.name = "t0_s",
       .description = "time of frame 0, s",
       .numbers = std::vector<double>(markers, table.time.t0_s)},
      {.name = "rate_hz",
       .description = "frames per second",
       .numbers = std::vector<double>(markers, table.time.rate_hz)}};
  if (table.first_frame) {
    columns.push_back({.name = "first_frame", .description = "number of frame 0 as the source counts"});
    columns.back().integers.assign(markers, *table.first_frame);
  }
  if (!table.offset_s.empty()) {
    columns.push_back({.name = "offset_s", .description = "time of its samples after their frame, s"});
    columns.back().numbers = table.offset_s;
  }
  add_filters(table.filters, columns);
  out.table(module, kMarkersTable, "markers, in their order", columns);
}

}  // namespace kinemark::io::internal
