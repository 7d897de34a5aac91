// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The pose of ndx-pose in our own files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/pose_writer.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using internal::Input;
using ::testing::IsEmpty;
using testing::sample_trajectories;

constexpr const char* kPosePath = "/processing/behavior/PoseEstimation";

class NwbPose : public ::testing::Test {
 protected:
  NwbPose() {
    const auto status = write_nwb(path_, t_, nullptr, testing::sample_metadata(), {.ndx_pose = true});
    EXPECT_TRUE(status) << status.error().message;
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "pose.nwb";
  data::Trajectories t_ = sample_trajectories();
  internal::Quiet quiet_;
};

TEST_F(NwbPose, TheRecordingComesBackAsWithoutIt) {
  const auto back = read_nwb(path_);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->trial.markers.names, t_.names);
  EXPECT_TRUE(testing::same_bits(back->trial.markers.x_in_world, t_.x_in_world));
  EXPECT_EQ(back->trial.markers.state, t_.state);
  EXPECT_TRUE(testing::same_bits(back->trial.markers.sample_offset_s, t_.sample_offset_s));
  EXPECT_THAT(back->warnings, IsEmpty()) << "the digest covers the pose";
}

TEST_F(NwbPose, EachMarkerIsASeriesThatSharesTheNumbersOfPosition) {
  auto in = Input::open(path_);
  ASSERT_TRUE(in) << in.error().message;
  const Handle pose = in->object(in->file(), kPosePath);
  EXPECT_EQ(in->text_attribute(pose.id(), "neurodata_type"), "PoseEstimation");
  EXPECT_EQ(in->text_attribute(pose.id(), "namespace"), "ndx-pose");
  EXPECT_EQ(in->soft_link(pose.id(), "skeleton"), "/processing/behavior/Skeletons/skeleton");
  const auto names = internal::series_names(t_.names);
  const Handle nodes = in->object(in->file(), "/processing/behavior/Skeletons/skeleton/nodes");
  EXPECT_EQ(in->texts(nodes.id()), names);
  for (std::size_t m = 0; m < names.size(); ++m) {
    const Handle series = in->object(pose.id(), names[m]);
    EXPECT_EQ(in->text_attribute(series.id(), "neurodata_type"), "PoseEstimationSeries");
    EXPECT_EQ(in->soft_link(series.id(), "data"), "/processing/behavior/Position/" + names[m] + "/data");
    EXPECT_EQ(in->soft_link(series.id(), "timestamps"),
              "/processing/behavior/Position/" + names[m] + "/timestamps");
    const Handle confidence = in->object(series.id(), "confidence");
    const auto numbers = in->numbers<double>(confidence.id());
    ASSERT_TRUE(numbers);
    for (std::int64_t f = 0; f < t_.frames(); ++f)
      ASSERT_EQ((*numbers)[static_cast<std::size_t>(f)],
                internal::confidence_of(t_.state[t_.index(f, static_cast<std::int64_t>(m))]))
          << names[m] << " " << f;
  }
}

TEST_F(NwbPose, WithoutTheOptionThereIsNone) {
  ASSERT_TRUE(write_nwb(scratch_ / "plain.nwb", t_));
  auto in = Input::open(scratch_ / "plain.nwb");
  ASSERT_TRUE(in) << in.error().message;
  EXPECT_FALSE(in->object(in->file(), kPosePath));
}

TEST_F(NwbPose, PiecesMakeTheSameFile) {
  auto writer = NwbWriter::create(scratch_ / "pieces.nwb", NwbOutline::of(t_, nullptr),
                                  testing::sample_metadata(), {.ndx_pose = true});
  ASSERT_TRUE(writer) << writer.error().message;
  for (const std::int64_t first : {20, 0}) {
    data::Trajectories piece = t_;
    const std::int64_t count = first == 0 ? 20 : t_.frames() - 20;
    const auto take = [&](auto& values, std::int64_t width) {
      const auto begin = values.begin() + first * t_.markers() * width;
      values = {begin, begin + count * t_.markers() * width};
    };
    piece.time.frames = count;
    take(piece.x_in_world, 3);
    take(piece.state, 1);
    take(piece.covariance, 6);
    take(piece.unfiltered_in_world, 3);
    take(piece.sample_offset_s, 1);
    take(piece.method, 1);
    ASSERT_TRUE(writer->write(piece, nullptr, first));
  }
  ASSERT_TRUE(writer->commit());
  for (const char* file : {"pose.nwb", "pieces.nwb"}) {
    auto in = Input::open(scratch_ / file);
    ASSERT_TRUE(in) << in.error().message;
    const Handle confidence = in->object(in->file(), std::string(kPosePath) + "/a_b/confidence");
    const auto numbers = in->numbers<double>(confidence.id());
    ASSERT_TRUE(numbers);
    EXPECT_EQ(numbers->size(), 50U);
    EXPECT_EQ((*numbers)[21], internal::confidence_of(t_.state[t_.index(21, 1)])) << file;
  }
}

TEST_F(NwbPose, AMarkerMayBeCalledLikeAPartOfThePose) {
  data::Trajectories t =
      data::Trajectories::all_missing({"skeleton", "_skeleton", "scorer"}, {.rate_hz = 100.0, .frames = 2});
  ASSERT_TRUE(write_nwb(scratch_ / "names.nwb", t, nullptr, {}, {.ndx_pose = true}));
  auto in = Input::open(scratch_ / "names.nwb");
  ASSERT_TRUE(in) << in.error().message;
  const Handle nodes = in->object(in->file(), "/processing/behavior/Skeletons/skeleton/nodes");
  EXPECT_EQ(in->texts(nodes.id()), (std::vector<std::string>{"__skeleton", "_skeleton", "_scorer"}));
  const Handle series = in->object(in->file(), std::string(kPosePath) + "/__skeleton");
  EXPECT_EQ(in->soft_link(series.id(), "data"), "/processing/behavior/Position/skeleton/data");
  EXPECT_TRUE(in->object(series.id(), "starting_time")) << "samples at the times of their frames";
}

TEST(ConfidenceOf, MeasuredAloneIsSure) {
  using enum data::SampleState;
  EXPECT_EQ(internal::confidence_of(measured), 1.0F);
  for (const auto made : {interpolated, model_filled, upsampled})
    EXPECT_EQ(internal::confidence_of(made), 0.5F);
  for (const auto none : {missing, rejected}) EXPECT_EQ(internal::confidence_of(none), 0.0F);
}

}  // namespace
}  // namespace kinemark::io
