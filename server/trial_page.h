// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "server/trial_files.h"

namespace kinemark::server {

/// A page, and what it may do.
struct Page {
  std::shared_ptr<const std::string> html;  ///< never empty
  std::string policy;                       ///< value of Content-Security-Policy
};

/// Pages that were made, each good until its files change. Threads may ask at once.
class PageShelf {
 public:
  explicit PageShelf(std::size_t most_bytes);  ///< of all pages; those not asked for longest go first

  /// The page of a trial whose files are still as they were.
  [[nodiscard]] std::optional<Page> find(std::uint32_t number, const Stamps& stamps);
  /// Keep a page in the place of that trial's older one. One that is larger than the shelf is not kept.
  void keep(std::uint32_t number, Stamps stamps, Page page);

 private:
  struct Kept {
    std::uint32_t number;
    Stamps stamps;
    Page page;
  };
  void drop(std::list<Kept>::iterator kept);

  std::size_t most_bytes_, bytes_ = 0;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< last asked for first
};

/// The page of a trial: the report of a solved one, of markers their recording, which can be edited there,
/// else what the file holds. O(file). Fails as the readers of its files.
/// @param root      where pages begin, Keys::root()
/// @param geometry  further folders of models' meshes
[[nodiscard]] Result<Page> make_trial_page(const std::filesystem::path& path, std::string_view root,
                                           const std::vector<std::filesystem::path>& geometry = {});

/// A self-contained report page with a policy under which its own style sheet and script run and nothing
/// else. The first style sheet and the last script are its own: data stand before the script.
/// @param nonce  unpredictable, of new_secret()
/// @param asks   it may ask this server for more
[[nodiscard]] Page shielded(std::string html, std::string_view nonce, bool asks = false);

}  // namespace kinemark::server
