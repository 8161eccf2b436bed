// Shows the run on the network to the clients of a server. The view subscribes to all channels, and
// publishes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/process/line_budget.h"
#include "services/runtime/wire/message_signer.h"
#include "tools/watch/followed_network.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/web/channel_table.h"
#include "tools/web/foxglove/session.h"
#include "tools/web/message_ring.h"
#include "tools/web/run_tracker.h"
#include "tools/web/server/server.h"
#include "tools/web/view_request.h"

namespace fogline::web {

struct LiveOptions {
  std::string url;
  bool follows = false;                    // whether to follow announced runs
  std::optional<std::int64_t> run;         // if set, only this run is shown
  std::optional<runtime::SigningKey> key;  // if set, only messages signed with it are shown
  bool waits_for_person = false;           // whether the run begins when a person is in the seat
};

class LiveView final : public View {
 public:
  /// Number of bytes of unsent messages above which a client is cut off.
  static constexpr std::uint64_t kMostBehind = SendQueue::kMostBytes;
  static constexpr Duration kHealthEvery = milliseconds(250);

  /// Listens to the network while `context` runs.
  /// @throws InputError, std::runtime_error like runtime::Bus()
  LiveView(boost::asio::io_context& context, LiveOptions options);

  /// Sets the server whose counts (viewers, cut off, refused) the clients get in `health`. The
  /// server must exist until Stop().
  void Show(const Server& server) { server_ = &server; }
  /// From now on, `teller` also gets each message on a channel of the graph. tracker() handles the
  /// message first. An empty `teller` stops this.
  using Teller = std::function<void(const RingMessage& message)>;
  void TellMessages(Teller teller) { teller_ = std::move(teller); }
  /// Stops the timers of this view, and stops listening to the network.
  void Stop();

  void Opened(Client& client) override;
  void Received(Client& client, std::string_view bytes, bool binary) override;
  void Idle(Client& client) override { Pump(client.id()); }
  void Closed(Client& client) override { viewers_.erase(client.id()); }

  const std::string& url() const { return network_.url(); }
  const RunTracker& tracker() const { return tracker_; }

 private:
  /// A client, and its place in ring_: the position after the last message that was sent to it.
  struct Viewer {
    Client* client = nullptr;
    std::uint64_t place = 0;
    std::optional<RequestId> history;           // set while the client gets earlier messages
    std::int64_t sent = 0;                      // number of history messages sent so far
    std::optional<foxglove::Session> foxglove;  // set if the client speaks Foxglove's protocol
  };
  /// Number of statistics. Each of them covers one second. Every 250 ms one of them ends and begins
  /// again. So every health message has the numbers of a whole second.
  static constexpr std::size_t kTurns = 4;

  void Hear(std::string_view channel, runtime::Bytes bytes);
  void Handle();
  void Wait();
  void WaitFor(std::size_t network);
  void WaitForHealth();
  void Pump(std::uint64_t id);
  void PumpAll();
  void BeginHistory(Viewer& viewer, RequestId id);
  void SendMessages(Viewer& viewer, std::string_view messages);
  void Translate(Viewer& viewer, std::string_view messages);
  void TellNews();
  void TellChannel(const KnownChannel& channel);
  /// Prints on stderr which runs and messages cannot be shown.
  void NameTrouble(const watch::SendersView& senders);
  /// Sends a text to the clients that speak our own protocol.
  void SendToAll(std::string text);
  std::string Health();

  boost::asio::io_context& context_;
  std::optional<runtime::MessageSigner> signer_;
  std::array<watch::TrafficStatistics, kTurns> statistics_;
  std::size_t turn_ = 0;
  ChannelTable channels_;
  foxglove::Channels foxglove_channels_;
  std::size_t told_channels_ = 0;  // number of channels_.others() that the clients know
  MessageRing ring_;
  RunTracker tracker_;
  const bool waits_for_person_;
  Teller teller_;
  std::int64_t told_run_ = 0;
  std::int64_t named_scenarios_ = 0;  // number of refused scenarios reported on stderr
  std::size_t named_fragmented_ = 0;  // number of channels with too large messages named on stderr
  LineBudget lines_{"fogline-web"};
  std::int64_t unverified_ = 0;
  watch::FollowedNetwork network_;
  std::int64_t generation_ = -1;  // network_.generation() when descriptors_ were made
  std::array<std::optional<boost::asio::posix::stream_descriptor>, 2> descriptors_;
  boost::asio::steady_timer look_;
  boost::asio::steady_timer health_;
  std::map<std::uint64_t, Viewer> viewers_;
  const Server* server_ = nullptr;
  bool stopped_ = false;
};

}  // namespace fogline::web
