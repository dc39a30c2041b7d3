#include "apps/serve/http.h"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <fmt/core.h>
#include <mutex>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <system_error>
#include <thread>
#include <unistd.h>

#include "core/base/exception.h"

namespace burnish {
namespace {

constexpr int kMostConnections = 16, kPatienceSeconds = 10, kLookMs = 100; // kLookMs: between looks at `stop`

Error bad(const char* reason)
{
    return Error{ExitCode::bad_input, "", "request", reason};
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

const char* reason_of(int status)
{
    switch (status) {
    case 200:
        return "OK";
    case 400:
        return "Bad Request";
    case 403:
        return "Forbidden";
    case 404:
        return "Not Found";
    case 409:
        return "Conflict";
    default:
        return "Error";
    }
}

// Limits on reading from a connection.
struct Patience {
    const std::atomic<bool>& stop;
    std::chrono::steady_clock::time_point until;
};

// Reads until the buffer holds `bytes`, or `end` where that is not empty. False: closed, too late, stopped, or more than `most`.
bool receive(int socket, std::string& buffer, std::size_t bytes, std::string_view end, std::size_t most, const Patience& patience)
{
    char part[4096];
    while (end.empty() ? buffer.size() < bytes : buffer.find(end) == std::string::npos) {
        if (buffer.size() > most || patience.stop || std::chrono::steady_clock::now() > patience.until)
            return false;
        pollfd waiting{socket, POLLIN, 0};
        if (poll(&waiting, 1, kLookMs) <= 0)
            continue;
        const ssize_t got = recv(socket, part, sizeof(part), MSG_DONTWAIT);
        if (got < 0 && (errno == EINTR || errno == EAGAIN))
            continue;
        if (got <= 0)
            return false;
        buffer.append(part, static_cast<std::size_t>(got));
    }
    return true;
}

bool is_closed(int socket)
{
    char byte = 0;
    const ssize_t got = recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

void send_all(int socket, std::string_view text)
{
    while (!text.empty()) {
        const ssize_t sent = send(socket, text.data(), text.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            return;
        text.remove_prefix(static_cast<std::size_t>(sent));
    }
}

Result<HttpRequest> receive_request(int socket, const std::atomic<bool>& stop)
{
    const Patience patience{stop, std::chrono::steady_clock::now() + std::chrono::seconds(kPatienceSeconds)};
    std::string buffer;
    if (!receive(socket, buffer, 0, "\r\n\r\n", kMostHeadBytes, patience))
        return bad("is incomplete");
    const std::size_t head = buffer.find("\r\n\r\n") + 4;
    Result<HttpRequest> request = parse_http_head(std::string_view(buffer).substr(0, head));
    BN_TRY(request);
    const Result<std::size_t> length = http_body_length(*request);
    BN_TRY(length);
    buffer.erase(0, head);
    if (!receive(socket, buffer, *length, "", kMostBodyBytes, patience))
        return bad("is incomplete");
    request->body = buffer.substr(0, *length);
    request->gone = [socket] { return is_closed(socket); };
    return request;
}

void answer_connection(int socket, const std::atomic<bool>& stop, const std::function<HttpResponse(const HttpRequest&)>& answer)
{
    const timeval patience{kPatienceSeconds, 0};
    setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
    HttpResponse response;
    try {
        const Result<HttpRequest> request = receive_request(socket, stop);
        if (request)
            response = answer(*request);
        else
            response.status = 400, response.body = request.error().line() + "\n";
        send_all(socket, http_text(response));
    } catch (...) { // no memory: the connection ends
        (void)error_of_exception(bad("is not answered"));
    }
    shutdown(socket, SHUT_RDWR);
    close(socket);
}

} // namespace

std::string HttpRequest::header(const std::string& name) const
{
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
}

std::string HttpRequest::parameter(std::string_view name) const
{
    for (std::string_view rest = query; !rest.empty();) {
        const std::string_view part = rest.substr(0, rest.find('&'));
        rest.remove_prefix(std::min(rest.size(), part.size() + 1));
        if (part.substr(0, part.find('=')) == name && part.find('=') != std::string_view::npos)
            return std::string(part.substr(part.find('=') + 1));
    }
    return "";
}

Result<HttpRequest> parse_http_head(std::string_view head)
{
    HttpRequest request;
    const std::string_view first = trimmed(head.substr(0, head.find('\n')));
    const std::size_t method = first.find(' '), target = first.find(' ', method + 1);
    if (method == std::string_view::npos || target == std::string_view::npos || first.substr(target + 1).rfind("HTTP/1.", 0) != 0)
        return bad("has no first line of HTTP/1");
    request.method = first.substr(0, method);
    const std::string_view address = first.substr(method + 1, target - method - 1);
    if (address.empty() || address[0] != '/')
        return bad("names no path");
    request.path = address.substr(0, address.find('?'));
    if (request.path.size() < address.size())
        request.query = address.substr(request.path.size() + 1);
    head.remove_prefix(std::min(head.size(), head.find('\n') + 1));
    while (!head.empty()) {
        const std::string_view line = head.substr(0, head.find('\n'));
        head.remove_prefix(std::min(head.size(), line.size() + 1));
        if (trimmed(line).empty())
            break;
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || colon == 0)
            return bad("has a header without a name");
        std::string name(line.substr(0, colon));
        for (char& c : name)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (!request.headers.emplace(name, trimmed(line.substr(colon + 1))).second && (name == "host" || name == "content-length"))
            return bad("has a header twice");
    }
    return request;
}

Result<std::size_t> http_body_length(const HttpRequest& request)
{
    if (!request.header("transfer-encoding").empty())
        return bad("is sent in pieces");
    const std::string text = request.header("content-length");
    if (text.empty())
        return std::size_t{0};
    std::size_t length = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (failed != std::errc() || end != text.data() + text.size() || length > kMostBodyBytes)
        return bad("has no valid length");
    return length;
}

std::string http_text(const HttpResponse& response)
{
    std::string text = fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n", response.status,
                                   reason_of(response.status), response.type, response.body.size());
    for (const auto& [name, value] : response.headers)
        text += name + ": " + value + "\r\n";
    return text + "\r\n" + response.body;
}

HttpServer::~HttpServer()
{
    if (socket_ >= 0)
        close(socket_);
}

Result<HttpServer> HttpServer::open(int port)
{
    HttpServer server;
    server.socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int again = 1;
    sockaddr_in address = {};
    address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(port)),
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (server.socket_ < 0 || setsockopt(server.socket_, SOL_SOCKET, SO_REUSEADDR, &again, sizeof(again)) != 0 ||
        bind(server.socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || listen(server.socket_, 64) != 0 ||
        getsockname(server.socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        return Error{ExitCode::usage, "", "--port", fmt::format("{}: {}", port, std::strerror(errno))};
    server.port_ = ntohs(address.sin_port);
    return server;
}

void HttpServer::run(const std::atomic<bool>& stop, const std::function<HttpResponse(const HttpRequest&)>& answer,
                     const std::function<void()>& stopping)
{
    std::mutex mutex;
    std::condition_variable ended;
    int open = 0;
    while (!stop) {
        pollfd waiting{socket_, POLLIN, 0};
        if (poll(&waiting, 1, kLookMs) <= 0)
            continue;
        const int connection = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        if (connection < 0) { // no descriptor is left: later
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            continue;
        }
        std::unique_lock lock(mutex);
        while (open >= kMostConnections && !stop)
            ended.wait_for(lock, std::chrono::milliseconds(kLookMs));
        ++open;
        try {
            std::thread([&mutex, &ended, &open, &answer, &stop, connection] {
                answer_connection(connection, stop, answer);
                const std::lock_guard done(mutex);
                --open;
                ended.notify_all();
            }).detach();
        } catch (const std::system_error&) { // no thread: the connection waits for none
            --open;
            close(connection);
        }
    }
    stopping();
    std::unique_lock lock(mutex);
    ended.wait(lock, [&] { return open == 0; });
}

} // namespace burnish
