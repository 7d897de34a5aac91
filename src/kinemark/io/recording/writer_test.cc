// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "kinemark/io/recording/reader.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;

RecordingMessage message_of(std::uint32_t sequence, std::string_view text) {
  return {0, sequence, 1000ULL * sequence, 1000ULL * sequence, std::as_bytes(std::span(text))};
}

/// Messages in a file and how it ends.
std::pair<std::int64_t, RecordingEnd> read_back(const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path);
  if (!reader) return {-1, RecordingEnd::damaged};
  RecordingMessage message;
  while (*reader->next(message)) {
  }
  return {reader->messages(), reader->end()};
}

TEST(RecordingWriter, EveryAcknowledgedMessageIsReadableAtOnceByAnyoneElse) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch / "a.mcap";
  for (const SyncPolicy policy : {SyncPolicy::never, SyncPolicy::background, SyncPolicy::always}) {
    auto writer = RecordingWriter::create(path, {.force = true, .sync = policy});
    ASSERT_TRUE(writer) << writer.error().message;
    EXPECT_EQ(read_back(path), std::pair(std::int64_t{0}, RecordingEnd::open));
    ASSERT_EQ(writer->add_channel({.topic = "/t"}).value(), 0);
    for (std::uint32_t i = 0; i < 20; ++i) {
      ASSERT_TRUE(writer->append(message_of(i, "some data")));
      EXPECT_EQ(writer->acknowledged(), i + 1);
      EXPECT_EQ(read_back(path), std::pair(std::int64_t{i + 1}, RecordingEnd::open));
      if (policy == SyncPolicy::always) {
        EXPECT_EQ(writer->on_disk(), i + 1);
      }
    }
    ASSERT_TRUE(writer->close());
    EXPECT_EQ(writer->on_disk(), 20);
    EXPECT_EQ(read_back(path), std::pair(std::int64_t{20}, RecordingEnd::closed));
  }
}

TEST(RecordingWriter, WithoutCloseTheFileStaysAsAfterAKill) {
  const testing_support::ScratchFolder scratch;
  {
    auto writer = RecordingWriter::create(scratch / "a.mcap");
    ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}) && writer->append(message_of(0, "x")));
  }
  EXPECT_EQ(read_back(scratch / "a.mcap"), std::pair(std::int64_t{1}, RecordingEnd::open));
}

TEST(RecordingWriter, TheBackgroundThreadReachesTheDiskWithoutBeingAsked) {
  const testing_support::ScratchFolder scratch;
  auto writer = RecordingWriter::create(scratch / "a.mcap", {.sync_interval_s = 0.01});
  ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}) && writer->append(message_of(0, "x")));
  // No limit in time: a machine that is busy only makes this slow, a thread that does nothing makes it hang.
  while (writer->on_disk() < 1) std::this_thread::yield();
  EXPECT_EQ(writer->on_disk(), 1);
}

TEST(RecordingWriter, SyncPutsOnTheDiskWhatThePolicyLeftInMemory) {
  const testing_support::ScratchFolder scratch;
  auto writer = RecordingWriter::create(scratch / "a.mcap", {.sync = SyncPolicy::never});
  ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}) && writer->append(message_of(0, "x")));
  EXPECT_EQ(writer->on_disk(), 0);
  ASSERT_TRUE(writer->sync());
  EXPECT_EQ(writer->on_disk(), 1);
}

TEST(RecordingWriter, NeverReplacesAFileUnasked) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch / "a.mcap";
  std::ofstream(path) << "precious";
  const auto refused = RecordingWriter::create(path);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("a.mcap: exists already; use --force to replace it"));
  std::ifstream still(path);
  std::string text;
  still >> text;
  EXPECT_EQ(text, "precious");
  ASSERT_TRUE(RecordingWriter::create(path, {.force = true}));
  EXPECT_EQ(read_back(path), std::pair(std::int64_t{0}, RecordingEnd::open));
  // Whoever has the old file open goes on reading the old one: `still` is not truncated.
  still.clear();
  still.seekg(0);
  still >> text;
  EXPECT_EQ(text, "precious");
}

TEST(RecordingWriter, SaysWhyAFileCannotBeMade) {
  const testing_support::ScratchFolder scratch;
  EXPECT_THAT(RecordingWriter::create(scratch.path()).error().message,
              HasSubstr("is a folder; need a file name"));
  const auto nowhere = RecordingWriter::create(scratch / "no/such/folder/a.mcap");
  EXPECT_EQ(nowhere.error().code, Code::io);
  EXPECT_THAT(nowhere.error().message, HasSubstr("cannot be written (No such file or directory)"));
  const auto interval = RecordingWriter::create(scratch / "a.mcap", {.sync_interval_s = 0.0});
  EXPECT_EQ(interval.error().code, Code::usage);
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(RecordingWriter, NothingIsAddedAfterClose) {
  const testing_support::ScratchFolder scratch;
  auto writer = RecordingWriter::create(scratch / "a.mcap");
  ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}) && writer->close());
  EXPECT_EQ(writer->append(message_of(0, "x")).error().code, Code::usage);
  EXPECT_EQ(writer->add_metadata({"m", {}}).error().code, Code::usage);
  EXPECT_EQ(writer->close().error().code, Code::usage);
  EXPECT_EQ(read_back(scratch / "a.mcap"), std::pair(std::int64_t{0}, RecordingEnd::closed));
}

/// For its lifetime no file of this process may grow beyond `bytes`, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(RecordingWriter, AFullDiskIsReportedOnceAndCostsNothingThatWasAcknowledged) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch / "a.mcap";
  std::int64_t acknowledged = 0;
  std::string first, second;
  {
    auto writer = RecordingWriter::create(path);
    ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}));
    const FullDisk full(1000);
    const std::string data(90, 'x');
    Status status;
    for (std::uint32_t i = 0; status && i < 100; ++i) {
      status = writer->append(message_of(i, data));
      acknowledged += status.has_value();
    }
    ASSERT_FALSE(status);
    first = status.error().message;
    EXPECT_EQ(status.error().code, Code::io);
    EXPECT_EQ(writer->acknowledged(), acknowledged);
    second = writer->append(message_of(100, "x")).error().message;
    EXPECT_FALSE(writer->close());
  }
  EXPECT_THAT(first, HasSubstr("cannot be written (File too large); 6 messages are kept"));
  EXPECT_EQ(first, second);
  EXPECT_EQ(read_back(path), std::pair(acknowledged, RecordingEnd::open));  // the torn bytes were taken back
}

TEST(RecordingWriter, MessagesThatAreTooLargeAreRefusedAndTheRecordingGoesOn) {
  const testing_support::ScratchFolder scratch;
  auto writer = RecordingWriter::create(scratch / "a.mcap");
  ASSERT_TRUE(writer && writer->add_channel({.topic = "/t"}));
  const std::string large(kMaxGroupBytes, 'x');
  EXPECT_EQ(writer->append(message_of(0, large)).error().code, Code::usage);
  ASSERT_TRUE(writer->append(message_of(1, "x")));
  EXPECT_EQ(read_back(scratch / "a.mcap"), std::pair(std::int64_t{1}, RecordingEnd::open));
}

}  // namespace
}  // namespace kinemark::io
