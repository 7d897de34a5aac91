// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/level_arguments.h"
#include "cli/motion_arguments.h"
#include "cli/serve_desk.h"
#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/pipeline/files/edit_job.h"
#include "kinemark/pipeline/files/model_input.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/live/live_input.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "server/bind_address.h"
#include "server/desktop.h"
#include "server/entrance.h"
#include "server/http_server.h"
#include "server/live_service.h"
#include "server/trial_page.h"
#include "server/trial_row.h"
#include "server/trial_service.h"

namespace kinemark::cli {
namespace {

struct ServeArguments {
  std::vector<std::filesystem::path> given;
  std::string bind = "127.0.0.1";
  std::uint16_t port = 0;
  bool no_open = false;
  std::filesystem::path model;             ///< of a live source, or of all recordings
  pipeline::IkJob asked;                   ///< of all solutions: tasks, folders of meshes
  std::vector<std::string> weights;        ///< of markers, NAME=W
  std::filesystem::path record;            ///< of a live source; of a device the folder of its trials
  std::filesystem::path rig;               ///< that the cameras of a device are aligned with
  std::vector<std::string> levels;         ///< of a live source, MARKER,MARKER,...
  motion::TrackOptions track;              ///< how the model follows a live source
  std::filesystem::path certificate, key;  ///< of TLS; empty: none

  /// A device was given.
  [[nodiscard]] bool is_desk() const {
    return std::ranges::any_of(given, [](const auto& one) { return names_desk(one.string()); });
  }
  /// A live source was given that is no device.
  [[nodiscard]] bool is_live() const {
    return !is_desk() && std::ranges::any_of(
                             given, [](const auto& one) { return pipeline::names_live_input(one.string()); });
  }
};

/// Something is said on how a model follows a live source.
bool says_how_to_follow(const ServeArguments& arguments) {
  return !arguments.levels.empty() || arguments.track.strict ||
         arguments.track.omega_rad_s != motion::TrackOptions().omega_rad_s;
}

/// A device is served alone, and knows of no model.
Status check_desk(const ServeArguments& arguments) {
  if (arguments.given.size() > 1)
    return fail(Code::usage, "a device is served alone; give it without other files and sources");
  const char* of_models = !arguments.model.empty()            ? "--model is"
                          : !arguments.asked.geometry.empty() ? "--geometry is"
                          : !arguments.asked.tasks.empty()    ? "--tasks is"
                          : !arguments.weights.empty()        ? "--weight is"
                          : says_how_to_follow(arguments)     ? "--level, --strict and --omega are"
                                                              : "";
  if (*of_models == '\0') return {};
  return fail(Code::usage, fmt::format("{} for markers and body models; {} is a device that gives counts",
                                       of_models, arguments.given.front().string()));
}

/// A live source is served alone, and only it, or a device, is recorded.
Status check_together(const ServeArguments& arguments) {
  if (arguments.is_desk()) return check_desk(arguments);
  if (!arguments.rig.empty())
    return fail(Code::usage, "--rig is for a device (sim:rig, serial:... or comedi:...)");
  if (arguments.is_live() && arguments.given.size() > 1)
    return fail(Code::usage, "a live source is served alone; give it without other files and sources");
  if (!arguments.is_live() && !arguments.record.empty())
    return fail(Code::usage, "--record is for a live source (sim:... or replay:FILE) or a device");
  if (!arguments.is_live() && says_how_to_follow(arguments))
    return fail(Code::usage, "--level, --strict and --omega are for a live source (sim:... or replay:FILE)");
  const char* of_files = !arguments.asked.geometry.empty() ? "geometry"
                         : !arguments.asked.tasks.empty()  ? "tasks"
                         : !arguments.weights.empty()      ? "weight"
                                                           : "";
  if (arguments.is_live() && *of_files != '\0')
    return fail(Code::usage, fmt::format("--{} is for files; {} is a live source", of_files,
                                         arguments.given.front().string()));
  return {};
}

/// What was given is there, and the model can be used.
Status check_files(const ServeArguments& arguments) {
  if (auto s = server::check_given(arguments.given); !s) return s;
  if (auto s = pipeline::check_geometry(arguments.asked.geometry); !s) return s;
  if (!arguments.asked.tasks.empty())
    if (const auto tasks = io::read_ik_tasks(arguments.asked.tasks); !tasks)
      return std::unexpected(tasks.error());
  if (arguments.model.empty()) return {};
  const auto model = pipeline::read_model_input(arguments.model);
  return model ? Status() : std::unexpected(model.error());
}

/// Certificate and key; nullptr where none were given.
Result<std::shared_ptr<server::Tls>> read_tls(const ServeArguments& arguments) {
  if (arguments.certificate.empty() && arguments.key.empty()) return nullptr;
  if (arguments.certificate.empty() || arguments.key.empty())
    return fail(Code::usage, "--certificate and --key belong together; give both");
  return server::Tls::read(arguments.certificate, arguments.key);
}

Result<server::Keys> make_keys(const ServeArguments& arguments, const server::Tls* tls, std::uint16_t port) {
  server::Keys keys{
      .hosts = server::own_hosts(arguments.bind, port, tls != nullptr ? &tls->names() : nullptr),
      .tls = tls != nullptr};
  if (keys.hosts.empty())
    return fail(
        Code::usage,
        fmt::format("--bind: {} stands for all addresses of this machine and the certificate {} names "
                    "none; give one address, or a certificate with a subjectAltName",
                    arguments.bind, arguments.certificate.string()));
  for (auto* key : {&keys.token, &keys.opening, &keys.session}) {
    auto secret = server::new_secret();
    if (!secret) return std::unexpected(secret.error());
    *key = std::move(*secret);
  }
  return keys;
}

/// A live source before its first frame.
struct LiveParts {
  std::string page, nonce;
  server::LiveFeedOptions feed;
};

Result<std::unique_ptr<LiveParts>> open_source(const CommonOptions& common, const ServeArguments& arguments) {
  auto input = pipeline::open_live_input(arguments.given.front().string(), arguments.model, common.seed);
  if (!input) return std::unexpected(input.error());
  auto track = arguments.track;
  if (auto s = take_levels(arguments.levels, track); !s) return std::unexpected(s.error());
  if (!input->model && says_how_to_follow(arguments))
    return fail(Code::usage, "--level and --omega need the body model that follows the source; give --model");
  if (auto s = pipeline::check_apart({arguments.record}, {input->file}); !s)
    return std::unexpected(s.error());
  if (auto s = pipeline::check_apart({arguments.record}, common.kept); !s) return std::unexpected(s.error());
  auto nonce = server::new_secret();
  if (!nonce) return std::unexpected(nonce.error());
  auto parts = std::make_unique<LiveParts>();
  parts->page = pipeline::live_page(*input, arguments.record, track);
  parts->nonce = std::move(*nonce);
  parts->feed = {.source = std::move(input->source),
                 .model = std::move(input->model),
                 .track = std::move(track),
                 .record = arguments.record,
                 .force = common.force,
                 .clock = std::make_shared<server::SteadyClock>(),
                 .say = [&common](std::string_view line) { say(common, line); }};
  return parts;
}

int serve_live(server::HttpServer& http, server::Keys keys, LiveParts& parts,
               std::unique_ptr<server::LiveFeed> feed) {
  server::LiveService service(std::move(keys), std::move(parts.page), parts.nonce, std::move(feed));
  http.run([&service](const server::Request& request, const server::Reply& reply) {
    service.handle(request, reply);
  });
  return 0;
}

/// Until a signal ends the program (watch_signals()), or an error comes.
int serve(const CommonOptions& common, ServeArguments& arguments) {
  for (const auto& text : arguments.weights) {
    const auto weight = parse_pair(text, "WEIGHT");
    if (!weight) return report_error(weight.error());
    arguments.asked.options.marker_weights.push_back({weight->first, weight->second});
  }
  const auto tls = read_tls(arguments);
  if (!tls) return report_error(tls.error());
  if (const auto s = server::check_bind_address(arguments.bind, *tls != nullptr); !s)
    return report_error(s.error());
  if (const auto s = check_together(arguments); !s) return report_error(s.error());
  const bool live = arguments.is_live(), desk = arguments.is_desk();
  if (const auto s = live || desk ? Status() : check_files(arguments); !s) return report_error(s.error());
  auto device = desk ? open_desk(common, arguments.given.front().string(), arguments.record, arguments.rig)
                     : Result<std::unique_ptr<DeskParts>>(nullptr);
  if (!device) return report_error(device.error());
  auto source = live ? open_source(common, arguments) : Result<std::unique_ptr<LiveParts>>(nullptr);
  if (!source) return report_error(source.error());
  const auto http = server::HttpServer::listen(arguments.bind, arguments.port, {}, *tls);
  if (!http) return report_error(http.error());
  auto keys = make_keys(arguments, tls->get(), (*http)->port());
  if (!keys) return report_error(keys.error());
  auto feed = live ? server::LiveFeed::create(std::move((*source)->feed))
                   : Result<std::unique_ptr<server::LiveFeed>>(nullptr);
  if (!feed) return report_error(feed.error());
  const bool opens = !arguments.no_open && server::has_desktop();
  if (!opens) keys->opening.clear();
  const auto address = [&tls, host = keys->hosts.front()](const std::string& token) {
    return fmt::format("{}://{}/?token={}", *tls ? "https" : "http", host, token);
  };
  // The address comes last: whoever waits for it may end the server at once.
  say(common, "the address, with its token, lets in whoever has it; Ctrl-C ends the server");
  print_result(address(keys->token) + "\n");
  if (output_failed()) return 0;  // which main() reports
  if (opens && !server::open_browser(address(keys->opening)))
    say(common, "note: no browser could be opened; open the address by hand");
  if (desk) return serve_desk(common, **http, std::move(*keys), **device);
  if (live) return serve_live(**http, std::move(*keys), **source, std::move(*feed));
  const auto root = keys->root();
  server::TrialService service(
      {.given = arguments.given,
       .keys = std::move(*keys),
       .make_page =
           [folders = arguments.asked.geometry, root](const std::filesystem::path& path) {
             return server::make_trial_page(path, root, folders);
           },
       .describe = server::describe_trial,
       .edits = {.time_now = pipeline::time_of_edit},
       .angles = {.model = arguments.model,
                  .asked = arguments.asked,
                  .threads = common.threads,
                  .seed = common.seed}});
  (*http)->run([&service](const server::Request& request, const server::Reply& reply) {
    service.handle(request, reply);
  });
  return 0;
}

}  // namespace

void add_serve(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("serve", "Trials in the browser, from this machine to this machine");
  command->footer(
      "Prints one line, the address with the token that lets a browser in, and answers until Ctrl-C.");
  const auto arguments = std::make_shared<ServeArguments>();
  command
      ->add_option(
          "FILE", arguments->given,
          ".c3d, .trc, .nwb, .csv, .tsv, .v3d, .mot, .sto, .mcap, or a folder of them, which is looked "
          "at again when the page is reloaded; or a live source: sim:walk, sim:arm, replay:FILE; or a "
          "device: "
          "sim:rig, serial:/dev/ttyACM0, comedi:/dev/comedi0")
      ->required();
  command->add_option(
      "-m,--model", arguments->model,
      "Body model, .osim, of a live source (a simulation has its own), or that recordings are "
      "solved with after edits; without, the .osim beside a recording");
  command->add_option(
      "--geometry", arguments->asked.geometry,
      "Folder with the meshes that an .osim names; looked into after the model's own folder and "
      "Geometry/ there. Repeatable.");
  command->add_option("--tasks", arguments->asked.tasks,
                      "OpenSim IKTaskSet, also within a setup of inverse kinematics: marker and coordinate "
                      "weights that recordings are solved with after edits");
  command->add_option("--weight", arguments->weights,
                      "Marker weight NAME=W for these solutions; 0 leaves the marker out. Repeatable.");
  command->add_option("--level", arguments->levels,
                      "Markers of one level of the model that follows a live source, A,B,...; '*' takes the "
                      "rest. Repeatable; as of track");
  command->add_flag("--strict", arguments->track.strict, "Levels are strict priorities, the highest first");
  command
      ->add_option("--omega", arguments->track.omega_rad_s,
                   "Stiffness by which the model follows a live source, rad/s: how far a push moves it")
      ->capture_default_str();
  command->add_option(
      "--record", arguments->record,
      "Recording to write, .mcap: every frame of a live source; of a device the folder of its "
      "trials, the current one when absent");
  command->add_option(
      "--rig", arguments->rig,
      "Rig as it is to stand, rig.toml: the page of a device says how to turn the cameras, by "
      "the tree of three LEDs held still in four places or more");
  command->add_option("--port", arguments->port, "Port to listen on; 0 takes any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option(
      "--certificate", arguments->certificate,
      "Certificate for TLS with its chain, .pem; needed for addresses that other machines reach");
  command->add_option("--key", arguments->key, "Key of that certificate without a password, .pem");
  command
      ->add_option("--bind", arguments->bind,
                   "Address of this machine to listen on: 127.0.0.1 or ::1; any other with --certificate")
      ->capture_default_str();
  command->add_flag("--no-open", arguments->no_open, "Open no browser, in a desktop session either");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return serve(common, *arguments); }; });
}

}  // namespace kinemark::cli
