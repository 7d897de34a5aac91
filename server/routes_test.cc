// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/routes.h"

#include <gtest/gtest.h>

#include <string>

namespace kinemark::server {
namespace {

TEST(Routes, AreFew) {
  EXPECT_EQ(find_route("/").target, Target::list_page);
  EXPECT_EQ(find_route("/api/trials").target, Target::list_json);
  EXPECT_EQ(find_route("/style.css").target, Target::style);
  EXPECT_EQ(find_route("/list.css").target, Target::list_style);
  EXPECT_EQ(find_route("/list.js").target, Target::list_script);
}

TEST(Routes, OfTrialsHaveANumber) {
  for (const std::uint32_t number : {1U, 9U, 10U, 12345U, 4294967295U}) {
    const auto route = find_route("/trial/" + std::to_string(number));
    EXPECT_EQ(route.target, Target::trial_page);
    EXPECT_EQ(route.number, number);
  }
}

TEST(Routes, OfEditsStandBehindTheNumber) {
  EXPECT_EQ(find_route("/api/trial/12/edits").target, Target::trial_edits);
  EXPECT_EQ(find_route("/api/trial/12/edits").number, 12U);
  EXPECT_EQ(find_route("/api/trial/7/data").target, Target::trial_data);
  EXPECT_EQ(find_route("/api/trial/7/data").number, 7U);
  for (const char* target :
       {"/api/trial/", "/api/trial/1", "/api/trial//edits", "/api/trial/edits", "/api/trial/0/edits",
        "/api/trial/01/data", "/api/trial/1/edits/", "/api/trial/1/edits?x", "/api/trial/../edits",
        "/api/trial/1/2/edits", "/trial/1/edits", "/api/trial/1/Edits", "/api/trial/+1/edits"})
    EXPECT_EQ(find_route(target).target, Target::none) << target;
}

TEST(Routes, OfAnglesStandBehindTheNumber) {
  EXPECT_EQ(find_route("/api/trial/12/angles").target, Target::trial_angles);
  EXPECT_EQ(find_route("/trial/12/angles/now").target, Target::angles_now);
  EXPECT_EQ(find_route("/trial/12/angles/before").target, Target::angles_before);
  EXPECT_EQ(find_route("/trial/12/angles/recorded").target, Target::angles_recorded);
  EXPECT_EQ(find_route("/trial/12/angles/recorded").number, 12U);
  for (const char* target :
       {"/trial/1/angles", "/trial/1/angles/", "/trial//angles/now", "/trial/0/angles/now",
        "/api/trial/1/angles/now", "/trial/1/angles/then", "/trial/1/angles/now/"})
    EXPECT_EQ(find_route(target).target, Target::none) << target;
}

TEST(Routes, NumbersAreSpeltInOneWay) {
  for (const char* target :
       {"/trial/", "/trial", "/trial/0", "/trial/01", "/trial/-1", "/trial/+1", "/trial/1.0", "/trial/ 1",
        "/trial/1/", "/trial/1?x", "/trial/%31", "/trial/4294967296", "/trial/99999999999999999999",
        "/trial/0x1", "/trial/one", "/trial/1#2"})
    EXPECT_EQ(find_route(target).target, Target::none) << target;
}

TEST(Routes, NoPathIsPutTogether) {
  for (const char* target : {"",
                             "*",
                             "//",
                             "/..",
                             "/../",
                             "/trial/../style.css",
                             "/./style.css",
                             "/style.css/..",
                             "/%2e%2e/etc/passwd",
                             "/..%2f..%2fetc%2fpasswd",
                             "/etc/passwd",
                             "/trial/../../etc/passwd",
                             "/style.css?",
                             "/STYLE.CSS",
                             "/list.js.map",
                             "http://127.0.0.1:1/",
                             "/\\..\\..",
                             "/?",
                             "/?token=",
                             "/api/trials/",
                             "/api",
                             "/favicon.ico",
                             "file:///etc/passwd"})
    EXPECT_EQ(find_route(target).target, Target::none) << target;
  EXPECT_EQ(find_route(std::string_view("/style.css\0x", 12)).target, Target::none);
  EXPECT_EQ(find_route(std::string_view("/trial/1\0", 9)).target, Target::none);
}

}  // namespace
}  // namespace kinemark::server
