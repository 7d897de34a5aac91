// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "kinemark/pipeline/files/info_job.h"
#include "kinemark/pipeline/motion/edited_page.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "server/entrance.h"
#include "server/served_page.h"
#include "server/trial_row.h"

namespace kinemark::server {
namespace {

/// A page of viewer/, behind a policy of its own.
Result<Page> report_page(Result<std::string> html, bool asks) {
  if (!html) return std::unexpected(html.error());
  const auto nonce = new_secret();
  if (!nonce) return std::unexpected(nonce.error());
  return shielded(std::move(*html), *nonce, asks);
}

}  // namespace

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

Page shielded(std::string html, std::string_view nonce, bool asks) {
  constexpr std::string_view kStyle = "<style", kScript = "<script type=\"module\"";
  constexpr std::string_view kNothing = "content=\"default-src 'none'; ", kAsks = "connect-src 'self'; ";
  const std::string attribute = fmt::format(" nonce=\"{}\"", nonce);
  if (const auto at = html.rfind(kScript); at != std::string::npos)
    html.insert(at + std::string_view("<script").size(), attribute);
  if (const auto at = html.find(kStyle); at != std::string::npos) html.insert(at + kStyle.size(), attribute);
  // A file by itself may ask nobody: its own policy is the first thing in it.
  if (const auto at = html.find(kNothing); asks && at != std::string::npos)
    html.insert(at + kNothing.size(), kAsks);
  return {.html = std::make_shared<const std::string>(std::move(html)),
          .policy = fmt::format("default-src 'none'; {1}script-src 'nonce-{0}'; style-src 'nonce-{0}'; "
                                "img-src data: blob:; media-src blob:; worker-src blob:; base-uri 'none'; "
                                "form-action 'none'; frame-ancestors 'none'",
                                nonce, asks ? kAsks : "")};
}

Result<Page> make_trial_page(const std::filesystem::path& path, std::string_view root,
                             const std::vector<std::filesystem::path>& geometry) {
  if (is_solved(path)) {
    pipeline::MarkersPageOptions options;
    options.geometry = geometry;
    return report_page(pipeline::page_of(path, options), false);
  }
  pipeline::InfoJob job;
  job.file = path;
  job.edits = io::kEditsNone;
  const auto info = pipeline::run_info(job);
  if (!info) return std::unexpected(info.error());
  if (std::holds_alternative<pipeline::MarkerFileFacts>(info->facts))
    return report_page(pipeline::edited_page(path), true);
  return Page{std::make_shared<const std::string>(facts_page(*info, root)), std::string(kOwnPolicy)};
}

}  // namespace kinemark::server
