// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/terminal.h"

namespace kinemark::screens {

Result<std::unique_ptr<Terminal>> Terminal::open() {
  return fail(Code::not_supported,
              "this program was built without ncurses, which draws the menus; give a source and -o FILE");
}

}  // namespace kinemark::screens
