// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/mcap_markers.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cmath>
#include <string>

#include "kinemark/io/recording/internal/mcap.h"

namespace kinemark::io {
namespace {

using internal::RecordScope;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void put_header(Bytes& out, const std::string& profile = "") {
  internal::put_raw(out, internal::kMagic);
  const RecordScope record(out, internal::kHeader);
  internal::put_string(out, profile);
  internal::put_string(out, "judge 1.0");
}

void put_channel(Bytes& out, std::uint16_t id, const std::string& topic, const std::string& schema,
                 const std::string& encoding = "json") {
  {
    const RecordScope record(out, internal::kSchema);
    internal::put_u16(out, id);
    for (const char* text : {schema.c_str(), "jsonschema", "{}"}) internal::put_string(out, text);
  }
  const RecordScope record(out, internal::kChannel);
  internal::put_u16(out, id);
  internal::put_u16(out, id);
  internal::put_string(out, topic);
  internal::put_string(out, encoding);
  internal::put_map(out, {});
}

void put_message(Bytes& out, std::uint16_t channel, std::uint64_t time_ns, const std::string& text) {
  const RecordScope record(out, internal::kMessage);
  internal::put_u16(out, channel);
  internal::put_u32(out, 0);
  internal::put_u64(out, time_ns);
  internal::put_u64(out, time_ns);
  internal::put_raw(out, text);
}

void put_end(Bytes& out) {
  const RecordScope record(out, internal::kDataEnd);
  internal::put_u32(out, 0);
}

Bytes packed(const Bytes& records, const std::string& how) {
  if (how.empty()) return records;
  Bytes out(how == "zstd" ? ZSTD_compressBound(records.size())
                          : LZ4F_compressFrameBound(records.size(), nullptr));
  out.resize(how == "zstd"
                 ? ZSTD_compress(out.data(), out.size(), records.data(), records.size(), 3)
                 : LZ4F_compressFrame(out.data(), out.size(), records.data(), records.size(), nullptr));
  return out;
}

void put_chunk(Bytes& out, const Bytes& records, const std::string& how, std::uint64_t size,
               std::uint32_t crc) {
  const Bytes bytes = packed(records, how == "zlib" ? "" : how);
  const RecordScope record(out, internal::kChunk);
  internal::put_u64(out, 0);
  internal::put_u64(out, 0);
  internal::put_u64(out, size);
  internal::put_u32(out, crc);
  internal::put_string(out, how);
  internal::put_u64(out, bytes.size());
  internal::put_bytes(out, bytes);
}

std::string transform(std::int64_t ms, const std::string& child, double x,
                      const std::string& parent = "lab") {
  return fmt::format(R"({{"timestamp":{{"sec":5,"nsec":{}}},"parent_frame_id":"{}","child_frame_id":"{}",)"
                     R"("translation":{{"x":{},"y":2,"z":-0.5}},"rotation":{{"x":0,"y":0,"z":0,"w":1}}}})",
                     ms * 1'000'000, parent, child, x);
}

/// Frames of 100 Hz of two points, as the transforms of a tree.
Bytes transforms() {
  Bytes out;
  put_channel(out, 1, "/tf", "foxglove.FrameTransform");
  for (int f = 0; f < 10; ++f)
    for (const char* child : {"LASI", "RASI"}) put_message(out, 1, 77, transform(10 * f, child, 0.01 * f));
  return out;
}

Bytes whole(const Bytes& records) {
  Bytes out;
  put_header(out);
  internal::put_bytes(out, records);
  put_end(out);
  return out;
}

Result<data::Trial> read(const Bytes& bytes) { return read_mcap_markers(MemorySource(bytes, "m.mcap")); }

data::Trial good(const Bytes& bytes) {
  auto trial = read(bytes);
  EXPECT_TRUE(trial) << trial.error().message;
  if (!trial) return {};
  EXPECT_TRUE(trial->validate());
  return std::move(*trial);
}

std::string bad(const Bytes& bytes, Code code = Code::bad_input) {
  const auto trial = read(bytes);
  EXPECT_FALSE(trial);
  if (trial) return "";
  EXPECT_EQ(trial.error().code, code);
  EXPECT_EQ(trial.error().message.find('\n'), std::string::npos) << "one sentence";
  EXPECT_TRUE(trial.error().message.starts_with("m.mcap: "));
  return trial.error().message;
}

TEST(McapMarkers, TransformsArePointsOnTheirOwnTimes) {
  const auto trial = good(whole(transforms()));
  EXPECT_EQ(trial.format, "MCAP");
  EXPECT_EQ(trial.software, "judge 1.0");
  EXPECT_THAT(trial.markers.names, ElementsAre("LASI", "RASI"));
  EXPECT_NEAR(trial.markers.time.rate_hz, 100.0, 1e-9);
  ASSERT_EQ(trial.markers.frames(), 10);
  EXPECT_EQ(trial.markers.x(9, 1), Eigen::Vector3d(0.09, 2, -0.5));
  EXPECT_THAT(trial.warnings, IsEmpty());
}

TEST(McapMarkers, ChunksArePackedInThreeWays) {
  const Bytes records = transforms();
  for (const std::string how : {"", "zstd", "lz4"}) {
    Bytes file;
    put_header(file);
    put_chunk(file, records, how, records.size(), internal::crc32(records));
    put_end(file);
    EXPECT_EQ(good(file).markers.x_in_world, good(whole(records)).markers.x_in_world) << how;
  }
}

TEST(McapMarkers, EverySchemaGivesItsPoints) {
  const std::string at = R"("timestamp":{"sec":5,"nsec":0},"frame_id":"lab")";
  const std::string pose = R"({"position":{"x":1,"y":2,"z":3}})";
  const std::vector<std::tuple<std::string, std::string, std::vector<std::string>>> cases = {
      {"PoseInFrame", "{" + at + R"(,"pose":)" + pose + "}", {"wand"}},
      {"PosesInFrame", "{" + at + R"(,"poses":[)" + pose + "," + pose + "]}", {"wand_1", "wand_2"}},
      {"FrameTransforms",
       R"({"transforms":[)" + transform(0, "A", 1) + "," + transform(0, "B", 1) + "]}",
       {"A", "B"}},
      {"SceneUpdate",
       R"({"deletions":[],"entities":[{)" + at + R"(,"id":"C7","spheres":[{"pose":)" + pose + "}]},{" + at +
           R"(,"id":"hand","spheres":[{"pose":)" + pose + R"(}],"cubes":[{"pose":)" + pose + "}]}]}",
       {"C7", "hand_1", "hand_2"}},
      {"Point3", R"({"x":1,"y":2,"z":3})", {"wand"}}};
  for (const auto& [schema, message, names] : cases) {
    Bytes records;
    put_channel(records, 3, "/wand", "foxglove." + schema);
    put_message(records, 3, 5'000'000'000, message);
    std::string later = message;
    for (auto p = later.find("\"nsec\":0"); p != std::string::npos; p = later.find("\"nsec\":0,", p + 1))
      later.replace(p, 8, "\"nsec\":20000000");
    put_message(records, 3, 5'020'000'000, later);
    const auto trial = good(whole(records));
    EXPECT_EQ(trial.markers.names, names) << schema;
    EXPECT_EQ(trial.markers.frames(), 2) << schema;
    EXPECT_EQ(trial.markers.x(1, 0).y(), 2.0) << schema;
  }
}

TEST(McapMarkers, GapsAndNullsAreMissing) {
  Bytes records;
  put_channel(records, 1, "/tf", "foxglove.FrameTransform");
  for (int f : {0, 1, 2, 3, 4, 5, 9, 10, 11, 12}) {
    put_message(records, 1, 0, transform(10 * f, "A", 0.1));
    std::string none = transform(10 * f, "B", 7);
    if (f == 2) none.replace(none.find("\"x\":7"), 5, "\"x\":null");
    put_message(records, 1, 0, none);
  }
  const auto trial = good(whole(records));
  ASSERT_EQ(trial.markers.frames(), 13);
  EXPECT_FALSE(trial.markers.present(7, 0));
  EXPECT_FALSE(trial.markers.present(2, 1));
  EXPECT_TRUE(trial.markers.present(2, 0));
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("no sample of 'A' in 3 frames (longest gap")));
}

TEST(McapMarkers, SlowerPointsBelongToTheNearestFrame) {
  Bytes records;
  put_channel(records, 1, "/tf", "foxglove.FrameTransform");
  for (int f = 0; f < 20; ++f) put_message(records, 1, 0, transform(10 * f, "A", 0.1));
  for (int f = 0; f < 5; ++f) put_message(records, 1, 0, transform(40 * f + 2, "B", 0.01 * f));
  put_message(records, 1, 0, transform(900, "B", 9));
  const auto trial = good(whole(records));
  ASSERT_EQ(trial.markers.frames(), 20);
  EXPECT_EQ(trial.markers.x(8, 1).x(), 0.02);
  EXPECT_FALSE(trial.markers.present(9, 1));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("5 samples are taken to the nearest frame of 'A'")));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 sample left out that no frame of 'A' is near")));
}

TEST(McapMarkers, WhatIsNotReadIsNamed) {
  Bytes records = transforms();
  put_channel(records, 2, "/camera", "foxglove.CompressedImage", "protobuf");
  put_message(records, 2, 0, "\x01");
  put_message(records, 1, 0, transform(0, "tip", 1, "hand"));
  put_message(records, 1, 0, transform(0, "LASI", 5));
  const auto trial = good(whole(records));
  EXPECT_THAT(trial.markers.names, ElementsAre("LASI", "RASI"));
  EXPECT_THAT(trial.warnings, Contains("points in other axes than 'lab' are left out: 1 point in 'hand'"));
  EXPECT_THAT(trial.warnings,
              Contains("a channel is left out: /camera (protobuf, foxglove.CompressedImage)"));
  EXPECT_THAT(trial.warnings,
              Contains(HasSubstr("1 sample left out that another of the same point and time")));
  EXPECT_EQ(trial.markers.x(0, 0).x(), 0.0) << "the first of two";
}

TEST(McapMarkers, AFileThatWasNotClosedIsReadUpToItsEnd) {
  Bytes file = whole(transforms());
  file.resize(file.size() - internal::kDataEndBytes);
  EXPECT_THAT(good(file).warnings, ElementsAre(HasSubstr("it was not closed")));
  file.resize(file.size() - 10);
  const auto cut = good(file);
  EXPECT_THAT(cut.warnings, Contains(HasSubstr("the file ends within the record at byte")));
  EXPECT_FALSE(cut.markers.present(9, 1));
}

TEST(McapMarkers, SaysWhatIsWrong) {
  EXPECT_THAT(bad({}), HasSubstr("does not begin as an MCAP file does"));
  Bytes ours;
  put_header(ours, "kinemark");
  put_end(ours);
  EXPECT_THAT(bad(ours, Code::not_supported), HasSubstr("kinemark reconstruct makes them"));
  EXPECT_THAT(bad(whole({}), Code::not_supported), HasSubstr("its channels: none with messages"));
  Bytes records;
  put_channel(records, 1, "/tf", "foxglove.FrameTransform", "protobuf");
  put_message(records, 1, 0, "x");
  EXPECT_THAT(bad(whole(records), Code::not_supported),
              HasSubstr("its channels: /tf (protobuf, foxglove.FrameTransform)"));
  records = transforms();
  put_message(records, 1, 0, "{\"timestamp\":");
  EXPECT_THAT(bad(whole(records)), HasSubstr("a message of '/tf' is no object of JSON"));
  records = transforms();
  put_message(records, 9, 0, "{}");
  EXPECT_THAT(bad(whole(records)), HasSubstr("a message is of channel 9, which is not there"));
  records.clear();
  put_channel(records, 1, "/tf", "foxglove.FrameTransform");
  put_message(records, 1, 0, transform(0, "A", 1));
  EXPECT_THAT(bad(whole(records)), HasSubstr("point 'A'")) << "one sample has no rate";
}

TEST(McapMarkers, DamagedChunksAreRefused) {
  const Bytes records = transforms();
  const auto chunk = [&](const std::string& how, std::uint64_t size, std::uint32_t crc) {
    Bytes file;
    put_header(file);
    put_chunk(file, records, how, size, crc);
    return file;
  };
  EXPECT_THAT(bad(chunk("zstd", records.size(), 1)), HasSubstr("a chunk does not match its checksum"));
  EXPECT_THAT(bad(chunk("zstd", records.size() + 1, 0)), HasSubstr("a chunk of zstd cannot be unpacked"));
  EXPECT_THAT(bad(chunk("lz4", records.size() + 1, 0)), HasSubstr("a chunk of lz4 cannot be unpacked"));
  EXPECT_THAT(bad(chunk("zstd", 1ULL << 40, 0)), HasSubstr("more than is believed"));
  EXPECT_THAT(bad(chunk("zlib", records.size(), 0), Code::not_supported),
              HasSubstr("compressed with 'zlib'"));
  Bytes nested;
  put_chunk(nested, records, "", records.size(), 0);
  Bytes file;
  put_header(file);
  put_chunk(file, nested, "", nested.size(), 0);
  EXPECT_THAT(bad(file), HasSubstr("a chunk is in a chunk"));
}

TEST(McapMarkers, ItsBeginTellsWhoseItIs) {
  const auto begin = [](const std::string& profile) {
    Bytes out;
    put_header(out, profile);
    return std::string(reinterpret_cast<const char*>(out.data()), out.size());
  };
  EXPECT_TRUE(is_mcap_of_others(begin("")));
  EXPECT_TRUE(is_mcap_of_others(begin("ros2")));
  EXPECT_FALSE(is_mcap_of_others(begin("kinemark")));
  EXPECT_TRUE(is_mcap(begin("kinemark")));
  EXPECT_FALSE(is_mcap("PathFileType"));
  EXPECT_FALSE(is_mcap_of_others(begin("").substr(0, 12)));
}

}  // namespace
}  // namespace kinemark::io
