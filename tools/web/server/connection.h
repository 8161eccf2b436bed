// One connection of the server. Only connection.cc includes Beast, because its headers take long to
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

/// A connection: first an HTTP request, then perhaps a WebSocket. The object exists until its last
/// operation has ended. The server removes the connection from its list earlier: as soon as the
/// connection is closed.
class Connection : public Client {
 public:
  /// Serves the client while the server's context runs.
  static std::shared_ptr<Connection> Start(Server& server, std::uint64_t id,
                                           boost::asio::ip::tcp::socket socket);

  /// Closes the connection, because the program ends.
  virtual void GoAway() = 0;
  /// Closes a connection that has opened no WebSocket, because another connection needs its place.
  virtual void GiveWay() = 0;

 protected:
  Connection(Server& server, std::uint64_t id) : server_(server), id_(id) {}

  std::uint64_t id() const final { return id_; }

  boost::asio::io_context& context() const { return server_.context_; }
  const Access& access() const { return server_.access_; }
  std::span<const Asset> assets() const { return server_.assets_; }
  View& view() const { return server_.view_; }
  const ServerLimits& limits() const { return server_.limits_; }
  bool IsFull() const { return server_.IsFull(); }
  bool drives() const { return protocol() == kDriveProtocol; }
  /// Makes this client a viewer or a driver. @return false if there is no free place
  [[nodiscard]] bool TakePlace() { return has_place_ = server_.TakePlace(id_, drives()); }
  void CountWrongFrame(std::string_view why) const final {
    server_.CountWrongFrame(address(), why);
  }
  void CountCutOff(const std::string& why) const { server_.CountCutOff(address(), why); }
  void CountRefused(std::string_view why) const { server_.CountRefused(address(), why); }
  /// Makes the server remove this connection. @param opened whether the view knows the connection
  void LeaveServer(bool opened) {
    if (has_place_) server_.LeavePlace(drives());
    if (opened) server_.view_.Closed(*this);
    server_.Leave(id_);
  }

 private:
  Server& server_;
  const std::uint64_t id_;
  bool has_place_ = false;  // whether this client counts as a viewer
};

}  // namespace fogline::web
