// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The certificate that a server shows, and its key. OpenSSL is in tls.cc alone (tls_absent.cc: without it).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::server {

/// What a server needs for TLS 1.2 and 1.3; made by Tls::read(). Threads may use it at once.
class Tls {
 public:
  virtual ~Tls() = default;

  /// Read a certificate with its chain, and the key of it, both PEM. One sentence: Code::io for a file that
  /// cannot be read, Code::bad_input for one that is none, an encrypted key, or one of another certificate;
  /// Code::not_supported where this program was built without TLS.
  [[nodiscard]] static Result<std::shared_ptr<Tls>> read(const std::filesystem::path& certificate,
                                                         const std::filesystem::path& key);

  /// Names and addresses that the certificate is for, in its order, as a URL has them ("lab-pc", "10.0.0.7",
  /// "[fe80::1]"). Those with a wildcard are left out.
  [[nodiscard]] virtual const std::vector<std::string>& names() const = 0;
  /// The boost::asio::ssl::context, for http_server.cc.
  [[nodiscard]] virtual void* context() = 0;
};

}  // namespace kinemark::server
