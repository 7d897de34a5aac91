// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/json_pieces.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// "key:piece" for each piece.
std::vector<std::string> pieces(const std::string& text) {
  std::vector<std::string> out;
  const auto status = read_pieces(text, [&](std::string_view key, const nlohmann::json& piece) -> Status {
    out.push_back(std::string(key) + ":" + piece.dump());
    return {};
  });
  EXPECT_TRUE(status) << status.error().message;
  return out;
}

std::string sentence(const std::string& text) {
  const auto status = read_pieces(text, [](std::string_view, const nlohmann::json&) { return Status(); });
  return status ? "read without complaint" : status.error().message;
}

TEST(JsonPieces, ElementsOfAnOutermostArray) {
  EXPECT_THAT(pieces(R"([1, {"a": [2, {"b": 3}]}, [4, [5]], null])"),
              ElementsAre(":1", R"(:{"a":[2,{"b":3}]})", ":[4,[5]]", ":null"));
  EXPECT_THAT(pieces("[]"), IsEmpty());
}

TEST(JsonPieces, ElementsOfArraysUnderKeysAndOtherValuesWhole) {
  EXPECT_THAT(
      pieces(R"({"v": 1.5, "list": [1, [2], {"x": [3]}], "w": "t", "object": {"k": [1, 2]}, "z": true})"),
      ElementsAre("v:1.5", "list:1", "list:[2]", R"(list:{"x":[3]})", R"(w:"t")", R"(object:{"k":[1,2]})",
                  "z:true"));
  EXPECT_THAT(pieces(R"({"empty": [], "none": {}})"), ElementsAre("none:{}"));
  EXPECT_THAT(pieces("{}"), IsEmpty());
}

TEST(JsonPieces, KeysInsideAPieceAreNotOutermost) {
  EXPECT_THAT(pieces(R"({"a": [{"b": [1]}, {"c": 2}]})"), ElementsAre(R"(a:{"b":[1]})", R"(a:{"c":2})"));
}

TEST(JsonPieces, NanOfPythonIsNullButNotInText) {
  EXPECT_THAT(pieces(R"([NaN, "NaN", "a\"NaN", [1, NaN]])"),
              ElementsAre(":null", R"(:"NaN")", R"(:"a\"NaN")", ":[1,null]"));
  EXPECT_THAT(sentence("[NaNa]"), HasSubstr("is no JSON"));
}

TEST(JsonPieces, WhatIsNoJsonIsNamedWithItsLine) {
  EXPECT_EQ(sentence(""), "line 1: is no JSON");
  EXPECT_EQ(sentence("[1,\n2,\n,3]"), "line 3: is no JSON");
  EXPECT_EQ(sentence("{\"a\": [1, 2"), "line 1: is no JSON");
  EXPECT_EQ(sentence("[1] [2]"), "line 1: is no JSON");
  EXPECT_EQ(sentence("[\"\xff\"]"), "line 1: is no JSON");
  EXPECT_EQ(sentence("[1e999]"), "holds a number that is too large");
  EXPECT_EQ(sentence("[Infinity]"), "line 1: is no JSON");
}

TEST(JsonPieces, DepthIsBounded) {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(sentence(nested(33)), "read without complaint");
  EXPECT_EQ(sentence(nested(34)), "has more than 32 levels");
  EXPECT_EQ(sentence(std::string(4'000'000, '[')), "has more than 32 levels") << "before its end is missed";
}

TEST(JsonPieces, AFailureEndsTheReading) {
  int taken = 0;
  const auto status = read_pieces("[1, 2, 3, x", [&](std::string_view, const nlohmann::json&) -> Status {
    return ++taken == 2 ? fail(Code::not_supported, "enough") : Status();
  });
  EXPECT_EQ(taken, 2);
  EXPECT_EQ(status.error().code, Code::not_supported);
  EXPECT_EQ(status.error().message, "enough");
}

}  // namespace
}  // namespace kinemark::io::internal
