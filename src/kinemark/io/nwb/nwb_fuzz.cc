// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A small file of ours with the edits that the bytes ask for (groups and datasets gone, linked elsewhere, of
// other shapes and types, other samples and attributes): a valid recording or one sentence. Whatever the
// reader itself looks at is reached. The structures that HDF5 keeps for itself are left whole: HDF5 1.10 can
// crash on damaged ones. It is what kinemark-nwb does, in this process: the file is read, the answer sent,
// received, and received again with the bytes changed that the input names.
#include <fuzzer/FuzzedDataProvider.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/testing/hdf5_edits.h"
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

/// What arrives of an answer: the same. Of a damaged one: what is valid, or nothing.
void check_transfer(const Result<io::NwbFile>& file, const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostBytes = 64UL << 20;
  const int fd = memfd_create("answer", 0);
  if (fd < 0 || !io::internal::send(fd, file)) std::abort();
  const auto length = static_cast<std::size_t>(lseek(fd, 0, SEEK_CUR));
  const auto receive = [fd] {
    lseek(fd, 0, SEEK_SET);
    return io::internal::receive(fd, kMostBytes);
  };
  const auto whole = receive();
  if (!whole || whole->has_value() != file.has_value()) std::abort();
  if (!file && (*whole).error().message != file.error().message) std::abort();
  if (file && (*whole)->trajectories.x_in_world.size() != file->trajectories.x_in_world.size()) std::abort();
  for (std::size_t i = 0; i + 2 < size; i += 3) {
    const std::size_t at = (data[i] + 256UL * data[i + 1]) % length;
    if (pwrite(fd, data + i + 2, 1, static_cast<off_t>(at)) != 1) std::abort();
  }
  if (const auto damaged = receive(); damaged && *damaged && !(*damaged)->trajectories.validate())
    std::abort();
  close(fd);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::internal::Quiet quiet;
  static const io::testing::Start start = make_start();
  FuzzedDataProvider bytes(data, size);
  static const testing_support::ScratchFolder scratch;
  io::testing::write_edited(scratch / "edited.nwb", start, bytes);
  const auto file = io::internal::read_nwb_here(scratch / "edited.nwb");
  check_transfer(file, data, size);
  if (!file) {
    if (file.error().message.find('\n') != std::string::npos) std::abort();
    if (file.error().code != Code::bad_input && file.error().code != Code::not_supported) std::abort();
    return 0;
  }
  if (!file->trajectories.validate()) std::abort();
  if (file->derivatives && !file->derivatives->validate(file->trajectories)) std::abort();
  return 0;
}
