#include "tools/web/server/server.h"

#include <utility>

#include <fmt/core.h>

#include "tools/web/server/connection.h"

namespace fogline::web {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

// Delay before the next try when a connection could not be accepted (no file descriptor is free).
constexpr std::chrono::milliseconds kPause(100);
// Connections beyond Server::kMostClients that may wait for their answer "503".
constexpr std::size_t kMostTurnedAway = 16;

}  // namespace

Server::Server(asio::io_context& context, const ServerOptions& options,
               std::span<const Asset> assets, View& view)
    : context_(context),
      assets_(assets),
      view_(view),
      acceptor_(context, tcp::endpoint(asio::ip::make_address(options.address), options.port)),
      access_({.address = options.address,
               .port = acceptor_.local_endpoint().port(),
               .token = options.token,
               .origins = options.origins}),
      pause_(context) {
  Accept();
}

Server::~Server() = default;

void Server::Accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {
      lines_.Print(fmt::format("cannot take a connection: {}", error.message()));
      pause_.expires_after(kPause);
      pause_.async_wait([this](error_code stopped) {
        if (!stopped) Accept();
      });
      return;
    }
    Take(std::move(socket));
    Accept();
  });
}

void Server::Take(tcp::socket socket) {
  const std::size_t taken = connections_.size();
  const auto place = taken < kMostClients ? Connection::Place::kFree : Connection::Place::kNone;
  if (place == Connection::Place::kNone) {
    ++counts_.cut_off;
    lines_.Print(fmt::format("a client turned away: {} clients are connected already", taken));
  }
  if (taken >= kMostClients + kMostTurnedAway) return;  // closes the socket
  const std::uint64_t id = next_id_++;
  connections_.emplace(id, Connection::Start(*this, id, std::move(socket), place));
}

void Server::Leave(std::uint64_t id) { connections_.erase(id); }

void Server::CountCutOff(const std::string& address, const std::string& why) {
  ++counts_.cut_off;
  lines_.Print(fmt::format("{} cut off: {}", address, why));
}

void Server::CountRefused(const std::string& address, std::string_view why) {
  ++counts_.refused;
  lines_.Print(fmt::format("{} refused: {}", address, why));
}

void Server::Stop() {
  error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel();
  const auto connections = connections_;
  for (const auto& [id, connection] : connections) connection->GoAway();
}

}  // namespace fogline::web
