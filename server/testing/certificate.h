// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Certificates that tests make for themselves, and the client's side of TLS.
#pragma once

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "server/testing/client.h"

namespace kinemark::server::testing {

/// A certificate that nobody but itself has signed, and its key, as PEM.
struct Certificate {
  std::string certificate, key;
};

/// @param names     of the subject: "DNS:lab-pc,IP:127.0.0.1"; empty: none
/// @param password  that the key is encrypted with; empty: it is not
inline Certificate make_certificate(const std::string& names, std::string password = "") {
  const auto text_of = [](auto write) {
    BIO* const memory = BIO_new(BIO_s_mem());
    write(memory);
    char* bytes = nullptr;
    const auto size = BIO_get_mem_data(memory, &bytes);
    std::string text(bytes, static_cast<std::size_t>(size));
    BIO_free(memory);
    return text;
  };
  EVP_PKEY* const key = EVP_EC_gen("P-256");
  X509* const made = X509_new();
  X509_set_version(made, 2);
  ASN1_INTEGER_set(X509_get_serialNumber(made), 1);
  X509_gmtime_adj(X509_getm_notBefore(made), -3600);
  X509_gmtime_adj(X509_getm_notAfter(made), 3600);
  X509_set_pubkey(made, key);
  if (!names.empty()) {
    X509_EXTENSION* const extension =
        X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, names.c_str());
    X509_add_ext(made, extension, -1);
    X509_EXTENSION_free(extension);
  }
  X509_sign(made, key, EVP_sha256());
  Certificate out;
  out.certificate = text_of([&](BIO* to) { PEM_write_bio_X509(to, made); });
  out.key = text_of([&](BIO* to) {
    PEM_write_bio_PKCS8PrivateKey(to, key, password.empty() ? nullptr : EVP_aes_128_cbc(), password.data(),
                                  static_cast<int>(password.size()), nullptr, nullptr);
  });
  X509_free(made);
  EVP_PKEY_free(key);
  return out;
}

/// TLS over a client's socket, without asking who the server is.
class TlsClient {
 public:
  /// @param most_version  TLS1_2_VERSION, ...
  explicit TlsClient(std::uint16_t port, int most_version = TLS1_3_VERSION)
      : client_(port), context_(SSL_CTX_new(TLS_client_method()), SSL_CTX_free) {
    SSL_CTX_set_security_level(context_.get(), 0);  // what is too old is for the server to refuse
    SSL_CTX_set_min_proto_version(context_.get(), 0);
    SSL_CTX_set_max_proto_version(context_.get(), most_version);
    ssl_ = {SSL_new(context_.get()), SSL_free};
    SSL_set_fd(ssl_.get(), client_.fd());
    greeted_ = SSL_connect(ssl_.get()) == 1;
  }
  [[nodiscard]] bool greeted() const { return greeted_; }
  [[nodiscard]] std::string version() const { return SSL_get_version(ssl_.get()); }
  void send(const std::string& text) const {
    SSL_write(ssl_.get(), text.data(), static_cast<int>(text.size()));
  }
  /// All until the server ends the connection, and whether it said that it does.
  [[nodiscard]] std::pair<std::string, bool> read_all() const {
    std::string text;
    std::array<char, 4096> buffer{};
    int n = 0;
    while ((n = SSL_read(ssl_.get(), buffer.data(), buffer.size())) > 0)
      text.append(buffer.data(), static_cast<std::size_t>(n));
    return {text, SSL_get_error(ssl_.get(), n) == SSL_ERROR_ZERO_RETURN};
  }

 private:
  Client client_;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_;
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{nullptr, SSL_free};
  bool greeted_ = false;
};

}  // namespace kinemark::server::testing
