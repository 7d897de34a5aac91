// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "server/angle_service.h"
#include "server/edit_service.h"
#include "server/entrance.h"
#include "server/message.h"
#include "server/routes.h"
#include "server/trial_files.h"
#include "server/trial_page.h"
#include "server/trial_row.h"
#include "server/worker.h"

namespace kinemark::server {

/// What is served, to whom, and who reads it.
struct ServiceOptions {
  std::vector<std::filesystem::path> given;                             ///< files and folders
  Keys keys;                                                            ///< what lets in
  std::function<Result<Page>(const std::filesystem::path&)> make_page;  ///< as make_trial_page()
  std::function<TrialRow(const std::filesystem::path&)> describe;       ///< as describe_trial()
  std::size_t most_page_bytes = 256UL << 20;                            ///< of pages that are kept
  EditServiceOptions edits;                                             ///< of recordings
  AngleServiceOptions angles;                                           ///< of recordings
};

/// A request in, a response out. Files are read on threads of their own: one for the list, one for what the
/// list says, one for pages, so that a long recording holds nobody else up.
class TrialService {
 public:
  explicit TrialService(ServiceOptions options);

  /// Answer a request. Returns at once; `reply` may be called before that, or later from another thread, or
  /// never where the service ends first.
  void handle(Request request, const Reply& reply);

 private:
  /// What is wrong, in a page that looks like the others.
  void send_sentence(int status, std::string_view title, std::string_view sentence, const Reply& reply) const;
  void send_busy(const Reply& reply) const;
  void send_list(bool as_json, const Reply& reply);
  void send_trial(std::uint32_t number, const Reply& reply);
  void send_edits(const Request& request, const Route& route, const Reply& reply);
  void send_angles(const Request& request, const Route& route, const Reply& reply);
  [[nodiscard]] std::optional<TrialFile> find_trial(std::uint32_t number);
  void make_page(const TrialFile& trial, const Reply& reply);
  [[nodiscard]] TrialRow row_of(const TrialFile& trial);
  void read_row(const TrialFile& trial);

  struct Described {
    Stamps stamps;
    TrialRow row;
  };

  ServiceOptions options_;
  Entrance entrance_;
  TrialFiles files_;
  PageShelf shelf_;
  EditService edits_;
  AngleService angles_;
  std::mutex mutex_;  ///< of rows_ and being_read_
  std::map<std::uint32_t, Described> rows_;
  std::set<std::uint32_t> being_read_;
  Worker list_worker_, row_worker_, page_worker_;  ///< end first
};

}  // namespace kinemark::server
