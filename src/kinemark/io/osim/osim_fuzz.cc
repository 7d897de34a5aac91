// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as external loads and as a model: a description or one sentence; what was read must be valid and,
// once written, read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/osim/external_loads.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view xml(reinterpret_cast<const char*>(data), size);
  const auto loads = kinemark::io::parse_external_loads(xml, "fuzz.xml");
  if (loads && loads->forces.empty()) std::abort();
  const auto model = kinemark::io::parse_osim(xml, "fuzz.osim");
  if (!model) return model.error().message.empty() ? std::abort(), 0 : 0;
  const auto text = kinemark::io::format_osim(*model);
  if (!text) return 0;
  if (!kinemark::io::parse_osim(*text, "again.osim")) std::abort();
  return 0;
}
