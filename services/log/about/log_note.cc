#include "services/log/about/log_note.h"

#include <algorithm>

#include <fmt/core.h>

namespace fogline::log {
namespace {

/// " of 500": the number of steps of the scenario; "" if it is not known.
std::string OfSteps(const RunLog& run) {
  return run.has_scenario ? fmt::format(" of {}", run.scenario.steps) : "";
}

/// Which steps of the log were read.
std::string Shortage(const RunLog& run, const LogRemarks& remarks) {
  if (remarks.unread && !remarks.unread->are_end) {
    if (run.steps == 0) return "no step is read";
    return fmt::format("complete up to step {}{}", remarks.next - 1, OfSteps(run));
  }
  if (run.steps == 0 && !run.gaps.Any()) return fmt::format("no step{} is complete", OfSteps(run));
  return fmt::format("ends after step {}{}", remarks.next - 1, OfSteps(run));
}

std::string StepLacks(std::int64_t step, const std::string& what) {
  return fmt::format("step {} lacks {}", step, what);
}

/// Text about the messages that the first unread step lacks.
std::string Lacks(const UnreadSteps& unread, std::int64_t step) {
  if (unread.first == step) return StepLacks(step, NamesOfChannels(unread.lacks));
  return StepLacks(step,
                   fmt::format("every message; the next step in the log is {}", unread.first));
}

}  // namespace

std::string NoteOf(const RunLog& run, const LogRemarks& remarks) {
  std::string all = remarks.torn;
  const auto note = [&all](const std::string& text) {
    all += all.empty() || text.empty() ? text : "; " + text;
  };
  if (!run.has_scenario) note("the log has no scenario");
  if (remarks.unchecked) note("--scenario is not checked, because the log has no hash");
  if (!remarks.alteration.empty()) note("altered: " + remarks.alteration);
  std::int64_t first = remarks.unread && run.steps == 0 ? remarks.unread->first : remarks.first;
  if (remarks.before_run) first = std::min(first, *remarks.before_run);
  if (first > 0) note(fmt::format("begins at step {}{}", first, OfSteps(run)));
  if (remarks.before_run) note("the messages before RUN are not read");
  if (!remarks.has_last) note(Shortage(run, remarks));
  note(run.gaps.Text());
  if (run.realtime && !run.realtime->has_status) note("real time, without STATUS of the world");
  if (run.realtime && run.realtime->missed_messages > 0) {
    note(fmt::format("real time, {} messages missing", run.realtime->missed_messages));
    const std::int64_t unlogged = run.realtime->unlogged_messages;
    const std::string names = NamesOfChannels(run.realtime->unlogged_channels);
    if (unlogged > 0) {
      note(fmt::format("published, but not in the log: at least {}{}", unlogged,
                       names.empty() ? "" : fmt::format(" ({})", names)));
    } else if (!names.empty()) {
      note(fmt::format("perhaps published, but not in the log: {}", names));
    }
  }
  if (remarks.tail) note(StepLacks(*remarks.tail, NamesOfChannels(remarks.tail_lacks)));
  if (remarks.unread && first == 0 && !remarks.before_run) note(Lacks(*remarks.unread, run.steps));
  if (remarks.astray > 0) note(fmt::format("{} impossible steps ignored", remarks.astray));
  note(remarks.conflict);
  if (remarks.foreign > 0) note(fmt::format("{} messages of other runs ignored", remarks.foreign));
  return all;
}

}  // namespace fogline::log
