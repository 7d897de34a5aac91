// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/gates.h"

#include <gmock/gmock.h>

#include <limits>
#include <utility>

namespace kinemark::workflow {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Gates, AGateFailsAboveItsBoundAndOnWhatIsNotANumber) {
  for (const auto& [value, passes] : {std::pair{1.0, true}, {1.0 + 1e-12, false}, {-1.0, true}}) {
    Gates gates;
    add_gate(gates, "g", value, 1.0, "mm", "text");
    EXPECT_EQ(gates.at(0).passed, passes) << value;
  }
  Gates gates;
  add_marker_gates(gates, {}, 0.0, "no offset", std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(gates.at(0).passed);
  EXPECT_FALSE(gates.at(1).passed);
}

TEST(Gates, AFewBadFramesOfManyDoNotFailATrial) {
  struct Case {
    std::int64_t bad, all;
    bool passes;
  };
  for (const Case& c : {Case{3, 100'000, true},
                        {1, 1'000, true},
                        {1, 999, false},
                        {101, 100'000, false},
                        {0, 50, true},
                        {0, 0, true}}) {
    Gates gates;
    add_frames_gate(gates, "not_converged", c.bad, c.all, "did not converge");
    EXPECT_EQ(gates.at(0).passed, c.passes) << c.bad << " of " << c.all;
    EXPECT_EQ(gates.at(0).unit, "%");
  }
  Gates gates;
  add_frames_gate(gates, "flagged", 2, 100, "are flagged");
  EXPECT_EQ(gates.at(0).value, 2.0);
  EXPECT_EQ(gates.at(0).sentence, "2 of 100 frames are flagged; at most 0.1 % are accepted.");
}

TEST(Gates, EachGateSaysWhatItCounted) {
  data::JointMotion motion;
  motion.marker_state = {data::SampleState::rejected, data::SampleState::measured};
  Gates gates;
  add_left_out_gate(gates, motion);
  add_marker_gates(gates, {}, 0.0, "no offset", 0.061);
  ASSERT_EQ(gates.size(), 3U);
  const auto &left_out = gates[0].sentence, &rms = gates[2].sentence;
  EXPECT_EQ(left_out, "1 of 2 samples were left out; at most 5 % are accepted.");
  EXPECT_EQ(rms,
            "The RMS distance between measured and model markers is 61.0 mm; at most 50.0 mm is accepted.");
  EXPECT_THAT(left_out, Not(HasSubstr("The RMS distance between measured and model markers is")));
  EXPECT_THAT(rms, Not(AnyOf(HasSubstr("samples were left out; at most"), HasSubstr("% are accepted."))));
  motion.marker_state.clear();
  Gates not_judged;
  add_left_out_gate(not_judged, motion);
  EXPECT_THAT(not_judged, IsEmpty());
}

}  // namespace
}  // namespace kinemark::workflow
