// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/comedi/comedi_device.h"

namespace kinemark::stream {

Result<std::unique_ptr<Device>> open_comedi(const std::string& path) {
  return fail(Code::not_supported,
              path +
                  ": this kinemark was built without comedi, so it opens no A/D boards; install "
                  "libcomedi-dev and build it again");
}

}  // namespace kinemark::stream
