// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/result.h"

namespace kinemark {

std::unexpected<Error> fail_at(std::string_view where, const Error& error) {
  return std::unexpected(Error{error.code, std::string(where) + ": " + error.message});
}

int exit_status(Code code) {
  switch (code) {
    case Code::usage:
      return 2;
    case Code::bad_input:
    case Code::not_supported:
      return 3;
    case Code::io:
      return 4;
    case Code::device:
      return 5;
    case Code::cancelled:
      return 130;
  }
  return 3;
}

}  // namespace kinemark
