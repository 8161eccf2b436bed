#include "tools/trials/trial_log.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/text.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/digest.h"
#include "services/runtime/wire/trial.h"

namespace fogline::trials {
namespace {

std::string_view TextOf(runtime::Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The facts of a run, without duplicates, in the order of their sequence numbers.
std::vector<trial_t> FactsOf(const std::filesystem::path& log, std::int64_t run_id) {
  std::map<std::int64_t, trial_t> facts;
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != ChannelOf<trial_t>().name) continue;
    trial_t fact{};
    const bool is_sound = runtime::Decode(event->data, fact) && runtime::WrongIn(fact) == nullptr;
    if (is_sound && fact.header.run_id == run_id) facts.emplace(fact.sequence, fact);
  }
  std::vector<trial_t> sorted;
  for (auto& [sequence, fact] : facts) sorted.push_back(std::move(fact));
  return sorted;
}

}  // namespace

std::string NameOf(TrialState state) {
  switch (state) {
    case TrialState::kOpen:
      return "open";
    case TrialState::kBroken:
      return "broken";
    case TrialState::kToAsk:
      return "to_ask";
    case TrialState::kDone:
      return "done";
  }
  return "";
}

TrialStory ReadStory(const std::filesystem::path& log) {
  TrialStory story;
  try {
    log::RunLogReader reader(log, log::RunLogReader::Compared::kFile);
    while (reader.Next() != nullptr) {
    }
    const log::RunLog& run = reader.run();
    story.run_id = run.run_id;
    story.steps = run.steps;
    story.last_utime = std::max<std::int64_t>(run.steps - 1, 0) *
                       static_cast<std::int64_t>(run.scenario.step_s * kMicrosPerSecond + 0.5);
    story.speed = run.realtime ? run.realtime->speed : 0;
    story.scenario = run.scenario;
    story.note = run.note;
    story.seal = run.seal;
    story.altered = run.altered;
    story.facts = FactsOf(log, run.run_id);
    const bool has_end = std::ranges::any_of(
        story.facts, [](const trial_t& fact) { return fact.kind == trial_t::END; });
    if (run.ended) story.state = has_end ? TrialState::kDone : TrialState::kToAsk;
  } catch (const InputError& error) {
    story.note = error.what();
  }
  return story;
}

std::string FaultText(const std::filesystem::path& log, const TrialStory& story) {
  const std::string path = PathText(log);
  // The note of an unreadable log already begins with the log's path.
  return story.note.starts_with(path) ? story.note : path + ": " + story.note;
}

void RequireReadable(const trial_t& fact) {
  if (runtime::WrongIn(fact) == nullptr) return;
  throw std::runtime_error(fmt::format(
      "a fact of trial {} of participant {} cannot be written: a text is too long, or a "
      "number is out of range",
      fact.trial, fact.participant));
}

void AddFacts(const std::filesystem::path& log, const TrialStory& story,
              const std::vector<trial_t>& facts, const runtime::SigningKey* key) {
  std::ranges::for_each(facts, RequireReadable);
  if (story.altered) {
    throw std::runtime_error(FaultText(log, story) + "; nothing is added");
  }
  const auto is_there = [&story](const trial_t& fact) {
    return std::ranges::any_of(
        story.facts, [&](const trial_t& other) { return other.sequence == fact.sequence; });
  };
  if (std::ranges::all_of(facts, is_there)) return;
  const log::EventLogReader old(log);
  log::LogHead head = story.seal ? story.seal->before : log::LogHead{};
  if (!story.seal) {
    log::EventLogReader whole(log);
    while (whole.Next()) {
    }
    head = whole.head();
  }
  AtomicFile file(log);
  runtime::Hash hash;
  const auto write = [&](runtime::Bytes bytes) {
    hash.Add(bytes);
    file.Write(TextOf(bytes));
  };
  old.ReadThrough(0, static_cast<std::size_t>(head.bytes), write);
  for (const trial_t& fact : facts) {
    if (is_there(fact)) continue;
    std::vector<std::uint8_t> data;
    runtime::Encode(fact, data);
    std::vector<std::uint8_t> event;
    log::AppendEvent(head.events, ChannelOf<trial_t>().name, story.last_utime, data, event);
    write(event);
    head.bytes += static_cast<std::int64_t>(event.size());
    ++head.events;
  }
  file.Close();
  // A log has no seal if the runner was killed after the last step. Then it is unknown whether the
  // log is complete, so the log stays without a seal.
  if (story.seal) {
    log_seal_t seal = story.seal->says;
    seal.file_hash = hash.Hex();
    log::SealLog(file.part(), head, std::move(seal), key);
  }
  file.Finish();
}

}  // namespace fogline::trials
