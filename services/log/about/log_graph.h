// The graph of a log: the channels whose messages make its steps (lcmtypes/log_graph_t.lcm). A log
// names its own graph, so a program with more channels still knows when a step of this log is
// complete. The graph is not part of the digest.
#pragma once

#include <cstdint>
#include <string_view>

#include "services/log/event_log.h"
#include "services/runtime/realtime/culprit.h"

namespace fogline::log {

/// The channel of log_graph_t. The channel is not part of kGraph, because no process publishes it.
inline constexpr std::string_view kLogGraphChannel = "FOGLINE_GRAPH";

/// The channels of this program that have a message in each step (Pace::kStep).
runtime::ChannelSet OwnStepChannels();

/// Writes the graph of a run, after the scenario of the run.
/// @param channels kStep channels
/// @throws std::runtime_error of EventLogWriter::Write()
void WriteLogGraph(EventLogWriter& log, std::int64_t run_id,
                   const runtime::ChannelSet& channels = OwnStepChannels());

/// The channels that an event on kLogGraphChannel names.
/// @return these channels; an empty set if the event is not a graph of this run, or if the graph
///     lacks TRUTH (only TRUTH shows which step is the last)
/// @throws InputError for a channel that this program does not know; the error text does not
///     contain the log's name
runtime::ChannelSet ReadLogGraph(const Event& event, std::int64_t run_id);

/// The channels of a log that does not name its graph, such as a log of lcm-logger. If the log has
/// the message types of this program, the result is the graph of this program. Otherwise an older
/// program wrote the log, and the result is the graph of all older programs: the nine channels from
/// TRUTH to FOLLOWER_COMMAND.
/// @param type_fingerprint of the log's RUN messages
runtime::ChannelSet StepChannelsOf(std::int64_t type_fingerprint);

}  // namespace fogline::log
