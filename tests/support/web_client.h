// Clients of fogline view in tests: a WebSocket by Boost.Beast, and plain HTTP.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "tests/support/command.h"

namespace fogline::test {

/// The server has closed the WebSocket, or the connection.
class WebClosed : public std::runtime_error {
 public:
  WebClosed(std::uint16_t code, const std::string& reason)
      : std::runtime_error(std::to_string(code) + " " + reason), code_(code) {}
  /// The code of the closing frame; 0 if there was none.
  std::uint16_t code() const { return code_; }

 private:
  std::uint16_t code_;
};

/// The server has answered the request for a WebSocket with a status other than 101.
class WebRefused : public std::runtime_error {
 public:
  explicit WebRefused(int status) : std::runtime_error(std::to_string(status)), status_(status) {}
  int status() const { return status_; }

 private:
  int status_;
};

struct WebFrame {
  bool binary = false;
  std::string bytes;
};

class WebClient {
 public:
  struct Options {
    std::string target = "/ws";
    std::string protocol = "fogline.view.v1";  // "": asks for none
    std::string host;                          // header Host; "": the address of the server
    std::string origin;                        // "": none
    int receive_bytes = 0;                     // buffer of the socket; 0: default of the system
  };

  /// @throws WebRefused, std::runtime_error
  explicit WebClient(std::uint16_t port);
  WebClient(std::uint16_t port, const Options& options);
  ~WebClient();
  WebClient(WebClient&&) noexcept;

  /// The subprotocol that the server has chosen.
  std::string protocol() const;
  /// @throws WebClosed
  void Send(const std::string& bytes, bool binary = false);
  /// The next frame. @throws WebClosed, std::runtime_error after the time limit
  WebFrame Receive(std::chrono::seconds limit = kPatience);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Sends bytes to a port of this machine, and reads until the other side closes.
/// @return the bytes that the other side has sent; "" if it sends nothing
std::string Exchange(std::uint16_t port, const std::string& bytes,
                     std::chrono::seconds limit = kPatience);

/// The text of a GET request for Exchange(). @param more further header lines, each with "\r\n"
std::string GetRequest(std::uint16_t port, const std::string& target, const std::string& more = "");

/// The status of an answer; 0 if the answer is not HTTP.
int StatusOf(const std::string& answer);

}  // namespace fogline::test
