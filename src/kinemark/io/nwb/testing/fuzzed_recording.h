// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the fuzzers of NWB files do with a start and their bytes: a small file of ours is edited
// (hdf5_edits.h) and read as kinemark-nwb does it, but in this process: the answer is sent, received, and
// received again with the bytes changed that the input names.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/testing/hdf5_edits.h"
#include "support/scratch.h"

namespace kinemark::io::testing {

/// What arrives of an answer: the same. Of a damaged one: what is valid, or nothing.
inline void check_transfer(const Result<NwbFile>& file, const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostBytes = 64UL << 20;
  const int fd = memfd_create("answer", 0);
  if (fd < 0 || !internal::send(fd, file)) std::abort();
  const auto length = static_cast<std::size_t>(lseek(fd, 0, SEEK_CUR));
  const auto receive = [fd] {
    lseek(fd, 0, SEEK_SET);
    return internal::receive(fd, kMostBytes);
  };
  const auto whole = receive();
  if (!whole || whole->has_value() != file.has_value()) std::abort();
  if (!file && (*whole).error().message != file.error().message) std::abort();
  if (file && (*whole)->trial.markers.x_in_world.size() != file->trial.markers.x_in_world.size())
    std::abort();
  for (std::size_t i = 0; i + 2 < size; i += 3) {
    const std::size_t at = (data[i] + 256UL * data[i + 1]) % length;
    if (pwrite(fd, data + i + 2, 1, static_cast<off_t>(at)) != 1) std::abort();
  }
  if (const auto damaged = receive(); damaged && *damaged && !(*damaged)->trial.validate()) std::abort();
  close(fd);
}

/// Edit the start as the bytes ask, read it: a valid recording or one sentence.
inline int read_edited(const Start& start, const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  static const testing_support::ScratchFolder scratch;
  write_edited(scratch / "edited.nwb", start, bytes);
  const auto file = internal::read_nwb_here(scratch / "edited.nwb");
  check_transfer(file, data, size);
  if (!file) {
    if (file.error().message.find('\n') != std::string::npos) std::abort();
    if (file.error().code != Code::bad_input && file.error().code != Code::not_supported) std::abort();
    return 0;
  }
  if (!file->trial.validate()) std::abort();
  if (file->derivatives && !file->derivatives->validate(file->trial.markers)) std::abort();
  return 0;
}

}  // namespace kinemark::io::testing
