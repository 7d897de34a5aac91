// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_fit.h"

#include <fmt/core.h>

#include <cmath>
#include <set>

namespace kinemark::data {

double FittedMarker::total_sd_m() const { return std::hypot(noise_sd_m, common_sd_m); }

std::vector<std::string> MarkerFit::excluded_as(std::string_view why) const {
  std::vector<std::string> names;
  for (const auto& marker : excluded)
    if (marker.why == why) names.push_back(marker.name);
  return names;
}

Status MarkerFit::validate() const {
  std::set<std::string_view> listed;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto& marker = markers[m];
    if (marker.name.empty())
      return fail(Code::bad_input, fmt::format("the marker fit: used marker {} has no name", m + 1));
    if (!listed.insert(marker.name).second)
      return fail(Code::bad_input, fmt::format("the marker fit: marker '{}' is listed twice", marker.name));
    if (!(marker.weight >= 0.0) || !std::isfinite(marker.weight))
      return fail(Code::bad_input,
                  fmt::format("the marker fit: marker '{}' has the weight {}; need 0 or more", marker.name,
                              marker.weight));
    if (!(marker.seen >= 0.0 && marker.seen <= 1.0))
      return fail(Code::bad_input,
                  fmt::format("the marker fit: marker '{}' is seen in a share of {}; need 0 to 1",
                              marker.name, marker.seen));
    if (marker.noise_sd_m < 0.0 || marker.common_sd_m < 0.0)
      return fail(Code::bad_input,
                  fmt::format("the marker fit: marker '{}' has a negative standard deviation", marker.name));
    if (marker.rejected_frames.value_or(0) < 0)
      return fail(Code::bad_input,
                  fmt::format("the marker fit: marker '{}' was left out in {} frames; need 0 or more",
                              marker.name, *marker.rejected_frames));
  }
  for (const auto& marker : excluded)
    if (marker.name.empty() || marker.why.empty())
      return fail(Code::bad_input,
                  fmt::format("the marker fit: excluded marker '{}' needs a name and a reason", marker.name));
  for (const auto& finding : findings)
    if (auto status = finding.validate(); !status) return fail_at("the marker fit", status.error());
  return {};
}

}  // namespace kinemark::data
