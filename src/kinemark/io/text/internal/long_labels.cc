// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/long_labels.h"

#include <algorithm>
#include <string_view>

#include "kinemark/io/text/internal/coordinate_labels.h"

namespace kinemark::io::internal {

LongLabels long_labels(const std::vector<std::string>& cells) {
  constexpr std::array<std::string_view, 12> kMarker{
      "marker",   "name",  "label",       "point",       "bodypart",   "keypoint",
      "landmark", "joint", "marker_name", "marker name", "markername", "trajectory"};
  LongLabels out;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto label = coordinate_label(cells[c]);
    const auto take = [c](std::optional<std::size_t>& column) {
      const bool is_first = !column;
      if (is_first) column = c;
      return is_first;
    };
    const bool nameless = label.name.empty() || lower(label.name) == "pos" || lower(label.name) == "position";
    if (label.is_frame) {
      take(out.frame);
    } else if (label.units_per_second > 0.0) {
      if (take(out.time)) out.units_per_second = label.units_per_second;
    } else if (label.axis >= 0 && label.axis < CoordinateLabel::kW && nameless) {
      if (take(out.coordinate[static_cast<std::size_t>(label.axis)]) && !label.unit.empty())
        out.unit = label.unit;
    } else if (std::ranges::find(kMarker, lower(cells[c])) != kMarker.end()) {
      take(out.marker);
    }
  }
  return out;
}

}  // namespace kinemark::io::internal
