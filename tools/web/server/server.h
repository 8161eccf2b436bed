// A server for browsers: the files of the pages by HTTP, and WebSockets. It has one thread, and
// nothing blocks it. The server does not use runs or logs: a View does.
//
// Every limit protects the other clients and the memory of this process. A client that exceeds a
// limit is closed, counted, and reported on stderr. A client that has not opened a WebSocket is a
// caller. Callers have their own limits, so a caller that is refused cannot take the place of a
// viewer.
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
#include "tools/web/server/subprotocol.h"

namespace fogline::web {

/// Codes with which the server closes a WebSocket (RFC 6455, 7.4.1; 1013 is from IANA's registry).
enum class CloseCode : std::uint16_t {
  kGoingAway = 1001,        // the program ends
  kPolicyViolation = 1008,  // the client sends too many frames
  kTryAgainLater = 1013,    // the client does not read its bytes
};

/// An open WebSocket. A View uses it through this interface.
class Client {
 public:
  virtual ~Client() = default;

  virtual std::uint64_t id() const = 0;
  /// The address and port of the client, for people.
  virtual const std::string& address() const = 0;
  /// The subprotocol; kViewProtocol if the client asked for none.
  virtual std::string_view protocol() const = 0;
  /// Queues a frame. A client whose queue has no room is cut off, because it does not read its
  /// bytes. A client that is being closed gets no frame.
  virtual void Send(OutgoingFrame frame) = 0;
  /// The number of bytes in the queue.
  virtual std::size_t waiting() const = 0;
  /// Closes the client because it exceeds a limit. The client is counted, and reported on stderr.
  /// View::Closed() is called later, not during this call.
  virtual void CutOff(CloseCode code, const std::string& why) = 0;
  /// Counts a frame of the client that cannot be used, and prints the reason on stderr. The client
  /// stays connected.
  virtual void CountWrongFrame(std::string_view why) const = 0;
};

/// The contents that a server gives its clients.
class View {
 public:
  virtual ~View() = default;
  virtual void Opened(Client& client) = 0;
  /// Called with a frame of a client. If many bytes wait to be sent to the client, the server reads
  /// no further frame of this client.
  virtual void Received(Client& client, std::string_view bytes, bool binary) = 0;
  /// Called when everything that was queued for the client has been sent.
  virtual void Idle(Client& client) = 0;
  /// The last call for this client.
  virtual void Closed(Client& client) = 0;
};

/// Limits of a server. Tests make them smaller.
struct ServerLimits {
  std::size_t viewers = 64;  // WebSockets; one more is allowed for a client that drives
  // Limit for the number of callers (clients that have not opened a WebSocket). A browser opens at
  // most 6 connections for a page at a time.
  std::size_t callers = 64;
  std::size_t callers_of_one = 32;  // from one address
  // Time in which a request must come, and in which its answer must be read.
  std::chrono::milliseconds request{10'000};
  // If a WebSocket sends nothing for half of this time, it gets a ping. Without an answer it is
  // closed.
  std::chrono::milliseconds silence{60'000};
};

struct ServerOptions {
  std::string address = "127.0.0.1";  // a numeric IPv4 address
  std::uint16_t port = 0;             // 0: the system chooses a port
  std::string token;                  // see Access::Rules
  std::vector<std::string> origins;   // see Access::Rules
  ServerLimits limits;
  bool seat = false;         // see Access::Rules
  std::string driver_token;  // see Access::Rules
};

/// Numbers of clients and frames: `viewers` and `drivers` at present, the others since the start of
/// the server.
struct ServerCounts {
  std::int64_t viewers = 0;  // WebSockets that are open, including those that drive
  std::int64_t drivers = 0;  // WebSockets that drive, or ask for the seat
  std::int64_t cut_off = 0;  // clients that exceeded a limit, or broke RFC 6455
  // Number of callers that exceeded a limit, or whose request was refused, such as for a wrong
  // Host, Origin or token.
  std::int64_t refused = 0;
  std::int64_t wrong_frames = 0;  // frames of open WebSockets that could not be used
};

class Connection;

class Server {
 public:
  using tcp = boost::asio::ip::tcp;

  static constexpr std::size_t kMostHeaderBytes = 8 << 10;
  static constexpr std::size_t kMostFrameBytes = 64 << 10;
  /// Limit for a frame of a client that drives. An input has less than 1 KiB.
  static constexpr std::size_t kMostSeatFrameBytes = 4 << 10;

  /// Listens, and accepts connections while the context runs.
  /// @param view must exist as long as the server
  /// @throws boost::system::system_error if the server cannot listen
  Server(boost::asio::io_context& context, const ServerOptions& options,
         std::span<const Asset> assets, View& view);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const Access& access() const { return access_; }
  const ServerCounts& counts() const { return counts_; }

  /// Closes all connections. Tells the WebSockets that the program ends, and closes those that do
  /// not answer within kFarewell. The context then has no more work.
  void Stop();
  static constexpr std::chrono::milliseconds kFarewell{300};

 private:
  friend class Connection;

  void Take(tcp::socket socket);
  /// Closes the oldest caller of this address if the address has reached its limit. Otherwise, if
  /// there are too many callers, closes the oldest caller of the address with most callers.
  void MakeRoomFor(const boost::asio::ip::address& host);
  void CloseOldestOf(const boost::asio::ip::address& host);
  /// Makes a caller a viewer. @return false if there is no free place
  bool TakePlace(std::uint64_t id, bool drives);
  void LeavePlace(bool drives);
  /// Whether all places of viewers are taken. One more place is kept for a client that drives, so
  /// that viewers cannot keep a person from driving.
  bool IsFull() const;
  void Leave(std::uint64_t id);
  /// Counts a viewer that exceeds a limit, and prints its address and the reason on stderr.
  void CountCutOff(const std::string& address, const std::string& why);
  void CountRefused(const std::string& address, std::string_view why);
  void CountWrongFrame(const std::string& address, std::string_view why);

  boost::asio::io_context& context_;
  std::span<const Asset> assets_;
  View& view_;
  const ServerLimits limits_;
  LineBudget lines_{"fogline-web"};
  LineBudget frame_lines_{"fogline-web"};  // separate, so that wrong frames hide no other lines
  Acceptor acceptor_;
  Access access_;
  std::map<std::uint64_t, std::shared_ptr<Connection>> connections_;
  std::map<std::uint64_t, boost::asio::ip::address> callers_;  // in the order of their connection
  std::uint64_t next_id_ = 0;
  ServerCounts counts_;
};

}  // namespace fogline::web
