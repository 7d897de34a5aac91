// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A small file of ours with the edits that the bytes ask for (groups and datasets gone, linked elsewhere, of
// other shapes and types, other samples and attributes): a valid recording or one sentence. Whatever the
// reader itself looks at is reached. The structures that HDF5 keeps for itself are left whole: HDF5 1.10 can
// crash on damaged ones.
#include <cstdlib>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/testing/fuzzed_recording.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

// HDF5 1.10 does not free everything when it gives up in the middle; that is not ours to mend.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace kinemark;

io::testing::Start make_start() {
  const testing_support::ScratchFolder scratch;
  const auto trajectories = io::testing::sample_trajectories(4);
  const auto derivatives = io::testing::sample_derivatives(trajectories);
  if (!io::write_nwb(scratch / "start.nwb", trajectories, &derivatives, io::testing::sample_metadata()))
    std::abort();
  auto out = io::testing::start_of(io::read_text(scratch / "start.nwb").value());
  if (out.paths.size() < 20) std::abort();
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::internal::Quiet quiet;
  static const io::testing::Start start = make_start();
  return io::testing::read_edited(start, data, size);
}
