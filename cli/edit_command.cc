// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/word_list.h"
#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/edit_job.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

using data::EditKind;

/// An operation as an option: one value, two, or none.
struct Operation {
  EditKind kind;
  const char* option;
  int values;
  const char* type;
  const char* text;
};

constexpr std::array kOperations = {
    Operation{EditKind::relabel, "--relabel", 2, "OLD NEW", "A marker becomes another, with its samples"},
    Operation{EditKind::swap, "--swap", 2, "A B", "Two markers exchange their samples"},
    Operation{EditKind::cut, "--cut", 1, "MARKER", "Samples become 'rejected'"},
    Operation{EditKind::fill, "--fill", 1, "MARKER", "Gaps are filled, by --method"},
    Operation{EditKind::unfill, "--unfill", 1, "MARKER", "Filled samples become missing"},
    Operation{EditKind::crop, "--crop", 0, "", "Frames outside --from and --to are left out"},
    Operation{EditKind::mark_event, "--mark", 1, "LABEL", "A new event, --at its time"},
    Operation{EditKind::move_event, "--move", 1, "LABEL", "The event --at a time gets the time --to"},
    Operation{EditKind::delete_event, "--delete", 1, "LABEL", "The event --at a time is left out"},
    Operation{EditKind::region, "--region", 1, "NAME", "The frames --from and --to get a name"},
};

struct EditArguments {
  pipeline::EditJob job;
  std::array<std::vector<std::string>, kOperations.size()> values;
  std::array<bool, kOperations.size()> given{};
  std::string method, context, author;
  int undo = 0, redo = 0;
  bool list = false;
  std::string frames;
};

/// An option that says where or how, and the operations that it is for.
struct Where {
  std::string_view option;
  bool given;
  std::string_view operations;
};

/// Every option that says where or how is one of this operation, "--cut".
Status check_where(const EditArguments& arguments, std::string_view operation) {
  constexpr std::string_view kAll =
      "--relabel --swap --cut --fill --unfill --crop --mark --move --delete --region --exchanges --undo "
      "--redo";
  constexpr std::string_view kFrames = "--relabel --swap --cut --fill --unfill --crop --region";
  constexpr std::string_view kTo = "--relabel --swap --cut --fill --unfill --crop --move --region";
  constexpr std::string_view kEvents = "--mark --move --delete";
  const auto& job = arguments.job;
  const std::array<Where, 7> where{{{"--from", !job.from.empty(), kFrames},
                                    {"--to", !job.to.empty(), kTo},
                                    {"--frames", !arguments.frames.empty(), "--swap"},
                                    {"--at", !job.at.empty(), kEvents},
                                    {"--context", !arguments.context.empty(), kEvents},
                                    {"--method", !arguments.method.empty(), "--fill"},
                                    {"--author", !arguments.author.empty(), kAll}}};
  for (const auto& one : where)
    if (one.given && !has_word(one.operations, operation))
      return fail(Code::usage, fmt::format("{} is for {}; this is {}", one.option,
                                           with_commas(one.operations), operation));
  return {};
}

/// What was asked for, apart from when. Nothing: to look.
Status read_edit(EditArguments& arguments) {
  std::vector<data::Edit> edits;
  std::vector<std::string> operations;
  for (std::size_t i = 0; i < kOperations.size(); ++i) {
    const auto& values = arguments.values[i];
    if (values.empty() && !arguments.given[i]) continue;
    data::Edit edit{.kind = kOperations[i].kind};
    if (edit.kind == EditKind::region)
      edit.name = values.front();
    else if (edit.kind == EditKind::mark_event || edit.kind == EditKind::move_event ||
             edit.kind == EditKind::delete_event)
      edit.label = values.front();
    else if (!values.empty())
      edit.marker = values.front();
    if (values.size() > 1) edit.other = values.back();
    edits.push_back(std::move(edit));
    operations.emplace_back(kOperations[i].option);
  }
  const auto add = [&](bool asked, const char* option, data::Edit edit) {
    if (!asked) return;
    edits.push_back(std::move(edit));
    operations.emplace_back(option);
  };
  add(arguments.undo > 0, "--undo", {.kind = EditKind::undo, .count = arguments.undo});
  add(arguments.redo > 0, "--redo", {.kind = EditKind::redo, .count = arguments.redo});
  add(arguments.job.exchanges, "--exchanges", {.kind = EditKind::swap});
  if (arguments.list) operations.emplace_back("--list");
  if (operations.size() > 1)
    return fail(Code::usage, fmt::format("{} are several operations; need one at a time", join(operations)));
  if (operations.empty())
    return fail(Code::usage, "no operation, such as --swap A B; --list shows what was edited");
  if (auto s = check_where(arguments, operations.front()); !s || arguments.list) return s;
  auto& edit = edits.front();
  edit.frames = arguments.frames;
  edit.method = arguments.method;
  edit.context = arguments.context;
  edit.author = arguments.author;
  edit.made = pipeline::time_of_edit();
  arguments.job.edit = std::move(edit);
  return {};
}

std::string list_text(const pipeline::EditOutcome& outcome) {
  const auto counts = outcome.list.in_force();
  std::string text;
  for (std::size_t i = 0; i < outcome.list.edits.size(); ++i) {
    const auto& edit = outcome.list.edits[i];
    const bool is_history = edit.kind == EditKind::undo || edit.kind == EditKind::redo;
    const bool undone = !is_history && counts && !std::ranges::binary_search(*counts, i);
    text +=
        printable(fmt::format("{:>4}  {:<20}  {}{}{}", edit.id, edit.made, describe(edit),
                              undone ? " (undone)" : "", edit.author.empty() ? "" : ", by " + edit.author)) +
        "\n";
  }
  return text;
}

void print_edit_outcome(const CommonOptions& common, const pipeline::EditOutcome& outcome, bool list) {
  for (const auto& note : outcome.warnings) say(common, fmt::format("note: {}", note));
  const auto depth = outcome.list.depth();
  const auto& edits = outcome.list.edits;
  for (auto i = edits.size() - outcome.appended; i < edits.size() && !list; ++i)
    say(common, fmt::format("{}: {}", outcome.journal.string(), describe(edits[i])));
  say(common, fmt::format("{} in force, {} undone that can be redone",
                          counted(static_cast<std::int64_t>(depth.undo), "edit"), depth.redo));
  if (common.json)
    print_result(pipeline::json_text(pipeline::edit_json(outcome)) + "\n");
  else if (list)
    print_result(list_text(outcome));
}

int run_command(const CommonOptions& common, EditArguments& arguments) {
  if (auto s = read_edit(arguments); !s) return report_error(s.error());
  return run_job(common, "edits", arguments.job, pipeline::run_edit,
                 [&](const CommonOptions& options, const pipeline::EditOutcome& outcome) {
                   print_edit_outcome(options, outcome, arguments.list);
                 });
}

}  // namespace

void add_edit(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("edit", "Labels, samples, gaps and events changed by hand, beside the file");
  command->footer(
      "One operation a call is appended to the journal NAME_edits.jsonl beside the recording, which itself\n"
      "is only read; 'clean --edits' and 'convert --edits' apply it. WHEN is a frame by the file's own "
      "number,\n"
      "120, or a time on its clock, 1.5s.");
  const auto arguments = std::make_shared<EditArguments>();
  auto& job = arguments->job;
  command->add_option("IN", job.input, "Recording: any marker file that is read")->required();
  command->add_option("--edits", job.edits, "Journal; NAME_edits.jsonl beside the recording when absent")
      ->type_name("FILE");
  for (std::size_t i = 0; i < kOperations.size(); ++i) {
    const auto& operation = kOperations[i];
    if (operation.values == 0)
      command->add_flag(operation.option, arguments->given[i], operation.text)->group("Operation, one of");
    else
      command->add_option(operation.option, arguments->values[i], operation.text)
          ->expected(operation.values)
          ->type_name(operation.type)
          ->group("Operation, one of");
  }
  command
      ->add_flag("--exchanges", job.exchanges,
                 "Markers that surely carry each other's label get their own: a swap of each pair")
      ->group("Operation, one of");
  const auto count = [&](const char* name, int& value, const char* text) {
    command->add_option(name, value, text)
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000))
        ->group("Operation, one of");
  };
  count("--undo", arguments->undo, "The last operations in force no longer count");
  count("--redo", arguments->redo, "The last that were undone count again");
  command->add_flag("--list", arguments->list, "Show all operations, append none")
      ->group("Operation, one of");
  const auto when = [&](const char* name, std::string& value, const char* text) {
    command->add_option(name, value, text)->type_name("WHEN")->group("Where and how");
  };
  when("--from", job.from, "First frame; the recording's when absent");
  when("--to", job.to, "Last frame, included; the recording's when absent");
  command
      ->add_option("--frames", arguments->frames,
                   "Of a swap: its frames, 1,4,19-20, or 1-127/3 for every third")
      ->type_name("LIST")
      ->group("Where and how");
  when("--at", job.at, "Of an event");
  command->add_option("--context", arguments->context, "Of an event: Left, Right, General")
      ->type_name("NAME")
      ->group("Where and how");
  command
      ->add_option("--method", arguments->method,
                   "auto (when absent), linear, cubic, pchip, walk, rigid, regression or pca")
      ->type_name("NAME")
      ->group("Where and how");
  command->add_option("--author", arguments->author, "Who edits, for the journal")
      ->type_name("NAME")
      ->group("Where and how");
  command->add_option("--rate", job.rate_hz,
                      "Frame rate of a marker file that stores none (.v3d, .amc, tables without times), Hz");
  command->add_option("--unit", job.unit, "Unit of a table of coordinates that states none: mm, cm or m")
      ->type_name("UNIT");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
