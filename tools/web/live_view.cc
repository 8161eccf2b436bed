#include "tools/web/live_view.h"

#include <fcntl.h>

#include <array>
#include <chrono>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/runtime/transport/lcm_url.h"
#include "tools/watch/announced.h"
#include "tools/watch/senders/senders_report.h"
#include "tools/watch/traffic_text.h"
#include "tools/web/types/lcm_types.h"
#include "tools/web/view_messages.h"

namespace fogline::web {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

double WallClock_ms() {
  using Milli = std::chrono::duration<double, std::milli>;
  return Milli(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::array<watch::TrafficStatistics, 4> FourStatistics() {
  const TimePoint now = Clock::now();
  using watch::TrafficStatistics;
  return {TrafficStatistics(now), TrafficStatistics(now), TrafficStatistics(now),
          TrafficStatistics(now)};
}

OutgoingFrame ToOutgoing(foxglove::Frame frame) {
  return frame.binary ? BinaryFrame(std::move(frame.bytes)) : TextFrame(std::move(frame.bytes));
}

void SendFrames(Client& client, std::vector<foxglove::Frame> frames) {
  for (foxglove::Frame& frame : frames) client.Send(ToOutgoing(std::move(frame)));
}

}  // namespace

LiveView::LiveView(asio::io_context& context, LiveOptions options)
    : context_(context),
      statistics_(FourStatistics()),
      foxglove_channels_(FoglineTypes()),
      tracker_(options.run),
      waits_for_person_(options.waits_for_person),
      network_(std::move(options.url),
               options.follows ? watch::Following::kNewestRun : watch::Following::kNothing,
               [this](std::string_view channel, runtime::Bytes bytes) { Hear(channel, bytes); }),
      look_(context),
      health_(context) {
  static_assert(kTurns == 4);
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    foxglove_channels_.Add({.id = static_cast<std::uint32_t>(i),
                            .topic = std::string(kChannels[i].name),
                            .type = FoglineTypes().WithFingerprint(runtime::FingerprintOf(i))});
  }
  if (options.key) signer_.emplace(*options.key, std::nullopt);
  Wait();
  WaitForHealth();
  if (!network_.tap_trouble().empty()) lines_.Print(network_.tap_trouble());
}

void LiveView::Stop() {
  stopped_ = true;
  look_.cancel();
  health_.cancel();
  for (auto& descriptor : descriptors_) descriptor.reset();
}

// ---- the network -------------------------------------------------------------------------------

void LiveView::Hear(std::string_view channel, runtime::Bytes bytes) {
  if (signer_) {
    const runtime::MessageSigner::Opened opened = signer_->Open(channel, bytes);
    if (opened.verdict != runtime::MessageSigner::Verdict::kGood) {
      ++unverified_;
      return;
    }
    bytes = opened.payload;
  }
  const TimePoint now = Clock::now();
  for (watch::TrafficStatistics& statistics : statistics_) statistics.Add(channel, bytes, now);
  if (!signer_ && runtime::LooksSigned(bytes)) bytes = runtime::WithoutSignature(bytes);
  const auto id = channels_.IdOf(channel, bytes);
  if (!id) return;
  const RingMessage message{.channel = *id, .wall_ms = WallClock_ms(), .bytes = bytes};
  ring_.Add(message);
  tracker_.Hear(*id, bytes, now);
  if (teller_ && *id < kNumChannels) teller_(message);
}

void LiveView::Handle() {
  const bool followed = network_.followed();
  const std::string heard = network_.url();
  network_.Handle(Clock::now());
  if (followed && !runtime::SameNetwork(heard, network_.url())) tracker_.LeaveNetwork();
  network_.ForgetNames(statistics_.front().unknown_names());
  TellNews();
  PumpAll();
}

/// Handles messages when a descriptor is readable, and at least every kLookEvery.
void LiveView::Wait() {
  if (stopped_) return;
  if (generation_ != network_.generation()) {
    generation_ = network_.generation();
    for (std::size_t i = 0; i < descriptors_.size(); ++i) {
      descriptors_[i].reset();
      // The descriptor is a duplicate, because the network may close its own descriptor at any
      // time.
      const int fd = fcntl(network_.descriptors()[i], F_DUPFD_CLOEXEC, 0);
      if (fd < 0) continue;
      descriptors_[i].emplace(context_, fd);
      WaitFor(i);
    }
  }
  look_.expires_after(watch::FollowedNetwork::kLookEvery);
  look_.async_wait([this](error_code stopped) {
    if (stopped || stopped_) return;
    Handle();
    Wait();
  });
}

void LiveView::WaitFor(std::size_t network) {
  const std::int64_t generation = generation_;
  descriptors_[network]->async_wait(asio::posix::stream_descriptor::wait_read,
                                    [this, network, generation](error_code error) {
                                      if (error || stopped_ || generation != generation_) return;
                                      Handle();
                                      if (network_.generation() == generation) WaitFor(network);
                                    });
}

// ---- clients -----------------------------------------------------------------------------------

void LiveView::Opened(Client& client) {
  Viewer& viewer = viewers_[client.id()];
  viewer.client = &client;
  viewer.place = ring_.end();
  if (IsFoxglove(client.protocol())) {
    viewer.foxglove.emplace(foxglove_channels_);
    return SendFrames(client, viewer.foxglove->Opened());
  }
  client.Send(TextFrame(HelloText(
      LiveFacts{.url = url(), .follows = network_.follows(), .waits_for_person = waits_for_person_},
      channels_.others())));
  if (!tracker_.run()) return;
  client.Send(TextFrame(tracker_.run_text()));
  for (const RunEvent& event : tracker_.events()) client.Send(TextFrame(EventText(event)));
}

void LiveView::Received(Client& client, std::string_view bytes, bool binary) {
  if (auto& session = viewers_.at(client.id()).foxglove) {
    const foxglove::Session::Answer answer = session->Received(bytes, binary);
    if (!answer.error.empty()) client.CountWrongFrame(answer.error);
    return SendFrames(client, answer.frames);
  }
  const ViewRequest request = ParseViewFrame(bytes, binary);
  std::string why = "this server shows a live network; only a log has steps and series";
  if (const auto* bad = std::get_if<BadRequest>(&request)) why = bad->why;
  if (const auto* history = std::get_if<HistoryRequest>(&request)) {
    Viewer& viewer = viewers_.at(client.id());
    if (!viewer.history) return BeginHistory(viewer, history->id);
    why = "a history is being sent already";
  }
  client.CountWrongFrame(why);
  client.Send(TextFrame(ErrorText(IdOf(request), why)));
}

void LiveView::BeginHistory(Viewer& viewer, RequestId id) {
  viewer.history = id;
  viewer.place = ring_.begin();
  viewer.sent = 0;
  Pump(viewer.client->id());
}

/// Sends the next messages if no earlier frame waits to be sent to the client.
void LiveView::Pump(std::uint64_t id) {
  const auto found = viewers_.find(id);
  if (found == viewers_.end()) return;
  Viewer& viewer = found->second;
  Client& client = *viewer.client;
  const std::uint64_t behind = ring_.end() - viewer.place;
  if (viewer.place < ring_.begin() || (!viewer.history && behind > kMostBehind)) {
    return client.CutOff(CloseCode::kTryAgainLater,
                         fmt::format("does not read; {} bytes wait for it", behind));
  }
  // A client of Foxglove's protocol may have subscribed to none of these messages. Then the queue
  // stays empty, and the loop goes on with the next messages.
  while (client.waiting() == 0 && viewer.place < ring_.end()) {
    const std::string_view messages = ring_.From(viewer.place);
    if (viewer.history) {
      for (std::string_view rest = messages; !rest.empty(); ++viewer.sent) TakeRingMessage(rest);
    }
    viewer.place += messages.size();
    SendMessages(viewer, messages);
  }
  if (!viewer.history || viewer.place < ring_.end()) return;
  client.Send(TextFrame(HistoryText(*viewer.history, viewer.sent)));
  viewer.history.reset();
}

void LiveView::SendMessages(Viewer& viewer, std::string_view messages) {
  if (messages.empty()) return;
  if (viewer.foxglove) return Translate(viewer, messages);
  viewer.client->Send(BinaryFrame(MessagesFrame(messages)));
}

/// Sends messages to a client that speaks Foxglove's protocol.
void LiveView::Translate(Viewer& viewer, std::string_view messages) {
  if (!viewer.foxglove->Subscribed()) return;
  constexpr double kNanosecondsPerMillisecond = 1e6;
  while (!messages.empty()) {
    const RingMessage message = TakeRingMessage(messages);
    const auto time_ns = static_cast<std::uint64_t>(message.wall_ms * kNanosecondsPerMillisecond);
    auto frame = viewer.foxglove->Message(message.channel, time_ns, message.bytes);
    if (frame) viewer.client->Send(ToOutgoing(std::move(*frame)));
  }
}

void LiveView::PumpAll() {
  for (const auto& [id, viewer] : viewers_) Pump(id);
}

void LiveView::SendToAll(std::string text) {
  const OutgoingFrame frame = TextFrame(std::move(text));
  for (const auto& [id, viewer] : viewers_) {
    if (!viewer.foxglove) viewer.client->Send(frame);
  }
}

void LiveView::TellChannel(const KnownChannel& channel) {
  SendToAll(ChannelText(channel));
  const LcmStruct* type = FoglineTypes().Named(channel.type);
  if (type == nullptr) return;  // Foxglove cannot show this channel
  const foxglove::Channel& added =
      foxglove_channels_.Add({.id = channel.id, .topic = channel.name, .type = type});
  for (const auto& [id, viewer] : viewers_) {
    if (viewer.foxglove) viewer.client->Send(ToOutgoing(viewer.foxglove->Advertised(added)));
  }
}

/// Tells the clients about new channels, a new run and new events.
void LiveView::TellNews() {
  for (; told_channels_ < channels_.others().size(); ++told_channels_) {
    TellChannel(channels_.others()[told_channels_]);
  }
  if (told_run_ != tracker_.runs()) {
    told_run_ = tracker_.runs();
    SendToAll(tracker_.run_text());
  }
  for (const RunEvent& event : tracker_.TakeEvents()) SendToAll(EventText(event));
}

// ---- health ------------------------------------------------------------------------------------

void LiveView::WaitForHealth() {
  health_.expires_after(kHealthEvery);
  health_.async_wait([this](error_code stopped) {
    if (stopped || stopped_) return;
    SendToAll(Health());
    WaitForHealth();
  });
}

void LiveView::NameTrouble(const watch::SendersView& senders) {
  if (named_scenarios_ != tracker_.refused_scenarios()) {
    named_scenarios_ = tracker_.refused_scenarios();
    lines_.Print(fmt::format("{} runs are not shown: their scenarios are no JSON objects",
                             named_scenarios_));
  }
  if (named_fragmented_ != senders.channels_in_fragments.size()) {
    named_fragmented_ = senders.channels_in_fragments.size();
    lines_.Print(watch::FragmentsText(senders));
  }
}

std::string LiveView::Health() {
  const watch::TrafficView traffic = statistics_[turn_].Observe(Clock::now());
  turn_ = (turn_ + 1) % kTurns;
  const watch::SendersView senders = network_.ViewSenders(Clock::now());
  const ServerCounts counts = server_ ? server_->counts() : ServerCounts{};
  NameTrouble(senders);
  nlohmann::ordered_json json{{"op", "health"},
                              {"traffic", watch::TrafficJson(traffic, url())},
                              {"senders", nullptr},
                              {"senders_note", network_.tap_trouble()},
                              {"own_overflow", senders.own_overflow},
                              {"too_large", senders.in_fragments},
                              {"too_large_channels", senders.channels_in_fragments},
                              {"refused_scenarios", tracker_.refused_scenarios()},
                              {"unverified", unverified_},
                              {"viewers", counts.viewers - counts.drivers},
                              {"drivers", counts.drivers},
                              {"cut_off", counts.cut_off},
                              {"refused", counts.refused},
                              {"wrong_frames", counts.wrong_frames},
                              {"events_left_out", tracker_.events_left_out()}};
  for (auto& run : json["traffic"]["runs"]) {  // as text: JavaScript rounds numbers beyond 2^53
    run["run_id"] = std::to_string(run["run_id"].get<std::int64_t>());
  }
  if (network_.numbered()) json["senders"] = watch::SendersJson(senders);
  if (network_.follows()) {
    json["traffic"]["announced"] = watch::AnnouncedJson(network_.runs(), network_.followed());
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace fogline::web
