// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Units, trials and field potentials of NWB files: ours as they were written, others as pynwb writes them,
// and broken ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "kinemark/io/nwb/internal/field_reader.h"
#include "kinemark/io/nwb/internal/neural_reader.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/testing/sample_session.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Column;
using internal::Handle;
using internal::Output;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(NwbNeural, ComesBackAsItWasWritten) {
  const testing_support::ScratchFolder scratch;
  const auto neural = testing::sample_neural();
  ASSERT_TRUE(testing::write_session(scratch / "s.nwb", neural, {testing::sample_field()}));
  const auto back = read_neural_lanes(scratch / "s.nwb");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->units.size(), 3U);
  for (std::size_t u = 0; u < 3; ++u) {
    EXPECT_EQ(back->units[u].id, neural.units[u].id);
    EXPECT_EQ(back->units[u].times_s, neural.units[u].times_s);
    EXPECT_EQ(back->units[u].labels[0].value, neural.units[u].labels[0].value);
    EXPECT_EQ(back->units[u].labels[1].column, "depth");
  }
  ASSERT_EQ(back->intervals.size(), 1U) << "the time without loads on plates is none";
  EXPECT_EQ(back->intervals[0].rows[1].start_s, 2.0);
  EXPECT_EQ(back->intervals[0].rows[1].labels[0].value, "right");
  const auto without = read_neural(scratch / "s.nwb");
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->units.size(), 3U);
  EXPECT_THAT(without->fields, IsEmpty()) << "potentials are read where they are drawn";
  EXPECT_EQ(back->fields.size(), 1U);
  const auto recording = read_nwb(scratch / "s.nwb");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->warnings, IsEmpty()) << "the digest holds units, references and potentials";
}

TEST(NwbNeural, PotentialsComeAsEnvelopes) {
  const testing_support::ScratchFolder scratch;
  const auto field = testing::sample_field();
  ASSERT_TRUE(testing::write_session(scratch / "s.nwb", {}, {field}));
  const auto back = read_neural_lanes(scratch / "s.nwb");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->fields.size(), 1U);
  const auto& envelope = back->fields[0];
  EXPECT_THAT(envelope.channels, ElementsAre("electrode 0", "electrode 1"));
  EXPECT_EQ(envelope.bins, internal::kFieldBins);
  EXPECT_EQ(envelope.start_s, 0.25);
  EXPECT_NEAR(envelope.bin_s * static_cast<double>(envelope.bins), 5.0, 1e-9);
  for (std::size_t k = 0; k < 2; ++k) {
    double least = 1.0, most = -1.0, low = 1.0, high = -1.0;
    for (std::size_t i = k; i < field.values.size(); i += 2)
      least = std::min(least, field.values[i]), most = std::max(most, field.values[i]);
    for (std::size_t b = k; b < envelope.low.size(); b += 2)
      low = std::min(low, envelope.low[b]), high = std::max(high, envelope.high[b]);
    EXPECT_EQ(low, least);
    EXPECT_EQ(high, most);
  }
  EXPECT_LE(envelope.low[2 * 700], envelope.high[2 * 700]);
  EXPECT_NEAR(envelope.low[2 * 700 + 1], 1e-6 * 700 * 5000 / 1500.0, 5e-6) << "in its place in time";
}

TEST(NwbNeural, AFileWithoutAnyIsEmpty) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_nwb(scratch / "s.nwb", testing::sample_trial(4)));
  const auto back = read_neural_lanes(scratch / "s.nwb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->units, IsEmpty());
  EXPECT_THAT(back->intervals, IsEmpty());
  EXPECT_THAT(back->fields, IsEmpty());
}

/// A file made by hand, and what is said of it.
std::string fault_with(const std::function<void(Output&)>& fill) {
  const testing_support::ScratchFolder scratch;
  {
    const internal::Quiet quiet;
    Output out((scratch / "f.nwb").string(), "foreign");
    out.declare(out.file(), "NWBFile");
    for (const char* name : {"/acquisition", "/intervals"}) out.group(out.file(), name);
    fill(out);
    EXPECT_TRUE(out.close());
  }
  const auto back = read_neural_lanes(scratch / "f.nwb");
  if (back) return "";
  EXPECT_EQ(back.error().code, Code::bad_input);
  return back.error().message;
}

void put_units(Output& out, std::vector<double> times, std::vector<std::int64_t> ends) {
  Column spikes{.name = "spike_times", .description = "s", .numbers = std::move(times)};
  spikes.ends = std::move(ends);
  out.table(out.file(), "units", "units", {spikes}, "Units");
}

TEST(NwbNeural, SpikesThatDoNotAscendAreRefused) {
  EXPECT_EQ(fault_with([](Output& out) { put_units(out, {0.1, 0.2, 0.1}, {2, 3}); }), "");
  EXPECT_THAT(fault_with([](Output& out) { put_units(out, {0.2, 0.1}, {2}); }),
              HasSubstr("unit 0: spike times must be numbers that ascend; 0.1 s comes after 0.2 s"));
  EXPECT_THAT(fault_with([](Output& out) { put_units(out, {0.2, kNaN}, {2}); }),
              HasSubstr("must be numbers"));
}

TEST(NwbNeural, AnIndexThatDoesNotFitIsRefused) {
  EXPECT_THAT(fault_with([](Output& out) { put_units(out, {0.1, 0.2}, {1, 5}); }),
              HasSubstr("/units/spike_times_index: holds 5 after 1; expected ends that ascend to 2"));
  EXPECT_THAT(fault_with([](Output& out) { put_units(out, {0.1, 0.2}, {2, 1}); }),
              HasSubstr("holds 1 after 2"));
}

TEST(NwbNeural, IntervalsEndAfterTheyBegin) {
  const auto put = [](double start_s, double stop_s) {
    return [=](Output& out) {
      const Handle group(H5Gopen2(out.file(), "/intervals", H5P_DEFAULT), H5Gclose);
      out.table(group.id(), "epochs", "epochs",
                {{.name = "start_time", .description = "s", .numbers = {start_s}},
                 {.name = "stop_time", .description = "s", .numbers = {stop_s}}},
                "TimeIntervals");
    };
  };
  EXPECT_EQ(fault_with(put(1.0, 2.0)), "");
  EXPECT_THAT(fault_with(put(2.0, 1.0)), HasSubstr("intervals 'epochs': one goes from 2 to 1 s"));
}

void put_series(Output& out, bool clock, double rate_hz) {
  const Handle series = out.group(out.file(), "/acquisition/raw", "ElectricalSeries");
  const Handle data = out.samples(series.id(), "data", H5T_STD_I16LE, 4, 2, 0.0, 0);
  const std::vector<double> values{1, 10, -2, 20, 3, 30, 4, 40};
  out.write(data, H5T_NATIVE_DOUBLE, 0, 4, 2, values.data());
  out.attribute(data.id(), "unit", "volts");
  out.attribute(data.id(), "conversion", 1e-6, H5T_IEEE_F32LE);
  if (!clock) return;
  const Handle start = out.number(series.id(), "starting_time", 5.0);
  out.attribute(start.id(), "rate", rate_hz, H5T_IEEE_F64LE);
}

TEST(NwbNeural, RawPotentialsAreReadWhereThereIsNoLfp) {
  const testing_support::ScratchFolder scratch;
  {
    const internal::Quiet quiet;
    Output out((scratch / "f.nwb").string(), "foreign");
    out.declare(out.file(), "NWBFile");
    out.group(out.file(), "/acquisition");
    put_series(out, true, 2.0);
    ASSERT_TRUE(out.close());
  }
  const auto back = read_neural_lanes(scratch / "f.nwb");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->fields.size(), 1U);
  EXPECT_THAT(back->fields[0].channels, ElementsAre("channel 1", "channel 2"));
  EXPECT_EQ(back->fields[0].bins, 4);
  EXPECT_DOUBLE_EQ(back->fields[0].low[2], -2e-6) << "conversion is applied";
  EXPECT_EQ(back->fields[0].bin_s, 0.5);
}

TEST(NwbNeural, ASeriesNeedsAClock) {
  EXPECT_THAT(fault_with([](Output& out) { put_series(out, false, 0.0); }),
              HasSubstr("/acquisition/raw: has neither a starting_time nor 4 timestamps"));
  EXPECT_THAT(fault_with([](Output& out) { put_series(out, true, 0.0); }), HasSubstr("runs at 0 Hz"));
}

TEST(NwbNeural, ArrivesFromTheOtherProcessOrNot) {
  const auto neural = testing::sample_neural();
  const int fd = ::memfd_create("sent", 0);
  ASSERT_TRUE(internal::send(fd, Result<data::Neural>(neural)));
  const auto length = ::lseek(fd, 0, SEEK_CUR);
  const auto again = [fd] {
    ::lseek(fd, 0, SEEK_SET);
    return internal::receive_neural(fd, 64UL << 20);
  };
  const auto whole = again();
  ASSERT_TRUE(whole && *whole);
  EXPECT_EQ((*whole)->units[0].times_s, neural.units[0].times_s);
  for (off_t cut = 0; cut < length; cut += 7) {
    ASSERT_EQ(::ftruncate(fd, cut), 0);
    EXPECT_FALSE(again());
    ASSERT_TRUE(::lseek(fd, 0, SEEK_SET) == 0 && internal::send(fd, Result<data::Neural>(neural)));
  }
  ::close(fd);
}

}  // namespace
}  // namespace kinemark::io
