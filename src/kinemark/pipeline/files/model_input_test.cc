// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/model_input.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

TEST(ReadModelInput, IsReadyToMoveAndOnRecord) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_osim(scratch / "human.osim", human_model().value()));
  const auto input = read_model_input(scratch / "human.osim");
  ASSERT_TRUE(input) << input.error().message;
  EXPECT_EQ(input->model.description().markers.size(), 40U);
  EXPECT_EQ(input->file.role, "model");
  EXPECT_EQ(input->file.path, (scratch / "human.osim").string());
  EXPECT_EQ(input->file.hash, io::hash_file(scratch / "human.osim").value().hex);
}

TEST(ReadModelInput, WithoutMarkersItIsOfNoUse) {
  const testing_support::ScratchFolder scratch;
  auto bare = human_model().value();
  bare.markers.clear();
  ASSERT_TRUE(io::write_osim(scratch / "bare.osim", bare));
  const auto refused = read_model_input(scratch / "bare.osim");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("bare.osim: model '"));
  EXPECT_THAT(refused.error().message, HasSubstr("has no markers; need at least one"));
}

TEST(ReadModelInput, SaysWhichFileIsWrong) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(read_model_input(scratch / "none.osim").error().code, Code::io);
  ASSERT_TRUE(io::write_text(scratch / "broken.osim", "<OpenSimDocument", false));
  const auto broken = read_model_input(scratch / "broken.osim");
  EXPECT_EQ(broken.error().code, Code::bad_input);
  EXPECT_THAT(broken.error().message, HasSubstr("broken.osim"));
}

}  // namespace
}  // namespace kinemark::pipeline
