// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/comedi/comedi_device.h"

#include <gmock/gmock.h>

#include <fstream>

#include "support/scratch.h"

namespace kinemark::stream {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

TEST(OpenComedi, SaysWhatIsMissing) {
  const testing_support::ScratchFolder scratch;
  const auto absent = open_comedi((scratch / "comedi0").string());
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().message,
              AnyOf(HasSubstr("no such device; is it plugged in?"), HasSubstr("without comedi")));
  std::ofstream(scratch / "comedi1") << "x";
  const auto file = open_comedi((scratch / "comedi1").string());
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().code, AnyOf(Code::device, Code::not_supported));
}

TEST(ListComedi, NamesBoardsAndNotTheirParts) {
  const testing_support::ScratchFolder scratch;
  for (const auto* name : {"comedi1", "comedi0", "comedi0_subd0", "comedi", "comedix"})
    std::ofstream(scratch / name) << "";
  const auto found = list_comedi(scratch / "");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].uri, "comedi:" + (scratch / "comedi0").string());
  EXPECT_EQ(found[1].name, "comedi1");
  EXPECT_EQ(found[0].state, "");
  EXPECT_TRUE(list_comedi(scratch / "none").empty());
}

}  // namespace
}  // namespace kinemark::stream
