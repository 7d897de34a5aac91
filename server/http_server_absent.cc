// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/http_server.h"

namespace kinemark::server {

Result<std::unique_ptr<HttpServer>> HttpServer::listen(const std::string&, std::uint16_t, const HttpLimits&,
                                                       std::shared_ptr<Tls>) {
  return fail(
      Code::not_supported,
      "this kinemark was built without its server; build it with Boost 1.81 or newer (libboost1.81-dev)");
}

}  // namespace kinemark::server
