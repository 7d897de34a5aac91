// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Files cut anywhere and with random bytes changed: an error of one sentence or a valid trial, never
// more memory than the file's size explains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "kinemark/core/random.h"
#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/plates/plate_forces.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using data::Trial;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
  const std::string text = read_text(path).value();
  std::vector<std::byte> bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::vector<std::vector<std::byte>> simulated_files() {
  const testing_support::ScratchFolder scratch;
  Trial trial = internal::simulate_trial({.markers = 6, .frames = 12, .channels = 7});
  trial.events.push_back({.label = "Foot Strike", .context = "Left", .time_s = 0.02});
  trial.force_plates.push_back({.type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}});
  std::vector<std::vector<std::byte>> files;
  for (const Processor processor : {Processor::intel, Processor::dec, Processor::mips}) {
    for (const bool integers : {false, true}) {
      EXPECT_TRUE(
          write_c3d(scratch / "f.c3d", trial, {.force = true, .processor = processor, .integers = integers}));
      files.push_back(bytes_of(scratch / "f.c3d"));
    }
  }
  return files;
}

/// True when the bytes could be read.
bool survives(std::span<const std::byte> bytes) {
  const auto reader = C3dReader::open(std::make_unique<MemorySource>(bytes, "hostile.c3d"));
  if (!reader) {
    EXPECT_THAT(reader.error().message, StartsWith("hostile.c3d: "));
    EXPECT_THAT(reader.error().message, Not(HasSubstr("\n")));
    return false;
  }
  const auto trial = read_trial(*reader);
  EXPECT_TRUE(trial) << trial.error().message;
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  EXPECT_LE(trial->markers.x_in_world.size() + trial->analog.values.size(), bytes.size());
  for (const std::string& warning : trial->warnings) EXPECT_THAT(warning, Not(HasSubstr("\n")));
  const auto forces = plate_forces(*trial);
  if (!forces) {
    EXPECT_THAT(forces.error().message, Not(HasSubstr("\n")));
    return true;
  }
  EXPECT_TRUE(forces->wrenches.validate()) << forces->wrenches.validate().error().message;
  std::size_t numbers = 0;
  for (const auto& wrench : forces->wrenches.items) numbers += wrench.force.size();
  EXPECT_LE(numbers, bytes.size());
  return true;
}

TEST(HostileC3d, CutAtEveryLength) {
  for (const auto& file : simulated_files())
    for (std::size_t n = 0; n < file.size(); n += n % 512 == 0 ? 1 : n % 512 == 1 ? 200 : 311 - n % 311)
      survives(std::span(file).first(n));
}

TEST(HostileC3d, BytesTurnedIntoAnything) {
  Random random(3, 0);
  int read = 0;
  for (const auto& file : simulated_files()) {
    for (int round = 0; round < 800; ++round) {
      auto bytes = file;
      const int changes = 1 + static_cast<int>(random.uniform(0.0, 12.0));
      for (int c = 0; c < changes; ++c) {
        // Mostly in the head, where the meaning is.
        const double limit = random.uniform() < 0.9 ? 3000.0 : static_cast<double>(bytes.size());
        bytes[static_cast<std::size_t>(random.uniform(0.0, limit))] =
            static_cast<std::byte>(random.uniform(0.0, 256.0));
      }
      read += survives(bytes);
    }
  }
  EXPECT_GT(read, 1600) << "most damage is small, so most files must still be read";
}

TEST(HostileC3d, RealFilesCutAtEveryBlockAndDamaged) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  Random random(4, 0);
  for (const char* name :
       {"c3d-org/sample01/Eb015si.c3d", "c3d-org/sample18/bad_parameter_section.c3d",
        "btk-others/badParameterOffset.c3d", "btk-others/MyCube.c3d",
        "ezc3d-testFiles/C3DRotationExample.c3d", "kineticstoolkit/walkingOptiTrack.c3d"}) {
    SCOPED_TRACE(name);
    const auto file = bytes_of(data / name);
    for (std::size_t n = 0; n < std::min<std::size_t>(file.size(), 40 * 512); n += 512)
      survives(std::span(file).first(n));
    for (int round = 0; round < 20; ++round) {
      auto bytes = file;
      for (int c = 0; c < 8; ++c)
        bytes[static_cast<std::size_t>(
            random.uniform(0.0, std::min(6000.0, static_cast<double>(bytes.size()))))] =
            static_cast<std::byte>(random.uniform(0.0, 256.0));
      survives(bytes);
    }
  }
}

TEST(HostileC3d, HugeCountsCostNothing) {
  for (const auto& file : simulated_files()) {
    for (const std::size_t at : {2U, 4U, 8U, 16U, 18U}) {
      auto bytes = file;
      bytes[at] = bytes[at + 1] = std::byte{0xFF};
      survives(bytes);
    }
    // All sizes in the parameter section at once.
    auto bytes = file;
    for (std::size_t i = 512; i < 2048; ++i)
      if (bytes[i] == std::byte{6}) bytes[i] = std::byte{0xFF};
    survives(bytes);
  }
}

}  // namespace
}  // namespace kinemark::io
