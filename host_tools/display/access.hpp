// SPDX-License-Identifier: MIT
// Who may talk to the display's server: what a request says of itself enters, whether it is refused leaves.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace torolux {

/// Of a request, as its headers say; empty: not there.
struct RequestFacts {
  std::string method, host, origin, fetch_site, content_type, content_length, transfer_encoding, token;
};

/// An HTTP status, and what to tell.
struct Refusal {
  int status;
  std::string text;
};

class Access {
 public:
  /// address: that the server listens on. token: demanded of each request; empty: none is.
  Access(std::string address, int port, std::string token);

  /// GET, HEAD, and POST of a short JSON text. `Host` must be this server's: pages of other sites, whose name has been
  /// made to point here, are kept out; so are requests that another site's page has caused.
  std::optional<Refusal> refuses(const RequestFacts& request) const;

  static constexpr std::size_t kMostBody = std::size_t{64} << 10U;

 private:
  bool host_is_own(std::string_view host) const;

  std::string address_, token_;
  int port_;
};

/// 127.0.0.0/8, ::1, localhost.
bool is_loopback(std::string_view address);
/// 128 bits by chance, as hexadecimal digits.
std::string random_token();

}  // namespace torolux
