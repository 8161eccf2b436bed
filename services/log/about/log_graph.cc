#include "services/log/about/log_graph.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "fogline/fingerprint.hpp"
#include "fogline/log_graph_t.hpp"

namespace fogline::log {
namespace {

// The graph of a log that does not name its graph and was written by an older program.
constexpr auto kFirstGraph =
    std::to_array<std::string_view>({"TRUTH", "HOST_EGO", "RADAR", "LIDAR", "TRACK", "ACC_COMMAND",
                                     "DRIVER_COMMAND", "HOST_COMMAND", "FOLLOWER_COMMAND"});

}  // namespace

runtime::ChannelSet OwnStepChannels() {
  runtime::ChannelSet channels;
  ForEachStepChannel([&channels]<class M>(std::size_t channel) { channels.set(channel); });
  return channels;
}

void WriteLogGraph(EventLogWriter& log, std::int64_t run_id, const runtime::ChannelSet& channels) {
  log_graph_t graph{};
  graph.header = {.run_id = run_id, .step = -1, .utime = 0};
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    if (!channels[channel]) return;
    graph.channel.emplace_back(kChannels[channel].name);
    graph.type.emplace_back(M::getTypeName());
    graph.type_hash.push_back(M::getHash());
    graph.producer.emplace_back(NameOf(kChannels[channel].from));
  });
  graph.num_channels = static_cast<std::int32_t>(graph.channel.size());
  std::vector<std::uint8_t> bytes;
  runtime::Encode(graph, bytes);
  log.Write(kLogGraphChannel, 0, bytes);
}

runtime::ChannelSet ReadLogGraph(const Event& event, std::int64_t run_id) {
  runtime::ChannelSet channels;
  log_graph_t graph{};
  if (!runtime::Decode(event.data, graph) || graph.header.run_id != run_id) return {};
  for (std::size_t i = 0; i < graph.channel.size(); ++i) {
    const std::size_t place = ChannelNamed(graph.channel[i]);
    if (place == kNumChannels || kChannels[place].pace != Pace::kStep) {
      throw InputError(fmt::format(
          "the log has the channel {} ({} from {}), which this program does not have: read the log "
          "with the version of Fogline that wrote it",
          EscapeControls(graph.channel[i]), EscapeControls(graph.type[i]),
          EscapeControls(graph.producer[i])));
    }
    channels.set(place);
  }
  return channels[IndexOf<truth_t>()] ? channels : runtime::ChannelSet();
}

runtime::ChannelSet StepChannelsOf(std::int64_t type_fingerprint) {
  if (type_fingerprint == TypeFingerprint()) return OwnStepChannels();
  runtime::ChannelSet channels;
  for (const std::string_view name : kFirstGraph) {
    const std::size_t place = ChannelNamed(name);
    if (place < kNumChannels) channels.set(place);
  }
  return channels;
}

}  // namespace fogline::log
