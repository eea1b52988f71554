// SPDX-License-Identifier: MIT
// Headers are compared with what this server is called; tokens in constant time.
#include "host_tools/display/access.hpp"

#include <arpa/inet.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

bool is_numeric(const std::string& address) {
  std::array<std::byte, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, address.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1;
}

/// "host:port", "[::1]:port"; without a port it is 80.
std::pair<std::string, std::string> split_host(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  const bool has_port = colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  std::string_view name = has_port ? host.substr(0, colon) : host;
  if (name.size() >= 2 && name.front() == '[' && name.back() == ']') name = name.substr(1, name.size() - 2);
  return {std::string(name), has_port ? std::string(host.substr(colon + 1)) : "80"};
}

bool same_in_constant_time(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::optional<Refusal> refuse_body(const RequestFacts& request) {
  if (!request.transfer_encoding.empty() || request.content_length.empty()) {
    return Refusal{411, "a request with a body must say its Content-Length"};
  }
  std::size_t length = 0;
  const char* const end = request.content_length.data() + request.content_length.size();
  const auto parsed = std::from_chars(request.content_length.data(), end, length);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return Refusal{400, "Content-Length is not a number"};
  if (length > Access::kMostBody) return Refusal{413, "a command has at most 64 KiB"};
  // Pages of other sites cannot send this without asking first.
  if (request.content_type != "application/json") return Refusal{415, "commands are application/json"};
  return std::nullopt;
}

}  // namespace

bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" ||
         (address.starts_with("127.") && is_numeric(std::string(address)));
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw MachineFailure("this computer gives no random numbers for the display's token");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

Access::Access(std::string address, int port, std::string token)
    : address_(std::move(address)), token_(std::move(token)), port_(port) {}

/// A name that is not this server's may be another site's, made to point here (DNS rebinding); numbers cannot be.
bool Access::host_is_own(std::string_view host) const {
  const auto [name, port] = split_host(host);
  if (port != std::to_string(port_)) return false;
  if (is_loopback(address_)) return is_loopback(name);
  return name == address_ || name == "localhost" || is_numeric(name);
}

std::optional<Refusal> Access::refuses(const RequestFacts& request) const {
  if (!host_is_own(request.host)) return Refusal{421, "this is not the server that the request is for"};
  if (!request.origin.empty() && request.origin != "http://" + request.host) {
    return Refusal{403, "requests of other sites' pages are refused"};
  }
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin" && request.fetch_site != "none") {
    return Refusal{403, "requests of other sites' pages are refused"};
  }
  if (!token_.empty() && !same_in_constant_time(request.token, token_)) {
    return Refusal{401, "the address must be complete: it ends in ?token=..., as torolux has printed it"};
  }
  if (request.method == "GET" || request.method == "HEAD") return std::nullopt;
  if (request.method != "POST") return Refusal{405, "GET and POST are understood"};
  return refuse_body(request);
}

}  // namespace torolux
