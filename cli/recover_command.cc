// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/recover_job.h"

namespace kinemark::cli {

void add_recover(CLI::App& app, const Globals& globals, Run& run) {
  auto* command =
      app.add_subcommand("recover", "A whole recording from one that was cut, damaged or never closed");
  command->footer(
      "Keeps every message whose checksum is right, those beyond the damage too, and writes down in the new\n"
      "file what was left out. The original is only read. Exit status 1 when bytes had to be left out.");
  struct Arguments {
    std::string in, out;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("IN", arguments->in, "Recording to read (.mcap)")->required();
  command->add_option("OUT", arguments->out, "Recording to write")->required();
  command->callback([&globals, arguments, &run] {
    run = [&globals, arguments] {
      const auto done = pipeline::recover_file(arguments->in, arguments->out, globals.force);
      if (!done) return report_error(done.error());
      for (const auto& warning : done->at("warnings"))
        say(globals, fmt::format("{}: {}", arguments->in, warning.get<std::string>()));
      say(globals,
          fmt::format("wrote {}: {} messages", arguments->out, done->at("messages").get<std::int64_t>()));
      if (globals.json) fmt::print("{}\n", done->dump(2));
      return done->at("bytes_left_out").get<std::uint64_t>() > 0 ? 1 : 0;
    };
  });
}

}  // namespace kinemark::cli
