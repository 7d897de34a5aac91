// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/completion.h"

#include <memory>

#include "cli/command.h"
#include "cli/console.h"

namespace kinemark::cli {

void add_completion(CLI::App& app, const CommonOptions&, Run& run) {
  auto* command =
      app.add_subcommand("completion", "A script with which a shell completes commands and options");
  command->footer(
      "Try it at once: source <(kinemark completion bash). 'cmake --install' puts the scripts where the "
      "shells look.");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&app, shell, &run] {
    run = [&app, shell] {
      const auto top = command_tree(app);
      print_result(*shell == "bash"  ? bash_completion(top)
                   : *shell == "zsh" ? zsh_completion(top)
                                     : fish_completion(top));
      return 0;
    };
  });
}

}  // namespace kinemark::cli
