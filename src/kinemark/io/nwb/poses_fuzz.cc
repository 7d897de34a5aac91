// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Points in images. The first byte chooses: a file as other programs wrote it with the edits that the rest
// asks for, or the rest as pickled labels of columns, with numbers. A table or one sentence; and what is sent
// of it arrives, or nothing.
#include <fuzzer/FuzzedDataProvider.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/pickled.h"
#include "kinemark/io/nwb/internal/pose_reader.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/testing/hdf5_edits.h"
#include "support/scratch.h"

extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

using namespace kinemark;

constexpr std::array<const char*, 5> kFiles = {"dlc_table.h5", "dlc_fixed.h5", "dlc_individuals.h5",
                                               "sleap_one.h5", "sleap_frames_first.h5"};

const io::testing::Start& start_of_file(std::size_t which) {
  static const auto starts = [] {
    std::vector<io::testing::Start> out;
    for (const char* name : kFiles) {
      auto bytes = io::read_text(std::filesystem::path(KINEMARK_TESTDATA) / name);
      if (!bytes) std::abort();
      out.push_back(io::testing::start_of(std::move(*bytes)));
    }
    return out;
  }();
  return starts[which];
}

Result<io::PoseTable> read_edited(std::size_t which, const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  static const testing_support::ScratchFolder scratch;
  io::testing::write_edited(scratch / "edited.h5", start_of_file(which), bytes);
  return io::internal::read_pose_table_here(scratch / "edited.h5");
}

Result<io::PoseTable> arrange_text(std::string_view text) {
  const auto columns = io::internal::parse_pickled_labels(text);
  if (!columns) return std::unexpected(columns.error());
  if (columns->size() > 1000) return fail(Code::bad_input, "more than is tried here");
  auto table = io::internal::arrange_columns(*columns, {0.0, 1.0}, Array<double>(2 * columns->size(), 5.0));
  if (table && !table->validate()) std::abort();
  return table;
}

/// What arrives of an answer: the same. Of a damaged one: what is valid, or nothing.
void check_transfer(const Result<io::PoseTable>& table, const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMostBytes = 64UL << 20;
  const int fd = memfd_create("answer", 0);
  if (fd < 0 || !io::internal::send(fd, table)) std::abort();
  const auto length = static_cast<std::size_t>(lseek(fd, 0, SEEK_CUR));
  const auto receive = [fd] {
    lseek(fd, 0, SEEK_SET);
    return io::internal::receive_poses(fd, kMostBytes);
  };
  const auto whole = receive();
  if (!whole || whole->has_value() != table.has_value()) std::abort();
  if (table && (*whole)->values.size() != table->values.size()) std::abort();
  for (std::size_t i = 0; i + 2 < size; i += 3)
    if (pwrite(fd, data + i + 2, 1, static_cast<off_t>((data[i] + 256UL * data[i + 1]) % length)) != 1)
      std::abort();
  if (const auto damaged = receive(); damaged && *damaged && !(*damaged)->validate()) std::abort();
  close(fd);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const io::internal::Quiet quiet;
  const std::size_t which = data[0] % (kFiles.size() + 1);
  const auto table = which < kFiles.size()
                         ? read_edited(which, data + 1, size - 1)
                         : arrange_text({reinterpret_cast<const char*>(data) + 1, size - 1});
  check_transfer(table, data, size);
  if (table) return 0;
  if (table.error().message.find('\n') != std::string::npos) std::abort();
  if (table.error().code != Code::bad_input && table.error().code != Code::not_supported) std::abort();
  return 0;
}
