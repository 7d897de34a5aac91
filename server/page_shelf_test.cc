// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/page_shelf.h"

#include <gtest/gtest.h>

namespace kinemark::server {
namespace {

Page page_of(std::size_t bytes, char letter = 'x') {
  return {.html = std::make_shared<const std::string>(bytes, letter), .policy = "policy"};
}

Stamps stamps(std::int64_t changed_ns) { return {Stamp{.bytes = 1, .changed_ns = changed_ns}, std::nullopt}; }

TEST(PageShelf, KeepsAPageUntilItsFilesChange) {
  PageShelf shelf(100);
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  shelf.keep(1, stamps(1), page_of(10, 'a'));
  const auto page = shelf.find(1, stamps(1));
  ASSERT_TRUE(page);
  EXPECT_EQ(*page->html, std::string(10, 'a'));
  EXPECT_EQ(page->policy, "policy");
  EXPECT_FALSE(shelf.find(2, stamps(1)));
  EXPECT_FALSE(shelf.find(1, stamps(2)));
  EXPECT_FALSE(shelf.find(1, stamps(1))) << "the older file does not come back";
}

TEST(PageShelf, ACompanionIsAFileOfThePageToo) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(10));
  auto with_companion = stamps(1);
  with_companion.back() = Stamp{.bytes = 5};
  EXPECT_FALSE(shelf.find(1, with_companion));
}

TEST(PageShelf, ANewerPageTakesThePlaceOfTheOlder) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(90, 'a'));
  shelf.keep(1, stamps(2), page_of(90, 'b'));
  EXPECT_EQ(shelf.find(1, stamps(2))->html->front(), 'b');
}

TEST(PageShelf, WhatNobodyAskedForLongestGoesFirst) {
  PageShelf shelf(100);
  for (std::uint32_t n = 1; n <= 3; ++n) shelf.keep(n, stamps(1), page_of(33));
  EXPECT_TRUE(shelf.find(1, stamps(1)));
  shelf.keep(4, stamps(1), page_of(33));
  EXPECT_FALSE(shelf.find(2, stamps(1)));
  for (const std::uint32_t n : {1U, 3U, 4U}) EXPECT_TRUE(shelf.find(n, stamps(1))) << n;
  shelf.keep(5, stamps(1), page_of(100));
  for (const std::uint32_t n : {1U, 3U, 4U}) EXPECT_FALSE(shelf.find(n, stamps(1))) << n;
  EXPECT_TRUE(shelf.find(5, stamps(1)));
}

TEST(PageShelf, APageThatIsTooLargeIsNotKeptNorTheOlderOne) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(10));
  shelf.keep(2, stamps(1), page_of(10));
  shelf.keep(1, stamps(2), page_of(101));
  EXPECT_FALSE(shelf.find(1, stamps(2)));
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  EXPECT_TRUE(shelf.find(2, stamps(1))) << "others stay";
}

TEST(PageShelf, APageThatIsBeingSentOutlivesTheShelf) {
  PageShelf shelf(10);
  shelf.keep(1, stamps(1), page_of(10, 'a'));
  const auto sent = shelf.find(1, stamps(1));
  shelf.keep(2, stamps(1), page_of(10, 'b'));
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  EXPECT_EQ(*sent->html, std::string(10, 'a'));
}

}  // namespace
}  // namespace kinemark::server
