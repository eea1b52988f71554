// SPDX-License-Identifier: MIT
// Bytes enter, SHA-256 digests leave (libcrypto).
#include "host_tools/files/digest.hpp"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {

struct Sha256::Context {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest{EVP_MD_CTX_new(), &EVP_MD_CTX_free};

  static void check(int result) {
    if (result != 1) throw std::runtime_error("libcrypto has no SHA-256");
  }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  Context::check(EVP_DigestInit_ex(context_->digest.get(), EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::byte> bytes) {
  Context::check(EVP_DigestUpdate(context_->digest.get(), bytes.data(), bytes.size()));
}

std::string Sha256::hexadecimal() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned length = 0;
  Context::check(EVP_DigestFinal_ex(context_->digest.get(), hash.data(), &length));
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += kDigits[hash[i] >> 4U];
    text += kDigits[hash[i] & 15U];
  }
  return text;
}

std::string sha256(std::string_view text) {
  Sha256 digest;
  digest.add(std::as_bytes(std::span(text)));
  return digest.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(file, error);
  if (is_device(file)) {
    throw InputError(file.string() + ": is a pipe or a device; it is read more than once and must be a file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream || is_folder) {
    throw InputError(file.string() + ": cannot be read: " + std::strerror(is_folder ? EISDIR : errno));
  }
  Sha256 digest;
  std::vector<char> piece(1U << 16U);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digest.add(std::as_bytes(std::span(piece.data(), static_cast<std::size_t>(stream.gcount()))));
  }
  if (stream.bad()) throw InputError(file.string() + ": cannot be read to its end");
  return digest.hexadecimal();
}

}  // namespace torolux
