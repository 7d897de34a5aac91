// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/tls.h"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <array>
#include <boost/asio/ssl/context.hpp>
#include <string_view>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;
namespace ssl = boost::asio::ssl;
using boost::system::error_code;

constexpr std::size_t kMostBytes = 1U << 20;

std::string_view bytes_of(const ASN1_STRING* text) {
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

std::string address_text(std::string_view bytes) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const bool is_ipv6 = bytes.size() == 16;
  if (!is_ipv6 && bytes.size() != 4) return {};
  if (::inet_ntop(is_ipv6 ? AF_INET6 : AF_INET, bytes.data(), text.data(), text.size()) == nullptr) return {};
  return is_ipv6 ? fmt::format("[{}]", text.data()) : text.data();
}

/// Letters of a host name alone: what else a certificate says is no name that a browser calls.
bool is_host_name(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-.";
  return !name.empty() && name.size() <= 253 && name.find_first_not_of(kLetters) == std::string_view::npos;
}

std::vector<std::string> names_of(X509* certificate) {
  std::vector<std::string> names;
  auto* const all =
      static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr));
  for (int i = 0; i < sk_GENERAL_NAME_num(all); ++i) {
    const GENERAL_NAME* one = sk_GENERAL_NAME_value(all, i);
    if (one->type == GEN_DNS && is_host_name(bytes_of(one->d.dNSName)))
      names.emplace_back(bytes_of(one->d.dNSName));
    else if (auto text = one->type == GEN_IPADD ? address_text(bytes_of(one->d.iPAddress)) : "";
             !text.empty())
      names.push_back(std::move(text));
  }
  GENERAL_NAMES_free(all);
  return names;
}

class OpenSsl final : public Tls {
 public:
  OpenSsl() : context_(ssl::context::tls_server) {}
  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] void* context() override { return &context_; }

  [[nodiscard]] Status load(const fs::path& certificate, const fs::path& key) {
    const auto chain = io::read_text(certificate, kMostBytes), secret = io::read_text(key, kMostBytes);
    for (const auto* text : {&chain, &secret})
      if (!*text) return std::unexpected(text->error());
    const auto wrong = [](const fs::path& file, std::string_view what) {
      ERR_clear_error();
      return fail(Code::bad_input, fmt::format("{}: {}", printable(file.string(), 300), what));
    };
    SSL_CTX* const native = context_.native_handle();
    if (SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION) != 1 ||
        SSL_CTX_set_cipher_list(native, "ECDHE+AESGCM:ECDHE+CHACHA20") != 1)
      return wrong(certificate, "TLS 1.2 cannot be had from this OpenSSL");
    SSL_CTX_set_options(native, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    // Nobody is there to be asked for a password.
    context_.set_password_callback([](std::size_t, ssl::context::password_purpose) { return std::string(); });
    error_code error;
    (void)context_.use_certificate_chain(boost::asio::buffer(*chain), error);
    if (error) return wrong(certificate, "is no certificate; need one in PEM (-----BEGIN CERTIFICATE-----)");
    if (secret->find("ENCRYPTED") != std::string::npos)
      return wrong(key, "is encrypted; need a key without a password, readable for its owner alone");
    (void)context_.use_private_key(boost::asio::buffer(*secret), ssl::context::pem, error);
    if (error && !is_key(*secret))
      return wrong(key, "is no key; need one in PEM (-----BEGIN PRIVATE KEY-----)");
    if (error || SSL_CTX_check_private_key(native) != 1)
      return wrong(key,
                   fmt::format("is not the key of the certificate {}", printable(certificate.string(), 300)));
    names_ = names_of(SSL_CTX_get0_certificate(native));
    return {};
  }

 private:
  static bool is_key(const std::string& text) {
    BIO* const memory = BIO_new_mem_buf(text.data(), static_cast<int>(text.size()));
    const auto nobody = [](char*, int, int, void*) { return 0; };
    EVP_PKEY* const key = PEM_read_bio_PrivateKey(memory, nullptr, nobody, nullptr);
    BIO_free(memory);
    EVP_PKEY_free(key);
    return key != nullptr;
  }

  ssl::context context_;
  std::vector<std::string> names_;
};

}  // namespace

Result<std::shared_ptr<Tls>> Tls::read(const fs::path& certificate, const fs::path& key) {
  auto tls = std::make_shared<OpenSsl>();
  if (auto s = tls->load(certificate, key); !s) return std::unexpected(s.error());
  return tls;
}

}  // namespace kinemark::server
