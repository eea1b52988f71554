// SPDX-License-Identifier: MIT
// Proves: the display's server tells pages what there is and passes commands on; whatever is sent to it, or not taken
// from it, neither stops it nor makes the run's thread wait, and it holds no more than it must.
#include "host_tools/display/display_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <vector>

#include "emulator/errors.hpp"
#include "tests/support/raw_http.hpp"

namespace torolux {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;
using testing_support::command_request;
using testing_support::get_request;
using testing_support::port_of;
using testing_support::RawHttp;
using testing_support::response_to;
using testing_support::status_of;
using testing_support::unchunked;
using Clock = std::chrono::steady_clock;

struct Served : testing::Test {
  LiveState state;
  CommandQueue commands;
  DisplayServer server{{"127.0.0.1", 0}, state, commands};
  int port = port_of(server.url());

  int get(const std::string& path, const std::string& headers = "") const {
    return status_of(response_to(port, get_request(port, path, headers)));
  }
  void expect_served() const { EXPECT_EQ(get("/"), 200); }
};

/// Of memory that was freed [bytes]; AddressSanitizer's own limit.
#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
constexpr std::size_t kKeptBySanitizer = std::size_t{256} << 20U;
#else
constexpr std::size_t kKeptBySanitizer = 0;
#endif

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * 4096;
}

using DisplayServerTest = Served;

TEST_F(DisplayServerTest, ServesThePageAndNothingElse) {
  const std::string page = response_to(port, get_request(port, "/"));
  EXPECT_EQ(status_of(page), 200);
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page, HasSubstr("<div id=\"page\">"));
  EXPECT_EQ(get("/display.js"), 200);
  EXPECT_EQ(get("/display.css"), 200);
  for (const char* path : {"/nothing", "/../etc/passwd", "/display.js/", "/command", "/%2e%2e/"})
    EXPECT_EQ(get(path), 404);
}

TEST_F(DisplayServerTest, StreamsTheNewest) {
  state.update().put(MessageType::machine, "{}");
  const RawHttp page(port);
  page.send(get_request(port, "/stream"));
  std::string told = page.receive(500ms, 1);
  EXPECT_EQ(status_of(told), 200);
  state.update().put(MessageType::progress, "now");
  told += page.receive(500ms);
  std::string expected;
  append_message(expected, MessageType::machine, "{}");
  append_message(expected, MessageType::progress, "now");
  EXPECT_THAT(unchunked(told), StartsWith(expected));
  EXPECT_EQ(server.viewers(), 1);
}

TEST_F(DisplayServerTest, PassesCommandsOn) {
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end", "x": [1, 2]})"))), 202);
  const auto command = commands.take();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->name, "end");
  EXPECT_EQ(command->values["x"][1], 2);
  EXPECT_FALSE(commands.take());
}

TEST_F(DisplayServerTest, RefusesWhatIsNoCommand) {
  const std::string deep(60'000, '[');
  for (const std::string& body : {std::string(), std::string("{"), std::string("[]"), std::string(R"({"do": 1})"),
                                  std::string(R"({"do": "nothing"})"), deep, std::string("\xFF\x00\xFE", 3)})
    EXPECT_EQ(status_of(response_to(port, command_request(port, body))), 400) << body.substr(0, 30);
  for (std::size_t i = 0; i < CommandQueue::kMostWaiting; ++i)
    response_to(port, command_request(port, R"({"do": "end"})"));
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end"})"))), 503);
  expect_served();
}

TEST_F(DisplayServerTest, RefusesForeignPages) {
  EXPECT_EQ(status_of(response_to(port, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n")), 421);
  EXPECT_EQ(status_of(response_to(port, "GET / HTTP/1.0\r\n\r\n")), 421);
  EXPECT_EQ(get("/stream", "Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end"})", "Origin: http://evil.example\r\n"))),
            403);
  EXPECT_FALSE(commands.take());
}

TEST_F(DisplayServerTest, MalformedRequestsDoNotHarm) {
  const std::string host = "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string("GET\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
        std::string("\x16\x03\x01\x02\x00\x01\x00", 7) + std::string(200, '\0'),
        "GET / HTTP/1.1\r\n" + host + ": x\r\n\r\n",
        "GET /stream HTTP/1.1\r\n" + host + "Range: bytes=0-1,2-3,5-\r\n\r\n",
        "POST /command HTTP/1.1\r\n" + host + "Content-Type: application/json\r\nContent-Length: x\r\n\r\n",
        "POST /command HTTP/1.1\r\n" + host +
            "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n",
        "GET /" + std::string(20'000, '%') + " HTTP/1.1\r\n" + host + "\r\n"}) {
    RawHttp connection(port);
    connection.send(bytes);
    connection.receive(50ms);
    connection.close();
    expect_served();
  }
}

/// cpp-httplib alone would take all of this in.
TEST_F(DisplayServerTest, EndlessRequestsAreCutOff) {
  for (const char* begin : {"GET / HTTP/1.1\r\nX: ", "GET /"}) {
    const std::size_t before = resident_bytes();
    const RawHttp connection(port);
    connection.send(begin);
    const std::string more(1 << 20U, 'a');
    bool taken = true;
    for (int i = 0; i < 64 && taken; ++i) taken = connection.send(more);
    EXPECT_FALSE(taken);
    EXPECT_LT(resident_bytes(), before + (32U << 20U));
  }
  const RawHttp connection(port);
  connection.send("GET / HTTP/1.1\r\n");
  bool taken = true;
  for (int i = 0; i < 1'000'000 && taken; ++i) taken = connection.send("a: b\r\n");
  EXPECT_FALSE(taken);
  expect_served();
}

/// Pictures go on being put while nobody takes them; what is kept for a page does not grow.
TEST_F(DisplayServerTest, SlowReadersHoldNobodyUp) {
  constexpr std::uint32_t kEdge = 256;
  state.update().begin_picture(kEdge, kEdge, "{}");
  std::vector<RawHttp> pages;
  for (int i = 0; i < 8; ++i) {
    pages.emplace_back(port, 4096);
    pages.back().send(get_request(port, "/stream"));
  }
  for (int i = 0; i < 500 && server.viewers() < 8; ++i) std::this_thread::sleep_for(10ms);
  ASSERT_EQ(server.viewers(), 8);
  const std::size_t before = resident_bytes();
  Clock::duration longest{};
  std::vector<LivePicture::Pixel> pixels(std::size_t{kEdge} * kEdge);
  for (int i = 0; i < 200; ++i) {
    std::ranges::fill(pixels, LivePicture::Pixel{static_cast<float>(i), 0, 0});
    const auto begin = Clock::now();
    if (auto update = state.try_update()) update->put_pixels(0, pixels);
    longest = std::max(longest, Clock::now() - begin);
  }
  // 200 pictures of 0.8 MB for 8 pages are 1.2 GB; a page may have two, and what its socket holds.
  EXPECT_LT(resident_bytes(), before + kKeptBySanitizer + (64U << 20U));
  EXPECT_LT(longest, 1s);
  expect_served();
}

TEST_F(DisplayServerTest, ClosedPagesAreForgotten) {
  for (int i = 0; i < 40; ++i) {
    const RawHttp page(port);
    page.send(get_request(port, "/stream"));
    page.receive(1000ms, 1);
  }
  // Each is noticed with the next message that does not reach it.
  for (int i = 0; i < 500 && server.viewers() > 0; ++i) {
    state.update().put(MessageType::progress, std::to_string(i));
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(server.viewers(), 0);
}

TEST_F(DisplayServerTest, TwoHundredConnectionsAtOnce) {
  const std::size_t before = resident_bytes();
  std::vector<RawHttp> idle;
  for (int i = 0; i < 200; ++i) {
    idle.emplace_back(port);
    if (i % 2 == 0) idle.back().send(i % 4 == 0 ? get_request(port, "/stream") : "GET / HT");
  }
  EXPECT_LT(resident_bytes(), before + (64U << 20U));
  EXPECT_LE(server.viewers(), 16);
  const auto begin = Clock::now();
  state.update().put(MessageType::progress, "x");
  EXPECT_LT(Clock::now() - begin, 1s);
  // Those that say nothing are sent away after five seconds.
  int status = 0;
  for (int i = 0; i < 100 && status != 200; ++i) {
    status = get("/");
    if (status != 200) std::this_thread::sleep_for(100ms);
  }
  EXPECT_EQ(status, 200);
}

TEST_F(DisplayServerTest, PortsAreNotShared) {
  EXPECT_THROW(DisplayServer({"127.0.0.1", port}, state, commands), InputError);
  EXPECT_THROW(DisplayServer({"300.1.2.3", 0}, state, commands), InputError);
}

TEST(DisplayServer, AnotherAddressDemandsTheToken) {
  LiveState state;
  CommandQueue commands;
  const DisplayServer server({"0.0.0.0", 0}, state, commands);
  const int port = port_of(server.url());
  const std::string query = server.url().substr(server.url().find('?'));
  EXPECT_EQ(query.size(), std::string("?token=").size() + 32);
  for (const char* path : {"/", "/display.js", "/stream", "/?token=", "/?token=0123"})
    EXPECT_EQ(status_of(response_to(port, get_request(port, path))), 401) << path;
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end"})"))), 401);
  const std::string page = response_to(port, get_request(port, "/" + query));
  EXPECT_EQ(status_of(page), 200);
  EXPECT_THAT(page, HasSubstr("display.js" + query));
  EXPECT_FALSE(commands.take());
}

TEST(DisplayServer, EndsAtOnceWhateverIsConnected) {
  LiveState state;
  CommandQueue commands;
  auto server = std::make_unique<DisplayServer>(DisplayAddress{"127.0.0.1", 0}, state, commands);
  const int port = port_of(server->url());
  const RawHttp stream(port), idle(port), half(port);
  stream.send(get_request(port, "/stream"));
  half.send("GET / HT");
  EXPECT_FALSE(stream.receive(1000ms, 1).empty());
  state.update().put(MessageType::bye, "{}");
  const auto begin = Clock::now();
  server.reset();
  EXPECT_LT(Clock::now() - begin, 2s);
  // What was told last has come, and the answer has an end.
  EXPECT_THAT(stream.receive(1000ms), testing::EndsWith("\r\n0\r\n\r\n"));
}

}  // namespace
}  // namespace torolux
