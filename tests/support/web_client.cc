#include "tests/support/web_client.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

namespace fogline::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;

tcp::endpoint Here(std::uint16_t port) { return {asio::ip::address_v4::loopback(), port}; }

std::string HostOf(std::uint16_t port) { return "127.0.0.1:" + std::to_string(port); }

}  // namespace

struct WebClient::Parts {
  asio::io_context context;
  websocket::stream<beast::tcp_stream> socket{context};
  beast::flat_buffer buffer;
  std::string protocol;

  /// Runs one asynchronous operation to its end. `start` gets the handler, and starts the
  /// operation.
  /// @return the error of the operation @throws std::runtime_error after the time limit
  template <class Start>
  error_code Run(const Start& start, std::chrono::seconds limit = kPatience) {
    std::optional<error_code> result;
    start([&result](error_code error, auto...) { result = error; });
    context.restart();
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!result && std::chrono::steady_clock::now() < end) context.run_one_until(end);
    if (!result) throw std::runtime_error("the server does not answer in time");
    return *result;
  }

  [[noreturn]] void ThrowClosed(error_code error) const {
    const auto& reason = socket.reason();
    throw WebClosed(
        error == websocket::error::closed ? reason.code : 0,
        error.message() + " " + std::string(reason.reason.data(), reason.reason.size()));
  }
};

WebClient::WebClient(std::uint16_t port) : WebClient(port, Options{}) {}

WebClient::WebClient(std::uint16_t port, const Options& options)
    : parts_(std::make_unique<Parts>()) {
  auto& socket = parts_->socket;
  auto& lowest = beast::get_lowest_layer(socket).socket();
  lowest.open(tcp::v4());
  if (options.receive_bytes > 0) {
    lowest.set_option(asio::socket_base::receive_buffer_size(options.receive_bytes));
  }
  lowest.connect(Here(port));
  beast::get_lowest_layer(socket).expires_never();
  socket.read_message_max(64 << 20);
  socket.set_option(websocket::stream_base::decorator([&options](websocket::request_type& request) {
    if (!options.protocol.empty()) {
      request.set(beast::http::field::sec_websocket_protocol, options.protocol);
    }
    if (!options.origin.empty()) request.set(beast::http::field::origin, options.origin);
  }));
  websocket::response_type response;
  const std::string host = options.host.empty() ? HostOf(port) : options.host;
  const error_code error = parts_->Run(
      [&](auto handler) { socket.async_handshake(response, host, options.target, handler); });
  if (error == websocket::error::upgrade_declined) throw WebRefused(int(response.result_int()));
  if (error) throw std::runtime_error(error.message());
  const auto chosen = response[beast::http::field::sec_websocket_protocol];
  parts_->protocol.assign(chosen.data(), chosen.size());
}

WebClient::~WebClient() = default;
WebClient::WebClient(WebClient&&) noexcept = default;

std::string WebClient::protocol() const { return parts_->protocol; }

void WebClient::Send(const std::string& bytes, bool binary) {
  parts_->socket.binary(binary);
  const error_code error =
      parts_->Run([&](auto handler) { parts_->socket.async_write(asio::buffer(bytes), handler); });
  if (error) parts_->ThrowClosed(error);
}

WebFrame WebClient::Receive(std::chrono::seconds limit) {
  parts_->buffer.clear();
  const error_code error =
      parts_->Run([&](auto handler) { parts_->socket.async_read(parts_->buffer, handler); }, limit);
  if (error) parts_->ThrowClosed(error);
  return {.binary = parts_->socket.got_binary(),
          .bytes = beast::buffers_to_string(parts_->buffer.cdata())};
}

std::string Exchange(std::uint16_t port, const std::string& bytes, std::chrono::seconds limit) {
  asio::io_context context;
  tcp::socket socket(context);
  socket.connect(Here(port));
  error_code error;
  asio::write(socket, asio::buffer(bytes), error);  // the server may close before it has read all
  std::string answer;
  std::array<char, 4096> buffer{};
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    pollfd waited{.fd = socket.native_handle(), .events = POLLIN, .revents = 0};
    if (poll(&waited, 1, 100) <= 0) continue;
    const ssize_t size = recv(socket.native_handle(), buffer.data(), buffer.size(), 0);
    if (size <= 0) return answer;
    answer.append(buffer.data(), static_cast<std::size_t>(size));
  }
  throw std::runtime_error("the server does not close the connection");
}

std::string GetRequest(std::uint16_t port, const std::string& target, const std::string& more) {
  return "GET " + target + " HTTP/1.1\r\nHost: " + HostOf(port) + "\r\n" + more + "\r\n";
}

int StatusOf(const std::string& answer) {
  if (!answer.starts_with("HTTP/1.1 ") || answer.size() < 12) return 0;
  return std::stoi(answer.substr(9, 3));
}

}  // namespace fogline::test
