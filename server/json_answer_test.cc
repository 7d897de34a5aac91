// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/json_answer.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace kinemark::server {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Pair;

TEST(JsonAnswer, IsJsonToWhoWasLetIn) {
  const auto response = json_response(202, {{"a", 1}});
  EXPECT_EQ(response.status, 202);
  EXPECT_EQ(response.type, "application/json");
  EXPECT_TRUE(response.admitted);
  EXPECT_EQ(nlohmann::json::parse(*response.body)["a"], 1);
  EXPECT_THAT(response.headers, IsEmpty());
}

TEST(JsonAnswer, ARefusalTellsWhetherItIsTheDataOrTheDisk) {
  EXPECT_EQ(refusal(Error{Code::bad_input, "x"}).status, 422);
  EXPECT_EQ(refusal(Error{Code::not_supported, "x"}).status, 422);
  EXPECT_EQ(refusal(Error{Code::io, "x"}).status, 503);
  EXPECT_THAT(refusal(503, "x").headers, Contains(Pair("Retry-After", "1")));
  EXPECT_EQ(nlohmann::json::parse(*refusal(400, "no such thing").body)["error"], "no such thing");
}

TEST(JsonAnswer, TypesThatAFormCanSendAreNone) {
  EXPECT_TRUE(is_json("application/json"));
  EXPECT_TRUE(is_json("application/json; charset=utf-8"));
  for (const char* type : {"", "text/plain", "application/jsonx", "application/x-www-form-urlencoded",
                           "multipart/form-data", "text/plain, application/json"})
    EXPECT_FALSE(is_json(type)) << type;
}

}  // namespace
}  // namespace kinemark::server
