// The rules of access to a run. The class has no sockets.
//
// A browser shows pages of many sites. Each page can send requests to a server on this machine. Two
// rules keep such a page from reading a run. The first rule: the Host header must name the address
// on which the server listens. A foreign site can make its own name point to this machine (DNS
// rebinding), but then the header contains the foreign name. The second rule: the Origin header of
// a WebSocket must name our own page, or an origin that the user has allowed. Every browser sends
// this header; other programs may omit it. If the server listens for other machines, a WebSocket
// also needs a token. Only the printed address contains this token. Viewers have one token, and the
// person who drives has another one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::web {

/// The path of the participant's page.
inline constexpr std::string_view kDrivePath = "/drive";

enum class Verdict { kAllowed, kWrongHost, kForeignOrigin, kWrongToken };

/// The reason why a request is refused, as a part of a sentence. @pre the verdict is not kAllowed
std::string_view WhyRefused(Verdict verdict);

/// The parts of a request by which Access decides. A missing header is empty.
struct RequestOrigin {
  std::string_view host;
  std::string_view origin;
  std::string_view target;  // the path, perhaps with "?token=..."
  bool drives = false;      // whether the request is for the seat
};

class Access {
 public:
  struct Rules {
    std::string address;               // numeric IPv4 address on which the server listens
    std::uint16_t port = 0;            // the port on which it listens
    std::string token;                 // "": no token is needed
    std::vector<std::string> origins;  // further origins that may open a WebSocket
    bool seat = false;                 // whether a person may drive
    std::string driver_token;          // the token of a client that drives, in place of `token`
  };
  explicit Access(Rules rules);

  /// Whether a file of a page may be sent. The files are not secret.
  Verdict OfPage(const RequestOrigin& request) const;
  /// Whether a WebSocket may be opened.
  Verdict OfWebSocket(const RequestOrigin& request) const;

  /// The address for a browser, such as "http://127.0.0.1:7680/". The token comes after '#',
  /// because a browser sends this part to no server.
  /// @param more further parts after '#', such as "step=190"; "" for none
  std::string Url(std::string_view more = "") const;
  /// The address of the participant's page, with the driver's token.
  std::string DriveUrl() const;

  const Rules& rules() const { return rules_; }

 private:
  bool IsOurs(std::string_view host) const;
  std::string UrlOf(std::string_view path, std::string_view fragment) const;

  Rules rules_;
};

/// 128 random bits as 32 hexadecimal digits.
std::string DrawToken();

/// Whether a text from a person or a program can be a token: 16 to 128 letters, digits, '-' and
/// '_'. An address can contain such a text without escapes.
bool IsToken(std::string_view text);

/// Whether two texts are equal. The time for the comparison does not depend on where they differ.
bool EqualInConstantTime(std::string_view a, std::string_view b);

/// The value of a parameter in the query of a target, such as "/ws?token=a"; "" if the parameter is
/// missing. The value is not decoded.
std::string_view QueryValue(std::string_view target, std::string_view name);

/// An origin in the form that a browser sends: scheme and host in small letters, and without the
/// scheme's default port.
std::string NormalOrigin(std::string_view origin);

/// Whether a text is an origin in the form that a browser sends: "http://HOST" or "https://HOST",
/// perhaps with a port, and without a path.
bool IsOrigin(std::string_view text);

}  // namespace fogline::web
