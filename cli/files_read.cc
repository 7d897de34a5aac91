// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/files_read.h"

#include <string>
#include <string_view>

#include "cli/hints.h"
#include "cli/word_list.h"

namespace kinemark::cli {
namespace {

namespace fs = std::filesystem;

/// Long names of options, or names of positional arguments, whose values are
/// written.
constexpr std::string_view kWritten =
    "OUT output out report figures record write-events write-cycles write-emg "
    "write-emg-cycles man-pages "
    "save-config";

bool is_written(const CLI::Option& option) {
  const std::string name = option.get_lnames().empty() ? option.get_name() : option.get_lnames().front();
  return has_word(kWritten, name) || name.starts_with("write-");
}

/// Of IN... OUT the list takes all words, what is written at its end.
bool ends_in_output(const CLI::App& command, const CLI::Option& option) {
  const auto* out = command.get_option_no_throw("OUT");
  return option.get_name() == "IN" && out != nullptr && out->count() == 0;
}

struct Values {
  std::vector<fs::path> read, written;
};

void add_read(const std::string& value, Values& values) {
  values.read.emplace_back(value);
  for (const char mark : {'=', ':'})
    if (const auto at = value.find(mark); at != std::string::npos)
      values.read.emplace_back(value.substr(at + 1));
}

Values values_of(const CLI::App& app) {
  Values values;
  const CLI::App& command = reached(app);
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options()) {
      if (option->get_items_expected_max() == 0 || option->count() == 0) continue;
      auto given = option->results();
      if (ends_in_output(command, *option) && given.size() > 1) {
        values.written.emplace_back(given.back());
        given.pop_back();
      }
      for (const auto& value : given)
        is_written(*option) ? (void)values.written.emplace_back(value) : add_read(value, values);
    }
  return values;
}

}  // namespace

std::vector<fs::path> files_read(const CLI::App& app) { return values_of(app).read; }

std::vector<fs::path> files_written(const CLI::App& app) { return values_of(app).written; }

}  // namespace kinemark::cli
