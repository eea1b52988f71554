// SPDX-License-Identifier: MIT
// cpp-httplib's server, on connections of our own.
#include "host_tools/display/display_server.hpp"

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "emulator/errors.hpp"
#include "host_tools/display/access.hpp"
#include "host_tools/display/connection.hpp"
#include "host_tools/display/connection_threads.hpp"
#include "host_tools/web/bundle.hpp"

namespace torolux {
namespace {

/// Endless answers at once: each has a thread, and what it has not yet sent.
constexpr int kMostViewers = 16;
constexpr std::chrono::milliseconds kAlive{1000};
constexpr int kMostWaiting = 256;
constexpr std::chrono::seconds kAnswerPatience{10};
constexpr std::chrono::milliseconds kLookAtEnd{5};
constexpr int kMostLooksAtEnd = 100;

/// Sockets become connections of bounded patience, one request each.
class Server final : public httplib::Server {
 public:
  Server() {
    new_task_queue = [] { return std::make_unique<ConnectionThreads>().release(); };  // httplib owns it
    // Not SO_REUSEPORT, which httplib sets: two servers would share a port.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }
  std::atomic<bool> stopping = false;

  /// After it has been bound: httplib would let five connections wait to be accepted.
  void let_wait(int connections) { ::listen(svr_sock_, connections); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    bool done = false;
    if (!ConnectionThreads::refusing() && !stopping) {
      Connection connection(socket, stopping);
      bool closed = false;
      done = process_request(connection, true, closed, nullptr);
    }
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return done;
  }
};

RequestFacts facts_of(const httplib::Request& request) {
  const auto header = [&request](const char* name) { return request.get_header_value(name); };
  return {request.method,
          header("Host"),
          header("Origin"),
          header("Sec-Fetch-Site"),
          header("Content-Type"),
          header("Content-Length"),
          header("Transfer-Encoding"),
          request.get_param_value("token")};
}

std::string page_html(const std::string& query) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
         "<title>Torolux</title>\n<link rel=\"stylesheet\" href=\"display.css" +
         query +
         "\">\n</head>\n<body>\n<div id=\"page\"></div>\n<noscript>The display needs JavaScript.</noscript>\n"
         "<script src=\"display.js" +
         query + "\"></script>\n</body>\n</html>\n";
}

httplib::Headers common_headers() {
  return {{"Content-Security-Policy",
           "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
           "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"X-Frame-Options", "DENY"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cross-Origin-Opener-Policy", "same-origin"},
          {"Cache-Control", "no-store"}};
}

void answer_json(httplib::Response& response, int status, const nlohmann::json& json) {
  response.status = status;
  response.set_content(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "application/json");
}

}  // namespace

struct DisplayServer::Parts {
  LiveState& state;
  CommandQueue& commands;
  std::string url;
  std::optional<Access> access;
  std::atomic<int> viewers = 0;
  Server server;
  std::thread listener;

  void add_pages(const std::string& query) {
    const auto serve = [this](const char* path, std::string text, const char* type) {
      server.Get(path, [text = std::move(text), type](const httplib::Request&, httplib::Response& response) {
        response.set_content(text, type);
      });
    };
    serve("/", page_html(query), "text/html; charset=utf-8");
    serve("/display.js", std::string(display_script()), "text/javascript; charset=utf-8");
    serve("/display.css", std::string(display_style()), "text/css; charset=utf-8");
  }

  /// The endless answer: messages as they come, the newest only.
  void stream(httplib::Response& response) {
    if (viewers.fetch_add(1) >= kMostViewers) {
      --viewers;
      response.status = 503;
      response.set_content("too many pages are looking on\n", "text/plain");
      return;
    }
    response.set_chunked_content_provider(
        "application/octet-stream",
        [this, seen = std::make_shared<Seen>(), out = std::make_shared<std::string>()](std::size_t /*offset*/,
                                                                                       httplib::DataSink& sink) {
          out->clear();
          state.take_news(*seen, *out, kAlive);
          if (server.stopping && out->empty()) {
            sink.done();
            return true;
          }
          if (out->empty()) append_message(*out, MessageType::alive, "");
          return sink.write(out->data(), out->size());
        },
        [this](bool /*success*/) { --viewers; });
  }

  void take_command(const httplib::Request& request, httplib::Response& response) {
    const auto json = nlohmann::json::parse(request.body, nullptr, false);
    if (!json.is_object() || !json.contains("do") || !json["do"].is_string()) {
      return answer_json(response, 400, {{"error", "a command is an object with a text \"do\""}});
    }
    const CommandName* const known = find_command(json["do"].get_ref<const std::string&>());
    if (known == nullptr) return answer_json(response, 400, {{"error", "there is no such command"}});
    const auto answer = known->answered ? std::make_shared<Answer>() : nullptr;
    if (!commands.put({std::string(known->name), json, answer})) {
      return answer_json(response, 503, {{"error", "too many commands wait"}});
    }
    if (!answer) return answer_json(response, 202, {{"taken", true}});
    const std::string text = answer->wait_for(kAnswerPatience);
    if (text.empty()) return answer_json(response, 503, {{"error", "the machine is too busy to answer"}});
    response.set_content(text, "application/json");
  }

  void listen(const DisplayAddress& where) {
    const std::string& address = where.address;
    const int port = where.port == 0                            ? server.bind_to_any_port(address)
                     : server.bind_to_port(address, where.port) ? where.port
                                                                : -1;
    if (port <= 0) {
      throw InputError("--display: nothing can be served at " + address + ", port " + std::to_string(where.port) +
                       "; another program may have that port: --display 0 takes any that is free");
    }
    server.let_wait(kMostWaiting);
    const std::string token = is_loopback(address) ? "" : random_token();
    const std::string query = token.empty() ? "" : "?token=" + token;
    const bool six = address.find(':') != std::string::npos;
    url = "http://" + (six ? "[" + address + "]" : address) + ":" + std::to_string(port) + "/" + query;
    access.emplace(address, port, token);
    add_pages(query);
  }

  void begin() {
    server.set_default_headers(common_headers());
    server.set_keep_alive_max_count(1);
    server.set_payload_max_length(Access::kMostBody);
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const auto refusal = access->refuses(facts_of(request));
      if (!refusal) return httplib::Server::HandlerResponse::Unhandled;
      response.status = refusal->status;
      response.set_content(refusal->text + "\n", "text/plain; charset=utf-8");
      return httplib::Server::HandlerResponse::Handled;
    });
    server.Get("/stream", [this](const httplib::Request&, httplib::Response& response) { stream(response); });
    server.Post("/command", [this](const httplib::Request& request, httplib::Response& response) {
      take_command(request, response);
    });
    listener = std::thread([this] { server.listen_after_bind(); });
    while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  void end() {
    server.stopping = true;
    state.wake();
    // Once httplib stops, it cuts streams off, what they still had to tell included.
    for (int i = 0; i < kMostLooksAtEnd && viewers > 0; ++i) std::this_thread::sleep_for(kLookAtEnd);
    server.stop();
    listener.join();
  }
};

DisplayServer::DisplayServer(const DisplayAddress& where, LiveState& state, CommandQueue& commands)
    : parts_(new Parts{state, commands, {}, {}, {}, {}, {}}) {
  parts_->listen(where);
  parts_->begin();
}

DisplayServer::~DisplayServer() {
  parts_->end();
}

const std::string& DisplayServer::url() const {
  return parts_->url;
}

int DisplayServer::viewers() const {
  return parts_->viewers;
}

}  // namespace torolux
