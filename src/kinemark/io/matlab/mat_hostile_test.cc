// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Files cut anywhere and with random bytes changed, as they are and inside what is compressed: one sentence
// or a valid trial, and no more memory than the bytes explain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/matlab/internal/inflate.h"
#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/mat.h"
#include "kinemark/io/matlab/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr std::size_t kHeader = 128, kTag = 8;

/// A file of ours and one of QTM's kind, not compressed.
std::vector<std::string> whole_files() {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(write_mat(scratch / "t.mat", testing::full_trial()));
  const std::string ours = read_text(scratch / "t.mat").value();
  const auto packed = std::as_bytes(std::span(ours)).subspan(kHeader + kTag);
  std::byte tag[kTag];
  EXPECT_TRUE(internal::inflate_start(packed, tag));
  std::uint32_t size = 0;
  std::memcpy(&size, tag + 4, 4);
  const auto plain = internal::inflate_all(packed, kTag + size).value();
  using namespace internal;
  const std::vector<double> numbers(24, 1.5);
  const std::vector<std::string> labels = {"a", "b"};
  const std::string group =
      mat_struct({{"Labels", mat_texts(labels)}, {"Data", mat_numbers(numbers, {2, 4, 3})}});
  const std::string analog = mat_structs(
      {"Labels", "Frequency", "Data"}, {{mat_texts(labels), mat_number(200), mat_numbers(numbers, {2, 12})}});
  return {ours.substr(0, kHeader) + std::string(reinterpret_cast<const char*>(plain.data()), plain.size()),
          testing::mat_file(
              {mat_struct({{"FrameRate", mat_number(100)},
                           {"StartFrame", mat_number(1)},
                           {"Trajectories", mat_struct({{"Labeled", group}, {"Unidentified", group}})},
                           {"Analog", analog}},
                          "walk")})};
}

/// The same with all after the header compressed.
std::string packed(const std::string& file) {
  if (file.size() < kHeader) return file;
  const auto bytes = internal::deflate_all(std::as_bytes(std::span(file)).subspan(kHeader));
  const std::uint32_t tag[] = {15, static_cast<std::uint32_t>(bytes.size())};
  return file.substr(0, kHeader) + std::string(reinterpret_cast<const char*>(tag), sizeof tag) +
         std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// True when it could be read.
bool survives(const std::string& file, std::size_t explained) {
  const auto trial = parse_mat(std::as_bytes(std::span(file)), "hostile.mat");
  if (!trial) {
    EXPECT_THAT(trial.error().message, StartsWith("hostile.mat: "));
    EXPECT_THAT(trial.error().message, Not(HasSubstr("\n")));
    return false;
  }
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  EXPECT_LE(trial->markers.x_in_world.size() + trial->analog.values.size(), explained);
  for (const std::string& warning : trial->warnings) EXPECT_THAT(warning, Not(HasSubstr("\n")));
  return true;
}

TEST(HostileMat, CutAtEveryLength) {
  for (const std::string& file : whole_files()) {
    EXPECT_TRUE(survives(file, file.size()));
    EXPECT_TRUE(survives(packed(file), file.size()));
    for (std::size_t n = 0; n + 8 < file.size(); n += n < 300 ? 1 : 7)
      EXPECT_FALSE(survives(file.substr(0, n), file.size())) << n;
    const std::string small = packed(file);
    for (std::size_t n = 0; n + 8 < small.size(); n += 5)
      EXPECT_FALSE(survives(small.substr(0, n), file.size())) << n;
  }
}

TEST(HostileMat, ChangedBytes) {
  int read = 0;
  for (const std::string& file : whole_files()) {
    Random random(7, 0);
    for (int trial = 0; trial < 3000; ++trial) {
      std::string changed = file;
      const int changes = 1 + static_cast<int>(random.uniform(0.0, 4.0));
      for (int i = 0; i < changes; ++i)
        changed[static_cast<std::size_t>(random.uniform(124.0, static_cast<double>(file.size())))] =
            static_cast<char>(static_cast<int>(random.uniform(0.0, 256.0)));
      read += survives(changed, file.size());
      if (trial % 10 == 0) survives(packed(changed), file.size());
    }
  }
  EXPECT_GT(read, 1000);  // most changes touch a number
}

TEST(HostileMat, FieldsOfOtherKindsAreRefusedOrPassedOver) {
  using namespace internal;
  const std::vector<std::string> kinds = {mat_text("x"),
                                          mat_number(kNaN),
                                          mat_number(-1),
                                          mat_number(1e300),
                                          mat_texts(std::vector<std::string>{"a", "b"}),
                                          mat_struct({}),
                                          mat_numbers(std::vector<double>{}, {0, 0})};
  const std::vector<std::string> fields = {"kinemark", "rate",   "start",  "first_frame",  "frames",
                                           "time",     "labels", "data",   "status",       "covariance",
                                           "channels", "analog", "events", "force_plates", "unloaded"};
  for (const std::string& field : fields)
    for (const std::string& value : kinds) {
      MatFields all = {{"kinemark", mat_number(1)},
                       {"rate", mat_number(100)},
                       {"start", mat_number(0)},
                       {"first_frame", mat_number(1)},
                       {"frames", mat_number(1)},
                       {"time", mat_number(0)},
                       {"labels", mat_texts(std::vector<std::string>{"a"})},
                       {"data", mat_numbers(std::vector<double>{1, 2, 3}, {1, 1, 3})},
                       {"status", mat_number(1)}};
      const auto same = std::ranges::find(all, field, &std::pair<std::string, std::string>::first);
      if (same != all.end())
        same->second = value;
      else
        all.emplace_back(field, value);
      survives(testing::mat_file({mat_struct(all, "trial")}), 10);
    }
}

/// One marker, two frames at 100 Hz from 0 s, with one field replaced or added.
std::string two_frames(const std::string& field, const std::string& value,
                       const std::string& name = "trial") {
  using namespace internal;
  MatFields all = {{"kinemark", mat_number(1)},
                   {"rate", mat_number(100)},
                   {"start", mat_number(0)},
                   {"first_frame", mat_number(1)},
                   {"frames", mat_number(2)},
                   {"time", mat_numbers(std::vector<double>{0, 0.01}, {2, 1})},
                   {"labels", mat_texts(std::vector<std::string>{"a"})},
                   {"data", mat_numbers(std::vector<double>{1, 4, 2, 5, 3, 6}, {2, 1, 3})},
                   {"status", mat_numbers(std::vector<double>{1, 1}, {2, 1})}};
  const auto same = std::ranges::find(all, field, &std::pair<std::string, std::string>::first);
  if (same != all.end())
    same->second = value;
  else
    all.emplace_back(field, value);
  return mat_struct(all, name);
}

std::string said(const std::vector<std::string>& variables) {
  const auto file = testing::mat_file(variables);
  const auto trial = parse_mat(std::as_bytes(std::span(file)), "f.mat");
  if (!trial) return trial.error().message;
  return trial->warnings.empty() ? "read" : trial->warnings.front();
}

TEST(HostileMat, UnitsAndTimesThatSayOtherwiseAreRefused) {
  using namespace internal;
  EXPECT_EQ(said({two_frames("units", mat_text("m"))}), "read");
  EXPECT_THAT(said({two_frames("units", mat_text("mm"))}), HasSubstr("is 'mm'; expected m"));
  EXPECT_THAT(said({two_frames("time", mat_numbers(std::vector<double>{0, 0.02}, {2, 1}))}),
              HasSubstr("is 0.02 s in row 2; 100 Hz from 0 s need 0.01"));
  EXPECT_THAT(said({two_frames("start", mat_number(5))}), HasSubstr("is 0 s in row 1"));
}

TEST(HostileMat, APolynomialOfAPlateIsTwoBySixFiniteNumbers) {
  using namespace internal;
  const auto said_of = [](const std::vector<double>& numbers, const MatDims& dims) {
    return said({two_frames(
        "force_plates",
        mat_structs({"type", "corners", "origin", "pressure_correction"},
                    {{mat_number(3), mat_numbers(std::vector<double>(12, 0.5), {4, 3}),
                      mat_numbers(std::vector<double>(3, 0.1), {1, 3}), mat_numbers(numbers, dims)}}))});
  };
  std::vector<double> numbers(12, 0.25);
  EXPECT_EQ(said_of(numbers, {2, 6}), "read");
  EXPECT_EQ(said_of({}, {0, 0}), "read");
  EXPECT_THAT(said_of(numbers, {6, 2}), HasSubstr("pressure_correction: is 6 x 2; expected 2 x 6 numbers"));
  numbers[3] = kNaN;
  EXPECT_THAT(said_of(numbers, {2, 6}), HasSubstr("pressure_correction: holds a value that is no finite"));
}

TEST(HostileMat, OfSeveralRecordingsTheFirstIsReadAndTheOthersSaid) {
  using namespace internal;
  EXPECT_THAT(said({two_frames("units", mat_text("m"), "walk"), two_frames("units", mat_text("m"), "jog")}),
              HasSubstr("of several recordings 'walk' is read; not read: jog"));
}

TEST(HostileMat, ANameForTheTerminalIsMadeSafe) {
  using namespace internal;
  const std::string file = testing::mat_file({mat_struct({{"a", mat_number(1)}}, "x\x1b[31m\n")});
  const auto trial = parse_mat(std::as_bytes(std::span(file)), "f.mat");
  ASSERT_FALSE(trial);
  EXPECT_THAT(trial.error().message, Not(HasSubstr("\x1b")));
  EXPECT_THAT(trial.error().message, Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace kinemark::io
