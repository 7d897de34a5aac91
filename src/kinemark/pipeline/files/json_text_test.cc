// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/json_text.h"

#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonText, IsValidAndSafeWhateverTheNames) {
  EXPECT_EQ(json_text({{"a", 1}}), "{\n  \"a\": 1\n}");
  EXPECT_EQ(json_text(Json("épaule")), "\"épaule\"");
  EXPECT_EQ(json_text(Json("Fu\xDF.trc")), "\"Fu\xEF\xBF\xBD.trc\"");
  EXPECT_EQ(json_text(Json("A\x1B[2J\x7F\xC2\x9B")), "\"A\\u001b[2J\\u007f\\u009b\"");
  EXPECT_EQ(Json::parse(json_text(Json("\x7F\xC2\x9B\xC2\xA0"))), Json("\x7F\xC2\x9B\xC2\xA0"));
}

}  // namespace
}  // namespace kinemark::pipeline
