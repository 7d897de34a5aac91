// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {

Result<std::unique_ptr<Canvas>> make_png_canvas(double, double, double) {
  return fail(Code::not_supported,
              "this program was built without Cairo and writes figures as SVG alone; install libcairo2-dev "
              "and build again");
}

}  // namespace kinemark::report
