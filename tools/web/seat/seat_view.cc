#include "tools/web/seat/seat_view.h"

#include <utility>
#include <variant>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "fogline/arbitration_t.hpp"
#include "fogline/run_t.hpp"
#include "fogline/truth_t.hpp"
#include "services/graph.h"
#include "services/runtime/seat/seat_instance.h"
#include "services/runtime/wire/wire.h"
#include "tools/web/seat/seat_told.h"

namespace fogline::web {
namespace {

// Delay between two attempts to open a network that cannot be reached.
constexpr Duration kOpenAgain = milliseconds(1000);

}  // namespace

SeatView::SeatView(boost::asio::io_context& context, LiveView& live,
                   std::optional<runtime::SigningKey> key)
    : live_(live), key_(std::move(key)), seat_(runtime::DrawSeatInstance()), look_(context) {
  live_.TellMessages([this](const RingMessage& message) { Hear(message); });
  if (const auto run = live_.tracker().followed()) {
    seat_.Hear({.run_id = *run, .step = -1, .utime = 0});
  }
  Open();
  WaitToLook();
}

void SeatView::Stop() {
  stopped_ = true;
  look_.cancel();
  live_.TellMessages({});
  if (!seat_.client()) return;
  if (const auto message = seat_.Leave(*seat_.client(), Clock::now())) Publish(*message);
}

// ---- the network -------------------------------------------------------------------------------

void SeatView::Open() {
  url_ = live_.url();
  bus_.emplace(url_);
  if (key_) bus_->Secure(runtime::MessageSigner(*key_, ChannelOf<driver_input_t>().from));
}

void SeatView::Publish(const driver_input_t& message) {
  const TimePoint now = Clock::now();
  if (url_ != live_.url() || (!bus_ && now >= open_at_)) {
    open_at_ = now + kOpenAgain;
    bus_.reset();
    try {
      Open();
    } catch (const std::exception& error) {  // the new network cannot be opened
      lines_.Print(fmt::format("DRIVER_INPUT cannot be sent: {}", error.what()));
    }
  }
  if (!bus_) return;
  runtime::Encode(message, bytes_);
  bus_->Publish(ChannelOf<driver_input_t>().name, bytes_);
  const runtime::Bus::FailedSends& failed = bus_->failed_sends();
  if (failed.since) lines_.Print(fmt::format("DRIVER_INPUT cannot be sent: {}", failed.error));
}

void SeatView::Hear(const RingMessage& message) {
  if (message.bytes.size() < runtime::kHeaderEnd) return;
  // Ignores messages of other runs on this network.
  const auto followed = live_.tracker().followed();
  if (followed && runtime::ReadInt64(message.bytes, runtime::kRunIdOffset) != *followed) return;
  TellRun();
  TellRequest(message);
  TellMessage(message);
  if (message.channel == IndexOf<truth_t>()) {
    if (truth_t truth; runtime::Decode(message.bytes, truth)) seat_.Hear(truth.header);
  } else if (message.channel == IndexOf<run_t>()) {
    run_t run;
    if (!runtime::Decode(message.bytes, run) || run.header.run_id == seat_.header().run_id) return;
    seat_.Hear({.run_id = run.header.run_id, .step = -1, .utime = 0});
  }
}

void SeatView::WaitToLook() {
  look_.expires_at(seat_.next_look());
  look_.async_wait([this](boost::system::error_code stopped) {
    if (stopped || stopped_) return;
    Look();
    WaitToLook();
  });
}

void SeatView::Look() {
  if (bus_) bus_->Drain();  // keeps the connection to a relay alive
  if (const auto message = seat_.Look(Clock::now())) Publish(*message);
  if (!seat_.lost() || std::exchange(told_lost_, true)) return;
  Client& client = *drivers_.at(*seat_.client()).client;
  lines_.Print(
      fmt::format("{}: its page is silent, so no person is ready at the seat", client.address()));
  Say(client, "lost");
}

// ---- clients -----------------------------------------------------------------------------------

void SeatView::Say(Client& client, std::string_view state) {
  client.Send(TextFrame(nlohmann::json{{"op", "seat"}, {"state", state}}.dump()));
}

void SeatView::TellRun() {
  if (told_run_ == live_.tracker().runs()) return;
  told_run_ = live_.tracker().runs();
  const OutgoingFrame frame = TextFrame(SeatRunText(*live_.tracker().run()));
  for (const auto& [id, driver] : drivers_) driver.client->Send(frame);
}

// Tells each page /drive that a request to take over begins. A page gets this text before it gets
// the HOST_COMMAND with the request.
void SeatView::TellRequest(const RingMessage& message) {
  if (message.channel != IndexOf<arbitration_t>()) return;
  arbitration_t command;
  if (!runtime::Decode(message.bytes, command) || !request_.Hear(command)) return;
  const OutgoingFrame frame = TextFrame(SeatRequestText(*request_.request()));
  for (const auto& [id, driver] : drivers_) driver.client->Send(frame);
}

void SeatView::TellMessage(const RingMessage& message) {
  if (drivers_.empty()) return;
  const auto bytes = ForSeat(message.channel, message.bytes);
  if (!bytes) return;
  std::string told;
  AddRingMessage({.channel = message.channel, .wall_ms = message.wall_ms, .bytes = *bytes}, told);
  for (auto& [id, driver] : drivers_) {
    driver.newest[message.channel] = told;
    Pump(driver);
  }
}

void SeatView::Pump(Driver& driver) {
  if (driver.newest.empty() || driver.client->waiting() > 0) return;
  std::string messages;
  for (const auto& [channel, message] : driver.newest) messages += message;
  driver.newest.clear();
  driver.client->Send(BinaryFrame(MessagesFrame(messages)));
}

void SeatView::Idle(Client& client) {
  const auto driver = drivers_.find(client.id());
  if (driver == drivers_.end()) return live_.Idle(client);
  Pump(driver->second);
}

void SeatView::Opened(Client& client) {
  if (client.protocol() != kDriveProtocol) return live_.Opened(client);
  drivers_[client.id()].client = &client;
  client.Send(TextFrame(SeatHelloText()));
  if (const auto& run = live_.tracker().run()) client.Send(TextFrame(SeatRunText(*run)));
  if (const auto& request = request_.request()) client.Send(TextFrame(SeatRequestText(*request)));
  const bool sits = seat_.Sit(client.id(), Clock::now());
  told_lost_ = told_lost_ && !sits;
  if (!sits) {
    lines_.Print(fmt::format("{} may not drive: another page has the seat", client.address()));
  }
  Say(client, sits ? "yours" : "taken");
}

void SeatView::Closed(Client& client) {
  if (drivers_.erase(client.id()) == 0) return live_.Closed(client);
  if (const auto message = seat_.Leave(client.id(), Clock::now())) Publish(*message);
}

void SeatView::Received(Client& client, std::string_view bytes, bool binary) {
  if (client.protocol() != kDriveProtocol) return live_.Received(client, bytes, binary);
  if (binary) return Refuse(client, "inputs are text frames");
  const SeatFrame frame = ParseSeatFrame(bytes);
  if (const auto* bad = std::get_if<BadSeatFrame>(&frame)) return Refuse(client, bad->why);
  Take(client, std::get<SeatInput>(frame));
}

void SeatView::Take(Client& client, const SeatInput& input) {
  const Seat::Taken taken = seat_.Take(client.id(), input, Clock::now());
  if (taken.before) Say(*drivers_.at(*taken.before).client, "taken");
  if (taken.too_many) Refuse(client, taken.why);
  if (!taken.why.empty() && !taken.too_many) {
    client.Send(TextFrame(ErrorText(std::nullopt, taken.why)));
  }
  if (!taken.why.empty() && !seat_.Has(client.id())) Say(client, "taken");
  if (!taken.message) return;
  Publish(*taken.message);
  const bool was_lost = std::exchange(told_lost_, false);
  if (was_lost || taken.sits) Say(client, "yours");
  client.Send(TextFrame(nlohmann::json{{"op", "published"},
                                       {"sequence", input.sequence},
                                       {"instance", std::to_string(taken.message->instance)},
                                       {"input", taken.message->sequence}}
                            .dump()));
}

void SeatView::Refuse(Client& client, const std::string& why) {
  client.CountWrongFrame(why);
  client.Send(TextFrame(ErrorText(std::nullopt, why)));
}

}  // namespace fogline::web
