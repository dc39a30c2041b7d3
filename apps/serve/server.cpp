#include "apps/serve/server.h"

#include <algorithm>
#include <fmt/core.h>
#include <random>

#include "apps/cli/outputs.h"
#include "apps/serve/assets.h"
#include "apps/serve/http.h"

namespace burnish {
namespace {

std::string random_token()
{
    std::random_device device;
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", device());
    return token;
}

class Server {
  public:
    Server(const ServeSetting& setting, ServedLists lists) : token_(random_token()), pages_(setting, std::move(lists)) {}

    const std::string& token() const { return token_; }
    void stop() { pages_.stop(); }
    void listens_on(int port)
    {
        for (const char* host : {"127.0.0.1", "localhost"})
            hosts_.push_back(port == 80 ? host : fmt::format("{}:{}", host, port));
    }

    HttpResponse operator()(const HttpRequest& request)
    {
        HttpResponse response;
        response.headers = {{"Cache-Control", "no-store"},
                            {"X-Content-Type-Options", "nosniff"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Content-Security-Policy",
                             "default-src 'none'; img-src 'self' blob: data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
                             "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}};
        const std::string given = request.path == "/" ? request.parameter("token") : request.header("x-token");
        if (std::find(hosts_.begin(), hosts_.end(), request.header("host")) == hosts_.end() || given != token_)
            response.status = 403, response.body = "This page needs the address that `burnish serve` printed, with its token.\n";
        else if (request.method == "GET" && request.path == "/")
            response.type = "text/html; charset=utf-8", response.body.assign(kServePage.bytes, kServePage.size);
        else
            pages_.answer(request, response);
        return response;
    }

  private:
    std::string token_;
    std::vector<std::string> hosts_;
    Pages pages_;
};

} // namespace

Status serve(const ServeSetting& setting, const std::atomic<bool>& stop, const std::function<void(const std::string&)>& ready)
{
    Result<ServedLists> lists = served_lists(setting.target);
    BN_TRY(lists);
    if (!setting.output_folder.empty())
        BN_TRY(make_output_folder(setting.output_folder));
    Server pages(setting, std::move(*lists));
    Result<HttpServer> server = HttpServer::open(setting.port);
    BN_TRY(server);
    pages.listens_on(server->port());
    ready(fmt::format("http://127.0.0.1:{}/?token={}", server->port(), pages.token()));
    server->run(
        stop, [&pages](const HttpRequest& request) { return pages(request); }, [&pages] { pages.stop(); });
    return {};
}

} // namespace burnish
