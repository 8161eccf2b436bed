#include "tools/web/server/http_answer.h"

#include <algorithm>

#include <fmt/core.h>

namespace fogline::web {
namespace {

constexpr unsigned kNotModified = 304;
constexpr unsigned kForbidden = 403;
constexpr unsigned kNotFound = 404;
constexpr unsigned kMethodNotAllowed = 405;
constexpr unsigned kUpgradeRequired = 426;

}  // namespace

std::vector<std::pair<std::string_view, std::string_view>> SafetyHeaders() {
  return {{"Content-Security-Policy",
           "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
           "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"}};
}

HttpAnswer Refusal(unsigned status, std::string text) {
  HttpAnswer answer{.status = status};
  answer.text = std::move(text);
  answer.headers.emplace_back("Content-Type", "text/plain; charset=utf-8");
  answer.headers.emplace_back("Cache-Control", "no-store");
  return answer;
}

std::string_view PathOf(std::string_view target) { return target.substr(0, target.find('?')); }

bool MayBeOfDrivePage(std::string_view path) {
  return path != "/" && path != "/index.html" && path != kSocketPath;
}

HttpAnswer Answer(const HttpRequest& request, const Access& access, std::span<const Asset> assets) {
  const std::string_view path = PathOf(request.from.target);
  const bool socket = path == kSocketPath;
  const Verdict verdict = socket ? access.OfWebSocket(request.from) : access.OfPage(request.from);
  if (verdict != Verdict::kAllowed) {
    HttpAnswer answer = Refusal(kForbidden, fmt::format("Refused: {}.\n", WhyRefused(verdict)));
    answer.verdict = verdict;
    return answer;
  }
  if (request.method != "GET") {
    HttpAnswer answer = Refusal(kMethodNotAllowed, "Only GET is known here.\n");
    answer.headers.emplace_back("Allow", "GET");
    return answer;
  }
  if (socket) {
    HttpAnswer answer = Refusal(kUpgradeRequired, "This is the address of a WebSocket.\n");
    answer.headers.emplace_back("Upgrade", "websocket");
    return answer;
  }
  const std::string_view wanted = path == "/"          ? "/index.html"
                                  : path == kDrivePath ? "/drive.html"
                                                       : path;
  const auto asset = std::ranges::find(assets, wanted, &Asset::path);
  if (asset == assets.end()) return Refusal(kNotFound, "There is no such file here.\n");
  HttpAnswer answer;
  answer.headers.emplace_back("ETag", asset->etag);
  // The browser keeps the file, and asks each time whether the file is unchanged.
  answer.headers.emplace_back("Cache-Control", "no-cache");
  if (request.if_none_match.find(asset->etag) != std::string_view::npos) {
    answer.status = kNotModified;
    return answer;
  }
  answer.headers.emplace_back("Content-Type", asset->type);
  answer.body = asset->bytes;
  return answer;
}

}  // namespace fogline::web
