// The rules of access to a run. The class has no sockets.
//
// A browser shows pages of many sites. Each of them can send requests to a server on this machine.
// Two rules keep such a page from reading a run. The Host header must name the address on which the
// server listens: a foreign name that was pointed at this machine (DNS rebinding) stays in this
// header. And the Origin header, which a browser sends with a WebSocket, must be that of our own
// page. If the server listens for other machines, a WebSocket also needs a token, which only the
// printed address contains. There is one token for those who look, and another one for the person
// who drives.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::web {

/// The path of the participant's page.
inline constexpr std::string_view kDrivePath = "/drive";

enum class Verdict { kAllowed, kWrongHost, kForeignOrigin, kWrongToken };

/// Why a request is refused, as a part of a sentence. @pre the verdict is not kAllowed
std::string_view WhyRefused(Verdict verdict);

/// The headers of a request that Access judges. A header that is not there is empty.
struct RequestOrigin {
  std::string_view host;
  std::string_view origin;
  std::string_view target;  // the path, perhaps with "?token=..."
  bool drives = false;      // whether it asks for the seat
};

class Access {
 public:
  struct Rules {
    std::string address;               // IPv4 in numbers, on which the server listens
    std::uint16_t port = 0;            // the port on which it listens
    std::string token;                 // "": no token is needed
    std::vector<std::string> origins;  // further origins that may open a WebSocket
    bool seat = false;                 // whether a person may drive
    std::string driver_token;          // in place of `token`, for the one who drives
  };
  explicit Access(Rules rules);

  /// Whether a file of the page may be sent. The files are no secret.
  Verdict OfPage(const RequestOrigin& request) const;
  /// Whether a WebSocket may be opened.
  Verdict OfWebSocket(const RequestOrigin& request) const;

  /// The address for a browser, such as "http://127.0.0.1:7680/". The token stands behind '#': a
  /// browser does not send this part to any server.
  /// @param more further parts behind '#', such as "step=190"; "" for none
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

/// Whether a text that a person or a program has chosen can be a token: 16 to 128 letters, digits,
/// '-' and '_', so that it stands in an address as it is.
bool IsToken(std::string_view text);

/// Whether two texts are equal, in a time that does not depend on where they differ.
bool EqualInConstantTime(std::string_view a, std::string_view b);

/// The value of a parameter in the query of a target, such as "/ws?token=a"; "" if there is none.
/// The value is as it stands there: nothing in it is decoded.
std::string_view QueryValue(std::string_view target, std::string_view name);

/// An origin as a browser sends it: scheme and host in small letters, and without the scheme's
/// default port.
std::string NormalOrigin(std::string_view origin);

/// An origin such as a browser sends it: "http://HOST" or "https://HOST", perhaps with a port, and
/// without a path.
bool IsOrigin(std::string_view text);

}  // namespace fogline::web
