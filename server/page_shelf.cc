// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/page_shelf.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace kinemark::server {

PageShelf::PageShelf(std::size_t most_bytes) : most_bytes_(most_bytes) {}

void PageShelf::drop(std::list<Kept>::iterator kept) {
  bytes_ -= kept->page.html->size();
  kept_.erase(kept);
}

std::optional<Page> PageShelf::find(std::uint32_t number, const Stamps& stamps) {
  const std::scoped_lock lock(mutex_);
  const auto at = std::ranges::find(kept_, number, &Kept::number);
  if (at == kept_.end()) return std::nullopt;
  if (at->stamps != stamps) {
    drop(at);
    return std::nullopt;
  }
  kept_.splice(kept_.begin(), kept_, at);
  return at->page;
}

void PageShelf::keep(std::uint32_t number, Stamps stamps, Page page) {
  const std::scoped_lock lock(mutex_);
  if (const auto at = std::ranges::find(kept_, number, &Kept::number); at != kept_.end()) drop(at);
  const std::size_t size = page.html->size();
  if (size > most_bytes_) return;
  while (bytes_ + size > most_bytes_) drop(std::prev(kept_.end()));
  kept_.push_front({number, std::move(stamps), std::move(page)});
  bytes_ += size;
}

}  // namespace kinemark::server
