// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/edit_request.h"

#include <gmock/gmock.h>

#include <string>

namespace kinemark::server {
namespace {

using data::EditKind;
using ::testing::HasSubstr;

TEST(EditRequest, IsANumberAndAnOperation) {
  const auto asked =
      parse_edit_request(R"({"expected":12,"edit":{"do":"swap","marker":"A","with":"B","first":120}})")
          .value();
  EXPECT_EQ(asked.expected, 12U);
  EXPECT_EQ(asked.edit.kind, EditKind::swap);
  EXPECT_EQ(asked.edit.marker, "A");
  EXPECT_EQ(asked.edit.other, "B");
  EXPECT_EQ(asked.edit.first_frame, 120);
  EXPECT_EQ(parse_edit_request(R"({"edit":{"do":"undo"},"expected":0})").value().edit.count, 1);
}

TEST(EditRequest, NamesAreTakenAsTheyAre) {
  const auto asked =
      parse_edit_request(R"({"expected":0,"edit":{"do":"cut","marker":"</script><img onerror=\"x\">"}})")
          .value();
  EXPECT_EQ(asked.edit.marker, "</script><img onerror=\"x\">");
}

TEST(EditRequest, AnythingElseIsOneSentence) {
  const std::string deep =
      R"({"expected":0,"edit":{"do":)" + std::string(1800, '[') + std::string(1800, ']') + "}}";
  for (const std::string& body :
       {std::string(), std::string("null"), std::string("[]"), std::string("{}"), std::string("{"),
        std::string(R"({"expected":0})"), std::string(R"({"edit":{"do":"undo"}})"),
        std::string(R"({"expected":-1,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":1.5,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":"1","edit":{"do":"undo"}})"),
        std::string(R"({"expected":99999999999999999999,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":0,"edit":[]})"),
        std::string(R"({"expected":0,"edit":{"do":"undo"},"more":1})"),
        std::string(R"({"expected":0,"edit":{"do":"explode"}})"),
        std::string(R"({"expected":0,"edit":{"do":"cut"}})"),
        std::string(R"({"expected":0,"edit":{"do":"cut","marker":7}})"),
        std::string(R"({"expected":0,"edit":{"do":"undo","marker":"A"}})"), std::string("\xff\xfe"), deep}) {
    const auto asked = parse_edit_request(body);
    ASSERT_FALSE(asked) << body.substr(0, 80);
    EXPECT_EQ(asked.error().code, Code::bad_input);
    EXPECT_LT(asked.error().message.size(), 300U);
    EXPECT_THAT(asked.error().message, ::testing::Not(HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace kinemark::server
