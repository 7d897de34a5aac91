// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <memory>

#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/rotations.h"
#include "kinemark/io/plates/plate_forces.h"

/// Any bytes are an error or a valid trial (and valid forces) whose arrays the file's size explains.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
  using namespace kinemark::io;
  const auto reader =
      C3dReader::open(std::make_unique<MemorySource>(std::as_bytes(std::span(bytes, size)), "fuzz.c3d"));
  if (!reader) return 0;
  const auto trial = read_trial(*reader);
  if (!trial || !trial->validate()) std::abort();
  if (trial->markers.x_in_world.size() + trial->analog.values.size() > size) std::abort();
  const auto rotations =
      read_rotations(*reader, MemorySource(std::as_bytes(std::span(bytes, size)), "fuzz.c3d"));
  if (rotations && (!rotations->validate() || rotations->quaternion.size() > size)) std::abort();
  const auto forces = plate_forces(*trial);
  if (forces && !forces->wrenches.validate()) std::abort();
  return 0;
}
