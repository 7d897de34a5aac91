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
    auto page = PageFile::begin(path, {}, {folder_ / "a.c3d"});
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
    ASSERT_TRUE(PageFile::begin(folder_ / "page.html", {}, {}));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(PageFileTest, AnEmptyPathIsNoPage) {
  auto page = PageFile::begin({}, {}, {});
  ASSERT_TRUE(page);
  EXPECT_FALSE(page->wanted());
  JobOutcome outcome;
  EXPECT_TRUE(page->write("words", outcome));
  EXPECT_TRUE(outcome.written.empty());
}

TEST_F(PageFileTest, RefusesOtherEndingsOtherFilesAndWhatIsThere) {
  const auto other = PageFile::begin(folder_ / "page.pdf", {}, {});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::usage);
  EXPECT_NE(other.error().message.find("ends in .html"), std::string::npos);
  const auto same = PageFile::begin(folder_ / "a.html", {}, {folder_ / "b" / ".." / "a.html"});
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().code, Code::usage);
  JobOutcome outcome;
  auto first = PageFile::begin(folder_ / "a.html", {}, {});
  ASSERT_TRUE(first && first->write("1", outcome));
  EXPECT_FALSE(PageFile::begin(folder_ / "a.html", {}, {}));
  EXPECT_TRUE(PageFile::begin(folder_ / "a.html", {.force = true}, {}));
}

TEST_F(PageFileTest, IsNoFileThatIsReadWheneverThatIsKnown) {
  ASSERT_TRUE(io::write_text(folder_ / "a.c3d", "recorded", false));
  fs::create_symlink("a.c3d", folder_ / "link.html");
  EXPECT_EQ(
      PageFile::begin(folder_ / "link.html", {.force = true, .kept = {folder_ / "a.c3d"}}, {}).error().code,
      Code::usage);
  auto page = PageFile::begin(folder_ / "link.html", {.force = true}, {});
  ASSERT_TRUE(page);
  page->add_inputs({{.role = "markers", .path = (folder_ / "a.c3d").string()}});
  JobOutcome outcome;
  EXPECT_EQ(page->write("<p>", outcome).error().code, Code::usage);
  EXPECT_EQ(io::read_text(folder_ / "a.c3d").value(), "recorded");
}

}  // namespace
}  // namespace kinemark::pipeline
