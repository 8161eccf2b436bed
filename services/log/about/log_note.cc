#include "services/log/about/log_note.h"

#include <fmt/core.h>

namespace fogline::log {
namespace {

/// " of 500": the number of steps of the scenario; "" if it is not known.
std::string OfSteps(const RunLog& run) {
  return run.has_scenario ? fmt::format(" of {}", run.scenario.steps) : "";
}

std::string Shortage(const RunLog& run, const LogRemarks& remarks) {
  if (run.steps == 0 && !run.gaps.Any()) return fmt::format("no step{} is complete", OfSteps(run));
  return fmt::format("ends after step {}{}", remarks.next - 1, OfSteps(run));
}

}  // namespace

std::string NoteOf(const RunLog& run, const LogRemarks& remarks) {
  std::string all = remarks.torn;
  const auto note = [&all](const std::string& text) {
    all += all.empty() || text.empty() ? text : "; " + text;
  };
  if (!run.has_scenario) note("the log has no scenario");
  if (!remarks.alteration.empty()) note("altered: " + remarks.alteration);
  if (run.gaps.first > 0) note(fmt::format("begins at step {}{}", run.gaps.first, OfSteps(run)));
  if (!remarks.has_last) note(Shortage(run, remarks));
  note(run.gaps.Text());
  if (run.realtime && run.realtime->missed_messages > 0) {
    note(fmt::format("real time, {} messages missing", run.realtime->missed_messages));
    const std::int64_t unlogged = run.realtime->unlogged_messages;
    if (unlogged > 0) note(fmt::format("published, but not in the log: {}", unlogged));
  }
  if (remarks.incomplete) note(fmt::format("step {} lacks {}", *remarks.incomplete, remarks.lacks));
  if (remarks.astray > 0) note(fmt::format("{} impossible steps ignored", remarks.astray));
  note(remarks.conflict);
  if (remarks.foreign > 0) note(fmt::format("{} messages of other runs ignored", remarks.foreign));
  return all;
}

}  // namespace fogline::log
