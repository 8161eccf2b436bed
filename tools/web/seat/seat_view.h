// A live view with a seat for one client that drives. It publishes the inputs of this client as
// DRIVER_INPUT on the network of the run, and nothing else. Clients with the page /drive get only
// the data of this page (seat_told.h), and at most one of them has the seat. All other clients are
// viewers of the live view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/process/line_budget.h"
#include "services/runtime/transport/bus.h"
#include "tools/web/live_view.h"
#include "tools/web/seat/open_request.h"
#include "tools/web/seat/seat.h"
#include "tools/web/server/server.h"

namespace fogline::web {

class SeatView final : public View {
 public:
  /// Publishes while the context runs.
  /// @param live must exist as long as this view, and must not handle messages after the end of
  ///     this view
  /// @param key signs the messages, if there is a key
  /// @throws InputError, std::runtime_error like runtime::Bus()
  SeatView(boost::asio::io_context& context, LiveView& live,
           std::optional<runtime::SigningKey> key);

  /// Ends the tasks of this view in the io_context. Tells the run that no person drives.
  void Stop();

  void Opened(Client& client) override;
  void Received(Client& client, std::string_view bytes, bool binary) override;
  void Idle(Client& client) override;
  void Closed(Client& client) override;

 private:
  /// A client of fogline.drive.v1.
  struct Driver {
    Client* client = nullptr;
    std::map<std::size_t, std::string> newest;  // newest unsent message of each channel
  };

  void Hear(const RingMessage& message);
  void TellRun();
  void TellRequest(const RingMessage& message);
  void TellMessage(const RingMessage& message);
  /// Sends the newest messages if no earlier frame waits to be sent to the client.
  static void Pump(Driver& driver);
  void Take(Client& client, const SeatInput& input);
  void Refuse(Client& client, const std::string& why);
  void Say(Client& client, std::string_view state);
  void Look();
  void WaitToLook();
  void Open();
  void Publish(const driver_input_t& message);

  LiveView& live_;
  std::optional<runtime::SigningKey> key_;
  Seat seat_;
  std::map<std::uint64_t, Driver> drivers_;
  OpenRequest request_;
  std::int64_t told_run_ = 0;        // RunTracker::runs() at the last report to the drivers
  bool told_lost_ = false;           // whether the client with the seat knows that the seat is lost
  std::string url_;                  // URL of the bus
  std::optional<runtime::Bus> bus_;  // nullopt: the network cannot be reached
  TimePoint open_at_{};
  std::vector<std::uint8_t> bytes_;
  boost::asio::steady_timer look_;
  LineBudget lines_{"fogline-web"};
  bool stopped_ = false;
};

}  // namespace fogline::web
