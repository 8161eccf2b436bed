// One connection of the relay.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "services/runtime/wire/tcpq_frame.h"
#include "tools/relay/subscriptions.h"

namespace fogline::relay {

class Relay;

/// The object of a client exists until its last operation has ended. The relay removes the client
/// from the list of clients as soon as the client has left.
class RelayClient : public std::enable_shared_from_this<RelayClient> {
 public:
  using tcp = boost::asio::ip::tcp;

  RelayClient(Relay& relay, std::uint64_t id, tcp::socket socket);

  void Start();

  /// Sends a message if the client wants it; disconnects the client if its queue is full.
  void Offer(const runtime::tcpq::Frame& message);

  /// Ends the connection and tells the relay. @param why the error to report; "" if there is none
  void Drop(const std::string& why);

 private:
  void Read();
  /// Stops reading from a client that gets its own messages and publishes faster than it reads. Its
  /// own messages have filled its queue, and with more of them it would be disconnected. The pause
  /// ends when the queue has room again, or when the client has accepted nothing for kLongestPause.
  void Pause();
  void EndPause();
  /// Called when the client has accepted bytes. A pause ends if the queue has room again. Otherwise
  /// the pause may last another kLongestPause.
  void Progress();
  /// The number of bytes that the client has not accepted yet.
  std::size_t Queued() const { return sending_.size() - sent_ + waiting_.size(); }
  /// Whether the queue is more than half full, or has no room for a message of the largest size.
  bool LacksRoom() const;
  void Take(runtime::Bytes bytes);
  void Handle(const runtime::tcpq::Frame& frame);
  void Write();
  void WriteRest();
  bool Wants(std::string_view channel);

  Relay& relay_;
  const std::uint64_t id_;
  tcp::socket socket_;
  const std::string address_;
  boost::asio::steady_timer greeting_;  // runs until the client has sent its magic
  boost::asio::steady_timer pause_;     // runs during a pause
  runtime::tcpq::FrameParser parser_;
  Subscriptions subscriptions_;
  std::vector<std::uint8_t> read_;
  std::vector<std::uint8_t> sending_;  // the socket is sending these bytes
  std::size_t sent_ = 0;               // number of bytes of sending_ that are sent
  std::vector<std::uint8_t> waiting_;  // the bytes to send next
  bool greeted_ = false;
  bool paused_ = false;  // whether the relay waits before it reads on
  bool stuck_ = false;   // whether the client has accepted nothing since a pause of kLongestPause
  bool deaf_ = false;    // whether writing has failed; the client's messages are still read
  bool gone_ = false;
};

}  // namespace fogline::relay
