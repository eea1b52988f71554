// SPDX-License-Identifier: MIT
// Proves: the display's server refuses what other sites' pages can send, what is too long, and what lacks the token.
#include "host_tools/display/access.hpp"

#include <gtest/gtest.h>

namespace torolux {
namespace {

RequestFacts get(const std::string& host) {
  RequestFacts facts;
  facts.method = "GET";
  facts.host = host;
  return facts;
}

int status(const Access& access, const RequestFacts& facts) {
  const auto refusal = access.refuses(facts);
  return refusal ? refusal->status : 200;
}

TEST(DisplayAccess, HostMustBeThisServer) {
  const Access own("127.0.0.1", 8080, "");
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"}) EXPECT_EQ(status(own, get(host)), 200);
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8081", "evil.example:8080", "127.evil.example:8080",
        "192.168.1.2:8080", "localhost.evil.example:8080", "[::1]", "]:8080", "127.0.0.1:8080:8080"})
    EXPECT_EQ(status(own, get(host)), 421) << host;
  const Access port_80("127.0.0.1", 80, "");
  EXPECT_EQ(status(port_80, get("localhost")), 200);
}

/// A name may be another site's, made to point here; a number cannot.
TEST(DisplayAccess, OfAnotherAddressNumbersAndItsNameAreOwn) {
  const Access all("0.0.0.0", 8080, "t");
  const Access named("workshop", 8080, "t");
  const auto with_token = [](const std::string& host) {
    RequestFacts facts = get(host);
    facts.token = "t";
    return facts;
  };
  EXPECT_EQ(status(all, with_token("192.168.1.2:8080")), 200);
  EXPECT_EQ(status(all, with_token("[fe80::1]:8080")), 200);
  EXPECT_EQ(status(all, with_token("evil.example:8080")), 421);
  EXPECT_EQ(status(named, with_token("workshop:8080")), 200);
  EXPECT_EQ(status(named, with_token("workshop.evil.example:8080")), 421);
}

TEST(DisplayAccess, OtherSitesPagesAreRefused) {
  const Access access("127.0.0.1", 8080, "");
  RequestFacts facts = get("127.0.0.1:8080");
  facts.origin = "http://127.0.0.1:8080";
  facts.fetch_site = "same-origin";
  EXPECT_EQ(status(access, facts), 200);
  for (const char* origin :
       {"null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081", "http://localhost:8080"}) {
    facts.origin = origin;
    EXPECT_EQ(status(access, facts), 403) << origin;
  }
  facts.origin.clear();
  for (const char* site : {"cross-site", "same-site"}) {
    facts.fetch_site = site;
    EXPECT_EQ(status(access, facts), 403) << site;
  }
}

TEST(DisplayAccess, TokenIsDemanded) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, random_token());
  const Access access("0.0.0.0", 8080, token);
  RequestFacts facts = get("10.0.0.1:8080");
  EXPECT_EQ(status(access, facts), 401);
  for (const std::string& wrong : {token.substr(1), token + "0", std::string(32, '0'), "x" + token.substr(1)}) {
    facts.token = wrong;
    EXPECT_EQ(status(access, facts), 401) << wrong;
  }
  facts.token = token;
  EXPECT_EQ(status(access, facts), 200);
}

TEST(DisplayAccess, BodiesAreShortJson) {
  const Access access("127.0.0.1", 8080, "");
  RequestFacts facts = get("127.0.0.1:8080");
  facts.method = "POST";
  facts.content_type = "application/json";
  facts.content_length = "65536";
  EXPECT_EQ(status(access, facts), 200);
  const auto with = [&](std::string RequestFacts::*field, const std::string& value) {
    RequestFacts changed = facts;
    changed.*field = value;
    return status(access, changed);
  };
  EXPECT_EQ(with(&RequestFacts::content_length, "65537"), 413);
  EXPECT_EQ(with(&RequestFacts::content_length, "99999999999999999999999"), 400);
  EXPECT_EQ(with(&RequestFacts::content_length, "-1"), 400);
  EXPECT_EQ(with(&RequestFacts::content_length, ""), 411);
  EXPECT_EQ(with(&RequestFacts::transfer_encoding, "chunked"), 411);
  EXPECT_EQ(with(&RequestFacts::content_type, "text/plain"), 415);
  EXPECT_EQ(with(&RequestFacts::content_type, "multipart/form-data; boundary=x"), 415);
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "PATCH", "PRI", "CONNECT"})
    EXPECT_EQ(with(&RequestFacts::method, method), 405) << method;
}

TEST(DisplayAccess, KnowsThisComputersOwnAddresses) {
  for (const char* own : {"127.0.0.1", "127.1.2.3", "::1", "localhost"}) EXPECT_TRUE(is_loopback(own)) << own;
  for (const char* other : {"0.0.0.0", "::", "10.0.0.1", "127.evil.example", "localhost.example"})
    EXPECT_FALSE(is_loopback(other)) << other;
}

}  // namespace
}  // namespace torolux
