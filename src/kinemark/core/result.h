// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <utility>

namespace kinemark {

/// Category of a failure. Each code maps to one exit status of the program (exit_status()).
enum class Code : std::uint8_t {
  usage,          ///< options that contradict each other or lie outside their range
  bad_input,      ///< a file or array whose content is wrong
  not_supported,  ///< valid input that this version cannot use
  io,             ///< a file cannot be opened, read or written
  device,         ///< an instrument does not answer
  cancelled,      ///< a signal or the caller asked to stop
};

/// One failure, described in one sentence: "file: place: what is wrong; what was expected".
struct Error {
  Code code = Code::bad_input;  ///< what kind of failure
  std::string message;          ///< one sentence for people
};

/// The value, or the reason why there is none. Library functions never print and never exit.
template <class T>
using Result = std::expected<T, Error>;
/// Success, or the reason why not.
using Status = std::expected<void, Error>;

/// Shorthand for returning a failure: `return fail(Code::io, "cannot open x.c3d");`
[[nodiscard]] inline std::unexpected<Error> fail(Code code, std::string message) {
  return std::unexpected(Error{code, std::move(message)});
}

/// The same failure with "where: " in front of its message, for adding a file name on the way up.
[[nodiscard]] std::unexpected<Error> fail_at(std::string_view where, const Error& error);

/// Exit status of the command line: usage 2, bad_input and not_supported 3, io 4, device 5, cancelled 130.
[[nodiscard]] int exit_status(Code code);

}  // namespace kinemark
