// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files of one result belong together: each carries the digest that names the set. A program that is killed
// while it puts new files in the place of old ones can leave both; who reads several together asks here.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/data/table.h"
#include "kinemark/data/trajectories.h"

struct XXH3_state_s;

namespace kinemark::pipeline {

/// The name of a set: a digest of what the result is and what it was made from. The same work gives the same
/// name, whatever the files are called and however many threads there were.
class SetDigest {
 public:
  SetDigest();                                                 ///< of nothing yet
  SetDigest& add(std::string_view text);                       ///< with its length
  SetDigest& add(std::span<const double> numbers);             ///< to the last bit
  SetDigest& add(const data::Table& table);                    ///< labels, times and cells
  SetDigest& add(const data::Trajectories& markers);           ///< names, clock, positions, states
  SetDigest& add(const std::vector<data::InputFile>& inputs);  ///< by their checksums
  SetDigest& add(const std::vector<std::pair<std::string, std::string>>& options);  ///< names and values
  [[nodiscard]] std::string hex() const;                                            ///< 16 lower-case digits

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// The set that a file names, whatever its format; empty when it names none or cannot be read.
[[nodiscard]] std::string set_in(const std::filesystem::path& file);

/// A file and the set that it names, empty: none.
struct SetMember {
  std::filesystem::path file;  ///< for the message
  std::string set;             ///< as set_in()
};

/// Code::bad_input, naming two of them, unless all members name the same set or none does; and where the
/// content of one is not what was written (io/seal.h).
[[nodiscard]] Status check_same_set(const std::vector<SetMember>& members);

/// Files beside `file` that by their names belong to one result with it but name another set, one sentence
/// each. Reads their beginnings.
[[nodiscard]] std::vector<std::string> find_strangers(const std::filesystem::path& file);

/// Files of one result with `file` that were changed since they were written (io/seal.h), one sentence each;
/// `file` itself where its reader does not say so (JSON). Reads them all.
[[nodiscard]] std::vector<std::string> find_changed(const std::filesystem::path& file);

}  // namespace kinemark::pipeline
