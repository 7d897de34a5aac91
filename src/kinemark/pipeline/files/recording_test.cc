// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "kinemark/workflow/prepare/screen_axes.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Edit;
using data::EditKind;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class RecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_markers(path_, trajectory::testing::moving_trial(), false));
    trial_ = io::read_markers(path_).value();
  }
  void append(const Edit& edit) {
    auto journal = io::EditJournal::open(io::edits_of(path_), io::identify_recording(path_).value());
    ASSERT_TRUE(journal) << journal.error().message;
    ASSERT_TRUE(journal->append(edit));
  }
  [[nodiscard]] Result<Recording> open(const RecordingOptions& options = {}) const {
    return open_recording({.path = path_}, options);
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "walk.c3d";
  data::Trial trial_;
};

TEST_F(RecordingTest, IsAsItsFileHasItWhereNothingIsAskedFor) {
  const auto recording = open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->trial.markers.names, trial_.markers.names);
  EXPECT_EQ(recording->trial.markers.frames(), trial_.markers.frames());
  EXPECT_THAT(recording->notes, IsEmpty());
  EXPECT_TRUE(recording->rate_known);
  EXPECT_FALSE(recording->plates);
}

TEST_F(RecordingTest, ForcesOfATableStandForThoseOfPlates) {
  const auto& time = trial_.markers.time;
  std::string text = "ground reactions\nendheader\ntime";
  for (const char* name : {"v", "p"})
    for (const char axis : {'x', 'y', 'z'}) text += std::string("\tground_force_") + name + axis;
  for (std::int64_t f = 0; f < time.frames; ++f)
    text += "\n" + std::to_string(time.time_s(f)) + "\t0\t0\t" + std::to_string(100 + f) + "\t0.1\t0.2\t0";
  ASSERT_TRUE(io::write_text(scratch_ / "grf.mot", text + "\n", false));
  RecordingOptions part;
  part.selection.first_time_s = time.time_s(3) - 1e-4;
  const auto recording =
      open_recording({.path = path_, .plates = true, .forces = scratch_ / "grf.mot"}, part);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_TRUE(recording->plates);
  EXPECT_EQ(recording->plates->time, recording->trial.markers.time);
  EXPECT_NEAR(recording->plates->items.at(0).force[2], 103.0, 1e-3);
  EXPECT_THAT(recording->notes, Contains(HasSubstr("forces are those of ")));
  ASSERT_EQ(recording->forces.size(), 1U);
  EXPECT_EQ(recording->forces[0].role, "forces");
  const auto own = open_recording({.path = path_, .plates = true}, {});
  EXPECT_FALSE(own->plates);
  EXPECT_THAT(own->notes, Not(Contains(HasSubstr("forces are those of "))));
  EXPECT_EQ(open_recording({.path = path_, .plates = true, .forces = scratch_ / "none.mot"}, {}).error().code,
            Code::io);
}

TEST_F(RecordingTest, TheJournalBesideItIsAppliedUnlessThatIsRefused) {
  append({.kind = EditKind::relabel, .marker = "RKNE", .other = "KNEE"});
  const auto edited = open();
  ASSERT_TRUE(edited) << edited.error().message;
  EXPECT_GE(edited->trial.markers.find("KNEE"), 0);
  EXPECT_THAT(edited->notes, Contains(HasSubstr("1 edit of")));
  EXPECT_EQ(edited->edits.in_force, 1U);
  for (const char* none : {"none", ""}) {
    const auto raw = open({.edits = none});
    EXPECT_LT(raw->trial.markers.find("KNEE"), 0);
    EXPECT_THAT(raw->notes, IsEmpty());
  }
}

TEST_F(RecordingTest, AJournalOfAnotherRecordingIsRefusedWithTheWayOut) {
  append({.kind = EditKind::cut, .marker = "RKNE"});
  trial_.markers.x(0, 0).x() += 1.0;
  ASSERT_TRUE(io::write_markers(path_, trial_, true));
  const auto refused = open();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("--edits none passes the journal over"));
  const auto named = open({.edits = io::edits_of(path_)});
  ASSERT_FALSE(named);
  EXPECT_THAT(named.error().message, Not(HasSubstr("--edits none")));
  EXPECT_TRUE(open({.edits = io::kEditsNone}));
}

TEST_F(RecordingTest, AJournalThatNamesAnotherFileIsLeftToIt) {
  append({.kind = EditKind::cut, .marker = "RKNE"});
  ASSERT_TRUE(io::write_markers(scratch_ / "walk.trc", trial_, false));
  const auto other = open_recording({.path = scratch_ / "walk.trc"}, {});
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(other->edits.in_force, 0U);
  EXPECT_THAT(other->notes, ElementsAre(HasSubstr("walk_edits.jsonl is of 'walk.c3d' and is not applied")));
  EXPECT_THAT(open()->notes, Not(Contains(HasSubstr("' and is not applied"))));
  // By name it is asked for, and refused.
  EXPECT_FALSE(open_recording({.path = scratch_ / "walk.trc"}, {.edits = io::edits_of(path_)}));
}

TEST_F(RecordingTest, EditsComeBeforeNamesAndFramesAndTheseBeforeTheRotation) {
  append({.kind = EditKind::relabel, .marker = "RKNE", .other = "KNEE"});
  const auto first = trial_.first_frame;
  RecordingOptions options;
  options.selection.select = {"KNEE"};
  options.selection.rename = {"KNEE=K"};
  options.selection.frames = std::to_string(first + 2) + "-" + std::to_string(first + 5);
  options.axes.rotate = "x -90";
  const auto recording = open(options);
  ASSERT_TRUE(recording) << recording.error().message;
  const auto& markers = recording->trial.markers;
  EXPECT_THAT(markers.names, ElementsAre("K"));
  EXPECT_EQ(markers.frames(), 4);
  EXPECT_EQ(recording->trial.first_frame, first + 2);
  const Vector3d before = trial_.markers.x(2, trial_.markers.find("RKNE")), after = markers.x(0, 0);
  EXPECT_TRUE(after.isApprox(Vector3d(before.x(), before.z(), -before.y()), 1e-6));
  EXPECT_THAT(recording->notes, Contains(HasSubstr("the recording was turned: x -90")));
}

TEST_F(RecordingTest, AJobThatTurnsItselfGetsItAsItLies) {
  RecordingOptions options;
  options.axes.rotate = "x -90";
  const auto recording = open_recording({.path = path_, .turns = false}, options);
  ASSERT_TRUE(recording);
  EXPECT_EQ(Vector3d(recording->trial.markers.x(0, 0)), Vector3d(trial_.markers.x(0, 0)));
  EXPECT_THAT(recording->notes, Not(Contains(HasSubstr("the recording was turned: "))));
}

TEST_F(RecordingTest, AStatedVerticalGoesIntoTheRecordingAndIsHeldAgainstThePlates) {
  RecordingOptions options;
  options.axes.up = "y";
  const auto recording = open(options);
  ASSERT_TRUE(recording);
  EXPECT_EQ(workflow::screen_up(recording->trial), Vector3d::UnitY());
  EXPECT_EQ(workflow::stated_vertical(options.axes)->from, "--up");
  options.axes.up = "auto";
  EXPECT_FALSE(workflow::stated_vertical(options.axes));

  auto& plate = trial_.force_plates.emplace_back();
  plate.type = 2;
  for (int i = 0; i < 6; ++i) {
    trial_.analog.names.push_back("F" + std::to_string(i));
    trial_.analog.units.emplace_back(i < 3 ? "N" : "Nmm");
    plate.channel_idx.push_back(i);
  }
  trial_.analog.rate_hz = trial_.markers.time.rate_hz;
  trial_.analog.samples = trial_.markers.frames();
  trial_.analog.values.assign(static_cast<std::size_t>(6 * trial_.analog.samples), 0.0);
  plate.corners_in_world = {
      Vector3d(0.2, 0.3, -9.0), {-0.2, 0.3, -9.0}, {-0.2, -0.3, -9.0}, {0.2, -0.3, -9.0}};
  ASSERT_TRUE(io::write_markers(path_, trial_, true));
  for (const char* up : {"z", "y"}) {
    options.axes.up = up;
    const auto standing = open(options);
    ASSERT_TRUE(standing) << standing.error().message;
    if (*up == 'z')
      EXPECT_THAT(standing->notes, Not(Contains(HasSubstr("--up says that "))));
    else
      EXPECT_THAT(standing->notes, Contains(HasSubstr("--up says that ")));
  }
}

TEST_F(RecordingTest, WhatMakesNoSenseIsRefusedBeforeAnythingIsRead) {
  const auto refused = [](const RecordingOptions& options) {
    const auto recording = open_recording({.path = "not_there.c3d"}, options);
    return recording || recording.error().code != Code::usage ? std::string("not refused")
                                                              : recording.error().message;
  };
  EXPECT_THAT(refused({.rate_hz = -1.0}), HasSubstr("--rate is -1 Hz"));
  EXPECT_THAT(refused({.selection = {.frames = "9-2"}}), HasSubstr("'9-2' is no range of frames"));
  EXPECT_THAT(refused({.axes = {.up = "w"}}), HasSubstr("--up: 'w' is not x, y, z"));
  EXPECT_THAT(refused({.axes = {.rotate = "x ninety"}}), HasSubstr("--rotate:"));
  EXPECT_THAT(refused({.axes = {.up = "z", .rotate = "x 90"}}), HasSubstr("give one of them"));
  EXPECT_EQ(refused({}), "not refused");
}

TEST(RecordingOptions, SayWhatBecomesOfDoubtfulSamples) {
  EXPECT_EQ(parse_doubtful("drop").value(), Doubtful::drop);
  EXPECT_EQ(to_string(parse_doubtful("keep").value()), "keep");
  EXPECT_THAT(parse_doubtful("perhaps").error().message, HasSubstr("'perhaps' is not drop or keep"));
  EXPECT_TRUE(RecordingOptions{}.drops_doubtful(true));
  EXPECT_FALSE(RecordingOptions{}.drops_doubtful(false));
  EXPECT_FALSE(RecordingOptions{.doubtful = Doubtful::keep}.drops_doubtful(true));
  EXPECT_TRUE(RecordingOptions{}.empty());
  EXPECT_TRUE(RecordingOptions{.edits = io::kEditsNone}.empty());
  EXPECT_FALSE(RecordingOptions{.edits = "b.jsonl"}.empty());
}

TEST(RecordingOptions, NameTheFilesThatAreRead) {
  EXPECT_THAT(files_of("a/walk.c3d", {}), ElementsAre("a/walk.c3d", "a/walk_edits.jsonl"));
  EXPECT_THAT(files_of("a/walk.c3d", {.edits = io::kEditsNone}), ElementsAre("a/walk.c3d"));
  EXPECT_THAT(files_of("a/walk.c3d", {.edits = "b.jsonl"}), ElementsAre("a/walk.c3d", "b.jsonl"));
  const testing_support::ScratchFolder scratch;
  for (const char* name : {"01.asf", "01_02.amc", "sub-1_task-w_tracksys-o_channels.tsv",
                           "sub-1_task-w_tracksys-o_motion.json", "sub-1_task-w_tracksys-o_motion.tsv"})
    ASSERT_TRUE(io::write_text(scratch / name, "x", false));
  EXPECT_THAT(files_of(scratch / "01_02.amc", {.edits = io::kEditsNone}),
              ElementsAre(scratch / "01_02.amc", scratch / "01.asf"));
  const auto motion = scratch / "sub-1_task-w_tracksys-o_motion.tsv";
  EXPECT_THAT(files_of(motion, {.edits = io::kEditsNone}),
              ElementsAre(motion, scratch / "sub-1_task-w_tracksys-o_channels.tsv",
                          scratch / "sub-1_task-w_tracksys-o_motion.json"));
}

TEST(RecordingOptions, AJournalIsOfOneRecording) {
  EXPECT_TRUE(check_for_several({}));
  EXPECT_TRUE(check_for_several({.edits = io::kEditsNone}));
  EXPECT_THAT(check_for_several({.edits = "b.jsonl"}).error().message,
              HasSubstr("--edits: b.jsonl is of one recording; need 'beside' or 'none' with several"));
}

}  // namespace
}  // namespace kinemark::pipeline
