// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes, read as an archive of NumPy: a valid trial or one sentence, never a crash, a hang or memory
// without bound.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "kinemark/io/numpy/npz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto trial = kinemark::io::parse_npz(std::as_bytes(std::span(data, size)), "fuzz");
  if (trial ? !trial->validate() : trial.error().message.find('\n') != std::string::npos) std::abort();
  // A byte of deflate makes 1032, a sample has one byte at least, and each frame may miss ten.
  if (trial && trial->markers.x_in_world.size() > 11 * 1032 * (size + 1)) std::abort();
  return 0;
}
