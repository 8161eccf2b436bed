// Accepts connections for a server with one thread, until Stop() is called.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include <fmt/core.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/process/line_budget.h"

namespace fogline {

class Acceptor {
 public:
  using tcp = boost::asio::ip::tcp;

  /// Begins to listen. Connections are accepted only after Begin().
  /// @param lines prints the errors, and must outlive the acceptor
  /// @throws boost::system::system_error if the acceptor cannot listen
  Acceptor(boost::asio::io_context& context, const tcp::endpoint& endpoint, LineBudget& lines)
      : lines_(lines), acceptor_(context, endpoint), pause_(context) {}

  /// Calls `take` for each connection while the context runs.
  void Begin(std::function<void(tcp::socket)> take) {
    take_ = std::move(take);
    Accept();
  }

  /// Stops accepting connections. Then the acceptor has no more work in the context.
  void Stop() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  }

  /// The address on which the acceptor listens. If port 0 was requested, the address has the port
  /// that the system has chosen.
  tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

 private:
  // Delay before the next try when a connection could not be accepted (no file descriptor is free).
  static constexpr std::chrono::milliseconds kPause{100};

  void Accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (!error) {
        take_(std::move(socket));
        return Accept();
      }
      lines_.Print(fmt::format("cannot take a connection: {}", error.message()));
      pause_.expires_after(kPause);
      pause_.async_wait([this](boost::system::error_code stopped) {
        if (!stopped) Accept();
      });
    });
  }

  LineBudget& lines_;
  tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;  // runs after a connection could not be accepted
  std::function<void(tcp::socket)> take_;
};

}  // namespace fogline
