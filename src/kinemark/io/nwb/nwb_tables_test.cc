// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/nwb_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using internal::Input;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<NwbTable> tables() {
  return {{.name = "measures",
           .description = "measures of movement",
           .columns = {{.name = "subject", .description = "marker", .texts = {"RFIN", ""}, .numbers = {}},
                       {.name = "peak_speed",
                        .description = "Peak tangential velocity, mm/s: max |v| (definition)",
                        .texts = {},
                        .numbers = {1076.5, kNaN}}}}};
}

class NwbTablesTest : public ::testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "measures.nwb";
  internal::Quiet quiet_;
};

TEST_F(NwbTablesTest, AreDynamicTablesOfTheModuleBehavior) {
  const auto status = write_nwb_tables(
      path_, tables(), {.session_description = "measures", .sources = {{"a.c3d", 7, "0"}}}, false);
  ASSERT_TRUE(status) << status.error().message;
  auto in = Input::open(path_);
  ASSERT_TRUE(in) << in.error().message;
  const Handle table = in->object(in->file(), "/processing/behavior/measures");
  EXPECT_EQ(in->text_attribute(table.id(), "neurodata_type"), "DynamicTable");
  EXPECT_EQ(in->text_attribute(table.id(), "description"), "measures of movement");
  EXPECT_EQ(in->text_attributes(table.id(), "colnames"), (std::vector<std::string>{"subject", "peak_speed"}));
  const Handle speed = in->object(table.id(), "peak_speed");
  EXPECT_EQ(in->text_attribute(speed.id(), "neurodata_type"), "VectorData");
  EXPECT_EQ(in->text_attribute(speed.id(), "description"),
            "Peak tangential velocity, mm/s: max |v| (definition)");
  const auto numbers = in->numbers<double>(speed.id());
  ASSERT_TRUE(numbers);
  EXPECT_EQ((*numbers)[0], 1076.5);
  EXPECT_TRUE(std::isnan((*numbers)[1]));
  EXPECT_THAT(in->texts(in->object(table.id(), "subject").id()).value(), ElementsAre("RFIN", ""));
  EXPECT_TRUE(in->object(in->file(), "/processing/behavior/sources/file"));
  EXPECT_EQ(internal::content_digest(*in), in->text_attribute(in->file(), internal::kDigestAttribute));
}

TEST_F(NwbTablesTest, TheSameTablesAreTheSameBytes) {
  ASSERT_TRUE(write_nwb_tables(path_, tables(), {}, false));
  const auto other = scratch_ / "other.nwb";
  ASSERT_TRUE(write_nwb_tables(other, tables(), {}, false));
  EXPECT_EQ(read_text(path_).value(), read_text(other).value());
  const auto again = write_nwb_tables(path_, tables(), {}, false);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::io);
  EXPECT_TRUE(write_nwb_tables(path_, tables(), {}, true));
}

TEST_F(NwbTablesTest, HoldNoMarkersForWhoReadsThem) {
  ASSERT_TRUE(write_nwb_tables(path_, tables(), {}, false));
  const auto read = read_nwb(path_);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Code::bad_input);
}

TEST_F(NwbTablesTest, WhatIsNoTableIsRefused) {
  const auto says = [this](const auto& change) {
    auto wrong = tables();
    change(wrong);
    const auto status = write_nwb_tables(path_, wrong, {}, false);
    EXPECT_FALSE(std::filesystem::exists(path_));
    return status ? std::string("written") : status.error().message;
  };
  EXPECT_THAT(says([](auto& t) { t.clear(); }), HasSubstr("no tables"));
  EXPECT_THAT(says([](auto& t) { t[0].columns[1].numbers.pop_back(); }),
              HasSubstr("column 'peak_speed' has 1 values, others 2"));
  EXPECT_THAT(says([](auto& t) { t[0].columns[1].name = "subject"; }),
              HasSubstr("'subject' is no name of a column"));
  EXPECT_THAT(says([](auto& t) { t[0].columns[1].name = "a/b"; }), HasSubstr("'a/b' is no name"));
  EXPECT_THAT(says([](auto& t) { t[0].name = "sources"; }), HasSubstr("'sources' is no name of a table"));
  EXPECT_THAT(says([](auto& t) { t[0].columns[0].texts.clear(), t[0].columns[1].numbers.clear(); }),
              HasSubstr("has no rows"));
  const auto date = write_nwb_tables(path_, tables(), {.session_start = "today"}, false);
  EXPECT_THAT(date.error().message, HasSubstr("is not a date"));
}

}  // namespace
}  // namespace kinemark::io
