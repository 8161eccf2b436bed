#include "tools/runner/person_measures.h"

#include "services/log/driver_inputs.h"
#include "services/metrics/take_over/input_times.h"

namespace fogline::runner {

void AddPersonMeasures(const std::set<std::int64_t>& seats, LoggedRun& run) {
  if (seats.empty()) return;
  metrics::InputTimes times(run.result.take_overs, run.scenario.person.take_over_pedal);
  log::InputLatencyAccumulator latency;
  log::ForEachDriverInput(run.result.log, run.run_id, [&](const driver_input_t& input) {
    if (!seats.contains(input.instance)) return;
    times.Add(input);
    latency.Add(input);
  });
  // A keyboard at the terminal and a device of the kernel measure no latency.
  if (const log::InputLatency measured = latency.Result(); measured.inputs > 0) {
    run.result.input_latency = measured;
  }
}

}  // namespace fogline::runner
