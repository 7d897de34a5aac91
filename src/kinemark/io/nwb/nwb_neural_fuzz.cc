// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// As nwb_fuzz.cc, of what read_neural_lanes() reads: objects of units, intervals, electrodes and field
// potentials alone are edited.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/neural_reader.h"
#include "kinemark/io/nwb/testing/hdf5_edits.h"
#include "kinemark/io/nwb/testing/sample_session.h"
#include "support/scratch.h"

// HDF5 1.10 does not free everything when it gives up in the middle; that is not ours to mend.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace kinemark;

bool is_neural(std::string_view path) {
  for (const std::string_view name :
       {"/units", "/intervals", "/general/extracellular_ephys", "/processing/ecephys"})
    if (path.starts_with(name)) return true;
  return false;
}

io::testing::Start make_start() {
  const testing_support::ScratchFolder scratch;
  auto field = io::testing::sample_field();
  field.values.resize(64);
  if (!io::testing::write_session(scratch / "start.nwb", io::testing::sample_neural(), {field})) std::abort();
  {
    // Without the digest, which no edit would fit.
    const io::internal::Handle file(H5Fopen((scratch / "start.nwb").c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
                                    H5Fclose);
    if (H5Adelete(file.id(), io::internal::kDigestAttribute) < 0) std::abort();
  }
  auto out = io::testing::start_of(io::read_text(scratch / "start.nwb").value());
  std::erase_if(out.paths, [](const std::string& path) { return !is_neural(path); });
  if (out.paths.size() < 20) std::abort();
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::internal::Quiet quiet;
  static const io::testing::Start start = make_start();
  static const testing_support::ScratchFolder scratch;
  FuzzedDataProvider bytes(data, size);
  io::testing::write_edited(scratch / "edited.nwb", start, bytes);
  const auto neural = io::internal::read_lanes_here(scratch / "edited.nwb");
  if (neural) {
    if (!neural->validate()) std::abort();
    return 0;
  }
  if (neural.error().message.find('\n') != std::string::npos) std::abort();
  if (neural.error().code != Code::bad_input) std::abort();
  return 0;
}
