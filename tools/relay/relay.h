// The relay takes messages from its clients. It sends each message to the clients that have
// subscribed to the message's channel, in the order of arrival. A sender that has subscribed also
// gets its own messages, as with LCM's own relay.
//
// The relay has one thread, and nothing blocks it. Each client has its own queue for bytes that the
// client has not accepted yet. A client whose queue is full is disconnected. So no client can delay
// another client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "common/clock.h"
#include "common/process/acceptor.h"
#include "common/process/line_budget.h"
#include "services/runtime/wire/tcpq_frame.h"

namespace fogline::relay {

struct RelayOptions {
  runtime::tcpq::Limits limits;
  std::size_t queue_bytes = 16 << 20;  // limit for each client; an empty queue accepts any message
  std::size_t clients = 128;
  std::size_t subscriptions = 1000;  // limit for each client
};

class RelayClient;

class Relay {
 public:
  using tcp = boost::asio::ip::tcp;

  /// Listens, and accepts clients while the context runs. @throws boost::system::system_error
  Relay(boost::asio::io_context& context, const tcp::endpoint& endpoint,
        const RelayOptions& options);
  ~Relay();

  /// The address on which the relay listens. If port 0 was requested, the address has the port that
  /// the system has chosen.
  tcp::endpoint endpoint() const { return acceptor_.endpoint(); }

  /// Ends all connections. The context then has no more work.
  void Stop();

  /// The counts up to this moment, in one line.
  std::string Summary() const;

 private:
  friend class RelayClient;

  void Take(tcp::socket socket);
  void Forward(const runtime::tcpq::Frame& message);
  void Greeted() { ++served_; }
  void Sent(std::size_t bytes);
  /// Removes a client. `why` is empty if the client left by itself.
  void Leave(std::uint64_t id, const std::string& address, const std::string& why);

  boost::asio::io_context& context_;
  const RelayOptions options_;
  LineBudget lines_{"fogline-relay"};
  Acceptor acceptor_;
  std::map<std::uint64_t, std::shared_ptr<RelayClient>> clients_;
  std::uint64_t next_id_ = 0;
  const TimePoint began_ = Clock::now();

  std::uint64_t served_ = 0;
  std::uint64_t disconnected_ = 0;
  std::uint64_t messages_in_ = 0;
  std::uint64_t bytes_in_ = 0;
  std::uint64_t messages_out_ = 0;
  std::uint64_t bytes_out_ = 0;
};

}  // namespace fogline::relay
