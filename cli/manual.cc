// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "kinemark/core/text.h"
#include "kinemark/core/version.h"

namespace kinemark::cli {
namespace {

/// Text that man(7) prints as it stands: no line begins a request, no letter is another one.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string option_entry(const OptionText& option) {
  const std::string value = option.value.empty() ? "" : fmt::format(" \\fI{}\\fR", escaped(option.value));
  std::vector<std::string> names;
  for (const auto& name : option.names) names.push_back(fmt::format("\\fB{}\\fR", escaped(name)));
  return fmt::format(".TP\n{}{}\n{}\n", join(names), value, escaped(option.description));
}

/// Options by their groups, in the order in which these are met.
std::string option_sections(const CommandText& command) {
  std::vector<std::string> groups;
  for (const auto& option : command.options)
    if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
  std::string out = ".SH OPTIONS\n";
  for (const auto& group : groups) {
    if (group != "Options") out += fmt::format(".SS {}\n", escaped(group));
    for (const auto& option : command.options)
      if (option.group == group) out += option_entry(option);
  }
  return out;
}

std::string synopsis(const CommandText& command) {
  std::string words = "kinemark";
  for (const auto& word : command.words) words += " " + word;
  const std::string inner = command.commands.empty() ? "" : " \\fICOMMAND\\fR";
  const std::string usage = command.usage.empty() ? "" : fmt::format(" \\fI{}\\fR", escaped(command.usage));
  return fmt::format("\\fB{}\\fR [\\fIoptions\\fR]{}{}", escaped(words), inner, usage);
}

std::string first_line(std::string_view text) {
  std::string line(text.substr(0, text.find('\n')));
  while (!line.empty() && line.back() == '.') line.pop_back();
  return line;
}

std::string paragraphs(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const auto line = text.substr(at, end - at);
    out += line.empty() ? ".PP\n" : escaped(line) + "\n.br\n";
    at = end + 1;
  }
  return out;
}

}  // namespace

std::string manual_name(const CommandText& command) {
  return command.words.empty() ? "kinemark" : "kinemark-" + join(command.words, "-");
}

std::string manual_page(const CommandText& command, const CommandText& top) {
  std::string title = manual_name(command);
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string out = fmt::format(
      ".TH {} 1 \"\" \"kinemark {}\" \"kinemark\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n", escaped(title),
      kVersion, escaped(manual_name(command)), escaped(first_line(command.description)), synopsis(command));
  out += fmt::format(".SH DESCRIPTION\n{}\n", escaped(command.description));
  if (!command.footer.empty() && command.footer != top.footer) out += ".PP\n" + paragraphs(command.footer);
  if (!command.commands.empty()) {
    out += ".SH COMMANDS\n";
    for (const auto& below : command.commands)
      out += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", escaped(manual_name(below)), escaped(below.description));
  }
  if (!command.arguments.empty()) {
    out += ".SH ARGUMENTS\n";
    for (const auto& argument : command.arguments) out += option_entry(argument);
  }
  out += option_sections(command);
  out += ".SH EXIT STATUS\n" + paragraphs(top.footer);
  if (!command.words.empty()) out += ".SH SEE ALSO\n\\fBkinemark\\fR(1)\n";
  return out;
}

}  // namespace kinemark::cli
