// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/convert_job.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/markers/orientation_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/testing/shared_folder.h"
#include "kinemark/pipeline/testing/test_files.h"
#include "kinemark/stages/motion/foundations/testing/walking_body.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ConvertFile : public testing::SharedFolder<ConvertFile> {
 public:
  static void make_files() { testing::simulate_into(at("in")); }

 protected:
  static Result<ConvertOutcome> convert(const std::filesystem::path& in, const std::filesystem::path& out,
                                        bool force, double rate_hz = 0.0) {
    ConvertJob job;
    job.in = in;
    job.out = out;
    job.force = force;
    job.rate_hz = rate_hz;
    return run_convert(job);
  }
};

TEST_F(ConvertFile, MarkersKeepPositionsAndGapsFromC3dToTrc) {
  const auto notes = convert(at("in/markers.c3d"), at("out.trc"), false);
  ASSERT_TRUE(notes) << notes.error().message;
  EXPECT_THAT(notes->warnings, ElementsAre("reconstruction residuals cannot be stored in a .trc file"));
  EXPECT_THAT(notes->written, ElementsAre(at("out.trc")));
  const auto before = io::read_markers(at("in/markers.c3d")).value().markers;
  const auto after = io::read_markers(at("out.trc")).value().markers;
  ASSERT_EQ(after.names, before.names);
  ASSERT_EQ(after.frames(), before.frames());
  EXPECT_GT(before.count_missing(), 0);
  for (std::int64_t f = 0; f < before.frames(); ++f)
    for (std::int64_t m = 0; m < before.markers(); ++m) {
      ASSERT_EQ(after.present(f, m), before.present(f, m)) << f << ' ' << m;
      if (!before.present(f, m)) continue;
      EXPECT_LT((after.x(f, m) - before.x(f, m)).norm(), 1e-6);
    }
}

TEST_F(ConvertFile, ABodyThatIsMirroredIsWrittenAndMissesABound) {
  data::Trial trial;
  trial.markers = motion::testing::walking_body(
      {"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK", "RANK", "LHEE", "RHEE", "LTOE", "RTOE"}, 40);
  ASSERT_TRUE(io::write_markers(at("body.trc"), trial, true));
  const auto good = convert(at("body.trc"), at("good.csv"), true);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_EQ(good->exit_status(), 0);
  for (std::size_t i = 2; i < trial.markers.x_in_world.size(); i += 3) trial.markers.x_in_world[i] *= -1.0;
  ASSERT_TRUE(io::write_markers(at("mirrored.trc"), trial, true));
  const auto mirrored = convert(at("mirrored.trc"), at("mirrored.csv"), true);
  ASSERT_TRUE(mirrored) << mirrored.error().message;
  EXPECT_EQ(mirrored->exit_status(), 1);
  EXPECT_THAT(mirrored->warnings, Contains(HasSubstr("shows a mirrored body")));
  EXPECT_TRUE(std::filesystem::exists(at("mirrored.csv")));
}

TEST_F(ConvertFile, ATableThatContradictsItselfIsWrittenAndMissesABound) {
  for (const double turn : {60.0, 4000.0}) {
    data::Table table{.name = "Coordinates", .in_degrees = true, .columns = {"knee_angle_r"}};
    for (int r = 0; r < 20; ++r) {
      table.time_s.push_back(0.01 * r);
      table.values.push_back(turn * r / 19.0);
    }
    ASSERT_TRUE(io::write_table(at("turning.mot"), table, {.force = true}));
    const auto out = convert(at("turning.mot"), at("turning.sto"), true);
    ASSERT_TRUE(out) << out.error().message;
    EXPECT_EQ(out->exit_status(), turn > 1000.0 ? 1 : 0);
  }
}

TEST_F(ConvertFile, ChannelsGoFromC3dToC3dAndAreMissedElsewhere) {
  const auto trial = testing::trial_with_channel();
  ASSERT_TRUE(io::write_markers(at("channels.c3d"), trial, true));
  const auto kept = convert(at("channels.c3d"), at("again.c3d"), true);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_THAT(kept->warnings, IsEmpty());
  const auto again = io::read_markers(at("again.c3d")).value();
  EXPECT_EQ(again.channels.names, trial.channels.names);
  EXPECT_EQ(again.channels.values, trial.channels.values);
  for (const char* ending : {".trc", ".csv"}) {
    const auto lost = convert(at("channels.c3d"), at(std::string("lost") + ending), true);
    ASSERT_TRUE(lost) << lost.error().message;
    EXPECT_THAT(lost->warnings,
                Contains(HasSubstr("1 channel that is no marker (LKneeAngles) cannot be stored in a " +
                                   std::string(ending) + " file")));
  }
}

TEST_F(ConvertFile, WhatTheNewFormatCannotHoldIsSaid) {
  auto trial = io::read_markers(at("in/markers.c3d")).value();
  trial.events.push_back({.label = "Foot Strike", .context = "Left", .time_s = 0.1});
  trial.analog = {.names = {"EMG"}, .units = {"V"}, .rate_hz = 60.0, .samples = trial.markers.frames()};
  trial.analog.values.assign(static_cast<std::size_t>(trial.analog.samples), 0.25);
  ASSERT_TRUE(io::write_markers(at("rich.c3d"), trial, false));
  const auto notes = convert(at("rich.c3d"), at("poor.trc"), false).value().warnings;
  EXPECT_THAT(notes, Contains("1 analog channel cannot be stored in a .trc file"));
  EXPECT_THAT(notes, Contains("1 event cannot be stored in a .trc file"));
  const auto kept = convert(at("rich.c3d"), at("rich2.c3d"), false).value().warnings;
  EXPECT_THAT(kept, Not(Contains(HasSubstr("cannot be stored"))));
  EXPECT_EQ(io::read_markers(at("rich2.c3d")).value().events.size(), 1U);
}

TEST_F(ConvertFile, TablesAndModelsComeThroughUnchanged) {
  ASSERT_TRUE(convert(at("in/truth.mot"), at("truth.sto"), false));
  const auto before = io::read_table(at("in/truth.mot")).value();
  const auto after = io::read_table(at("truth.sto")).value();
  EXPECT_EQ(after.columns, before.columns);
  EXPECT_EQ(after.values, before.values);
  EXPECT_EQ(io::angles_are_degrees(after), io::angles_are_degrees(before));
  ASSERT_TRUE(convert(at("in/model.osim"), at("copy.OSIM"), false)) << "capital letters are fine";
  EXPECT_EQ(io::read_osim(at("copy.OSIM")).value().coordinates.size(),
            io::read_osim(at("in/model.osim")).value().coordinates.size());
}

TEST_F(ConvertFile, ATableBecomesMatAndNoneIsReadFromIt) {
  const auto made = convert(at("in/truth.mot"), at("truth.mat"), false);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_THAT(made->written, ElementsAre(at("truth.mat")));
  EXPECT_EQ(convert(at("in/truth.mot"), at("truth.mat"), false).error().code, Code::io);
  EXPECT_THAT(convert(at("truth.mat"), at("back.mot"), false).error().message,
              HasSubstr("no positions are found"));
  EXPECT_FALSE(convert(at("truth.mat"), at("back.trc"), false)) << "angles are no markers";
}

TEST_F(ConvertFile, AModelBecomesARobotAndSaysWhatThatLoses) {
  const auto as_mjcf = convert(at("in/model.osim"), at("robot.xml"), false);
  ASSERT_TRUE(as_mjcf) << as_mjcf.error().message;
  EXPECT_THAT(as_mjcf->written, ElementsAre(at("robot.xml")));
  EXPECT_THAT(as_mjcf->warnings, Not(Contains(HasSubstr("cannot be stored"))));
  const auto as_urdf = convert(at("in/model.osim"), at("robot.URDF"), false);
  ASSERT_TRUE(as_urdf) << "capital letters are fine";
  EXPECT_THAT(as_urdf->warnings, Contains(HasSubstr("cannot be stored in a .urdf file")));
  const auto again = convert(at("in/model.osim"), at("robot.xml"), false);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::io);
  EXPECT_TRUE(convert(at("in/model.osim"), at("robot.xml"), true));
}

TEST_F(ConvertFile, OnlyAModelBecomesARobotAndNoRobotIsRead) {
  for (const char* in : {"in/markers.c3d", "in/truth.mot"}) {
    const auto refused = convert(at(in), at("no.urdf"), false);
    ASSERT_FALSE(refused) << in;
    EXPECT_EQ(refused.error().code, Code::usage) << in;
  }
  ASSERT_TRUE(convert(at("in/model.osim"), at("read.mjcf"), true));
  const auto back = convert(at("read.mjcf"), at("back.urdf"), false);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, Code::usage);
  EXPECT_FALSE(std::filesystem::exists(at("no.urdf")) || std::filesystem::exists(at("back.urdf")));
}

TEST_F(ConvertFile, OrientationsGoWhereTheyAreAskedFor) {
  const std::string text =
      "NO_OF_FRAMES\t2\nNO_OF_BODIES\t1\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_NAMES\tstick\n"
      "100\t200\t300\t0\t0\t0\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n"
      "0.000\t0.000\t0.000\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\n";
  ASSERT_TRUE(io::write_text(at("bodies.tsv"), text, true));
  ConvertJob job;
  job.in = at("bodies.tsv");
  job.out = at("bodies.sto");
  job.force = true;
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("are written with --orientations"));
  job.orientations = true;
  ASSERT_TRUE(run_convert(job)) << run_convert(job).error().message;
  const auto turned = io::read_orientation_file(at("bodies.sto")).value();
  EXPECT_THAT(turned.names, ElementsAre("stick"));
  ASSERT_EQ(turned.frames(), 2);
  EXPECT_TRUE((turned.rotation(0, 0) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_FALSE(turned.present(1, 0));
  // A table of them holds nothing else.
  ASSERT_TRUE(convert(at("bodies.sto"), at("again.csv"), true));
  EXPECT_EQ(io::read_orientation_file(at("again.csv")).value().frames(), 2);

  job.out = at("bodies.trc");
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("written as .sto (OpenSense, for 'kinemark ik"));
  job.out = at("other.sto");
  job.rate_hz = 50.0;
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("orientations are written as they are"));
  job.rate_hz = 0.0;
  job.in = at("in/markers.c3d");
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("ROTATION"));
  job.in = at("in/model.osim");
  EXPECT_EQ(run_convert(job).error().code, Code::not_supported);
  job.in = job.out = at("bodies.sto");
  EXPECT_EQ(run_convert(job).error().code, Code::usage) << "onto itself";
}

TEST_F(ConvertFile, DifferentKindsAreAMisuse) {
  ASSERT_TRUE(io::write_text(at("a.v3d"),
                             "\ts\ts\ts\n\tA\tA\tA\n\tTARGET\tTARGET\tTARGET\n\tp\tp\tp\n"
                             "ITEM\tX\tY\tZ\n1\t1\t2\t3\n2\t1\t2\t3\n",
                             false));
  const auto no_rate = convert(at("a.v3d"), at("a.trc"), false);
  ASSERT_FALSE(no_rate);
  EXPECT_EQ(no_rate.error().code, Code::usage);
  EXPECT_TRUE(convert(at("a.v3d"), at("a.trc"), false, 179.0));
  const auto mixed = convert(at("in/markers.c3d"), at("x.osim"), false);
  ASSERT_FALSE(mixed);
  EXPECT_EQ(mixed.error().code, Code::usage);
  EXPECT_THAT(mixed.error().message, HasSubstr("different kinds of file"));
  const auto no_plates = convert(at("in/markers.c3d"), at("x.mot"), false);
  ASSERT_FALSE(no_plates);
  EXPECT_EQ(no_plates.error().code, Code::bad_input);
  EXPECT_THAT(no_plates.error().message, HasSubstr("has no force plates, whose forces a .mot could hold"));
  EXPECT_FALSE(std::filesystem::exists(at("x.mot")));
}

TEST_F(ConvertFile, NeverReplacesAFileUnasked) {
  ASSERT_TRUE(io::write_text(at("mine.trc"), "mine", false));
  EXPECT_EQ(convert(at("in/markers.c3d"), at("mine.trc"), false).error().code, Code::io);
  EXPECT_EQ(io::read_text(at("mine.trc")).value(), "mine");
  EXPECT_TRUE(convert(at("in/markers.c3d"), at("mine.trc"), true));
  EXPECT_GT(io::read_text(at("mine.trc")).value().size(), 1000U);
}

TEST_F(ConvertFile, ABadInputLeavesNoOutput) {
  ASSERT_TRUE(io::write_text(at("bad.c3d"), "not a C3D file at all", false));
  EXPECT_EQ(convert(at("bad.c3d"), at("never.trc"), false).error().code, Code::bad_input);
  EXPECT_FALSE(std::filesystem::exists(at("never.trc")));
}

TEST_F(ConvertFile, WhatIsUpInASkeletonIsSaidWhereTheModelHasGravity) {
  auto text = io::read_text(at("in/model.osim")).value();
  const auto begin = text.find("<gravity>"), end = text.find("</gravity>");
  ASSERT_NE(begin, std::string::npos);
  text.replace(begin, end - begin, "<gravity>0 0 0");
  ASSERT_TRUE(io::write_text(at("afloat.osim"), text, false));
  ConvertJob job;
  job.in = at("in/truth.mot");
  for (const char* model : {"in/model.osim", "afloat.osim"}) {
    job.model = at(model);
    job.out = at(std::string(model) == "afloat.osim" ? "afloat.bvh" : "heavy.bvh");
    const auto outcome = run_convert(job);
    ASSERT_TRUE(outcome) << outcome.error().message;
    if (job.out == at("afloat.bvh")) {
      EXPECT_THAT(outcome->warnings,
                  Contains(HasSubstr("cannot say; what is up is not known, as the model has")));
      EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr("lengths are in cm and y is up"))));
    } else {
      EXPECT_THAT(outcome->warnings, Not(Contains(HasSubstr("what is up is not known, as the model has"))));
    }
  }
}

TEST_F(ConvertFile, ASceneIsTurnedWhereTheVerticalIsKnown) {
  const auto on_plate = [](const Eigen::Vector3d& up) {
    data::Trial trial;
    trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 4});
    for (std::int64_t f = 0; f < 4; ++f) {
      trial.markers.x(f, 0) = up;
      trial.markers.state[trial.markers.index(f, 0)] = data::SampleState::measured;
    }
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = up.cross(x);
    data::ForcePlate plate{.type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}};
    plate.corners_in_world = {0.2 * x + 0.2 * y, -0.2 * x + 0.2 * y, -0.2 * x - 0.2 * y, 0.2 * x - 0.2 * y};
    trial.force_plates.push_back(plate);
    trial.analog = {.names = {"fx", "fy", "fz", "mx", "my", "mz"},
                    .units = {"N", "N", "N", "Nmm", "Nmm", "Nmm"},
                    .rate_hz = 100.0,
                    .samples = 4};
    trial.analog.values.assign(24, 0.0F);
    return trial;
  };
  const auto notes = [&](const data::Trial& trial, const std::string& name) {
    EXPECT_TRUE(io::write_markers(at(name), trial, true));
    return convert(at(name), at("scene.glb"), true).value().warnings;
  };
  const auto lying = notes(on_plate(Eigen::Vector3d::UnitZ()), "z.c3d");
  EXPECT_THAT(lying, Contains("the recording was turned: z is up by the force plates, and y in a .glb"));
  EXPECT_THAT(lying, Not(Contains(HasSubstr("which way is up is not known and y is taken"))));
  const auto upright = notes(on_plate(Eigen::Vector3d::UnitY()), "y.c3d");
  EXPECT_THAT(upright, Not(Contains(HasSubstr("the recording was turned:"))));
  const auto unknown = notes(on_plate(Eigen::Vector3d::UnitZ()), "z.trc");
  EXPECT_THAT(unknown, Contains(HasSubstr("which way is up is not known and y is taken, as a .glb has it")));
}

TEST_F(ConvertFile, AMotionBecomesASkeletonWithItsModelOnly) {
  ConvertJob job;
  job.in = at("in/truth.mot");
  job.out = at("walk.bvh");
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("made with the model that they are of"));
  job.model = at("in/model.osim");
  const auto outcome = run_convert(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->warnings, Contains("lengths are in cm and y is up, which a .bvh file cannot say"));
  const auto skeleton = io::read_markers(at("walk.bvh")).value();
  EXPECT_EQ(skeleton.markers.frames(), io::read_table(job.in).value().rows());
  const auto model = io::read_osim(job.model).value();
  for (const auto& body : model.bodies) EXPECT_GE(skeleton.markers.find(body.name), 0);
  job.out = at("walk.sto");
  EXPECT_EQ(run_convert(job).error().code, Code::usage) << "a table needs no model";
  job.model.clear();
  job.in = at("in/markers.c3d");
  job.out = at("markers.bvh");
  EXPECT_EQ(run_convert(job).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline
