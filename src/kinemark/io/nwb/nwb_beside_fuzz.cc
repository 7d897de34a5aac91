// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// As nwb_fuzz.cc, of a file that others have added to, whose additions alone are edited. A result is put into
// what comes of it, and is read back.
#include <algorithm>
#include <cstdlib>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/testing/fuzzed_recording.h"
#include "kinemark/io/nwb/testing/others.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

// HDF5 1.10 does not free everything when it gives up in the middle; that is not ours to mend.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace kinemark;

/// The start, and beside it a result to put into what is made of it.
struct Files {
  testing_support::ScratchFolder scratch;
  io::testing::Start start;

  Files() {
    const auto markers = io::testing::sample_trajectories(4);
    if (!io::write_nwb(scratch / "start.nwb", markers) || !io::write_nwb(scratch / "fresh.nwb", markers))
      std::abort();
    const auto ours = io::testing::start_of(io::read_text(scratch / "start.nwb").value());
    io::testing::add_others(scratch / "start.nwb", false);
    start = io::testing::start_of(io::read_text(scratch / "start.nwb").value());
    std::erase_if(start.paths,
                  [&](const auto& path) { return std::ranges::find(ours.paths, path) != ours.paths.end(); });
    if (start.paths.size() < 10) std::abort();
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::internal::Quiet quiet;
  static const Files files;
  io::testing::read_edited(files.start, data, size);
  FuzzedDataProvider bytes(data, size);
  const auto edited = files.scratch / "edited.nwb";
  io::testing::write_edited(edited, files.start, bytes);
  if (const auto carried = io::internal::carry_here(edited, files.scratch / "fresh.nwb"); !carried) {
    if (carried.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  const auto back = io::internal::read_nwb_here(edited);
  if (!back || back->trial.markers.frames() != 4)
    std::abort();  // what is ours is there again, and fits its digest
  return 0;
}
