// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes, read as the export of its vendor: a valid trial or one sentence, never a crash, a hang or memory
// without bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/text/body_orientations.h"
#include "kinemark/io/text/d_flow_forces.h"
#include "kinemark/io/text/orientation_csv.h"
#include "kinemark/io/text/vendor_exports.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)kinemark::io::begins_orientation_csv(text);
  const auto turned = kinemark::io::parse_orientation_csv(text, "fuzz");
  if (turned ? !turned->validate() : turned.error().message.find('\n') != std::string::npos) std::abort();
  if (turned && turned->quaternion.size() > 4 * (size + 1'000'000)) std::abort();
  const auto forces = kinemark::io::parse_d_flow_forces(text, "fuzz", 20.0);
  if (forces ? !forces->validate() : forces.error().message.find('\n') != std::string::npos) std::abort();
  if (forces && forces->values.size() > 9 * 32 * (size + 1)) std::abort();
  const auto which = kinemark::io::vendor_export_of(text);
  if (!which) return 0;
  const auto trial = kinemark::io::parse_vendor_export(text, "fuzz", *which);
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  if (trial && kinemark::io::has_body_axes(*trial)) (void)kinemark::io::orientations_of_bodies(*trial);
  if (trial && trial->markers.x_in_world.size() > 3 * (size / 2 + 1'000'000)) std::abort();
  return 0;
}
