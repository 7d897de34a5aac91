// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes in any of the formats: a valid mesh or one sentence, never a crash, a hang or memory without
// bound.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/io/mesh/mesh_file.h"
#include "kinemark/io/mesh/mesh_reduction.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"fuzz.vtp", "fuzz.stl", "fuzz.obj"}) {
    auto mesh = kinemark::io::parse_mesh(bytes, name);
    if (!mesh) {
      if (mesh.error().message.find('\n') != std::string::npos) std::abort();
      continue;
    }
    if (!mesh->validate()) std::abort();
    std::vector<kinemark::data::TriangleMesh> meshes{std::move(*mesh)};
    kinemark::io::reduce_meshes(meshes, 8);
    if (!meshes.front().validate()) std::abort();
  }
  return 0;
}
