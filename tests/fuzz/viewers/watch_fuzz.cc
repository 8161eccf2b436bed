// `fogline top` with arbitrary traffic. Input: for each message a byte and a datagram. The byte is
// an index into kChannels. A byte beyond kChannels means another channel, and the name of this
// channel comes before the datagram.
#include <nlohmann/json.hpp>

#include <limits>

#include "tests/fuzz/samples.h"
#include "tools/watch/traffic_statistics.h"
#include "tools/watch/traffic_text.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxDatagrams = 256;
constexpr std::size_t kMaxChannel = 63;
constexpr Duration kBetween = milliseconds(7);

std::string_view Text(runtime::Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.substr(0, std::min(text.find('\0'), kMaxChannel));
}

void DemandShowable(const watch::TrafficView& view) {
  for (const watch::Line& line : watch::TrafficLines(view, "udpm://239.255.76.67:7667")) {
    Demand(Printable(line.text) && line.text.find('\n') == std::string::npos,
           "a line can be written to a terminal");
  }
  const std::string text = watch::TrafficJson(view, "udpm://239.255.76.67:7667")
                               .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  Demand(nlohmann::json::accept(text), "the JSON text is valid JSON");
}

void DemandBounded(const watch::TrafficView& view) {
  Demand(view.runs.size() <= watch::TrafficStatistics::kMaxRuns, "runs fill no memory");
  Demand(view.others.size() <= watch::TrafficStatistics::kMaxOthers, "channels fill no memory");
  for (const watch::RunView& run : view.runs) {
    Demand(run.roles.size() <= watch::TrafficStatistics::kMaxRoles, "roles fill no memory");
    for (const watch::ChannelView& channel : run.channels) {
      if (!channel.steps) continue;
      Demand(channel.steps->lost >= 0 && channel.steps->missing >= 0, "less than none is not lost");
      Demand(channel.NumUndecodable() <= channel.arrivals.messages, "each message counts once");
    }
  }
}

void DemandSoundView(runtime::Bytes input) {
  TimePoint now{};
  watch::TrafficStatistics statistics(now);
  Cutter cutter(input);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < kMaxDatagrams && !cutter.empty(); ++i) {
    const std::size_t place = cutter.Byte();
    const std::string_view name =
        place < kNumChannels ? kChannels[place].name : Text(cutter.Datagram());
    now += kBetween;
    statistics.Add(name, cutter.Datagram(), now);
    if (place % 16 == 15) DemandShowable(statistics.Observe(now));
  }
  const watch::TrafficView view = statistics.Observe(now + kBetween);
  DemandBounded(view);
  DemandShowable(view);
  for (const watch::RunView& run : view.runs) taken += run.channels.size() + run.roles.size();
  if (taken > 0) Took();
}

}  // namespace

std::vector<Input> Seeds() {
  Input run;
  for (std::int64_t step = 0; step < kSteps; ++step) {
    ForEachStepChannel([&]<class M>(std::size_t channel) {
      run.push_back(static_cast<std::uint8_t>(channel));
      AddDatagram(Encoded(Sample<M>(step)), run);
    });
  }
  Input control;
  auto status = Sample<status_t>(2);
  status.error = "no disk\x1b[2J";
  control.push_back(IndexOf<status_t>());
  AddDatagram(Encoded(status), control);
  control.push_back(IndexOf<run_t>());
  AddDatagram(Encoded(Sample<run_t>(0)), control);
  Input readings;
  // Two readings of the processor time whose difference does not fit into 64 bits.
  for (const std::int64_t cpu_ms :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    auto reading = Sample<status_t>(2);
    reading.sequence = cpu_ms < 0 ? 1 : 2;
    reading.cpu_ms = cpu_ms;
    readings.push_back(IndexOf<status_t>());
    AddDatagram(Encoded(reading), readings);
  }
  Input others;
  for (const std::string_view name : {"LCM_SELF_TEST", "CAMERA\x9b", "TRUTH2"}) {
    others.push_back(0xff);
    AddDatagram({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()}, others);
    AddDatagram(Encoded(Sample<truth_t>(0)), others);
  }
  return {run, control, others, readings};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundView({data, size});
  return 0;
}
