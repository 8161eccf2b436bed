// The answer of the server to an HTTP request. The functions have no sockets.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/web/server/access.h"
#include "tools/web/server/assets.h"

namespace fogline::web {

/// The path at which a WebSocket is opened.
inline constexpr std::string_view kSocketPath = "/ws";

struct HttpRequest {
  std::string_view method;
  RequestOrigin from;
  std::string_view if_none_match;  // the ETag of the browser's copy; "": no copy
};

struct HttpAnswer {
  unsigned status = 200;
  /// The headers that depend on the request, except Date, Server and Content-Length.
  std::vector<std::pair<std::string_view, std::string>> headers;
  std::string_view body;  // a file of a page; "" if `text` is the answer
  std::string text;       // one line for a person
  Verdict verdict = Verdict::kAllowed;
};

/// The headers of every answer. With these headers our page may load only files of this server, and
/// no other page may show our page in a frame.
std::vector<std::pair<std::string_view, std::string_view>> SafetyHeaders();

/// The answer to a request that does not open a WebSocket, or that may not open one. Only GET is
/// allowed. "/" means "/index.html", "/drive" means "/drive.html". The query after a path is
/// ignored.
HttpAnswer Answer(const HttpRequest& request, const Access& access, std::span<const Asset> assets);

/// An answer that has only a line of text.
HttpAnswer Refusal(unsigned status, std::string text);

/// The path of a target, without its query.
std::string_view PathOf(std::string_view target);

/// Whether a path may belong to the participant's page or to one of its files. Returns false only
/// for the paths of the page for viewers and of the WebSocket. Returns true for every other
/// path, because the two pages share files.
bool MayBeOfDrivePage(std::string_view path);

}  // namespace fogline::web
