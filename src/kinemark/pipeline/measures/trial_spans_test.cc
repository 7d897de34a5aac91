// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/trial_spans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr TimeBase kTime{.rate_hz = 100.0, .t0_s = 2.0, .frames = 1001, .first_number = 1};

data::IntervalTable table_of(const std::vector<std::array<double, 2>>& spans) {
  data::IntervalTable out{.name = "trials", .rows = {}};
  for (const auto& [start_s, stop_s] : spans)
    out.rows.push_back({.start_s = start_s,
                        .stop_s = stop_s,
                        .labels = {{"side", start_s < 5.0 ? "left" : "right"}, {"load", "2"}}});
  return out;
}

TEST(TrialSpans, AreFramesNearestToTheTimes) {
  const auto spans = spans_of(table_of({{2.0, 3.004}, {6.0, 12.0}}), kTime);
  ASSERT_EQ(spans.regions.size(), 2U);
  EXPECT_EQ(spans.regions[0].name, "trial 1");
  EXPECT_EQ(spans.regions[0].first_frame, 1);
  EXPECT_EQ(spans.regions[0].last_frame, 101);
  EXPECT_EQ(spans.regions[1].last_frame, 1001);
  EXPECT_THAT(spans.labels.columns, ElementsAre("side", "load"));
  EXPECT_THAT(spans.labels.cells.at("trial 2"), ElementsAre("right", "2"));
  EXPECT_THAT(spans.notes,
              ElementsAre("each of 2 trials of the file is measured (--trials none: the whole recording)"));
  EXPECT_THAT(spans.notes, Not(Contains(HasSubstr("are not wholly in the recording and not measured"))));
}

TEST(TrialSpans, ThoseThatLeaveTheRecordingAreCounted) {
  const auto spans = spans_of(table_of({{1.0, 3.0}, {4.0, 5.0}, {11.0, 13.0}}), kTime);
  ASSERT_EQ(spans.regions.size(), 1U);
  EXPECT_EQ(spans.regions[0].name, "trial 2") << "its number is that of the file";
  EXPECT_THAT(spans.notes.back(),
              HasSubstr("2 of 3 trials are not wholly in the recording and not measured"));
  EXPECT_THAT(spans_of(table_of({}), kTime).notes,
              Not(Contains(HasSubstr("of the file is measured (--trials none: the whole recording)"))));
}

TEST(TrialSpans, ShortOnesAndThoseWithoutTimesAreCountedApart) {
  const auto spans = spans_of(table_of({{2.0, 3.0}, {4.0, 4.004}, {5.0, kNaN}, {kNaN, 7.0}}), kTime);
  ASSERT_EQ(spans.regions.size(), 1U);
  EXPECT_THAT(spans.notes, Contains("1 of 4 trials are shorter than a frame and not measured"));
  EXPECT_THAT(spans.notes, Contains("2 of 4 trials have no start or no stop and are not measured"));
  EXPECT_THAT(spans.notes, Not(Contains(HasSubstr("are not wholly in the recording and not measured"))));
  const auto whole = spans_of(table_of({{2.0, 3.0}, {11.0, 13.0}}), kTime);
  EXPECT_THAT(whole.notes, Not(Contains(HasSubstr("are shorter than a frame and not measured"))));
  EXPECT_THAT(whole.notes, Not(Contains(HasSubstr("have no start or no stop and are not measured"))));
}

TEST(TrialSpans, OnlyAnNwbHasThem) {
  const auto none = trial_spans("walk.c3d", "", kTime);
  ASSERT_TRUE(none);
  EXPECT_THAT(none->regions, IsEmpty());
  EXPECT_THAT(none->notes, Not(Contains(HasSubstr("trials are not looked for: "))));
  const auto named = trial_spans("walk.c3d", "trials", kTime);
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().code, Code::usage);
  EXPECT_THAT(named.error().message, HasSubstr("walk.c3d is no .nwb and has no intervals"));
  EXPECT_TRUE(trial_spans("absent.nwb", "none", kTime)) << "the file is not looked at";
}

TEST(TrialSpans, AFaultOfTheFileIsANoteUnlessTrialsAreAskedFor) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "no.nwb", "no HDF5", false));
  const auto by_itself = trial_spans(scratch / "no.nwb", "", kTime);
  ASSERT_TRUE(by_itself);
  EXPECT_THAT(by_itself->notes, ElementsAre(HasSubstr("trials are not looked for: ")));
  const auto asked = trial_spans(scratch / "no.nwb", "trials", kTime);
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, Code::bad_input);
}

TEST(TrialSpans, ATableThatIsNotThereIsNamed) {
  const testing_support::ScratchFolder scratch;
  const auto markers = data::Trajectories::all_missing({"a"}, {.rate_hz = 100.0, .frames = 10});
  const auto write = [&](const char* name, const data::Neural& neural) {
    auto writer = io::NwbWriter::create(scratch / name, io::NwbOutline::of(markers, nullptr));
    ASSERT_TRUE(writer && writer->write(markers) && writer->write_neural(neural, {}) && writer->commit());
  };
  data::Neural with;
  with.intervals = {table_of({{2.0, 3.0}})};
  write("with.nwb", with);
  write("without.nwb", {});
  const auto fault = [&](const char* file, const char* name) {
    const auto spans = trial_spans(scratch / file, name, kTime);
    return spans ? "" : spans.error().message;
  };
  EXPECT_THAT(fault("with.nwb", "trails"), HasSubstr("there are no intervals 'trails'; nearest: trials"));
  EXPECT_THAT(fault("with.nwb", "trails"), Not(HasSubstr("the file has none")));
  EXPECT_THAT(fault("without.nwb", "trials"), HasSubstr("the file has none"));
  EXPECT_EQ(fault("with.nwb", "trials"), "");
  EXPECT_EQ(fault("without.nwb", ""), "");
}

TEST(SpanColumns, AreThoseOfAllRecordingsOfATable) {
  RecordingName one{.spans = {.columns = {"side"}, .cells = {{"trial 1", {"left"}}}}};
  RecordingName two{.spans = {.columns = {"load", "side"}, .cells = {{"trial 1", {"2", "right"}}}}};
  unite_span_columns({&one, &two});
  EXPECT_EQ(span_columns(one), ",side,load");
  EXPECT_EQ(span_cells(one, "trial 1"), ",left,");
  EXPECT_EQ(span_cells(two, "trial 1"), ",right,2");
  EXPECT_EQ(span_cells(two, "elsewhere"), ",,");
  name_apart(one.spans, "file,side,value");
  EXPECT_EQ(span_columns(one), ",span_side,load");
}

}  // namespace
}  // namespace kinemark::pipeline
