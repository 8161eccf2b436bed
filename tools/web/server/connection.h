// One connection of the server. Only connection.cc knows Beast, because its headers take long to
// compile.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <boost/asio/ip/tcp.hpp>

#include "tools/web/server/server.h"

namespace fogline::web {

/// First a request by HTTP, then perhaps a WebSocket. A connection lives until its last operation
/// has ended. The server forgets it as soon as it has left.
class Connection : public Client {
 public:
  /// Whether there is a place for this client. Without one it is told to come again later.
  enum class Place { kFree, kNone };

  /// Serves the client while the server's context runs.
  static std::shared_ptr<Connection> Start(Server& server, std::uint64_t id,
                                           boost::asio::ip::tcp::socket socket, Place place);

  /// Closes the connection, because the program ends.
  virtual void GoAway() = 0;

 protected:
  Connection(Server& server, std::uint64_t id) : server_(server), id_(id) {}

  std::uint64_t id() const final { return id_; }

  boost::asio::io_context& context() const { return server_.context_; }
  const Access& access() const { return server_.access_; }
  std::span<const Asset> assets() const { return server_.assets_; }
  View& view() const { return server_.view_; }
  /// Counts this client as a viewer.
  void CountViewer() const { ++server_.counts_.viewers; }
  void CountCutOff(const std::string& why) const { server_.CountCutOff(address(), why); }
  void CountRefused(std::string_view why) const { server_.CountRefused(address(), why); }
  /// The server forgets this connection. @param opened whether it was a viewer
  void LeaveServer(bool opened) {
    if (opened) {
      --server_.counts_.viewers;
      server_.view_.Closed(*this);
    }
    server_.Leave(id_);
  }

 private:
  Server& server_;
  const std::uint64_t id_;
};

}  // namespace fogline::web
