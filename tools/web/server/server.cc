#include "tools/web/server/server.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "tools/web/server/connection.h"

namespace fogline::web {

namespace asio = boost::asio;
using asio::ip::address;

Server::Server(asio::io_context& context, const ServerOptions& options,
               std::span<const Asset> assets, View& view)
    : context_(context),
      assets_(assets),
      view_(view),
      limits_(options.limits),
      acceptor_(context, {asio::ip::make_address(options.address), options.port}, lines_),
      access_({.address = options.address,
               .port = acceptor_.endpoint().port(),
               .token = options.token,
               .origins = options.origins,
               .seat = options.seat,
               .driver_token = options.driver_token}) {
  acceptor_.Begin([this](tcp::socket socket) { Take(std::move(socket)); });
}

Server::~Server() = default;

void Server::Take(tcp::socket socket) {
  boost::system::error_code error;
  const address host = socket.remote_endpoint(error).address();
  if (error) return;  // the client has already left
  MakeRoomFor(host);
  const std::uint64_t id = next_id_++;
  callers_.emplace(id, host);
  connections_.emplace(id, Connection::Start(*this, id, std::move(socket)));
}

void Server::MakeRoomFor(const address& host) {
  std::map<address, std::size_t> callers;
  for (const auto& [id, of] : callers_) ++callers[of];
  if (callers[host] >= limits_.callers_of_one) return CloseOldestOf(host);
  if (callers_.size() < limits_.callers) return;
  CloseOldestOf(
      std::ranges::max_element(callers, {}, [](const auto& count) { return count.second; })->first);
}

void Server::CloseOldestOf(const address& host) {
  const auto oldest =
      std::ranges::find(callers_, host, [](const auto& caller) { return caller.second; });
  const auto connection = connections_.at(oldest->first);
  callers_.erase(oldest);
  connection->GiveWay();
}

bool Server::IsFull() const {
  const std::int64_t in_own_place = counts_.drivers > 0 ? 1 : 0;
  return counts_.viewers - in_own_place >= static_cast<std::int64_t>(limits_.viewers);
}

bool Server::TakePlace(std::uint64_t id, bool drives) {
  const bool has_own_place = drives && counts_.drivers == 0;
  if (!has_own_place && IsFull()) return false;
  callers_.erase(id);
  ++counts_.viewers;
  if (drives) ++counts_.drivers;
  return true;
}

void Server::LeavePlace(bool drives) {
  --counts_.viewers;
  if (drives) --counts_.drivers;
}

void Server::Leave(std::uint64_t id) {
  callers_.erase(id);
  connections_.erase(id);
}

void Server::CountCutOff(const std::string& address, const std::string& why) {
  ++counts_.cut_off;
  lines_.Print(fmt::format("{} cut off: {}", address, why));
}

void Server::CountRefused(const std::string& address, std::string_view why) {
  ++counts_.refused;
  lines_.Print(fmt::format("{} refused: {}", address, why));
}

void Server::CountWrongFrame(const std::string& address, std::string_view why) {
  ++counts_.wrong_frames;
  frame_lines_.Print(
      fmt::format("{} sends a wrong frame ({} so far): {}", address, counts_.wrong_frames, why));
}

void Server::Stop() {
  acceptor_.Stop();
  const auto connections = connections_;
  for (const auto& [id, connection] : connections) connection->GoAway();
}

}  // namespace fogline::web
