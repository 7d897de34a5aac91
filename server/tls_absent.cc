// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/tls.h"

namespace kinemark::server {

Result<std::shared_ptr<Tls>> Tls::read(const std::filesystem::path& /*certificate*/,
                                       const std::filesystem::path& /*key*/) {
  return fail(
      Code::not_supported,
      "this program was built without TLS, which --certificate needs: install libssl-dev and build again");
}

}  // namespace kinemark::server
