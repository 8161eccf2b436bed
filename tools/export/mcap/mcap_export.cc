#include "tools/export/mcap/mcap_export.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "services/log/undecodable.h"
#include "services/log/wall_clock.h"
#include "services/runtime/wire/message_signer.h"
#include "tools/export/mcap/descriptor.h"
#include "tools/export/mcap/translate.h"
#include "tools/export/mcap/writer.h"
#include "tools/web/types/lcm_types.h"

namespace fogline::mcap {
namespace {

constexpr std::string_view kLibrary = "fogline";
constexpr std::string_view kEncoding = "protobuf";
constexpr std::int64_t kNanosPerMicro = 1000;

// In this file, `channel` is an index in kChannels, or kWallClock. kWallClock stands for the
// channel of the wall clock of the steps, which is not in kChannels.
constexpr std::size_t kWallClock = kNumChannels;
constexpr std::size_t kNone = kNumChannels + 1;

/// The message type of a channel.
const web::LcmStruct& TypeOf(std::size_t channel) {
  static const auto kTypes = std::apply(
      []<class... M>(const fogline::Channel<M>&...) {
        return std::array{web::FoglineTypes().Named(M::getTypeName())...,
                          web::FoglineTypes().Named(wall_clock_t::getTypeName())};
      },
      kGraph);
  return *kTypes[channel];
}

std::string_view NameOfChannel(std::size_t channel) {
  return channel == kWallClock ? log::kWallClockChannel : kChannels[channel].name;
}

/// The channel of an event that does not belong to a step; kNone for RUN and for any other event.
std::size_t ChannelBesideSteps(const log::Event& event) {
  if (event.channel == log::kWallClockChannel) return kWallClock;
  const std::size_t channel = ChannelNamed(event.channel);
  const bool is_beside = channel < kNumChannels && channel != IndexOf<run_t>() &&
                         kChannels[channel].pace == Pace::kControl;
  return is_beside ? channel : kNone;
}

/// Writes the steps of a run, and between them the messages outside of steps, as channels of a
/// file.
class Exporter {
 public:
  Exporter(const std::filesystem::path& log, const log::ReadOptions& options, AtomicFile& file)
      : log_(log),
        options_(options),
        events_(log),
        writer_([&file](std::string_view bytes) { file.Write(bytes); }, kLibrary) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      if (kChannels[channel].pace == Pace::kStep) Add(channel);
    }
  }

  log::RunLog Run() {
    log::RunLogReader reader(log_, options_);
    while (const log::StepMessages* messages = reader.Next()) {
      if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
      AddStep(*messages);
    }
    const log::RunLog& run = reader.run();
    run_id_ = run.run_id;
    AddEventsUntil(std::nullopt);
    AddFacts(run);
    writer_.Finish();
    return run;
  }

 private:
  void AddStep(const log::StepMessages& messages) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      const runtime::Bytes bytes = messages[channel];
      if (bytes.size() < runtime::kHeaderEnd) continue;  // a run in real time may lack a message
      const std::int64_t utime = runtime::ReadInt64(bytes, kUtimeOffset);
      if (!run_id_) run_id_ = runtime::ReadInt64(bytes, runtime::kRunIdOffset);
      AddEventsUntil(utime);
      AddMessage(channel, bytes, runtime::ReadInt64(bytes, runtime::kStepOffset), utime);
    }
  }

  /// Adds the messages of this run that belong to no step, in the order of the log. Stops before
  /// the first message with a simulated time after `utime`. If `utime` is nullopt, adds all
  /// remaining messages.
  void AddEventsUntil(std::optional<std::int64_t> utime) {
    while (true) {
      if (!event_) ReadEvent();
      if (!event_ || (utime && event_utime_ > *utime)) return;
      const std::size_t channel = ChannelBesideSteps(*event_);
      if (channel != kNone && log::IsOfRun(*event_, run_id_.value_or(0))) {
        AddMessage(channel, event_->data, runtime::ReadInt64(event_->data, runtime::kStepOffset),
                   event_utime_);
      }
      event_.reset();
    }
  }

  /// Reads the next event, and finds its simulated time. The recorder logs each event at its
  /// simulated time. Other loggers log an event at the wall clock. Then the simulated time is that
  /// of the newest step that was logged before.
  void ReadEvent() {
    event_ = events_.Next();
    if (!event_) return;
    if (log::IsStepChannel(event_->channel) && log::IsOfRun(*event_, run_id_.value_or(0))) {
      const std::int64_t utime = runtime::ReadInt64(event_->data, kUtimeOffset);
      has_wall_clock_ = event_->utime != utime;
      newest_utime_ = std::max(newest_utime_, utime);
    }
    event_utime_ = has_wall_clock_ ? newest_utime_ : event_->utime;
  }

  void AddMessage(std::size_t channel, runtime::Bytes bytes, std::int64_t step,
                  std::int64_t utime) {
    Add(channel);
    if (!Translate(channel, bytes)) {
      throw InputError(
          fmt::format("{}: error: {}", PathText(log_),
                      log::DoesNotDecode(fmt::format("message {} of {}", counts_[channel],
                                                     NameOfChannel(channel)))));
    }
    ++counts_[channel];
    const auto nanos = static_cast<std::uint64_t>(utime * kNanosPerMicro);
    writer_.Write(*ids_[channel], {.sequence = static_cast<std::uint32_t>(step),
                                   .log_time = nanos,
                                   .publish_time = nanos,
                                   .data = protobuf_});
  }

  /// Sets protobuf_ to the translated message. Another logger, such as lcm-logger, records signed
  /// messages with their signatures. So if a message does not decode, this function tries again
  /// without the last bytes, which may be a signature.
  /// @return false if the message does not decode
  bool Translate(std::size_t channel, runtime::Bytes bytes) {
    const auto translate = [&](runtime::Bytes message) {
      protobuf_.clear();
      return AppendProtobuf(types_, TypeOf(channel), message, protobuf_);
    };
    return translate(bytes) ||
           (runtime::LooksSigned(bytes) && translate(runtime::WithoutSignature(bytes)));
  }

  /// Adds a channel and its schema if the file does not have them yet.
  void Add(std::size_t channel) {
    if (ids_[channel]) return;
    const web::LcmStruct& type = TypeOf(channel);
    const SchemaId schema =
        writer_.AddSchema(type.FullName(), kEncoding, DescriptorSetOf(types_, type));
    const bool in_graph = channel != kWallClock;
    const Role from = in_graph ? kChannels[channel].from : Role::kRecorder;
    const std::string_view what =
        in_graph ? kChannels[channel].what : "the wall clock at which the TRUTH of a step came";
    ids_[channel] =
        writer_.AddChannel(schema, NameOfChannel(channel), kEncoding,
                           {{"from", std::string(NameOf(from))}, {"what", std::string(what)}});
  }

  void AddFacts(const log::RunLog& run) {
    std::map<std::string, std::string> facts{{"complete", run.complete ? "true" : "false"},
                                             {"digest", log::DigestText(run)},
                                             {"run_id", std::to_string(run.run_id)},
                                             {"steps", std::to_string(run.steps)}};
    if (run.has_scenario) {
      writer_.AddAttachment("scenario.json", "application/json", run.scenario_text);
      facts.insert({{"scenario_hash", run.scenario_hash},
                    {"seed", std::to_string(run.scenario.seed)},
                    {"title", run.scenario.title}});
    }
    writer_.AddMetadata("fogline", facts);
  }

  static constexpr std::size_t kUtimeOffset = runtime::kStepOffset + sizeof(std::int64_t);

  const std::filesystem::path& log_;
  const log::ReadOptions& options_;
  const web::LcmTypes& types_ = web::FoglineTypes();
  log::EventLogReader events_;       // the messages outside of steps
  std::optional<log::Event> event_;  // read, but not added yet
  std::int64_t event_utime_ = 0;     // the simulated time of event_
  std::int64_t newest_utime_ = 0;    // the simulated time of the newest step in the events so far
  bool has_wall_clock_ = true;       // whether the log has events at the wall clock
  std::optional<std::int64_t> run_id_;
  Writer writer_;
  std::array<std::optional<ChannelId>, kNumChannels + 1> ids_{};
  std::array<std::int64_t, kNumChannels + 1> counts_{};
  std::string protobuf_;
};

}  // namespace

bool IsMcapExport(const std::filesystem::path& file) {
  // The beginning of a file that Writer writes: the magic, and a Header without a profile.
  std::string content;
  PutString("", content);
  PutString(kLibrary, content);
  std::string expected(kMagic);
  PutRecord(Opcode::kHeader, content, expected);
  std::ifstream in(file, std::ios::binary);
  std::string head(expected.size(), '\0');
  in.read(head.data(), std::ssize(head));
  return head == expected;
}

log::RunLog WriteMcap(const std::filesystem::path& log, const log::ReadOptions& options,
                      const std::filesystem::path& file) {
  AtomicFile out(file);
  log::RunLog run = Exporter(log, options, out).Run();
  out.Finish();
  return run;
}

}  // namespace fogline::mcap
