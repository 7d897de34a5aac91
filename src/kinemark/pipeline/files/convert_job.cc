// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/convert_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

enum class Kind { markers, table, model };

Kind kind_of(const std::string& ending) {
  if (ending == ".osim") return Kind::model;
  if (ending == ".mot" || ending == ".sto") return Kind::table;
  return Kind::markers;
}

std::vector<std::string> losses(const data::Trial& trial, const std::string& ending) {
  std::vector<std::string> notes = trial.warnings;
  if (ending == ".c3d") return notes;
  if (!trial.analog.names.empty())
    notes.push_back(
        fmt::format("{} analog channels cannot be stored in a {} file", trial.analog.names.size(), ending));
  if (!trial.force_plates.empty())
    notes.push_back(
        fmt::format("{} force plates cannot be stored in a {} file", trial.force_plates.size(), ending));
  if (!trial.events.empty())
    notes.push_back(fmt::format("{} events cannot be stored in a {} file", trial.events.size(), ending));
  return notes;
}

}  // namespace

Result<std::vector<std::string>> convert_file(const fs::path& in, const fs::path& out, bool force,
                                              double rate_hz) {
  const std::string from = ending_of(in), to = ending_of(out);
  if (kind_of(from) != kind_of(to))
    return fail(Code::usage,
                fmt::format("{} cannot become {}: markers, tables and models are different kinds of file",
                            in.string(), out.string()));
  switch (kind_of(from)) {
    case Kind::model: {
      const auto model = io::read_osim(in);
      if (!model) return std::unexpected(model.error());
      if (auto s = io::write_osim(out, *model, {.force = force}); !s) return std::unexpected(s.error());
      return model->warnings;
    }
    case Kind::table: {
      const auto table = io::read_table(in);
      if (!table) return std::unexpected(table.error());
      if (auto s = io::write_table(out, *table, {.force = force}); !s) return std::unexpected(s.error());
      return table->warnings;
    }
    case Kind::markers:
      break;
  }
  const auto trial = io::read_markers(in, {.rate_hz = rate_hz});
  if (!trial) return std::unexpected(trial.error());
  if (auto s = io::write_markers(out, *trial, force); !s) return std::unexpected(s.error());
  return losses(*trial, to);
}

}  // namespace kinemark::pipeline
