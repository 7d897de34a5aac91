// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/page_file.h"

#include <gtest/gtest.h>

#include "kinemark/pipeline/testing/test_files.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

class PageFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(PageFileTest, AppearsWhenItIsWrittenAndNotBefore) {
  const auto path = folder_ / "page.html";
  JobOutcome outcome;
  {
    auto page = PageFile::begin(path, {folder_ / "a.c3d"}, false);
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_TRUE(page->wanted());
    EXPECT_FALSE(fs::exists(path));
    ASSERT_TRUE(page->write("<p>words</p>", outcome));
  }
  EXPECT_EQ(fs::file_size(path), 12U);
  EXPECT_EQ(outcome.written, std::vector<fs::path>{path});
}

TEST_F(PageFileTest, NothingStaysOfAPageThatWasNotWritten) {
  {
    ASSERT_TRUE(PageFile::begin(folder_ / "page.html", {}, false));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(PageFileTest, AnEmptyPathIsNoPage) {
  auto page = PageFile::begin({}, {}, false);
  ASSERT_TRUE(page);
  EXPECT_FALSE(page->wanted());
  JobOutcome outcome;
  EXPECT_TRUE(page->write("words", outcome));
  EXPECT_TRUE(outcome.written.empty());
}

TEST_F(PageFileTest, RefusesOtherEndingsOtherFilesAndWhatIsThere) {
  const auto other = PageFile::begin(folder_ / "page.pdf", {}, false);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::usage);
  EXPECT_NE(other.error().message.find("ends in .html"), std::string::npos);
  const auto same = PageFile::begin(folder_ / "a.html", {folder_ / "b" / ".." / "a.html"}, false);
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().code, Code::usage);
  JobOutcome outcome;
  auto first = PageFile::begin(folder_ / "a.html", {}, false);
  ASSERT_TRUE(first && first->write("1", outcome));
  EXPECT_FALSE(PageFile::begin(folder_ / "a.html", {}, false));
  EXPECT_TRUE(PageFile::begin(folder_ / "a.html", {}, true));
}

}  // namespace
}  // namespace kinemark::pipeline
