// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/pipeline/files/edit_session.h"
#include "server/message.h"
#include "server/trial_files.h"
#include "server/worker.h"

namespace kinemark::server {

/// An operation that somebody asks for, and on what.
struct EditRequest {
  std::size_t expected = 0;  ///< operations that the journal holds, as who asks believes
  data::Edit edit;           ///< one operation, its id as given
};

/// Parse {"expected": 12, "edit": {"do": "swap", ...}}, the operation in the words of a journal.
/// Code::bad_input, one sentence: no such object, a value of another type, or what io::parse_edit() says.
[[nodiscard]] Result<EditRequest> parse_edit_request(std::string_view body);

/// What the edits of recordings may take.
struct EditServiceOptions {
  std::size_t most_sessions = 4;          ///< recordings that are kept ready
  std::size_t most_bytes = 1UL << 30;     ///< of all of them but the one that was asked for last
  std::function<std::string()> time_now;  ///< "2026-11-24T09:30:00Z", for the journal
};

/// Edits of recordings: what there is, what they make of the recording, and one operation more. One thread
/// does them in the order in which they come.
///
/// An operation is answered with 200 when it is on the disk; with 409 and the state when the journal holds
/// other operations than who asked believes; with 422 and the reason when it cannot be applied; 400 for what
/// is no operation, 415 for another type of content, 503 where the journal cannot be written now. Answers are
/// JSON: pipeline::editing_json() or pipeline::edited_page_json(), or {"error": one sentence}, with "editing"
/// beside it where the status is 409.
class EditService {
 public:
  explicit EditService(EditServiceOptions options);

  /// Answer a request for /api/trial/N/edits (GET, POST) or /api/trial/N/data (GET) of somebody who was let
  /// in. Returns false, and never replies, where too much waits already.
  [[nodiscard]] bool handle(const Request& request, const TrialFile& trial, bool wants_data,
                            const Reply& reply);

 private:
  struct Open {
    std::filesystem::path path;
    std::optional<Stamp> stamp;
    pipeline::EditSession session;
  };

  [[nodiscard]] Response answer(const Request& request, const TrialFile& trial, bool wants_data);
  [[nodiscard]] Response append(const Request& request, pipeline::EditSession& session);
  [[nodiscard]] Result<pipeline::EditSession*> session_of(const std::filesystem::path& path);

  EditServiceOptions options_;
  std::list<Open> open_;  ///< asked for last first; of the worker alone
  Worker worker_;         ///< ends first
};

}  // namespace kinemark::server
