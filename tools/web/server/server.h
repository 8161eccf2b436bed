// A server for browsers: the files of the page by HTTP, and WebSockets. It has one thread, and
// nothing blocks it. It knows nothing of runs and logs: a View does.
//
// Every limit protects the other clients and the memory of this process. A client that exceeds a
// limit is closed, counted, and named on stderr. A connection that has not opened a WebSocket (a
// caller) has limits of its own. So a caller that is refused cannot take the place of a viewer.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "common/process/acceptor.h"
#include "common/process/line_budget.h"
#include "tools/web/server/access.h"
#include "tools/web/server/assets.h"
#include "tools/web/server/send_queue.h"

namespace fogline::web {

/// The subprotocols of WebSockets: our own for those who look and for the one who drives, and both
/// names of Foxglove's.
inline constexpr std::string_view kViewProtocol = "fogline.view.v1";
inline constexpr std::string_view kDriveProtocol = "fogline.drive.v1";
inline constexpr std::string_view kFoxgloveProtocol = "foxglove.websocket.v1";
inline constexpr std::string_view kFoxgloveSdkProtocol = "foxglove.sdk.v1";

constexpr bool IsFoxglove(std::string_view protocol) {
  return protocol == kFoxgloveProtocol || protocol == kFoxgloveSdkProtocol;
}

/// Codes with which the server closes a WebSocket (RFC 6455, 7.4.1; 1013 is from IANA's registry).
enum class CloseCode : std::uint16_t {
  kGoingAway = 1001,        // the program ends
  kPolicyViolation = 1008,  // the client sends too many frames
  kTryAgainLater = 1013,    // the client does not take its bytes
};

/// An open WebSocket, as a view sees it.
class Client {
 public:
  virtual ~Client() = default;

  virtual std::uint64_t id() const = 0;
  /// The address and port of the client, for people.
  virtual const std::string& address() const = 0;
  /// The subprotocol; kViewProtocol if the client asked for none.
  virtual std::string_view protocol() const = 0;
  /// Queues a frame. If there is no room in its queue, the client is cut off: it does not take its
  /// bytes. A client that is being closed gets nothing.
  virtual void Send(OutgoingFrame frame) = 0;
  /// The bytes that are queued.
  virtual std::size_t waiting() const = 0;
  /// Closes the client because it exceeds a limit. The client is counted and named. View::Closed()
  /// comes later, not during this call.
  virtual void CutOff(CloseCode code, const std::string& why) = 0;
};

/// The contents that a server gives its clients.
class View {
 public:
  virtual ~View() = default;
  virtual void Opened(Client& client) = 0;
  /// A frame of a client. No further frame of the client is read while much waits to be sent to it.
  virtual void Received(Client& client, std::string_view bytes, bool binary) = 0;
  /// Everything that was queued for the client has been sent.
  virtual void Idle(Client& client) = 0;
  /// The last call for this client.
  virtual void Closed(Client& client) = 0;
};

/// Bounds of a server that tests make smaller.
struct ServerLimits {
  std::size_t viewers = 64;  // WebSockets, without the place that is kept for the one who drives
  // A browser opens at most 6 connections for a page at a time.
  std::size_t callers = 64;
  std::size_t callers_of_one = 32;  // from one address
  // A request must be there, and its answer taken, within this time.
  std::chrono::milliseconds request{10'000};
  // A WebSocket that sends nothing for half of this time gets a ping; without an answer it is
  // closed.
  std::chrono::milliseconds silence{60'000};
};

struct ServerOptions {
  std::string address = "127.0.0.1";  // IPv4 in numbers
  std::uint16_t port = 0;             // 0: the system chooses a port
  std::string token;                  // see Access::Rules
  std::vector<std::string> origins;   // see Access::Rules
  ServerLimits limits;
  bool seat = false;         // see Access::Rules
  std::string driver_token;  // see Access::Rules
};

/// Numbers since the start of the server.
struct ServerCounts {
  std::int64_t viewers = 0;  // WebSockets that are open now, those that drive included
  std::int64_t drivers = 0;  // those of them that drive, or ask for the seat
  std::int64_t cut_off = 0;  // viewers that exceeded a limit
  // Callers that exceeded a limit, or had a wrong Host, Origin or token.
  std::int64_t refused = 0;
};

class Connection;

class Server {
 public:
  using tcp = boost::asio::ip::tcp;

  static constexpr std::size_t kMostHeaderBytes = 8 << 10;
  static constexpr std::size_t kMostFrameBytes = 64 << 10;
  /// Of a client that drives: an input has less than 1 KiB.
  static constexpr std::size_t kMostSeatFrameBytes = 4 << 10;

  /// Listens, and accepts while the context runs.
  /// @param view must live as long as the server
  /// @throws boost::system::system_error if it cannot listen
  Server(boost::asio::io_context& context, const ServerOptions& options,
         std::span<const Asset> assets, View& view);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const Access& access() const { return access_; }
  const ServerCounts& counts() const { return counts_; }

  /// Closes all connections: it says to the WebSockets that it goes away, and closes those that do
  /// not answer in kFarewell. The context then has no more work.
  void Stop();
  static constexpr std::chrono::milliseconds kFarewell{300};

 private:
  friend class Connection;

  void Take(tcp::socket socket);
  /// Closes the oldest caller of an address that has its share, or of the address that has most
  /// callers if there are too many in all.
  void MakeRoomFor(const boost::asio::ip::address& host);
  void CloseOldestOf(const boost::asio::ip::address& host);
  /// Makes a caller a viewer. @return false if there are too many viewers
  bool TakePlace(std::uint64_t id, bool drives);
  void LeavePlace(bool drives);
  /// Whether the places of the viewers are taken. Those who drive have one more place, so that
  /// viewers cannot keep a person from driving.
  bool IsFull() const;
  void Leave(std::uint64_t id);
  /// Counts a viewer that exceeds a limit, and names it on stderr.
  void CountCutOff(const std::string& address, const std::string& why);
  void CountRefused(const std::string& address, std::string_view why);

  boost::asio::io_context& context_;
  std::span<const Asset> assets_;
  View& view_;
  const ServerLimits limits_;
  LineBudget lines_{"fogline-web"};
  Acceptor acceptor_;
  Access access_;
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections_;
  std::map<std::uint64_t, boost::asio::ip::address> callers_;  // the oldest first
  std::uint64_t next_id_ = 0;
  ServerCounts counts_;
};

}  // namespace fogline::web
