#include "tools/record/recording.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/interrupt.h"
#include "common/text.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/watch/senders/senders_report.h"
#include "tools/watch/traffic_statistics.h"

namespace fogline::record {
namespace {

// Interval at which the recording looks for an announced run, and checks whether it must end.
constexpr Duration kLookEvery = milliseconds(100);
// Number of channel names for which the result of the matching with RecordingOptions::channels is
// stored. If there are more names, all stored results are deleted.
constexpr std::size_t kMostNames = 10'000;
constexpr std::string_view kOtherChannels = "(other channels)";
// If no message waits to be flushed, the writing thread waits at most this time for a message.
constexpr Duration kIdle = milliseconds(1000);

std::vector<std::unique_ptr<TrafficSource>> Only(std::unique_ptr<TrafficSource> source) {
  std::vector<std::unique_ptr<TrafficSource>> sources;
  sources.push_back(std::move(source));
  return sources;
}

}  // namespace

Recording::Recording(RecordingOptions options)
    : options_(std::move(options)),
      sources_(Only(TrafficSource::Open(options_.url, options_.buffer_bytes, senders_))),
      began_(Clock::now()),
      ended_(began_),
      files_(options_.file, options_.rotation, began_) {
  if (options_.follows) listener_.emplace(options_.url);
  const int granted = sources_.front()->buffer_bytes();
  if (granted > 0 && granted < options_.buffer_bytes) {
    options_.say(fmt::format(
        "warning: the kernel grants a receive buffer of {} bytes instead of {} (sysctl "
        "net.core.rmem_max): a burst may lose messages while this program gets no processor time",
        granted, options_.buffer_bytes));
  }
  if (files_.removed() > 0) {
    options_.say(fmt::format("removed {} file{} of an earlier recording", files_.removed(),
                             files_.removed() == 1 ? "" : "s"));
  }
  options_.say(fmt::format("records {} in {}", options_.url, PathText(files_.files().front())));
  writer_ = std::thread([this] { WriteAll(); });
}

Recording::~Recording() {
  queue_.Close();
  if (writer_.joinable()) writer_.join();
}

void Recording::Run() {
  const TimePoint end =
      options_.limit > Duration::zero() ? began_ + options_.limit : TimePoint::max();
  for (TimePoint now = Clock::now(); now < end && !WasInterrupted() && !failed_;
       now = Clock::now()) {
    Listen(now, std::min(kLookEvery, end - now));
    Follow(Clock::now());
  }
  if (!failed_) Listen(Clock::now(), Duration::zero());  // messages that came before the end
  ended_ = Clock::now();
  for (const auto& source : sources_) given_up_ += source->given_up();
  queue_.Close();
  writer_.join();
}

void Recording::Listen(TimePoint now, Duration longest) {
  std::array<pollfd, 2> waited{};
  for (std::size_t i = 0; i < waited.size(); ++i) {
    waited[i] = {
        .fd = i < sources_.size() ? sources_[i]->fd() : -1, .events = POLLIN, .revents = 0};
  }
  poll(waited.data(), waited.size(), static_cast<int>(Milliseconds(longest)));
  Drain(*sources_.front(), now);
  if (sources_.size() < 2) return;
  try {
    Drain(*sources_.back(), now);
  } catch (const std::runtime_error& error) {  // the network's relay has ended
    options_.say(fmt::format("leaves {}: {}", followed_url_, error.what()));
    LeaveFollowed();
  }
}

void Recording::Drain(TrafficSource& source, TimePoint now) {
  source.Drain(now, [this](const Message& message) { Take(message); });
  if (const std::string news = source.TakeNews(); !news.empty()) options_.say(news);
}

void Recording::Take(const Message& message) {
  if (message.channel.empty() || watch::IsHousekeeping(message.channel)) return;
  if (!Wanted(message.channel)) return;
  auto counts = channels_.find(message.channel);
  if (counts == channels_.end()) {
    const bool has_room = channels_.size() < kMostChannels;
    counts = channels_.try_emplace(std::string(has_room ? message.channel : kOtherChannels)).first;
  }
  for (Counts* of : {&counts->second, &all_}) {
    ++of->messages;
    of->bytes += std::ssize(message.data);
  }
  queue_.Put(message);
}

bool Recording::Wanted(std::string_view channel) {
  if (!options_.channels) return true;
  const std::string name(channel);
  const auto known = wanted_.find(name);
  if (known != wanted_.end()) return known->second;
  if (wanted_.size() >= kMostNames) wanted_.clear();
  return wanted_[name] = std::regex_match(name, *options_.channels);
}

void Recording::Follow(TimePoint now) {
  if (!listener_ || now < follow_at_) return;
  follow_at_ = now + kLookEvery;
  listener_->Look();
  const std::vector<runtime::Announcement> runs = listener_->Runs();
  if (runs.empty() || runs.front().url == followed_url_) return;
  followed_url_ = runs.front().url;
  LeaveFollowed();
  if (runtime::SameNetwork(followed_url_, options_.url)) return;
  try {
    sources_.push_back(TrafficSource::Open(followed_url_, options_.buffer_bytes, senders_));
    options_.say("follows " + runs.front().Text());
  } catch (const std::exception& error) {  // the address came from the network and may be invalid
    options_.say(fmt::format("warning: {}", error.what()));
  }
}

void Recording::LeaveFollowed() {
  if (sources_.size() < 2) return;
  given_up_ += sources_.back()->given_up();
  sources_.pop_back();
}

void Recording::WriteAll() {
  try {
    WriteMessages();
  } catch (const std::exception& error) {
    error_ = error.what();
    failed_ = true;
  }
}

void Recording::WriteMessages() {
  constexpr TimePoint kNever = TimePoint::max();
  TimePoint flush_at = kNever;  // kNever if no message waits to be flushed
  while (!queue_.Over()) {
    const std::vector<MessageQueue::Chunk> chunks =
        queue_.Take(flush_at == kNever ? Clock::now() + kIdle : flush_at);
    const TimePoint now = Clock::now();
    if (!chunks.empty() && flush_at == kNever) flush_at = now + options_.flush_every;
    for (const MessageQueue::Chunk& chunk : chunks) {
      runtime::Bytes rest = chunk;
      std::string_view why;
      while (const auto event = log::ParseEvent(rest, why)) {
        files_.Write(*event, now);
        rest = rest.subspan(log::SizeInFile(*event));
      }
    }
    if (now < flush_at) continue;
    files_.Flush();
    flush_at = kNever;
  }
  files_.Flush();
}

nlohmann::ordered_json Recording::Json() {
  nlohmann::ordered_json json{{"lcm_url", options_.url},
                              {"files", nlohmann::ordered_json::array()},
                              {"duration_s", Seconds(ended_ - began_)},
                              {"messages", all_.messages},
                              {"bytes", files_.bytes()},
                              {"channels", nlohmann::ordered_json::array()}};
  for (const std::filesystem::path& file : files_.files()) json["files"].push_back(file.string());
  for (const auto& [channel, counts] : channels_) {
    json["channels"].push_back(
        {{"channel", channel}, {"messages", counts.messages}, {"bytes", counts.bytes}});
  }
  const watch::SendersView view = senders_.View(Clock::now());
  json["senders"] =
      sources_.front()->is_numbered() ? watch::SendersJson(view) : nlohmann::ordered_json(nullptr);
  json["own_overflow"] = view.own_overflow;
  json["incomplete_messages"] = given_up_;
  json["recv_buffer_bytes"] = sources_.front()->buffer_bytes();
  json["most_bytes_waiting"] = queue_.most_waiting();
  json["error"] = nullptr;
  if (!error_.empty()) json["error"] = error_;
  return json;
}

std::string Recording::Text() {
  const watch::SendersView view = senders_.View(Clock::now());
  std::int64_t lost = 0;
  std::int64_t missed = 0;
  for (const watch::SenderView& sender : view.senders) {
    lost += sender.counts.lost;
    missed += sender.counts.missed_here;
  }
  std::string text = fmt::format("{} messages on {} channels in {:.1f} s, {} bytes", all_.messages,
                                 channels_.size(), Seconds(ended_ - began_), files_.bytes());
  if (sources_.front()->is_numbered()) {
    text += fmt::format("; lost on the way: {}, lost here: {}", lost, missed);
  }
  text += '\n';
  for (const std::filesystem::path& file : files_.files()) text += PathText(file) + "\n";
  if (lost == 0 && missed == 0) return text;
  for (const watch::Line& line : watch::SenderLines(view)) text += line.text + "\n";
  return text;
}

}  // namespace fogline::record
