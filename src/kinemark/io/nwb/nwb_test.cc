// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/nwb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/check.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::sample_derivatives;
using testing::sample_metadata;
using testing::sample_trajectories;

void expect_same(const std::vector<data::FilterUsed>& got, const std::vector<data::FilterUsed>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t m = 0; m < wanted.size(); ++m) {
    EXPECT_EQ(got[m].method, wanted[m].method);
    EXPECT_EQ(got[m].order, wanted[m].order);
    EXPECT_THAT(got[m].cutoff_hz, ::testing::NanSensitiveDoubleEq(wanted[m].cutoff_hz));
    EXPECT_THAT(got[m].noise_sd_m, ::testing::NanSensitiveDoubleEq(wanted[m].noise_sd_m));
  }
}

void expect_same(const data::Trajectories& got, const data::Trajectories& wanted) {
  EXPECT_EQ(got.names, wanted.names);
  EXPECT_EQ(got.time, wanted.time);
  EXPECT_TRUE(testing::same_bits(got.x_in_world, wanted.x_in_world));
  EXPECT_EQ(got.state, wanted.state);
  EXPECT_TRUE(testing::same_bits(got.covariance, wanted.covariance));
  EXPECT_TRUE(testing::same_bits(got.sample_offset_s, wanted.sample_offset_s));
  EXPECT_EQ(got.methods, wanted.methods);
  EXPECT_EQ(got.method, wanted.method);
  EXPECT_TRUE(testing::same_bits(got.unfiltered_in_world, wanted.unfiltered_in_world));
  expect_same(got.filters, wanted.filters);
}

void expect_same(const data::Derivatives& got, const data::Derivatives& wanted) {
  for (const internal::Rate& rate : internal::kRates)
    EXPECT_TRUE(testing::same_bits(got.*rate.values, wanted.*rate.values)) << rate.container;
  expect_same(got.filters, wanted.filters);
}

TEST(Nwb, EverythingComesBackBitByBit) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  const auto d = sample_derivatives(t);
  ASSERT_TRUE(t.validate());
  const auto written = write_nwb(scratch / "a.nwb", t, &d, sample_metadata());
  ASSERT_TRUE(written) << written.error().message;
  const auto back = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(back) << back.error().message;
  expect_same(back->trial.markers, t);
  ASSERT_TRUE(back->derivatives);
  expect_same(*back->derivatives, d);
  EXPECT_THAT(back->warnings, ElementsAre());
}

TEST(Nwb, MetadataComeBack) {
  const testing_support::ScratchFolder scratch;
  const auto wanted = sample_metadata();
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", sample_trajectories(), nullptr, wanted));
  const NwbMetadata got = read_nwb(scratch / "a.nwb").value().metadata;
  EXPECT_EQ(got.identifier, wanted.identifier);
  EXPECT_EQ(got.session_description, wanted.session_description);
  EXPECT_EQ(got.session_start, wanted.session_start);
  EXPECT_EQ(got.created, wanted.created);
  EXPECT_EQ(got.reference_frame, wanted.reference_frame);
  EXPECT_EQ(got.subject_id, wanted.subject_id);
  EXPECT_EQ(got.species, wanted.species);
  EXPECT_EQ(got.sex, wanted.sex);
  EXPECT_EQ(got.age, wanted.age);
  EXPECT_EQ(got.software, wanted.software);
  EXPECT_EQ(got.version, wanted.version);
  EXPECT_EQ(got.command, wanted.command);
  EXPECT_EQ(got.options, wanted.options);
  EXPECT_EQ(got.seed, wanted.seed);
  ASSERT_EQ(got.sources.size(), 2U);
  EXPECT_EQ(got.sources[0].file, wanted.sources[0].file);
  EXPECT_EQ(got.sources[0].bytes, wanted.sources[0].bytes);
  EXPECT_EQ(got.sources[0].xxh3, wanted.sources[0].xxh3);
  EXPECT_EQ(got.sources[1].xxh3, "");
}

TEST(Nwb, WhatIsNotThereStaysAbsent) {
  const testing_support::ScratchFolder scratch;
  auto t = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1});
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", t));
  const auto back = read_nwb(scratch / "a.nwb").value();
  expect_same(back.trial.markers, t);
  EXPECT_FALSE(back.derivatives);
  EXPECT_THAT(back.metadata.identifier, ::testing::StartsWith("kinemark-"));
  EXPECT_EQ(back.metadata.session_start, "") << "no date was told, none is made up";
  EXPECT_FALSE(back.metadata.seed);
}

TEST(Nwb, OffsetsOfMarkersAndFiltersWithoutDerivatives) {
  const testing_support::ScratchFolder scratch;
  auto t = sample_trajectories();
  t.sample_offset_s = {0.0, 1.0 / 3.0, 0.1, -0.002, 0.0};
  t.covariance.clear();
  data::Derivatives d;
  d.filters = sample_derivatives(t).filters;
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", t, &d));
  const auto back = read_nwb(scratch / "a.nwb").value();
  expect_same(back.trial.markers, t);
  ASSERT_TRUE(back.derivatives);
  expect_same(*back.derivatives, d);
}

TEST(Nwb, TheSameInputGivesTheSameBytes) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  const auto d = sample_derivatives(t);
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", t, &d, sample_metadata()));
  ASSERT_TRUE(write_nwb(scratch / "b.nwb", t, &d, sample_metadata()));
  EXPECT_EQ(read_text(scratch / "a.nwb").value(), read_text(scratch / "b.nwb").value());
}

TEST(Nwb, AFileAppearsWholeOrNotAtAll) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  {
    auto writer = NwbWriter::create(scratch / "a.nwb", NwbOutline::of(t, nullptr));
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE(writer->write(t));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.nwb"));
  }
  EXPECT_EQ(scratch.count_files(), 0) << "no temporary file stays";
  ASSERT_TRUE(write_text(scratch / "a.nwb", "mine", false));
  const auto refused = write_nwb(scratch / "a.nwb", t);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("a.nwb: exists already; use --force"));
  EXPECT_EQ(read_text(scratch / "a.nwb").value(), "mine");
  EXPECT_TRUE(write_nwb(scratch / "a.nwb", t, nullptr, {}, {.force = true}));
  EXPECT_TRUE(read_nwb(scratch / "a.nwb"));
  EXPECT_EQ(scratch.count_files(), 1);
}

/// Frames [first, first + n) of some markers.
data::Trajectories cut(const data::Trajectories& t, std::vector<std::int64_t> markers, std::int64_t first,
                       std::int64_t n) {
  std::vector<std::string> names;
  for (const std::int64_t m : markers) names.push_back(t.names[static_cast<std::size_t>(m)]);
  auto out = data::Trajectories::all_missing(names, t.time);
  out.time.frames = n;
  out.x_in_world.resize(static_cast<std::size_t>(3 * n * out.markers()));
  out.state.resize(static_cast<std::size_t>(n * out.markers()));
  out.covariance.resize(6 * out.state.size());
  out.unfiltered_in_world.resize(3 * out.state.size());
  for (const std::int64_t m : markers) out.filters.push_back(t.filters[static_cast<std::size_t>(m)]);
  out.sample_offset_s.resize(out.state.size());
  for (std::int64_t f = 0; f < n; ++f) {
    for (std::size_t k = 0; k < markers.size(); ++k) {
      const std::size_t from = t.index(first + f, markers[k]);
      const std::size_t to = out.index(f, static_cast<std::int64_t>(k));
      std::copy_n(t.x_in_world.data() + 3 * from, 3, out.x_in_world.data() + 3 * to);
      std::copy_n(t.covariance.data() + 6 * from, 6, out.covariance.data() + 6 * to);
      std::copy_n(t.unfiltered_in_world.data() + 3 * from, 3, out.unfiltered_in_world.data() + 3 * to);
      out.state[to] = t.state[from];
      out.sample_offset_s[to] = t.sample_offset_s[from];
      if (const auto by = t.made_by(first + f, markers[k]); !by.empty())
        out.set_method(f, static_cast<std::int64_t>(k), by);
    }
  }
  return out;
}

TEST(NwbWriter, PiecesInAnyOrderMakeTheSameRecording) {
  const testing_support::ScratchFolder scratch;
  const std::int64_t frames = 9000;  // over two chunks
  const auto t = sample_trajectories(frames);
  auto writer = NwbWriter::create(scratch / "a.nwb", NwbOutline::of(t, nullptr)).value();
  ASSERT_TRUE(writer.write(cut(t, {4, 1}, 0, frames), nullptr, 0));
  for (std::int64_t f = frames; f > 0;) {
    const std::int64_t n = std::min<std::int64_t>(f, 1000);
    f -= n;
    ASSERT_TRUE(writer.write(cut(t, {0, 2, 3}, f, n), nullptr, f));
  }
  ASSERT_TRUE(writer.commit());
  const auto back = read_nwb(scratch / "a.nwb").value().trial.markers;
  EXPECT_TRUE(testing::same_bits(back.x_in_world, t.x_in_world));
  EXPECT_TRUE(testing::same_bits(back.covariance, t.covariance));
  EXPECT_TRUE(testing::same_bits(back.sample_offset_s, t.sample_offset_s));
  EXPECT_TRUE(testing::same_bits(back.unfiltered_in_world, t.unfiltered_in_world));
  ASSERT_EQ(back.filters.size(), t.filters.size());
  for (std::size_t m = 0; m < t.filters.size(); ++m) {
    EXPECT_EQ(back.filters[m].method, t.filters[m].method);
    EXPECT_EQ(back.filters[m].order, t.filters[m].order);
  }
  EXPECT_EQ(back.state, t.state);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      ASSERT_EQ(back.made_by(f, m), t.made_by(f, m)) << "methods are numbered as they come, names stay";
}

TEST(NwbWriter, SamplesThatNobodyWroteAreMissing) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  auto writer = NwbWriter::create(scratch / "a.nwb", NwbOutline::of(t, nullptr)).value();
  ASSERT_TRUE(writer.write(cut(t, {1}, 10, 20), nullptr, 10));
  ASSERT_TRUE(writer.commit());
  const auto back = read_nwb(scratch / "a.nwb").value().trial.markers;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      EXPECT_EQ(back.state[back.index(f, m)],
                m == 1 && f >= 10 && f < 30 ? t.state[t.index(f, m)] : data::SampleState::missing);
}

TEST(NwbWriter, PiecesMustFitTheOutline) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  auto writer = NwbWriter::create(scratch / "a.nwb", NwbOutline::of(t, nullptr)).value();
  EXPECT_THROW((void)writer.write(t, nullptr, 1), ContractError) << "one frame too far";
  EXPECT_THROW((void)writer.write(t, nullptr, -1), ContractError);
  auto other = t;
  other.names[0] = "nobody";
  EXPECT_THROW((void)writer.write(other), ContractError);
  other = t;
  other.covariance.clear();
  EXPECT_THROW((void)writer.write(other), ContractError);
  other = t;
  other.sample_offset_s.clear();
  EXPECT_THROW((void)writer.write(other), ContractError);
  other = t;
  other.unfiltered_in_world.clear();
  EXPECT_THROW((void)writer.write(other), ContractError);
  other = t;
  other.filters.clear();
  EXPECT_THROW((void)writer.write(other), ContractError);
  const auto d = sample_derivatives(t);
  auto promised = NwbWriter::create(scratch / "b.nwb", NwbOutline::of(t, &d)).value();
  EXPECT_THROW((void)promised.write(t, nullptr), ContractError);
  ASSERT_TRUE(writer.commit());
  EXPECT_THROW((void)writer.commit(), ContractError);
}

TEST(Nwb, RefusesWhatNwbCannotSay) {
  const testing_support::ScratchFolder scratch;
  const auto refusal = [&](const data::Trajectories& t, const NwbMetadata& m) {
    const auto status = write_nwb(scratch / "a.nwb", t, nullptr, m);
    EXPECT_EQ(scratch.count_files(), 0);
    EXPECT_EQ(status.error().code, Code::bad_input);
    return status.error().message;
  };
  const TimeBase time{.rate_hz = 100.0, .t0_s = 0.0, .frames = 3};
  EXPECT_THAT(refusal(data::Trajectories::all_missing({}, time), {}),
              HasSubstr("a.nwb: has 0 markers and 3 frames"));
  EXPECT_THAT(refusal(data::Trajectories::all_missing({"A"}, {.rate_hz = 1.0, .t0_s = 0.0, .frames = 0}), {}),
              HasSubstr("has 1 markers and 0 frames"));
  EXPECT_THAT(refusal(data::Trajectories::all_missing({"A", "A"}, time), {}), HasSubstr("occurs twice"));
  const auto good = data::Trajectories::all_missing({"A"}, time);
  EXPECT_THAT(refusal(good, {.sex = "female"}), HasSubstr("need F, M, U or O"));
  for (const char* date : {"yesterday", "2026-11-21", "2026-11-21T09:30:00", "2026-11-21T09:30:00+1:00",
                           "2026-11-21T09:30:00.5Zulu", "2026-11-21 09:30:00Z"})
    EXPECT_THAT(refusal(good, {.session_start = date}), HasSubstr("is not a date in the form of NWB"))
        << date;
  EXPECT_EQ(write_nwb(scratch / "no" / "a.nwb", good).error().code, Code::io);
}

TEST(SeriesNames, AreAllowedInHdf5AndUnique) {
  EXPECT_THAT(internal::series_names({"a/b", "a:b", "a_b", ".", "..", "a_b_2", "x\n"}),
              ElementsAre("a_b", "a_b_2", "a_b_3", "_.", "_..", "a_b_2_2", "x_"));
}

TEST(Nwb, SamplesFromBeforeAFilterAreNoMarkersOfTheirOwn) {
  const testing_support::ScratchFolder scratch;
  const auto t = sample_trajectories();
  ASSERT_TRUE(write_nwb(scratch / "a.nwb", t));
  const auto back = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(back) << back.error().message;
  expect_same(back->trial.markers, t);
}

}  // namespace
}  // namespace kinemark::io
