// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/transfer.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/testing/sample.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMost = 64UL << 20;

/// What send() writes.
std::string bytes_of(const Result<NwbFile>& file) {
  const int fd = ::memfd_create("sent", 0);
  EXPECT_TRUE(send(fd, file));
  std::string out(static_cast<std::size_t>(::lseek(fd, 0, SEEK_CUR)), '\0');
  EXPECT_EQ(::pread(fd, out.data(), out.size(), 0), static_cast<ssize_t>(out.size()));
  ::close(fd);
  return out;
}

std::optional<Result<NwbFile>> receive_bytes(const std::string& bytes, std::size_t most = kMost) {
  const int fd = ::memfd_create("received", 0);
  EXPECT_EQ(::write(fd, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  ::lseek(fd, 0, SEEK_SET);
  auto out = receive(fd, most);
  ::close(fd);
  return out;
}

NwbFile sample() {
  NwbFile file{.trial = testing::sample_trial(), .metadata = testing::sample_metadata()};
  file.derivatives = testing::sample_derivatives(file.trial.markers);
  file.metadata.set = "0123456789abcdef";
  file.warnings = {"one", "", "three"};
  return file;
}

TEST(Transfer, ATableOfPointsArrivesAndADamagedOneDoesNot) {
  const PoseTable table{
      .frames = 1, .people = {"a", ""}, .points = {"p"}, .values = {1.0, 2.0, 0.9, 3.0, 4.0, 1.0}};
  const int fd = ::memfd_create("sent", 0);
  ASSERT_TRUE(send(fd, Result<PoseTable>(table)));
  const auto length = ::lseek(fd, 0, SEEK_CUR);
  const auto again = [fd] {
    ::lseek(fd, 0, SEEK_SET);
    return receive_poses(fd, kMost);
  };
  const auto back = again();
  ASSERT_TRUE(back && *back);
  EXPECT_EQ((*back)->people, table.people);
  EXPECT_EQ((*back)->points, table.points);
  EXPECT_EQ((*back)->values, table.values);
  const char three = 3;  // frames
  ASSERT_EQ(::pwrite(fd, &three, 1, 9), 1);
  EXPECT_FALSE(again());
  ASSERT_EQ(::ftruncate(fd, length - 1), 0);
  EXPECT_FALSE(again());
  ::close(fd);
}

TEST(Transfer, EverythingArrives) {
  for (const std::int64_t frames : {2, 50, 3000}) {  // short of the buffer, and beyond
    NwbFile file = sample();
    file.trial = testing::sample_trial(frames);
    file.trial.unread = {"derivatives of markers"};
    file.trial.beside = {.file = "a.nwb",
                         .room = "/processing/kinemark",
                         .objects = {{.path = "/lfp",
                                      .type = "ElectricalSeries",
                                      .shape = {6000, 4},
                                      .unit = "volts",
                                      .rate_hz = 1000.0,
                                      .lost = "why"},
                                     {.path = "/units", .type = "Units"}}};
    file.derivatives = testing::sample_derivatives(file.trial.markers);
    const auto back = receive_bytes(bytes_of(file));
    ASSERT_TRUE(back && *back);
    const NwbFile& got = **back;
    EXPECT_EQ(got.trial.markers.names, file.trial.markers.names);
    EXPECT_EQ(got.trial.markers.time, file.trial.markers.time);
    EXPECT_TRUE(testing::same_bits(got.trial.markers.x_in_world, file.trial.markers.x_in_world));
    EXPECT_EQ(got.trial.markers.state, file.trial.markers.state);
    EXPECT_TRUE(testing::same_bits(got.trial.markers.covariance, file.trial.markers.covariance));
    EXPECT_TRUE(testing::same_bits(got.trial.markers.sample_offset_s, file.trial.markers.sample_offset_s));
    EXPECT_EQ(got.trial.markers.methods, file.trial.markers.methods);
    EXPECT_EQ(got.trial.markers.method, file.trial.markers.method);
    EXPECT_EQ(got.trial.first_frame, file.trial.first_frame);
    EXPECT_EQ(got.trial.camera_mask, file.trial.camera_mask);
    EXPECT_EQ(got.trial.channels.kinds, file.trial.channels.kinds);
    EXPECT_TRUE(testing::same_bits(got.trial.channels.values, file.trial.channels.values));
    EXPECT_EQ(got.trial.analog.units, file.trial.analog.units);
    EXPECT_TRUE(testing::same_bits(got.trial.analog.values, file.trial.analog.values));
    EXPECT_EQ(got.trial.events[1].time_s, file.trial.events[1].time_s);
    EXPECT_EQ(got.trial.force_plates[1].channel_idx, file.trial.force_plates[1].channel_idx);
    EXPECT_EQ(got.trial.force_plates[1].corners_in_world, file.trial.force_plates[1].corners_in_world);
    EXPECT_EQ(got.trial.unloaded_s, file.trial.unloaded_s);
    EXPECT_EQ(got.trial.calibration_error.fields, file.trial.calibration_error.fields);
    EXPECT_EQ(got.trial.unread, file.trial.unread);
    EXPECT_EQ(got.trial.beside.file, "a.nwb");
    EXPECT_EQ(got.trial.beside.room, "/processing/kinemark");
    ASSERT_EQ(got.trial.beside.objects.size(), 2U);
    const auto& lfp = got.trial.beside.objects.front();
    EXPECT_EQ(lfp.path + lfp.type + lfp.unit + lfp.lost, "/lfpElectricalSeriesvoltswhy");
    EXPECT_EQ(lfp.shape, (std::vector<std::int64_t>{6000, 4}));
    EXPECT_EQ(lfp.rate_hz, 1000.0);
    for (const Rate& rate : kRates)
      EXPECT_TRUE(testing::same_bits((*got.derivatives).*rate.values, (*file.derivatives).*rate.values));
    EXPECT_EQ(got.derivatives->filters.size(), file.derivatives->filters.size());
    EXPECT_EQ(got.metadata.sources[0].bytes, file.metadata.sources[0].bytes);
    EXPECT_EQ(got.metadata.options, file.metadata.options);
    EXPECT_EQ(got.metadata.seed, file.metadata.seed);
    EXPECT_EQ(got.metadata.set, file.metadata.set);
    EXPECT_EQ(got.metadata.command, file.metadata.command);
    EXPECT_EQ(got.warnings, file.warnings);
  }
}

TEST(Transfer, AFailureArrives) {
  const auto back = receive_bytes(bytes_of(fail(Code::not_supported, "x.nwb: is in 'pixels'")));
  ASSERT_TRUE(back);
  ASSERT_FALSE(*back);
  EXPECT_EQ(back->error().code, Code::not_supported);
  EXPECT_EQ(back->error().message, "x.nwb: is in 'pixels'");
}

TEST(Transfer, WhatIsCutIsNothing) {
  const std::string whole = bytes_of(sample());
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 7)
    EXPECT_FALSE(receive_bytes(whole.substr(0, size))) << size;
}

TEST(Transfer, ClaimsBeyondTheLimitAreNothing) {
  const std::string whole = bytes_of(sample());
  EXPECT_TRUE(receive_bytes(whole, whole.size()));
  EXPECT_FALSE(receive_bytes(whole, whole.size() / 2));
}

TEST(Transfer, ChangedBytesAreNothingOrAValidRecording) {
  const std::string whole = bytes_of(sample());
  Random random(3, 0);
  for (int k = 0; k < 300; ++k) {
    std::string changed = whole;
    // Half of them near the beginning, where sizes and flags stand.
    const double share = random.uniform() * (k % 2 == 0 ? 1.0 : 0.01);
    auto& byte = changed[static_cast<std::size_t>(share * static_cast<double>(whole.size()))];
    byte = static_cast<char>(byte ^ (1 << (k % 8)));
    const auto back = receive_bytes(changed);
    if (back && *back) {
      EXPECT_TRUE((*back)->trial.markers.validate());
    }
  }
}

TEST(Transfer, AReaderThatWentAwayIsNoticed) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ::close(ends[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  EXPECT_FALSE(send(ends[1], sample()));
  std::signal(SIGPIPE, before);
  ::close(ends[1]);
}

}  // namespace
}  // namespace kinemark::io::internal
