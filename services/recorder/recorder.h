// The recorder: writes every per-step message of a run, and its scenario, into an LCM event log. It
// takes part in the lockstep: the world runs only a few steps ahead of what is on disk, so nothing
// is lost however fast the run is. Events stand in the order of step and graph table, whatever the
// order of arrival, so equal runs have equal logs but for the run id.
#pragma once

#include <filesystem>

#include "services/recorder/event_log.h"
#include "services/runtime/node.h"

namespace fogline {

class Recorder final : public Node {
 public:
  /// @throws InputError if the file cannot be written
  Recorder(Bus& bus, std::optional<std::int64_t> run_id, const std::filesystem::path& file);

 private:
  void Configure(const Scenario& scenario) override;
  bool Accept(std::size_t input, std::int64_t step, Arrival& arrival) override;
  void Compute(std::int64_t step) override;
  void OnStatusAsked(std::int64_t step, TimePoint now) override;
  void BeforeStatus() override;
  void OnLeave() override;

  void Write(std::int64_t step);

  std::optional<EventLogWriter> log_;
  std::int64_t final_ = -1;  // step after which the run ends, once known
};

}  // namespace fogline
