#include "tools/relay/relay.h"

#include <utility>

#include <fmt/core.h>

#include "tools/relay/relay_client.h"

namespace fogline::relay {
namespace {

namespace asio = boost::asio;

}  // namespace

Relay::Relay(asio::io_context& context, const tcp::endpoint& endpoint, const RelayOptions& options)
    : context_(context), options_(options), acceptor_(context, endpoint, lines_) {
  acceptor_.Begin([this](tcp::socket socket) { Take(std::move(socket)); });
}

Relay::~Relay() = default;

void Relay::Take(tcp::socket socket) {
  const std::uint64_t id = next_id_++;
  const auto client = std::make_shared<RelayClient>(*this, id, std::move(socket));
  if (clients_.size() >= options_.clients) {
    return client->Drop(fmt::format("{} clients are connected already", clients_.size()));
  }
  clients_.emplace(id, client);
  client->Start();
}

void Relay::Forward(const runtime::tcpq::Frame& message) {
  ++messages_in_;
  bytes_in_ += message.payload.size();
  for (const auto& [id, client] : clients_) client->Offer(message);
}

void Relay::Sent(std::size_t bytes) {
  ++messages_out_;
  bytes_out_ += bytes;
}

void Relay::Leave(std::uint64_t id, const std::string& address, const std::string& why) {
  if (!why.empty()) {
    ++disconnected_;
    lines_.Print(fmt::format("{} disconnected: {}", address, why));
  }
  // The client is erased later, because Forward() may be iterating over clients_.
  asio::post(context_, [this, id] { clients_.erase(id); });
}

void Relay::Stop() {
  acceptor_.Stop();
  for (const auto& [id, client] : clients_) client->Drop("");
}

std::string Relay::Summary() const {
  constexpr double kMegabyte = 1e6;
  return fmt::format(
      "{} clients, {} disconnected; {} messages in ({:.1f} MB), {} out ({:.1f} MB); {:.1f} s",
      served_, disconnected_, messages_in_, static_cast<double>(bytes_in_) / kMegabyte,
      messages_out_, static_cast<double>(bytes_out_) / kMegabyte,
      std::chrono::duration<double>(Clock::now() - began_).count());
}

}  // namespace fogline::relay
