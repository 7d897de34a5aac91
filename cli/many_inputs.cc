// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/many_inputs.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "cli/console.h"
#include "kinemark/core/text.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/markers/marker_format.h"
#include "kinemark/pipeline/files/file_table.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {

bool are_many(const std::vector<std::filesystem::path>& given) {
  std::error_code ignored;
  return given.size() > 1 || (given.size() == 1 && std::filesystem::is_directory(given.front(), ignored));
}

bool ManyArguments::are_many() const {
  std::error_code ignored;
  return cli::are_many(inputs) || std::filesystem::is_directory(output, ignored) ||
         (!output.empty() && !output.has_filename());
}

std::string written_formats() {
  auto names = io::written_extensions();
  for (auto& name : names) name.erase(0, 1);
  return join(names);
}

Status ManyArguments::split_output() {
  if (inputs.size() < 2) return fail(Code::usage, "OUT is required: the file or folder to write");
  output = std::move(inputs.back());
  inputs.pop_back();
  if (to.empty()) return {};
  if (!are_many())
    return fail(Code::usage, fmt::format("{}: --to is for a folder; the ending of a file names its format",
                                         output.string()));
  return check_format();
}

Status ManyArguments::check_format() {
  if (!to.starts_with('.')) to.insert(0, ".");
  if (!io::check_marker_format("x" + to))
    return fail(Code::usage, fmt::format("--to: '{}' is none of {}", to.substr(1), written_formats()));
  return {};
}

Status ManyArguments::check_single() const {
  if (to.empty() && jobs == 1 && !keep_going) return {};
  const char* name = !to.empty() ? "to" : keep_going ? "keep-going" : "jobs";
  return fail(Code::usage,
              fmt::format("--{} is for several recordings, or a folder of them; there is one", name));
}

void add_in_and_out(CLI::App& command, ManyArguments& arguments, const char* in) {
  command.add_option("IN", arguments.inputs, in)->required();
  // The list before it takes all names, this one among them.
  command.add_option("OUT", arguments.output,
                     "File to write, its ending names the format; or a folder (REQUIRED)");
  command.add_option("--to", arguments.to, "Format of the files in the folder OUT: " + written_formats())
      ->type_name("FORMAT")
      ->group("Several recordings");
}

void add_many_options(CLI::App& command, ManyArguments& arguments) {
  command
      .add_option("--jobs", arguments.jobs,
                  "Recordings at a time; 0: one for each core. The bits are the same.")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group("Several recordings");
  command.add_flag("--keep-going", arguments.keep_going, "Go on with the others when one has failed")
      ->group("Several recordings");
}

int run_each(const CommonOptions& common, const ManyArguments& arguments, std::string ending,
             std::string belongs, decltype(pipeline::ManyJob::run_one) run_one) {
  if (arguments.output.empty())
    return report_error(
        {.code = Code::usage,
         .message = "several recordings need a folder for what is made of them; give --output"});
  auto list = pipeline::list_inputs(arguments.inputs, pipeline::marker_endings());
  if (!list) return report_error(list.error());
  std::error_code ignored;
  const auto known = pipeline::known_endings();
  if (!std::filesystem::is_directory(arguments.output, ignored) &&
      std::ranges::find(known, pipeline::ending_of(arguments.output)) != known.end())
    return report_error(
        {.code = Code::usage,
         .message = fmt::format("{}: several recordings need a folder for what is made of them",
                                arguments.output.string())});
  pipeline::ManyJob job;
  job.inputs = std::move(list->files);
  job.folder = arguments.output;
  job.pages = arguments.pages;
  job.ending = std::move(ending);
  job.jobs = arguments.jobs;
  job.keep_going = arguments.keep_going;
  job.belongs = std::move(belongs);
  job.run_one = std::move(run_one);
  settle(common, "recordings", job);
  const auto outcome = pipeline::run_many(job);
  if (!outcome) return report_error(outcome.error());
  for (const auto& note : list->notes) say(common, fmt::format("note: {}", note));
  for (const auto& trial : outcome->trials)
    if (trial.status == pipeline::TrialStatus::failed)
      (void)report_error({.code = Code::bad_input, .message = trial.said});
  if (common.json)
    print_result(pipeline::json_text(pipeline::trials_json(*outcome)) + "\n");
  else if (!common.quiet)
    print_result(pipeline::trial_table(*outcome));
  return outcome->exit_status();
}

}  // namespace kinemark::cli
