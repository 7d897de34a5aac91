// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// As nwb_fuzz.cc, of a file with analog channels, channels, events and force plates, whose objects alone are
// edited: the rest is what that one looks for.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/testing/fuzzed_recording.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

// HDF5 1.10 does not free everything when it gives up in the middle; that is not ours to mend.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace kinemark;

/// Whether something in a file is what a recording holds beside positions.
bool is_signal(std::string_view path) {
  for (const std::string_view name :
       {"/acquisition", "/intervals", "analog_channels", "/Channels", "/channels", "/events", "/force_plates",
        "/Residual", "/Cameras", "/first_frame"})
    if (path.find(name) != std::string_view::npos) return true;
  return false;
}

io::testing::Start make_start() {
  const testing_support::ScratchFolder scratch;
  auto trial = io::testing::sample_trial(4);
  trial.markers.sample_offset_s.clear();
  if (!io::write_nwb(scratch / "start.nwb", trial)) std::abort();
  auto out = io::testing::start_of(io::read_text(scratch / "start.nwb").value());
  std::erase_if(out.paths, [](const std::string& path) { return !is_signal(path); });
  if (out.paths.size() < 20) std::abort();
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::internal::Quiet quiet;
  static const io::testing::Start start = make_start();
  return io::testing::read_edited(start, data, size);
}
