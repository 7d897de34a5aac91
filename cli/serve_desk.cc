// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/serve_desk.h"

#include <utility>

#include "cli/console.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/desk/acquire_desk.h"
#include "kinemark/pipeline/desk/desk_page.h"

namespace kinemark::cli {
namespace {

constexpr std::string_view kRig = "sim:rig";

}  // namespace

bool names_desk(std::string_view argument) {
  return argument == kRig || (argument.starts_with(kRig) && argument[kRig.size()] == '?') ||
         argument.starts_with("serial:") || argument.starts_with("comedi:");
}

Result<std::unique_ptr<DeskParts>> open_desk(const CommonOptions& common, const std::string& uri,
                                             const std::filesystem::path& folder,
                                             const std::filesystem::path& rig) {
  std::error_code none;
  const std::filesystem::path trials = folder.empty() ? "." : folder;
  if (std::filesystem::exists(trials, none) && !std::filesystem::is_directory(trials, none))
    return fail(Code::usage,
                fmt::format("--record: {} is a file; trials of a device go into a folder", trials.string()));
  auto nonce = server::new_secret();
  if (!nonce) return std::unexpected(nonce.error());
  auto parts = std::make_unique<DeskParts>();
  auto shown = std::filesystem::weakly_canonical(trials, none);
  parts->page = pipeline::desk_page(uri, none ? trials : shown);
  parts->nonce = std::move(*nonce);
  auto& [desk, session, stop, ended] = parts->served;
  pipeline::TrialFiles files{.folder = trials, .seed = common.seed};
  if (!rig.empty()) {
    auto wanted_rig = io::read_rig(rig);
    if (!wanted_rig) return std::unexpected(wanted_rig.error());
    files.wanted_rig = std::move(*wanted_rig);
  }
  pipeline::Wanted wanted;
  wanted.source = uri;
  if (pipeline::is_session(trials)) {
    auto continued = pipeline::Session::open(trials, {});
    if (!continued) return std::unexpected(continued.error());
    for (const auto& note : continued->notes()) say(common, note);
    wanted.subject = continued->subject();
    files.session = std::move(*continued);
  }
  auto acquire_desk = std::make_unique<pipeline::AcquireDesk>(std::move(files));
  session = std::make_unique<pipeline::DeskSession>(*acquire_desk, wanted);
  if (const auto& failure = acquire_desk->failure()) return std::unexpected(*failure);
  desk = std::move(acquire_desk);
  return parts;
}

int serve_desk(const CommonOptions& common, server::HttpServer& http, server::Keys keys, DeskParts& parts) {
  end_gently();
  parts.served.stop = [] { return signal_that_came() != 0; };
  parts.served.ended = [&common, &http](const pipeline::DeskState& state) {
    for (const auto& file : state.kept) say(common, fmt::format("kept {}", file));
    http.stop();
  };
  server::DeskService service(std::move(keys), std::move(parts.page), parts.nonce, std::move(parts.served));
  http.run([&service](const server::Request& request, const server::Reply& reply) {
    service.handle(request, reply);
  });
  say(common, "kinemark: the command was stopped");
  return 128 + signal_that_came();
}

}  // namespace kinemark::cli
