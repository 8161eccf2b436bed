// SUMO's simulation with the cars of Fogline in it. This file is part of the module that
// services/models/traffic/load_sumo.h loads.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/models/sumo/lane_path.h"
#include "services/models/sumo/memory_file.h"
#include "services/models/traffic/traffic.h"

namespace fogline::sumo {

/// The traffic of one run, moved by SUMO. A process can have only one simulation of SUMO. So a
/// second object waits in Begin() until the run of the first object has ended.
class SumoTraffic final : public models::Traffic {
 public:
  explicit SumoTraffic(const models::TrafficSetup& setup) : setup_(setup) {}
  ~SumoTraffic() override { Close(); }
  SumoTraffic(const SumoTraffic&) = delete;
  SumoTraffic& operator=(const SumoTraffic&) = delete;

  models::LeaderInTraffic Begin(std::span<const models::Motion> cars) override;
  std::optional<models::LeaderInTraffic> Step(std::span<const models::Motion> cars) override;
  void End() override { Close(); }

 private:
  /// The files that SUMO reads.
  struct Files {
    explicit Files(const models::TrafficSetup& setup) : net(setup.net), routes(setup.routes) {}
    MemoryFile net;
    MemoryFile routes;
  };

  void Close();
  void Load();
  std::string WhyNot(const std::string& error, const std::string& said) const;
  void RequireCarBehindWhichToBegin() const;
  void Enter(std::span<const models::Motion> cars);
  void Move(std::span<const models::Motion> cars) const;
  double Along(const models::Motion& car) const { return car.position_m + origin_m_; }
  std::optional<models::LeaderInTraffic> Ahead(const models::Motion& host);

  models::TrafficSetup setup_;
  bool running_ = false;
  std::optional<Files> files_;
  std::optional<LanePath> path_;
  double origin_m_ = 0;             // place on the path at which Fogline's positions are 0
  std::vector<std::string> names_;  // names of Fogline's cars in SUMO
  std::string ahead_;               // name of the car ahead of the host
};

}  // namespace fogline::sumo
