// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/step_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

TEST(StepFiles, WhatWasWrittenIsInItsLines) {
  EXPECT_THAT(written_files({"note: wrote nothing", "wrote a b/ik.mot", "rewrote x", "wrote ik_sd.sto"}),
              ElementsAre("a b/ik.mot", "ik_sd.sto"));
  EXPECT_THAT(written_files({}), IsEmpty());
}

TEST(StepFiles, ResultsNameWhatTheyWereMadeFrom) {
  const testing_support::ScratchFolder scratch;
  const auto put = [&](const char* name, const char* text) {
    ASSERT_TRUE(io::write_text(scratch / name, text, true));
  };
  put("r.json", R"({"inputs": [{"path": "tasks.xml", "hash": "12", "hash_kind": "XXH3-64"},
                               {"path": "other", "hash": "12", "hash_kind": "MD5"}, 7, {"hash_kind": "XXH3-64", "path": 5}]})");
  put("list.json", "[1, 2]");
  put("broken.json", "{");
  put("no.txt", R"({"inputs": [{"path": "x", "hash": "1", "hash_kind": "XXH3-64"}]})");
  EXPECT_THAT(named_inputs({"list.json", "r.json", "broken.json", "no.txt", "absent.json"}, scratch.path()),
              ElementsAre(Pair("tasks.xml", "12")));
}

}  // namespace
}  // namespace kinemark::pipeline
