// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes: a definition that computes something of a recording, or what is wrong.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  const auto definition =
      pipeline::parse_definition({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  if (!definition) return definition.error().message.empty() ? std::abort(), 0 : 0;
  auto markers = data::Trajectories::all_missing({"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "A", "B"},
                                                 {.rate_hz = 100.0, .frames = 2});
  for (std::int64_t f = 0; f < 2; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const auto k = static_cast<double>(m);
      markers.x(f, m) = Eigen::Vector3d(0.1 * k, 0.01 * k * k, 1.0 / (1.0 + k));
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto motion = analysis::compute_segments(*definition, {.markers = &markers, .static_trial = &markers},
                                                 {.noise_sd_m = 1e-3});
  if (!motion) return motion.error().message.empty() ? std::abort(), 0 : 0;
  if (!motion->points.validate()) std::abort();
  return 0;
}
