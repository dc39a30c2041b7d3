// HTTP/1.1 for pages on this machine: GET and POST, one request a connection, no encryption. A library would load OpenSSL at each start of
// the program.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace burnish {

inline constexpr std::size_t kMostHeadBytes = 16 << 10, kMostBodyBytes = 1 << 20;

struct HttpRequest {
    std::string method, path, query;            // path: without the query, as sent
    std::map<std::string, std::string> headers; // names in lower case
    std::string body;
    std::function<bool()> gone; // true once the connection is closed at its other end; empty: not known

    std::string header(const std::string& name) const;  // "" if absent
    std::string parameter(std::string_view name) const; // of the query, as sent; "" if absent
};

struct HttpResponse {
    int status = 200;
    std::string type = "text/plain; charset=utf-8", body;
    std::vector<std::pair<std::string, std::string>> headers;
};

// Reads a request's first line and headers, up to the empty line. Errors: ExitCode::bad_input.
Result<HttpRequest> parse_http_head(std::string_view head);
// Returns the body's length from the headers. Errors: ExitCode::bad_input for one that is no number, above kMostBodyBytes, or sent in
// pieces.
Result<std::size_t> http_body_length(const HttpRequest& request);
std::string http_text(const HttpResponse& response);

class HttpServer {
  public:
    HttpServer() = default;
    HttpServer(HttpServer&& other) noexcept : socket_(std::exchange(other.socket_, -1)), port_(other.port_) {}
    HttpServer& operator=(HttpServer&&) = delete;
    ~HttpServer();

    // Listens on 127.0.0.1. port 0: any that is free. Errors: ExitCode::usage for a port that is taken.
    static Result<HttpServer> open(int port);
    int port() const { return port_; }

    // Answers requests until `stop`, each in a thread of its own, at most 16 at a time. Then calls `stopping`, and returns when all are
    // answered.
    void run(const std::atomic<bool>& stop, const std::function<HttpResponse(const HttpRequest&)>& answer,
             const std::function<void()>& stopping);

  private:
    int socket_ = -1, port_ = 0;
};

} // namespace burnish
