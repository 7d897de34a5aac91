// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as external loads and as a model: a description or one sentence; what was read must be valid and,
// once written, read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "kinemark/io/osim/external_loads.h"
#include "kinemark/io/osim/osim_document.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"

namespace {

/// A document that can be read can be kept, and stretched where its numbers allow it.
void check_document(std::string_view xml) {
  const auto document = kinemark::io::OsimDocument::parse(xml, "fuzz.osim");
  if (!document) std::abort();
  const std::vector<Eigen::Vector3d> factors(document->model().bodies.size(), {1.25, 0.5, 2.0});
  for (const bool stretch : {false, true}) {
    kinemark::io::OsimChange change{.model = document->model(), .factors = {}, .paths = {}};
    for (const auto& path : document->paths()) change.paths.push_back({.name = path.name, .ratio = 1.5});
    if (stretch) change.factors = factors;
    const auto text = document->format(change);
    if (text && !kinemark::io::parse_osim(text->text, "again.osim")) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view xml(reinterpret_cast<const char*>(data), size);
  const auto loads = kinemark::io::parse_external_loads(xml, "fuzz.xml");
  if (loads && loads->forces.empty()) std::abort();
  const auto model = kinemark::io::parse_osim(xml, "fuzz.osim");
  if (!model) return model.error().message.empty() ? std::abort(), 0 : 0;
  check_document(xml);
  const auto text = kinemark::io::format_osim(*model);
  if (!text) return 0;
  if (!kinemark::io::parse_osim(*text, "again.osim")) std::abort();
  return 0;
}
