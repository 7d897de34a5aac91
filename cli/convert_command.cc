// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/recording_options.h"
#include "kinemark/pipeline/files/convert_job.h"

namespace kinemark::cli {
namespace {

struct ConvertArguments {
  pipeline::ConvertJob job;
  bool merge = false;
  ManyArguments many;
};

/// Files of one recording into one.
int merge_files(const CommonOptions& common, ConvertArguments& arguments) {
  auto& job = arguments.job;
  auto list = pipeline::list_inputs(arguments.many.inputs, pipeline::marker_endings());
  if (!list) return report_error(list.error());
  for (const auto& note : list->notes) say(common, fmt::format("note: {}", note));
  if (list->files.size() < 2)
    return report_error({.code = Code::usage,
                         .message = fmt::format("--merge is for several files of one recording; {} is one",
                                                list->files.front().filename().string())});
  job.in = list->files.front();
  job.merged.assign(list->files.begin() + 1, list->files.end());
  job.out = arguments.many.output;
  return run_job(common, "files", job, pipeline::run_convert, print_written);
}

int run_command(const CommonOptions& common, ConvertArguments& arguments) {
  auto& job = arguments.job;
  auto& many = arguments.many;
  if (auto s = many.split_output(); !s) return report_error(s.error());
  if (arguments.merge) return merge_files(common, arguments);
  if (!many.are_many()) {
    if (auto s = many.check_single(); !s) return report_error(s.error());
    job.in = many.inputs.front();
    job.out = many.output;
    return run_job(common, "files", job, pipeline::run_convert, print_written);
  }
  if (many.to.empty())
    return report_error({.code = Code::usage,
                         .message = fmt::format("{}: files for a folder need --to and one of {}",
                                                many.output.string(), written_formats())});
  if (auto s = pipeline::check_for_several(job); !s) return report_error(s.error());
  const auto convert_one = [&job](const std::filesystem::path& input, const std::filesystem::path& output,
                                  const std::filesystem::path& /*page*/,
                                  const pipeline::JobSettings& settings) -> Result<pipeline::JobOutcome> {
    pipeline::ConvertJob one = job;
    static_cast<pipeline::JobSettings&>(one) = settings;
    one.in = input;
    drop_what_it_states(one, input);
    one.out = output;
    return pipeline::run_convert(one);
  };
  return run_each(common, many, many.to, "", convert_one);
}

}  // namespace

void add_convert(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("convert", "Files in another format of their kind");
  command->footer(
      "Markers: 'kinemark help --formats' lists what is read, what is written, and what each format keeps. "
      "Tables: .mot, .sto; .mat is written; a recording becomes a .mot or .sto of the forces of its plates. "
      "Orientations: .sto, .csv. "
      "Models: .osim, in their own version from 2.0 on, older ones as "
      "4.0; .urdf, and "
      "for MuJoCo .xml or .mjcf, are written.\n"
      "Several recordings, or a folder of them: OUT is a folder, --to the format; what is there already is "
      "not done "
      "again.");
  const auto arguments = std::make_shared<ConvertArguments>();
  auto& job = arguments->job;
  auto& many = arguments->many;
  add_in_and_out(*command, many, "File to read; several, or a folder of recordings");
  add_many_options(*command, many);
  command->add_option("--skeleton", job.skeleton,
                      "Skeleton (.asf) of an .amc; the one beside it when absent");
  command->add_flag(
      "--merge", arguments->merge,
      "The files IN are of one recording: parts in time or sets of markers, to be one file OUT");
  command->add_option("--resample", job.resample_hz, "Write a marker file at this frame rate, Hz");
  command->add_option("-m,--model", job.model,
                      "Model (.osim) that a table of coordinates is of, which then becomes a .bvh or .glb");
  command->add_flag(
      "--orientations", job.orientations,
      "Write the orientations that the file holds (C3D of Theia and Visual3D, rigid bodies of QTM "
      "and Motive): .sto of OpenSense, for ik, or .csv");
  command->add_flag("--ndx-pose", job.ndx_pose,
                    "In an .nwb also a PoseEstimation of ndx-pose, which pynwb then needs to read the file");
  add_recording_options(*command, job, pipeline::Doubtful::keep);
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
