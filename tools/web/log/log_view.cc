#include "tools/web/log/log_view.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/graph.h"
#include "tools/web/types/field_reader.h"
#include "tools/web/view_messages.h"

namespace fogline::web {
namespace {

// Offset of utime in a message, in bytes. The fingerprint, run_id and step come before it, and take
// 8 bytes each.
constexpr std::size_t kUtimeOffset = 24;

/// Identifies the messages of a series: their channel and, for STATUS, the role that has sent them.
struct Source {
  std::size_t channel = 0;
  std::string role;  // "": any

  /// @param name "CHANNEL" or "STATUS/ROLE"
  /// @throws InputError if there is no such channel
  explicit Source(const std::string& name) {
    const std::size_t slash = name.find('/');
    channel = ChannelNamed(name.substr(0, slash));
    if (slash != std::string::npos) role = name.substr(slash + 1);
    if (channel < kNumChannels && (role.empty() || channel == IndexOf<status_t>())) return;
    throw InputError(fmt::format("there is no channel {}", QuoteShort(name)));
  }
};

/// A field of the messages of one channel.
class LoggedField {
 public:
  /// @throws InputError if there is no such channel or field
  LoggedField(const LogIndex& index, const SeriesRequest& request)
      : index_(index),
        request_(request),
        source_(request.channel),
        read_(FoglineTypes(), TypeOf(source_.channel), request.field) {
    const auto& members = TypeOf(source_.channel).members;
    const bool has_valid = std::ranges::find(members, "valid", &LcmMember::name) != members.end();
    const bool is_value = request.field != "valid" && !request.field.starts_with("header.");
    if (has_valid && is_value) valid_.emplace(FoglineTypes(), TypeOf(source_.channel), "valid");
  }

  /// The series that the request asks for.
  Series Values() const {
    if (kChannels[source_.channel].pace == Pace::kStep) {
      return Values(
          std::max(request_.from, index_.first_step()), std::min(request_.to, index_.last_step()),
          [this](std::int64_t step) { return Of(index_.Message(step, source_.channel)); });
    }
    const std::vector<SeriesPoint> points = OfControl();
    return Values(0, std::ssize(points) - 1, [&points](std::int64_t i) {
      return std::optional(points[static_cast<std::size_t>(i)]);
    });
  }

 private:
  template <class At>
  Series Values(std::int64_t from, std::int64_t to, const At& at) const {
    if (request_.changes) {
      if (auto changes = Changes(from, to, 2 * request_.points, at)) return std::move(*changes);
    }
    return Decimate(from, to, request_.points, at);
  }

  /// The points of a channel with Pace::kControl.
  std::vector<SeriesPoint> OfControl() const {
    std::vector<SeriesPoint> points;
    status_t status;
    for (std::int64_t i = 0; i < index_.control_messages(source_.channel); ++i) {
      const runtime::Bytes message = index_.ControlMessage(source_.channel, i);
      const std::int64_t step = runtime::ReadInt64(message, runtime::kStepOffset);
      if (step < request_.from || step > request_.to) continue;
      if (!source_.role.empty() &&
          (!runtime::Decode(message, status) || status.role != source_.role)) {
        continue;
      }
      auto point = Of(message);
      // If a role is started again, the time in its messages goes back. The times of a series must
      // not go back, so this point then gets the time of the point before.
      if (!points.empty()) point->time_s = std::max(point->time_s, points.back().time_s);
      points.push_back(*point);
    }
    return points;
  }

  std::optional<SeriesPoint> Of(runtime::Bytes message) const {
    if (message.empty()) return std::nullopt;
    const auto utime = static_cast<double>(runtime::ReadInt64(message, kUtimeOffset));
    // The fields of a message that is not valid are 0, and this 0 is no value.
    const bool has_value = !valid_ || (*valid_)(message) != 0.0;
    const std::optional<double> value = has_value ? read_(message) : std::nullopt;
    return SeriesPoint{.time_s = utime / kMicrosPerSecond,
                       .value = value.value_or(std::numeric_limits<double>::quiet_NaN())};
  }

  static const LcmStruct& TypeOf(std::size_t channel) {
    return *FoglineTypes().WithFingerprint(runtime::FingerprintOf(channel));
  }

  const LogIndex& index_;
  const SeriesRequest& request_;
  Source source_;
  FieldReader read_;
  std::optional<FieldReader> valid_;  // only for a value of a message that may be not valid
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
  const ViewRequest request = ParseViewFrame(bytes, binary);
  try {
    client.Send(Answer(request));
  } catch (const InputError& error) {
    client.CountWrongFrame(error.what());
    client.Send(TextFrame(ErrorText(IdOf(request), error.what())));
  }
}

/// @throws InputError if the request cannot be fulfilled
OutgoingFrame LogView::Answer(const ViewRequest& request) const {
  if (const auto* steps = std::get_if<StepsRequest>(&request)) {
    return BinaryFrame(StepsFrame(*steps, index_));
  }
  if (const auto* series = std::get_if<SeriesRequest>(&request)) {
    return BinaryFrame(SeriesFrame(series->id, LoggedField(index_, *series).Values()));
  }
  if (const auto* bad = std::get_if<BadRequest>(&request)) throw InputError(bad->why);
  throw InputError("a log is shown; it has no history");
}

}  // namespace fogline::web
