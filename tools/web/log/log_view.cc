#include "tools/web/log/log_view.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/graph.h"
#include "tools/web/types/field_reader.h"
#include "tools/web/view_messages.h"

namespace fogline::web {
namespace {

// Offset of utime in bytes. Before it a message has the fingerprint, run_id and step, of 8 bytes
// each.
constexpr std::size_t kUtimeOffset = 24;

/// The channel of a series.
/// @throws InputError if the name is not that of a channel with a message in every step
std::size_t ChannelOfSeries(const std::string& name) {
  const std::size_t channel = ChannelNamed(name);
  if (channel < kNumChannels && kChannels[channel].pace == Pace::kStep) return channel;
  throw InputError(fmt::format("no channel {} has a message in every step", QuoteShort(name)));
}

/// A field of the messages of one channel.
class LoggedField {
 public:
  /// @throws InputError if there is no such channel or field
  LoggedField(const LogIndex& index, const std::string& channel, const std::string& field)
      : index_(index),
        channel_(ChannelOfSeries(channel)),
        read_(FoglineTypes(), *FoglineTypes().WithFingerprint(runtime::FingerprintOf(channel_)),
              field) {}

  std::optional<SeriesPoint> At(std::int64_t step) const {
    const runtime::Bytes message = index_.Message(step, channel_);
    if (message.empty()) return std::nullopt;
    const auto utime = static_cast<double>(runtime::ReadInt64(message, kUtimeOffset));
    return SeriesPoint{.time_s = utime / kMicrosPerSecond,
                       .value = read_(message).value_or(std::numeric_limits<double>::quiet_NaN())};
  }

 private:
  const LogIndex& index_;
  std::size_t channel_;
  FieldReader read_;
};

/// A warning for a client of Foxglove's protocol, as a status of level 1.
std::string NoLogForFoxglove() {
  return R"({"op":"status","level":1,"message":"a log is shown; Foxglove gets live runs only"})";
}

}  // namespace

void LogView::Opened(Client& client) {
  if (client.protocol() != kViewProtocol) return client.Send(TextFrame(NoLogForFoxglove()));
  client.Send(TextFrame(HelloText(std::nullopt, {})));
  const log::RunLog& run = index_.run();
  client.Send(TextFrame(RunText({.run_id = run.run_id,
                                 .scenario_text = run.scenario_text,
                                 .realtime = run.realtime.has_value(),
                                 .pace = run.realtime ? run.realtime->speed : 0})));
  client.Send(TextFrame(LogText(file_, index_)));
}

void LogView::Received(Client& client, std::string_view bytes, bool binary) {
  if (client.protocol() != kViewProtocol) return;
  if (binary) return client.Send(TextFrame(ErrorText(std::nullopt, "requests are text frames")));
  client.Send(Answer(ParseViewRequest(bytes)));
}

OutgoingFrame LogView::Answer(const ViewRequest& request) const {
  if (const auto* steps = std::get_if<StepsRequest>(&request)) {
    return BinaryFrame(StepsFrame(*steps, index_));
  }
  if (const auto* series = std::get_if<SeriesRequest>(&request)) return AnswerSeries(*series);
  if (const auto* history = std::get_if<HistoryRequest>(&request)) {
    return TextFrame(ErrorText(history->id, "a log is shown; it has no history"));
  }
  const auto& bad = std::get<BadRequest>(request);
  return TextFrame(ErrorText(bad.id, bad.why));
}

OutgoingFrame LogView::AnswerSeries(const SeriesRequest& request) const {
  try {
    const LoggedField field(index_, request.channel, request.field);
    const std::int64_t from = std::max(request.from, index_.first_step());
    const std::int64_t to = std::min(request.to, index_.last_step());
    return BinaryFrame(
        SeriesFrame(request.id, Decimate(from, to, request.points,
                                         [&field](std::int64_t step) { return field.At(step); })));
  } catch (const InputError& error) {
    return TextFrame(ErrorText(request.id, error.what()));
  }
}

}  // namespace fogline::web
