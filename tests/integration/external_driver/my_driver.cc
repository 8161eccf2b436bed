// A driver of your own: the linear car-following model, with the gains of Helly (1959). The
// argument and the result of Step() make this class the role "driver" (services/graph.h).
// RunService() does everything else that a role must do.
#include "services/runtime/process/service.h"

class MyDriver {
 public:
  explicit MyDriver(const fogline::Scenario& /*scenario*/) {}

  const fogline::driver_command_t& Step(const fogline::truth_t& truth) {
    const double gap_error_m = truth.host_gap_m - (2.0 + 1.2 * truth.host_speed_mps);
    const double closing_speed_mps = truth.host_speed_mps - truth.preceding_speed_mps;
    out_.header = truth.header;
    out_.acceleration_mps2 = 0.125 * gap_error_m - 0.5 * closing_speed_mps;
    out_.readiness = 1;
    return out_;
  }

 private:
  fogline::driver_command_t out_{};
};

int main(int argc, char** argv) { return fogline::runtime::RunService<MyDriver>(argc, argv); }
