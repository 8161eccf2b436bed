// The frames that a server sends to a page (docs/view.md describes them).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/web/channel_table.h"
#include "tools/web/log/log_index.h"
#include "tools/web/log/series.h"
#include "tools/web/run_events.h"
#include "tools/web/view_request.h"

namespace fogline::web {

/// The kinds of binary frames. The first byte of a frame is its kind.
enum class FrameKind : std::uint8_t { kMessages = 1, kSteps = 2, kSeries = 3 };

/// The facts about a run that a page needs.
struct RunFacts {
  std::int64_t run_id = 0;
  std::string scenario_text;  // the effective scenario, JSON
  bool realtime = false;
  double pace = 0;
};

/// The facts about a live view that a page needs.
struct LiveFacts {
  std::string url;                // of the LCM network
  bool follows = false;           // whether the view follows announced runs
  bool waits_for_person = false;  // whether the run begins when a person is in the seat
};

/// @param live nullopt for a log
std::string HelloText(const std::optional<LiveFacts>& live,
                      const std::vector<KnownChannel>& others);
std::string ChannelText(const KnownChannel& channel);
/// @return "" if the scenario is not a JSON object
std::string RunText(const RunFacts& run);
std::string LogText(const std::filesystem::path& file, const LogIndex& index);
std::string EventText(const RunEvent& event);
std::string HistoryText(RequestId id, std::int64_t messages);
std::string ErrorText(std::optional<RequestId> id, std::string_view message);

/// A frame of FrameKind::kMessages. @param messages in the form of MessageRing::From()
std::string MessagesFrame(std::string_view messages);
/// A frame of FrameKind::kSteps with all messages of the requested steps.
std::string StepsFrame(const StepsRequest& request, const LogIndex& index);
/// A frame of FrameKind::kSeries.
std::string SeriesFrame(RequestId id, const Series& series);

}  // namespace fogline::web
