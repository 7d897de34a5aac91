// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the acceptance script edits.py drives.
//
//   edits_acceptance_tool append FILE    appends edits without end, the id of each acknowledged one on stdout
//   edits_acceptance_tool check FILE     "EDITS NOTES FIRST_WRONG_EDIT|none" of what is there
#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "kinemark/io/edits/edit_journal.h"

namespace {

using namespace kinemark;

const data::EditedRecording kRecording{.name = "walk.c3d", .bytes = 1000, .hash = "0123456789abcdef"};

/// An edit that tells its number: each of a length of its own.
data::Edit numbered_edit(std::int64_t number) {
  return {.kind = data::EditKind::region,
          .first_frame = number,
          .last_frame = 2 * number,
          .name = fmt::format("n{}{}", number, std::string(static_cast<std::size_t>(number * 37 % 300), 'x')),
          .id = std::to_string(number)};
}

int failed(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return exit_status(error.code);
}

int append(const char* path) {
  auto journal = io::EditJournal::open(path, kRecording);
  if (!journal) return failed(journal.error());
  for (auto number = std::ssize(journal->list().edits);; ++number) {
    if (auto s = journal->append(numbered_edit(number)); !s) return failed(s.error());
    const auto line = fmt::format("{}\n", number);
    if (::write(STDOUT_FILENO, line.data(), line.size()) < 0) return 4;
  }
}

int check_file(const char* path) {
  const auto read = io::read_edits(path);
  if (!read) return failed(read.error());
  std::int64_t wrong = -1;
  for (std::int64_t i = 0; i < std::ssize(read->list.edits) && wrong < 0; ++i) {
    const auto edit = numbered_edit(i);
    const auto& there = read->list.edits[static_cast<std::size_t>(i)];
    if (!there.same_as(edit) || there.id != edit.id) wrong = i;
  }
  fmt::print("{} {} {}\n", read->list.edits.size(), read->notes.size(),
             wrong < 0 ? "none" : std::to_string(wrong));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view verb = argc > 1 ? argv[1] : "";
  if (verb == "append" && argc == 3) return append(argv[2]);
  if (verb == "check" && argc == 3) return check_file(argv[2]);
  fmt::print(stderr, "usage: edits_acceptance_tool append FILE | check FILE\n");
  return 2;
}
