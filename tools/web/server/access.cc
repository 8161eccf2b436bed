#include "tools/web/server/access.h"

#include <arpa/inet.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

#include <fmt/core.h>

#include "common/parse_number.h"

namespace fogline::web {
namespace {

constexpr std::string_view kEveryAddress = "0.0.0.0";

std::string Lowered(std::string_view text) {
  std::string lowered(text);
  std::ranges::transform(lowered, lowered.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return lowered;
}

bool IsAddressInNumbers(const std::string& name) {
  in_addr ignored{};
  return inet_pton(AF_INET, name.c_str(), &ignored) == 1;
}

/// Whether this text can be an origin without its scheme, as a browser writes it: "HOST" or
/// "HOST:PORT". HOST may be "[IPv6]", and PORT is a number from 1 to 65535.
bool IsHostAndPort(std::string_view text) {
  std::size_t end = text.find(':');
  if (text.starts_with('[')) {
    const std::size_t bracket = text.find(']');
    if (bracket == std::string_view::npos) return false;
    end = bracket + 1;
  }
  const std::string_view host = text.substr(0, end);
  const std::string_view port = text.substr(host.size());
  if (host.empty()) return false;
  if (port.empty()) return true;
  return port.starts_with(':') && !port.starts_with(":0") &&
         ParseNumber<std::uint16_t>(port.substr(1)).has_value();
}

}  // namespace

std::string_view WhyRefused(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAllowed:
      break;
    case Verdict::kWrongHost:
      return "its Host header does not name the address of this server";
    case Verdict::kForeignOrigin:
      return "a page of another origin asks";
    case Verdict::kWrongToken:
      return "the token is missing or wrong";
  }
  return "";
}

Access::Access(Rules rules) : rules_(std::move(rules)) {
  for (std::string& origin : rules_.origins) origin = NormalOrigin(origin);
}

bool Access::IsOurs(std::string_view host) const {
  std::string name = Lowered(host);
  const std::string port = fmt::format(":{}", rules_.port);
  constexpr std::uint16_t kPortOfHttp = 80;
  if (name.ends_with(port)) {
    name.resize(name.size() - port.size());
  } else if (rules_.port != kPortOfHttp) {
    return false;
  }
  if (name == rules_.address) return true;
  const bool everywhere = rules_.address == kEveryAddress;
  if (name == "localhost") return everywhere || rules_.address.starts_with("127.");
  // A numeric address needs no DNS, so DNS rebinding cannot use it.
  return everywhere && IsAddressInNumbers(name);
}

Verdict Access::OfPage(const RequestOrigin& request) const {
  return IsOurs(request.host) ? Verdict::kAllowed : Verdict::kWrongHost;
}

Verdict Access::OfWebSocket(const RequestOrigin& request) const {
  if (!IsOurs(request.host)) return Verdict::kWrongHost;
  const std::string origin = NormalOrigin(request.origin);
  const bool own = origin.empty() || origin == NormalOrigin(fmt::format("http://{}", request.host));
  if (!own && std::ranges::find(rules_.origins, origin) == rules_.origins.end()) {
    return Verdict::kForeignOrigin;
  }
  const std::string_view token = QueryValue(request.target, "token");
  const std::string& needed = request.drives ? rules_.driver_token : rules_.token;
  if (!needed.empty() && !EqualInConstantTime(token, needed)) {
    return Verdict::kWrongToken;
  }
  return Verdict::kAllowed;
}

std::string Access::UrlOf(std::string_view path, std::string_view fragment) const {
  // 0.0.0.0 means every address of this machine. A browser on this machine needs one real address.
  const std::string address = rules_.address == kEveryAddress ? "127.0.0.1" : rules_.address;
  return fmt::format("http://{}:{}{}{}{}", address, rules_.port, path, fragment.empty() ? "" : "#",
                     fragment);
}

std::string Access::Url(std::string_view more) const {
  std::string fragment = rules_.token.empty() ? "" : "token=" + rules_.token;
  if (!fragment.empty() && !more.empty()) fragment += '&';
  fragment += more;
  return UrlOf("/", fragment);
}

std::string Access::DriveUrl() const {
  return UrlOf(kDrivePath, rules_.driver_token.empty() ? "" : "token=" + rules_.driver_token);
}

std::string DrawToken() {
  std::array<unsigned char, 16> secret{};
  randombytes_buf(secret.data(), secret.size());
  std::string token;
  for (const unsigned char byte : secret) token += fmt::format("{:02x}", byte);
  return token;
}

bool IsToken(std::string_view text) {
  constexpr std::size_t kLeast = 16;  // our choice: 16 hexadecimal digits have 64 bits
  constexpr std::size_t kMost = 128;
  return text.size() >= kLeast && text.size() <= kMost && std::ranges::all_of(text, [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
         });
}

bool EqualInConstantTime(std::string_view a, std::string_view b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string_view QueryValue(std::string_view target, std::string_view name) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return "";
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    if (part.size() <= name.size() || part[name.size()] != '=') continue;
    if (part.starts_with(name)) return part.substr(name.size() + 1);
  }
  return "";
}

std::string NormalOrigin(std::string_view origin) {
  std::string normal = Lowered(origin);
  const bool secure = normal.starts_with("https:");
  const std::string_view port = secure ? ":443" : ":80";
  if (normal.ends_with(port)) normal.resize(normal.size() - port.size());
  return normal;
}

bool IsOrigin(std::string_view origin) {
  const std::string text = Lowered(origin);
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!text.starts_with(scheme)) continue;
    const std::string_view rest = std::string_view(text).substr(scheme.size());
    return IsHostAndPort(rest) && std::ranges::all_of(rest, [](char c) {
             return c > ' ' && c < 127 &&
                    std::string_view("/?#@\\").find(c) == std::string_view::npos;
           });
  }
  return false;
}

}  // namespace fogline::web
